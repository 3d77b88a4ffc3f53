"""Skeletons in real bodies: joints where the files say they are; animals are doubted."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tempose.clips import SkinnedMesh
from tempose.embedding import embed_skeleton, embed_skin
from tempose.formats import load_mesh, load_skin
from tempose.kinematics import rest_transforms
from tempose.kinematics.roles import find_roles

pytestmark = pytest.mark.real
Folder = Callable[[str], Path]


def makehuman(data_folder: Folder) -> SkinnedMesh:
    folder = data_folder("makehuman-base")
    return load_skin(folder / "default_weights.mhw", mesh=load_mesh(folder / "base.obj", group="body"))


def male(data_folder: Folder) -> SkinnedMesh:
    return load_skin(data_folder("rigged-gltf") / "human-male.glb")


@pytest.mark.parametrize("who", [makehuman, male])
def test_joints_lie_where_the_rig_has_them(who: Callable[[Folder], SkinnedMesh], data_folder: Folder) -> None:
    skin = who(data_folder)
    found, embedding = embed_skin(skin.mesh)
    roles, (_, positions) = find_roles(skin.skeleton), rest_transforms(skin.skeleton)
    away = [
        100 * np.linalg.norm(joint - positions[roles[name]]) / skin.mesh.height
        for name, joint in zip(embedding.names, embedding.joints)
    ]
    assert np.median(away) < 2.0 and max(away) < 5.0
    assert not embedding.doubtful and embedding.penalty < 0.6
    # the limb that a vertex follows most is the rig's own
    for part in ("forearm", "thigh", "shin"):
        for side in ("left", "right"):
            mine = found.weights[:, found.skeleton.index(f"{side}_{part}")] > 0.9
            theirs = skin.weights[mine].argmax(axis=1)
            names = {skin.skeleton.names[j] for j in np.unique(theirs)}
            assert mine.sum() > 20
            assert all((".R" not in n and "_r" not in n) or side == "right" for n in names)


@pytest.mark.parametrize(
    "path",
    [
        "horse-camel-poses/camel_ref.obj",
        "horse-camel-poses/horse_ref.obj",
        "elephant-poses/1.obj",
        "rigged-gltf/Fox.glb",
        "cheburashka-lbs/cheburashka.obj",
    ],
)
@pytest.mark.slow
def test_animals_are_doubted(path: str, data_folder: Folder) -> None:
    folder, name = path.split("/")
    embedding = embed_skeleton(load_mesh(data_folder(folder) / name))
    assert embedding.doubtful and embedding.penalty > 1.1


@pytest.mark.parametrize("frame", [0, 40])
def test_a_clothed_man_is_human_and_faces_his_toes(frame: int, data_folder: Folder) -> None:
    mesh = load_mesh(sorted(data_folder("vlasic-crane").glob("*.obj"))[frame])
    embedding = embed_skeleton(mesh)
    assert not embedding.doubtful and embedding.up == "+y"
    assert abs(np.linalg.det(embedding.facing) - 1) < 1e-9
    assert embedding.facing[2] @ [-1.0, 0, 0] > 0.8
