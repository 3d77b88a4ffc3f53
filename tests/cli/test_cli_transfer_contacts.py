"""Contacts and ground as the command line takes them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tempose.cli.transfer_contacts import load_contacts, parse_ground


def test_without_a_file_the_switch_rules() -> None:
    assert load_contacts(None, True) is True
    assert load_contacts(None, False) is False


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("c.json", '{"left_foot": [[0, 24], [51, 78]], "right_foot": []}'),
        ("c.toml", "left_foot = [[0, 24], [51, 78]]\nright_foot = []\n"),
    ],
)
def test_json_and_toml_say_the_same(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert load_contacts(tmp_path / name, True) == {"left_foot": [[0, 24], [51, 78]], "right_foot": []}


@pytest.mark.parametrize("text", ["", "[1, 2]", '{"left_foot": 3}', "{", "[" * 100_000])
def test_files_of_something_else_are_named(tmp_path: Path, text: str) -> None:
    path = tmp_path / "c.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"c\.json: expected"):
        load_contacts(path, True)


def test_stated_contacts_and_none_contradict_each_other(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="contradict each other"):
        load_contacts(tmp_path / "c.json", False)


@pytest.mark.parametrize(
    ("text", "height"), [(None, None), ("none", None), (" None ", None), ("-0.25", -0.25)]
)
def test_heights_of_the_ground(text: str | None, height: float | None) -> None:
    assert parse_ground(text) == height


@pytest.mark.parametrize("text", ["", "floor", "nan", "inf"])
def test_grounds_that_are_no_height_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match="--ground must be a height in metres or none"):
        parse_ground(text)
