"""Write src/tempose/datasets/registry.json from folders of clips whose READMEs name their source.

Usage: python tools/dataset_registry.py DATA_FOLDER

A README names, under "Source", lines such as ``GitHub `owner/name`, commit `sha` `` followed by paths in
back quotes; a path that ends in a slash stands for every data file of the folder. Checksums are those of
the files found.
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
from pathlib import Path
from typing import Any

OUT = Path(__file__).resolve().parents[1] / "src" / "tempose" / "datasets" / "registry.json"

FACTS = {
    "cheburashka-lbs": (
        "a skinned character in 11 poses, with its weights",
        "none stated; cite CGF 2020 paper",
    ),
    "dem-bones-cache": (
        "an Alembic cache and the FBX rigs that made it",
        "none stated (repository BSD-3-Clause)",
    ),
    "elephant-gallop-2frames": (
        "two frames of a galloping elephant",
        "none stated; cite SIGGRAPH 2004 paper",
    ),
    "elephant-poses": ("ten poses of an elephant", "none stated; cite SIGGRAPH 2004 paper"),
    "horse-camel-poses": (
        "a horse, a camel and vertex pairs between them",
        "none stated; cite SIGGRAPH 2004 paper",
    ),
    "horse-gallop": ("48 frames of a galloping horse", "none stated; cite SIGGRAPH 2004 paper"),
    "horse-poses": ("ten poses of a horse", "none stated; cite SIGGRAPH 2004 paper"),
    "makehuman-base": ("a neutral human with skeleton, weights and poses", "CC0 1.0"),
    "mocap-bandai-namco": ("studio motion capture, BVH", "CC BY-NC 4.0"),
    "mocap-c3d-trc": ("optical markers, C3D and TRC", "Apache-2.0 in part, none stated in part"),
    "mocap-cmu": ("motion capture, ASF/AMC and BVH", "free for any use; acknowledge mocap.cs.cmu.edu"),
    "point-cache-pc2": ("a PC2 point cache and its mesh", "MIT or public domain"),
    "rigged-gltf": (
        "skinned and morphing glTF binaries",
        "CC0 1.0; Fox rig CC BY 4.0; CesiumMan Cesium terms",
    ),
    "usd-skel": ("USD scenes with skins and blend shapes", "Apache-2.0; TOST-1.0"),
    "vlasic-crane": ("175 frames of a captured person in clothes", "none stated; cite SIGGRAPH 2008 paper"),
}


def digest(path: Path) -> str:
    """Return the SHA-256 of a file, in hexadecimal."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def data_files(folder: Path) -> list[Path]:
    """List what is data in a folder: neither its README nor a licence text."""
    return sorted(p for p in folder.iterdir() if not re.match(r"README|LICENSE", p.name))


def sources(folder: Path) -> list[dict[str, Any]]:
    """Read where the files of one folder came from, with their checksums."""
    text = (folder / "README.md").read_text(encoding="utf-8")
    found: list[dict[str, Any]] = []
    for part in re.split(r"(?=GitHub `)", text)[1:]:
        repository, commit = re.match(r"GitHub `([^`]+)`, commit `([0-9a-f]{40})`", part).groups()  # type: ignore[union-attr]
        files: dict[str, str] = {}
        for path in re.findall(r"`([^`\n]+/[^`\n]*)`", part.split("commit", 1)[1]):
            local = data_files(folder) if path.endswith("/") else [folder / Path(path).name]
            base = path if path.endswith("/") else path.rpartition("/")[0] + "/"
            files |= {base + p.name: digest(p) for p in local}
        found.append({"repository": repository, "commit": commit, "files": files})
    return found


def main(root: Path) -> None:
    """Write the registry of every folder in `root`."""
    registry: dict[str, Any] = {}
    for name, (about, licence) in FACTS.items():
        entry = sources(root / name)
        listed = {Path(path).name for source in entry for path in source["files"]}
        missing = {p.name for p in data_files(root / name)} - listed
        if missing:
            raise SystemExit(f"{name}: the README names no source for {', '.join(sorted(missing))}")
        registry[name] = {"about": about, "licence": licence, "sources": entry}
    OUT.write_text(json.dumps(registry, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
