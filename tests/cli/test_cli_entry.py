"""Every failure is one line and an exit code; help is help."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

import tempose
from tempose.cli import entry
from tempose.cli.app import command


@pytest.fixture(autouse=True)
def interrupts_arrive():
    """Listen for Ctrl-C even where the tests run in the background of a shell, which ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


COMMANDS = sorted(getattr(command, "commands", {}))


def test_table_of_commands() -> None:
    assert {"info", "convert", "compare", "render", "data"} <= set(COMMANDS)


@pytest.mark.parametrize("words", [[], *([name] for name in COMMANDS), ["data", "fetch"], ["data", "list"]])
def test_help_exits_0(run: Callable[..., object], words: list[str]) -> None:
    ran = run(*words, "--help")
    assert (ran.code, ran.err) == (0, "")
    assert "Usage: tempose" in ran.out


def test_no_command_shows_help_and_version_is_ours(run: Callable[..., object]) -> None:
    assert run().out == run("--help").out
    assert run("--version").out == f"tempose {tempose.__version__}\n"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nothing"], "No such command 'nothing'"),
        (["info"], "Missing argument"),
        (["info", "a", "b"], "unexpected extra argument"),
        (["convert", "a"], "Missing argument 'OUT'"),
        (["convert", "a", "b", "--fps", "fast"], "Invalid value for '--fps'"),
        (["convert", "a", "b", "--wings"], "No such option: --wings"),
        (["render", "a"], "Missing option"),
        (["data"], "Missing command"),
        (["data", "fetch", "nothing"], "no data set named 'nothing'"),
    ],
)
def test_wrong_usage_is_one_line(run: Callable[..., object], words: list[str], said: str) -> None:
    ran = run(*words)
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.line


BAD_FILES = {
    "empty.obj": b"",
    "garbage.obj": bytes(range(256)) * 8,
    "cut.bvh": b"HIERARCHY\nROOT hips\n{\n  OFFSET 0 0",
    "still.bvh": b"MOTION\nFrames: 0\n",
    "nan.obj": b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "far.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n",
    "picture.obj": b"\x89PNG\r\n\x1a\n" + b"\0" * 60,
    "unknown.xyz": b"0 0 0\n",
    "bare": b"0 0 0\n",
}


@pytest.mark.parametrize("name", BAD_FILES)
@pytest.mark.parametrize("words", [["info", "F"], ["convert", "F", "out.npz"], ["compare", "F", "F"]])
def test_bad_file_is_one_line_that_names_it(
    run: Callable[..., object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, words: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path(name).write_bytes(BAD_FILES[name])
    ran = run(*(name if word == "F" else word for word in words))
    assert (ran.code, ran.out) == (2, "")
    assert name in ran.line
    assert os.listdir() == [name]


@pytest.mark.parametrize(
    ("error", "code", "line"),
    [
        (KeyboardInterrupt(), 130, "tempose: interrupted; nothing was written under its final name"),
        (OSError(28, "No space left on device", "out.npz"), 2, "tempose: out.npz: No space left on device"),
        (OSError(28, "No space left on device"), 2, "tempose: No space left on device"),
        (PermissionError(13, "Permission denied", "/x"), 2, "tempose: /x: Permission denied"),
        (MemoryError(), 2, "tempose: out of memory; try a smaller mesh or fewer frames"),
        (ValueError("two\n  lines"), 2, "tempose: two lines"),
        (ImportError('pip install "tempose[render]"'), 2, 'tempose: pip install "tempose[render]"'),
        (
            TypeError("x"),
            1,
            "tempose: a defect of Tempose, please report it: TypeError: x (TEMPOSE_TRACEBACK=1 shows where)",
        ),
    ],
)
def test_exit_codes(
    run: Callable[..., object], monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int, line: str
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(tempose, "load", fail)
    ran = run("info", "anything.obj")
    assert (ran.code, ran.line) == (code, line)


def test_traceback_on_request(run: Callable[..., object], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TEMPOSE_TRACEBACK", "1")
    with pytest.raises(ValueError, match="no such file"):
        run("info", "nothing.obj")


def _start(*words: object, **options: object) -> subprocess.Popen[bytes]:
    run_main = "import sys; from tempose.cli import main; sys.exit(main())"
    line = [sys.executable, "-c", run_main, *map(str, words)]
    return subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)  # type: ignore[call-overload]


@pytest.mark.skipif(os.name == "nt", reason="no named pipes")
def test_ctrl_c_while_reading(tmp_path: Path) -> None:
    pipe = tmp_path / "slow.obj"
    os.mkfifo(pipe)
    process = _start("info", pipe)
    deadline = time.monotonic() + 60
    writer = -1
    while writer < 0 and process.poll() is None and time.monotonic() < deadline:
        try:
            writer = os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)  # refused until the command has opened it
        except OSError:
            time.sleep(0.02)
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20)
    if writer >= 0:
        os.close(writer)
    assert process.returncode == 130
    assert (out, err) == (b"", b"tempose: interrupted; nothing was written under its final name\n")


def test_interrupt_that_got_lost_is_raised_at_the_next_progress(
    run: Callable[..., object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def swallow(path: str, progress: Callable[[int, int, str], None], **_: object) -> None:
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        progress(1, 2, "reading")
        raise AssertionError("went on after Ctrl-C")

    before = signal.getsignal(signal.SIGINT)
    monkeypatch.setattr(tempose, "load", swallow)
    assert run("info", "anything.obj").code == 130
    assert signal.getsignal(signal.SIGINT) is before
    monkeypatch.undo()
    assert run("info", tmp_path / "nothing.obj").code == 2, "one Ctrl-C ends one command"


@pytest.mark.skipif(os.name == "nt", reason="no pipes of that kind")
def test_reader_that_goes_away_hears_nothing() -> None:
    with _start("data", "list", "--json") as process:
        assert process.stdout is not None and process.stderr is not None
        process.stdout.close()
        assert process.wait(timeout=60) == 1
        assert process.stderr.read() == b""


def test_main_returns_the_code_for_the_shell() -> None:
    assert entry.main(["--version"]) == 0
