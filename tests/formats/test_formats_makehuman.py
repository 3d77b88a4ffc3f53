"""MakeHuman skins: joints are means of helper vertices, rows of weights sum to 1, faults are named."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Mesh, Source
from tempose.formats.conventions import FormatError
from tempose.formats.makehuman import read_skin
from tempose.formats.obj import read_first
from tempose.kinematics import linear_blend_skinning, rest_transforms

V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [4, 0, 0], [6, 0, 0], [5, 2, 2], [8, 1, 0]], float)
SKIN = np.array([[0, 1, 2]])
BASE = Mesh(V, [[0, 1, 2], [3, 4, 5], [4, 5, 6]])
BODY = Mesh(V[:3], SKIN)


def skeleton():
    return {
        "bones": {
            "hand": {"head": "b", "tail": "c", "parent": "arm"},
            "arm": {"head": "a", "tail": "b", "parent": "root"},
            "root": {"head": "o", "tail": "a", "parent": None},
        },
        "joints": {"o": [0], "a": [3, 4], "b": [5], "c": [6]},
    }


def weights():
    return {"weights": {"arm": [[0, 0.5], [1, 1.0]], "hand": [[0, 0.75], [5, 1.0]], "root": []}}


@pytest.fixture
def write(tmp_path):
    def put(**given):
        content = {"skeleton": skeleton(), "weights": weights(), **given}
        for name, key in (("x.mhskel", "skeleton"), ("x_weights.mhw", "weights")):
            text = content[key] if isinstance(content[key], str) else json.dumps(content[key])
            (tmp_path / name).write_text(text)
        return tmp_path / "x_weights.mhw"

    return put


def test_joints_are_means_of_helpers_and_parents_come_first(write):
    skin = read_skin(write(), BASE)
    assert skin.skeleton.names == ("root", "arm", "hand")
    assert skin.skeleton.parents.tolist() == [-1, 0, 1]
    assert_allclose(rest_transforms(skin.skeleton)[1], [[0, 0, 0], [5, 0, 0], [5, 2, 2]])
    assert_allclose(skin.skeleton.tips, [[5, 0, 0], V[5] - [5, 0, 0], V[6] - V[5]])


def test_rows_of_weights_sum_to_one_or_nothing(write):
    skin = read_skin(write(), BASE)
    expected = np.zeros((7, 3))
    expected[0, 1:], expected[1, 1], expected[5, 2] = [0.4, 0.6], 1, 1
    assert_allclose(skin.weights, expected)
    assert_allclose(read_skin(write(), BODY, base=BASE).weights, expected[:3])


def test_helpers_are_read_again_from_where_the_mesh_came(write, tmp_path):
    path = tmp_path / "base.obj"
    faces = "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in BASE.faces)
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in V) + faces)
    body = Mesh(V[:3] * 0.1, SKIN, source=Source(str(path), "obj", "y", 0.1))
    assert_allclose(read_skin(write(), body).skeleton.offsets, [[0, 0, 0], [0.5, 0, 0], [0, 0.2, 0.2]])
    turned = Mesh(V[:3][:, [0, 2, 1]] * [0.1, 0.1, -0.1], SKIN, source=Source(str(path), "obj", "z", 0.1))
    assert_allclose(read_skin(write(), turned).skeleton.offsets, [[0, 0, 0], [0.5, 0, 0], [0, 0.2, -0.2]])
    moved = Mesh(V[:3], SKIN, source=Source(str(path), "obj", "y", 0.1))
    with pytest.raises(FormatError, match=r"expected a mesh of the first 3 vertices of the base mesh, found"):
        read_skin(write(), moved)


def test_a_mesh_without_helpers_is_refused_with_advice(write):
    with pytest.raises(
        FormatError, match=r"joints need 7 vertices, the mesh has 3 .* pass the whole mesh as base"
    ):
        read_skin(write(), BODY)
    with pytest.raises(FormatError, match=r"joints need 7 vertices, the base mesh has 3"):
        read_skin(write(), BODY, base=BODY)


def test_the_skeleton_beside_is_found_or_asked_for(write, tmp_path):
    path = write()
    (tmp_path / "x.mhskel").rename(tmp_path / "other.mhskel")
    assert read_skin(path, BASE).skeleton.n_joints == 3
    (tmp_path / "third.mhskel").write_text("")
    with pytest.raises(FormatError, match=r"expected x.mhskel beside it, found other.mhskel, third.mhskel"):
        read_skin(path, BASE)
    assert read_skin(path, BASE, tmp_path / "other.mhskel").skeleton.n_joints == 3


def changed(make, *keys, to):
    content = make()
    place = content
    for key in keys[:-1]:
        place = place[key]
    place[keys[-1]] = to
    return content


@pytest.mark.parametrize(("content", "message"), [
    ("", r"mhskel: expected a MakeHuman skeleton, found an empty file"),
    ("{\n,}", r"mhskel, line 2: expected a MakeHuman skeleton in JSON"),
    ("[" * 100000, r"mhskel: expected a MakeHuman skeleton in JSON"),
    ("[1]", r"mhskel: expected an object 'bones' in the JSON, found nothing"),
    (changed(skeleton, "joints", to=[1]), r"expected an object 'joints' in the JSON, found \[1\]"),
    (changed(skeleton, "bones", "hand", to=3), r"expected the parent of 'hand' among the other bones"),
    (changed(skeleton, "bones", "hand", "parent", to="leg"), r"the parent of 'hand' .* found 'leg'"),
    (changed(skeleton, "bones", "hand", "parent", to=["a"]), r"the parent of 'hand' .* found \['a'\]"),
    (changed(skeleton, "bones", "hand", "parent", to=None), r"one bone without parent, found hand, root"),
    (changed(skeleton, "bones", "root", "parent", to="hand"), r"one bone without parent, found none"),
    (changed(skeleton, "bones", "arm", "parent", to="hand"), r"every bone under 'root', found a circle"),
    (changed(skeleton, "bones", "arm", "head", to="z"), r"the head of bone 'arm', found nothing"),
    (changed(skeleton, "joints", "c", to=[]), r"indices for the tail of bone 'hand', found \[\]"),
    (changed(skeleton, "joints", "c", to=[-1]), r"indices for the tail of bone 'hand', found \[-1\]"),
    (changed(skeleton, "joints", "c", to=[1.5]), r"indices for the tail of bone 'hand', found \[1.5\]"),
    (changed(skeleton, "joints", "c", to=[[1], [2, 3]]), r"indices for the tail of bone 'hand'"),
    (changed(skeleton, "joints", "c", to=[10**30]), r"indices for the tail of bone 'hand'"),
    (changed(skeleton, "joints", "c", to=[99]), r"joints need 100 vertices"),
])  # fmt: skip
def test_faults_of_the_skeleton_are_named(write, content, message):
    with pytest.raises(FormatError, match=message):
        read_skin(write(skeleton=content), BASE)


@pytest.mark.parametrize(("content", "message"), [
    ("{}", r"mhw: expected an object 'weights' in the JSON, found nothing"),
    (changed(weights, "weights", "leg", to=[]), r"mhw: expected bones of the skeleton, found 'leg'"),
    (changed(weights, "weights", "arm", to=[[0, -1.0]]), r"pairs \[vertex, weight >= 0\] for bone 'arm'"),
    (changed(weights, "weights", "arm", to=[[0, float("nan")]]), r"bone 'arm', found \[\[0, nan\]\]"),
    (changed(weights, "weights", "arm", to=[[0.5, 1]]), r"pairs \[vertex, weight >= 0\] for bone 'arm'"),
    (changed(weights, "weights", "arm", to=[0, 1]), r"pairs \[vertex, weight >= 0\] for bone 'arm'"),
    (changed(weights, "weights", "arm", to=[[0, 1, 2]]), r"pairs \[vertex, weight >= 0\] for bone 'arm'"),
    (changed(weights, "weights", "arm", to="arm"), r"pairs \[vertex, weight >= 0\] for bone 'arm'"),
    (changed(weights, "weights", "arm", to=None), r"pairs .* for bone 'arm', found nothing"),
])  # fmt: skip
def test_faults_of_the_weights_are_named(write, content, message):
    with pytest.raises(FormatError, match=message):
        read_skin(write(weights=content), BASE)


@pytest.mark.real
def test_the_real_body_is_bound_everywhere_and_moves_rigidly(data_folder):
    folder = data_folder("makehuman-base")
    mesh = read_first(str(folder / "base.obj")).mesh
    body = Mesh(mesh.vertices[:13380] * 0.1, mesh.faces[mesh.groups["body"]],
                source=Source(str(folder / "base.obj"), "obj", "y", 0.1))  # fmt: skip
    skin = read_skin(folder / "default_weights.mhw", body)
    J = skin.skeleton.n_joints
    assert (J, skin.weights.shape) == (163, (13380, 163))
    assert_allclose(skin.weights.sum(axis=1), 1.0, atol=1e-12)
    joints = dict(zip(skin.skeleton.names, rest_transforms(skin.skeleton)[1]))
    assert_allclose(joints["wrist.L"] * [-1, 1, 1], joints["wrist.R"], atol=1e-3)
    assert joints["wrist.L"][0] > 0.3 and joints["head"][1] - joints["foot.L"][1] > 1.3
    # a quarter turn about the vertical through the root moves every vertex with it
    half = np.sqrt(0.5)
    pose = np.tile([1.0, 0, 0, 0], (1, J, 1))
    pose[0, 0] = [half, 0, half, 0]
    root = skin.skeleton.offsets[:1]
    local = body.vertices - root
    expected = np.column_stack([local[:, 2], local[:, 1], -local[:, 0]]) + root
    assert_allclose(linear_blend_skinning(skin, pose, root)[0], expected, atol=1e-9)
