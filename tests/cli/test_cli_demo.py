"""`tempose demo` leaves clips, pictures, a table and a page that needs no network."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import tempose
from tempose.cli import demo, demo_cases, demo_detail, demo_signals
from tempose.signals.pictures import thumbnails

Run = Callable[..., Any]


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same demo with coarse characters, short motions and small pictures."""
    pytest.importorskip("imageio_ffmpeg")

    def short(case: demo_cases.Case) -> demo_cases.Case:
        return replace(case, motion=lambda: case.motion().frames(slice(0, 6)))

    monkeypatch.setattr(demo_cases, "TRIANGLES", 2000)
    monkeypatch.setattr(demo, "CASES", tuple(short(case) for case in demo_cases.CASES[:2]))
    for name, value in (("_CELL", 24), ("_MOMENTS", 2), ("_FILM", (24, 24))):
        monkeypatch.setattr(demo, name, value)
        monkeypatch.setattr(demo_signals, name, value)
        if name != "_FILM":
            monkeypatch.setattr(demo_detail, name, value)
    monkeypatch.setattr(demo_signals, "TRIANGLES", 2000)
    monkeypatch.setattr(demo_detail, "TRIANGLES", 2000)
    monkeypatch.setattr(demo_detail, "SECONDS", 0.6)
    monkeypatch.setattr(thumbnails, "FINE", 1)


def test_demo_writes_everything_it_promises(run: Run, tmp_path: Path, small: None) -> None:
    out = tmp_path / "new" / "demo"
    ran = run("demo", "-o", out)
    assert ran.code == 0, ran.err
    names = {path.name for path in out.iterdir()}
    assert names == {
        "detail.glb",
        "detail.png",
        "detail.tempose",
        "detail_heldout.svg",
        "human_run.glb",
        "human_run.png",
        "human_walk.glb",
        "human_walk.mp4",
        "human_walk.png",
        "report.html",
        "report.json",
        "signals.glb",
        "signals.mp4",
        "signals.png",
        "signals.tempose",
        "signals_plane_dark.png",
        "signals_plane_light.png",
        "signals_retiming.svg",
    }
    report = json.loads((out / "report.json").read_text())
    assert (report["command"], report["version"]) == ("demo", tempose.__version__)
    assert [t["name"] for t in report["transfers"]] == ["human_walk", "human_run"]
    for transfer in report["transfers"]:
        assert transfer["title"] in ran.out
        assert transfer["flipped_percent"] == 0
    curve = report["signals"]
    assert curve["title"] in ran.out and curve["errors"]["rms_percent"] < 0.5 and curve["seam"] < 2
    assert tempose.formats.load_clip(out / "signals.glb").n_frames == curve["played"]
    clip = tempose.formats.load_clip(out / "human_walk.glb")
    assert clip.n_frames == report["transfers"][0]["frames"]


def test_page_asks_nothing_of_the_network(run: Run, tmp_path: Path, small: None) -> None:
    assert run("demo", "-o", tmp_path, "--only", "human_walk").code == 0
    page = (tmp_path / "report.html").read_text()
    assert not re.findall(r'(?:src|href)="(?!data:|#)', page) and "@import" not in page
    assert "A walk" in page and "A run" not in page and "as a curve" not in page


@pytest.mark.slow
def test_signals_alone(run: Run, tmp_path: Path, small: None) -> None:
    assert run("demo", "-o", tmp_path, "--only", "signals").code == 0
    page = (tmp_path / "report.html").read_text()
    assert "as a curve" in page and "A walk" not in page
    assert not re.findall(r'(?:src|href)="(?!data:|#)', page)


def test_unknown_case_lists_the_known(run: Run, tmp_path: Path) -> None:
    ran = run("demo", "-o", tmp_path / "out", "--only", "flight")
    assert ran.code == 2 and "human_walk" in ran.line and not (tmp_path / "out").exists()


def test_folder_that_cannot_be_made(run: Run, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    ran = run("demo", "-o", tmp_path / "file")
    assert ran.code == 2 and "file" in ran.line


@pytest.mark.slow
@pytest.mark.parametrize("case", demo_cases.CASES, ids=lambda case: case.name)
def test_built_in_transfers_are_good(case: demo_cases.Case) -> None:
    result = tempose.transfer.transfer_motion(case.motion(), demo_cases.make_target(case.target))
    report = result.report
    assert report["flipped_percent"] < 0.01
    assert report["edge_ratio"][0] > 0.75 and report["edge_ratio"][1] < 1.25
    assert report["bone_direction_deg"]["mean"] < 6
