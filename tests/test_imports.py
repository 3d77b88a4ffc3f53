"""Imports point down only, and `import tempose` stays light."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

SRC = Path(__file__).resolve().parents[1] / "src" / "tempose"

TABLE = [
    {"_version", "_validate", "_files", "_tables", "typing", "jobs"},
    {"rotations", "linalg", "geometry", "curves", "regression"},
    {"clips", "kinematics"},
    {"formats", "live", "samples", "datasets", "shape_spaces", "embedding", "metrics", "render", "models"},
    {"transfer", "signals", "rigging", "detail", "steering"},
    {"cli", "studio"},
]
LEVELS = {package: level for level, packages in enumerate(TABLE) for package in packages}
SIDEWAYS = {("kinematics", "clips"), ("_validate", "typing"), ("jobs", "typing"), ("detail", "rigging")}
"""The only imports allowed inside one level."""

OPTIONAL = {
    "PIL",
    "bpy",
    "cholespy",
    "embreex",
    "ezc3d",
    "fastapi",
    "imageio",
    "imageio_ffmpeg",
    "pxr",
    "skimage",
    "starlette",
    "uvicorn",
}


def imported_names(node: ast.AST) -> list[str]:
    """Every module that the statement may load; `from a import b` may load a.b."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
        return [f"{node.module}.{alias.name}" for alias in node.names]
    return []


def direction_faults(path: Path, root: Path) -> list[str]:
    """Imports of a file that do not point down, wherever in the file they stand."""
    here = path.relative_to(root).parts[0].removesuffix(".py")
    if here not in LEVELS:
        return [f"{here!r} stands in no level of {Path(__file__).name}"]
    faults: list[str] = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level > 0:
            faults.append(f"line {node.lineno}: relative imports hide their level")
        for name in imported_names(node):
            fault = _fault(here, name.split("."))
            faults += [f"line {node.lineno}: {fault}"] if fault else []  # type: ignore[attr-defined]
    return faults


def _fault(here: str, parts: list[str]) -> str | None:
    if parts[0] != "tempose":
        return None
    there = parts[1] if len(parts) > 1 else ""
    if there not in LEVELS:
        # the lazy top level reaches everything, so only entry points may use it
        return None if LEVELS[here] == 5 else f"{here} must not import the lazy names of tempose"
    if there == here or (here, there) in SIDEWAYS or LEVELS[there] < LEVELS[here]:
        return None
    return f"{here} (level {LEVELS[here]}) must not import {there} (level {LEVELS[there]})"


def run_on_import(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Statements that run when a module is imported: everything but the bodies of functions."""
    for node in body:
        yield node
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            continue
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            yield from run_on_import(node.orelse)
            continue
        for field in ("body", "orelse", "finalbody"):
            yield from run_on_import(getattr(node, field, []))
        for handler in getattr(node, "handlers", []):
            yield from run_on_import(handler.body)


def optional_faults(path: Path) -> list[str]:
    """Optional packages that importing the file would load."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [
        f"line {node.lineno}: import {name} inside the function that needs it"
        for node in run_on_import(tree.body)
        for name in imported_names(node)
        if name.split(".")[0] in OPTIONAL
    ]


def sources() -> list[Path]:
    return sorted(path for path in SRC.rglob("*.py") if path != SRC / "__init__.py")


@pytest.mark.parametrize("path", sources(), ids=lambda path: path.relative_to(SRC).as_posix())
def test_imports_point_down(path: Path) -> None:
    assert direction_faults(path, SRC) == []


@pytest.mark.parametrize("path", sources(), ids=lambda path: path.relative_to(SRC).as_posix())
def test_optional_packages_are_imported_inside_functions(path: Path) -> None:
    assert optional_faults(path) == []


def test_the_walk_finds_the_library() -> None:
    found = {path.relative_to(SRC).parts[0].removesuffix(".py") for path in sources()}
    assert {"typing", "rotations", "geometry", "clips", "kinematics", "formats", "metrics"} <= found


