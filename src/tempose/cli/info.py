"""`tempose info`: what is in a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

import tempose
from tempose.cli.console import progress_bar, show_json, show_table
from tempose.cli.options import Clip, FromFps, FromUnit, FromUp, Json, Topology

if TYPE_CHECKING:
    from tempose.clips import Mesh, MeshClip, SkeletonClip

_DEFECTS = {
    "boundary_edges": "open edges (the surface has holes)",
    "nonmanifold_edges": "edges with more than two faces",
    "degenerate_faces": "faces without area",
    "duplicate_faces": "faces that are there twice",
    "loose_vertices": "vertices without a face",
}


def info(  # numpydoc ignore=PR01
    file: Annotated[str, typer.Argument(help="File, folder of frames, glob, or name.####.obj.")],
    from_up: FromUp = None,
    from_unit: FromUnit = None,
    from_fps: FromFps = None,
    clip: Clip = None,
    topology: Topology = None,
    json: Json = False,
) -> None:
    """Say what is in a file, in which axes and unit, and what is wrong with it."""
    with progress_bar() as progress:
        thing = tempose.load(
            file,
            up=from_up,
            unit=from_unit,
            fps=from_fps,
            clip=clip,
            topology=topology,
            progress=progress,
        )
    facts = _facts(file, thing)
    if json:
        show_json(facts)
    else:
        show_table([(name.replace("_", " "), _text(name, value)) for name, value in facts.items()])


def _facts(file: str, thing: Mesh | MeshClip | SkeletonClip) -> dict[str, Any]:
    source = thing.source
    facts: dict[str, Any] = {"file": file, "format": source.format, "name": thing.name}
    if isinstance(thing, tempose.SkeletonClip):
        facts |= {"kind": "skeleton clip", **_motion(thing), "joints": list(thing.skeleton.names)}
        problems: dict[str, int] = {}
    else:
        moving = isinstance(thing, tempose.MeshClip)
        mesh = thing.mesh if isinstance(thing, tempose.MeshClip) else thing
        facts |= {"kind": "mesh clip" if moving else "mesh"}
        facts |= _motion(thing) if isinstance(thing, tempose.MeshClip) else {}
        problems = tempose.geometry.find_defects(mesh.vertices, mesh.faces).as_dict()
        facts |= _surface(mesh) | {"pieces": problems.pop("pieces")}
    if source.format in ("glb", "gltf"):
        facts |= _scene(file)
    return facts | {
        "up": source.up,
        "unit_metres": source.unit,
        "guessed": list(source.guessed),
        "notes": list(source.notes),
        "problems": {key: count for key, count in problems.items() if count},
    }


def _motion(clip: MeshClip | SkeletonClip) -> dict[str, Any]:
    return {"frames": clip.n_frames, "fps": clip.fps, "seconds": max(clip.n_frames - 1, 0) / clip.fps}


def _surface(mesh: Mesh) -> dict[str, Any]:
    return {
        "vertices": len(mesh.vertices),
        "triangles": len(mesh.faces),
        "polygons": len(mesh.faces) if mesh.polygons is None else len(mesh.polygons),
        "uv": mesh.uv is not None,
        "colors": mesh.colors is not None,
        "groups": {name: len(faces) for name, faces in mesh.groups.items()},
        "height_metres": mesh.height,
        "diagonal_metres": mesh.diagonal,
    }


def _scene(file: str) -> dict[str, Any]:
    from tempose.formats.glb import clip_names

    facts: dict[str, Any] = {"animations": list(clip_names(file))}
    try:
        skin = tempose.formats.load_skin(file)
    except tempose.formats.FormatError:
        return facts
    return facts | {"joints": list(skin.skeleton.names)}


def _text(name: str, value: Any) -> str:
    if name == "problems":
        return ", ".join(f"{count} {_DEFECTS[key]}" for key, count in value.items()) or "none found"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, dict):
        return _shortened([f"{key} ({count})" for key, count in value.items()], 12)
    if isinstance(value, list):
        return f"{len(value)}: {_shortened(value, 80)}" if name == "joints" else _shortened(value, 12)
    return str(value) or "-"


def _shortened(words: list[str], count: int) -> str:
    more = f" and {len(words) - count} more" if len(words) > count else ""
    return ", ".join(words[:count]) + more or "-"
