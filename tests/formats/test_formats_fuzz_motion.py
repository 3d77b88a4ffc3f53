"""Mutated motion and skin files give a valid object or one clear error, never anything else."""

import json

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tempose.clips import Mesh
from tempose.formats.asf_amc import read_amc
from tempose.formats.bvh import read_bvh
from tempose.formats.conventions import FormatError
from tempose.formats.makehuman import read_skin

WORDS = [
    *("{", "}", "[", "]", ",", '"', ":", "#", "(", "\n", "\r", " ", "\t", "\x00", "\xff", "é", "٣"),
    *(
        "nan",
        "-inf",
        "1e999",
        "1e300",
        "-1e-320",
        "1e11",
        "-1",
        "0",
        "3.5",
        "99999999999999999999",
        "1_0",
        "0x10",
    ),
    *(
        "HIERARCHY",
        "ROOT a",
        "JOINT b",
        "End Site",
        "OFFSET",
        "OFFSET 0 0 0",
        "MOTION",
        "Frames: 0",
        "Frames: 9e9",
    ),
    *(
        "Frame Time: 0",
        "Frame Time: 1e-320",
        "Frame Time: 1e300",
        "CHANNELS 1 Xrotation",
        "CHANNELS 0",
        "Xposition",
    ),
    *(
        "begin",
        "end",
        ":bonedata",
        ":hierarchy",
        ":units",
        "length 0",
        "dof rx",
        "axis 0 0 0 XYZ",
        "root",
        "name x",
    ),
    *("null", "true", "{}", "[[]]", '"root"', "1", "2"),
]


@st.composite
def edits(draw):
    """Cuts, insertions, repetitions and exchanged bytes, at places given as fractions of the file."""
    place = st.floats(0, 1)
    kinds = st.sampled_from(["cut", "insert", "repeat", "byte", "word", "end"])
    word = st.sampled_from(WORDS)
    return draw(st.lists(st.tuples(kinds, place, st.integers(1, 80), word), min_size=1, max_size=4))


def mutate(data, changes):
    for kind, place, length, word in changes:
        k = int(place * len(data))
        payload = word.encode("latin-1" if word == "\xff" else "utf-8")
        if kind == "cut":
            data = data[:k] + data[k + length :]
        elif kind == "insert":
            data = data[:k] + payload + data[k:]
        elif kind == "repeat":
            data = data[: k + length] + data[k:]
        elif kind == "byte":
            data = data[:k] + bytes([length * 3 % 256]) + data[k + 1 :]
        elif kind == "end":
            data = data[:k]
        else:
            # a whole word is exchanged, so that the file stays what it is but for one value
            end = next((i for i in range(k, len(data)) if data[i : i + 1].isspace()), len(data))
            start = next((i for i in range(k, 0, -1) if data[i - 1 : i].isspace()), 0)
            data = data[:start] + payload + data[end:]
    return data


def check_message(error, path):
    assert str(error).startswith(str(path.parent)) and len(str(error).splitlines()) == 1


def check_clip(read, path):
    try:
        clip = read(path)
    except FormatError as error:
        check_message(error, path)
        return
    assert clip.n_frames >= 1
    assert np.isfinite(clip.rotations).all() and np.isfinite(clip.root_position).all()
    assert np.isfinite(clip.skeleton.offsets).all() and np.isfinite(clip.fps)
    assert np.abs(np.linalg.norm(clip.rotations, axis=-1) - 1).max() < 1e-6


def head_of_bvh(path, frames=3):
    lines = path.read_text().splitlines()
    start = lines.index("MOTION")
    return "\n".join(
        [*lines[: start + 1], f"Frames: {frames}", *lines[start + 2 : start + 3 + frames]]
    ).encode()


def head_of_amc(path, frames=3):
    lines = path.read_text().splitlines()
    return "\n".join(lines[: lines.index(str(frames + 1))]).encode()


def small_skin(folder):
    """The trunk of the MakeHuman skeleton, its weights, and a mesh that has the vertices for it."""
    skeleton = json.loads((folder / "default.mhskel").read_text())
    names = ["root", "spine05", "spine04", "spine03", "spine02", "spine01", "neck01", "clavicle.L"]
    skeleton["bones"] = {name: skeleton["bones"][name] for name in names}
    used = {bone[end] for bone in skeleton["bones"].values() for end in ("head", "tail")}
    skeleton = {"bones": skeleton["bones"], "joints": {name: skeleton["joints"][name] for name in used}}
    weights = json.loads((folder / "default_weights.mhw").read_text())["weights"]
    weights = {"weights": {name: weights[name][:5] for name in names}}
    n = 15000
    rng = np.random.default_rng(5)
    mesh = Mesh(rng.normal(size=(n, 3)), np.array([[0, 1, 2]]))
    return json.dumps(skeleton, indent=1).encode(), json.dumps(weights, indent=1).encode(), mesh


FUZZ = settings(
    max_examples=60,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
    deadline=None,
)


@pytest.mark.real
@pytest.mark.parametrize("name", [
    "mocap-cmu/cmu_12_01_walk.bvh", "mocap-bandai-namco/dataset-1_run_normal_001.bvh",
    "makehuman-base/walk1.bvh",
])  # fmt: skip
def test_mutated_bvh(data_folder, tmp_path, name):
    folder, file = name.split("/")
    original = head_of_bvh(data_folder(folder) / file)
    path = tmp_path / "a.bvh"
    path.write_bytes(original)
    assert read_bvh(path).n_frames == 3

    @FUZZ
    @given(edits())
    def run(changes):
        path.write_bytes(mutate(original, changes))
        check_clip(read_bvh, path)

    run()


@pytest.mark.real
@pytest.mark.parametrize("which", ["01.amc", "01.asf"])
def test_mutated_asf_and_amc(data_folder, tmp_path, which):
    folder = data_folder("mocap-cmu")
    for name, content in (
        ("01.asf", (folder / "01.asf").read_bytes()),
        ("01.amc", head_of_amc(folder / "01_01.amc")),
    ):
        (tmp_path / name).write_bytes(content)
    path = tmp_path / which
    original = path.read_bytes()
    assert read_amc(tmp_path / "01.amc").n_frames == 3

    @FUZZ
    @given(edits())
    def run(changes):
        path.write_bytes(mutate(original, changes))
        check_clip(read_amc, tmp_path / "01.amc")

    run()


@pytest.mark.real
@pytest.mark.parametrize("which", ["a.mhskel", "a_weights.mhw"])
def test_mutated_skin(data_folder, tmp_path, which):
    skeleton, weights, mesh = small_skin(data_folder("makehuman-base"))
    (tmp_path / "a.mhskel").write_bytes(skeleton)
    (tmp_path / "a_weights.mhw").write_bytes(weights)
    path = tmp_path / which
    original = path.read_bytes()
    assert read_skin(tmp_path / "a_weights.mhw", mesh).skeleton.n_joints == 8

    @FUZZ
    @given(edits())
    def run(changes):
        path.write_bytes(mutate(original, changes))
        try:
            skin = read_skin(tmp_path / "a_weights.mhw", mesh)
        except FormatError as error:
            check_message(error, path)
            return
        sums = skin.weights.sum(axis=1)
        assert np.isfinite(skin.skeleton.offsets).all()
        assert (np.isclose(sums, 1) | (sums == 0)).all()

    run()