UP_OR_SIDEWAYS = [
    ("rotations/bad.py", "from tempose.clips import Mesh"),
    ("rotations/bad.py", "import tempose.clips.mesh as m"),
    ("geometry/bad.py", "from tempose.linalg import SparseCholesky"),
    ("typing.py", "from tempose._validate import as_floats"),
    ("clips/bad.py", "from tempose.kinematics import forward_kinematics"),
    ("metrics/bad.py", "from tempose.formats import load"),
    ("render/bad.py", "def f():\n    from tempose import samples"),
    ("transfer/bad.py", "from tempose.signals import SignalModel"),
    ("rigging/bad.py", "from tempose.detail import DetailModel"),
    ("transfer/bad.py", "if True:\n    from tempose.cli import main"),
    ("cli/bad.py", "from tempose.studio import serve"),
    ("studio/bad.py", "from tempose.cli import main"),
    ("metrics/bad.py", "import tempose"),
    ("metrics/bad.py", "from tempose import load"),
    ("metrics/bad.py", "from .errors import compare"),
    ("somewhere/bad.py", "import numpy"),
]
DOWN = [
    ("clips/good.py", "from tempose._validate import as_floats\nfrom tempose.clips.source import Source"),
    ("kinematics/good.py", "from tempose.clips import Skeleton\nfrom tempose.rotations import multiply"),
    ("metrics/good.py", "import numpy as np\nfrom tempose.geometry import face_normals"),
    ("detail/good.py", "from tempose.rigging import Rig"),
    ("transfer/good.py", "from tempose.formats.conventions import FormatError\nimport tempose.metrics"),
    ("cli/good.py", "import tempose\nfrom tempose import load, __version__\nfrom tempose import transfer"),
]


def planted(tmp_path: Path, name: str, text: str) -> Path:
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(("name", "text"), UP_OR_SIDEWAYS)
def test_the_checker_catches_what_does_not_point_down(tmp_path: Path, name: str, text: str) -> None:
    assert len(direction_faults(planted(tmp_path, name, text), tmp_path)) == 1


@pytest.mark.parametrize(("name", "text"), DOWN)
def test_the_checker_lets_pass_what_points_down(tmp_path: Path, name: str, text: str) -> None:
    assert direction_faults(planted(tmp_path, name, text), tmp_path) == []


@pytest.mark.parametrize(
    "text",
    [
        "import PIL.Image",
        "from embreex import rtcore_scene",
        "try:\n    import imageio\nexcept ImportError:\n    imageio = None",
        "if True:\n    pass\nelse:\n    import pxr",
        "class A:\n    from uvicorn import run",
        "with a:\n    import fastapi",
    ],
)
def test_the_checker_catches_optional_packages_on_import(tmp_path: Path, text: str) -> None:
    assert len(optional_faults(planted(tmp_path, "bad.py", text))) == 1


@pytest.mark.parametrize(
    "text",
    ["def f():\n    import PIL.Image", "if TYPE_CHECKING:\n    import pxr", "import numpy, scipy, trimesh"],
)
def test_the_checker_lets_pass_optional_packages_in_functions(tmp_path: Path, text: str) -> None:
    assert optional_faults(planted(tmp_path, "good.py", text)) == []


def modules_after(statement: str) -> set[str]:
    code = f"import sys; {statement}; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return set(run.stdout.split())


def test_import_loads_nothing_heavy() -> None:
    loaded = modules_after("import tempose")
    assert not loaded & (
        OPTIONAL | {"numba", "trimesh", "pygltflib", "typer", "rich", "pooch", "scipy.sparse"}
    )
    assert {name for name in loaded if name.startswith("tempose.")} <= {"tempose._version"}


def test_using_every_name_loads_no_optional_package() -> None:
    assert not modules_after("import tempose; [getattr(tempose, n) for n in tempose.__all__]") & OPTIONAL


def test_every_lazy_name_exists_and_an_unknown_one_is_refused() -> None:
    import tempose

    assert set(dir(tempose)) == set(tempose.__all__)
    for name in tempose.__all__:
        assert getattr(tempose, name) is getattr(tempose, name)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        tempose.nothing  # noqa: B018
