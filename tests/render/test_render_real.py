"""Captured people and horses: silhouettes, torn places and contact as the data has them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Mesh, MeshClip
from tempose.render import LIGHT, Camera, contact_sheet, render_frame
from tempose.render.floor_shadow import floor_shadow
from tempose.render.frame import key_direction
from tempose.render.lights import QUALITIES, make_lights
from tempose.render.themes import rgb

pytestmark = pytest.mark.real


def obj(path, group=None):
    V, F, current = [], [], None
    for line in path.read_text().splitlines():
        kind, _, rest = line.partition(" ")
        if kind == "v":
            V.append([float(x) for x in rest.split()[:3]])
        elif kind == "g":
            current = rest.strip()
        elif kind == "f" and group in (None, current):
            corners = [int(c.split("/")[0]) - 1 for c in rest.split()]
            F += [[corners[0], *corners[k : k + 2]] for k in range(1, len(corners) - 1)]
    F = np.array(F)
    return np.array(V)[: F.max() + 1], F


@pytest.fixture(scope="module")
def crane(data_folder):
    frames = [obj(data_folder("vlasic-crane") / f"mesh_{t:04d}.obj") for t in (0, 60, 120)]
    return np.stack([V for V, _ in frames]), frames[0][1]


def mask(V, F, camera, size=(200, 200)):
    picture = render_frame(V, F, camera, size=size, lit=False, colors="#000000", quality="draft")
    return (picture != np.round(rgb(LIGHT.view) * 255).astype(int)).any(axis=2), picture


def test_opposite_parallel_views_have_mirrored_silhouettes(crane):
    V, F = crane
    for v in V:
        front, back = (Camera.fit([v.min(axis=0), v.max(axis=0)], a, 0.0, 0.0) for a in (0.4, 0.4 + np.pi))
        one, other = mask(v, F, front)[0], mask(v, F, back)[0]
        assert one.sum() > 3000
        assert (one != other[:, ::-1]).sum() <= 0.01 * one.sum()


def test_the_silhouette_has_the_height_of_the_person(crane):
    v, F = crane[0][0], crane[1]
    camera = Camera.fit([v.min(axis=0), v.max(axis=0)], 0.0, 0.0, 0.0)
    rows = np.flatnonzero(mask(v, F, camera, (300, 300))[0].any(axis=1))
    height = (rows[-1] - rows[0] + 1) / camera.pixels_per_metre((300, 300))
    assert_allclose(height, np.ptp(v[:, 1]), atol=0.02)


def test_a_closed_surface_shows_no_back_face_and_a_reversed_one_nothing_else(crane):
    v, F = crane[0][1], crane[1]
    camera = Camera.fit(v, 0.8, 0.2)
    tint = np.round(rgb(LIGHT.back) * 255)
    seen, picture = mask(v, F, camera)
    assert (picture[seen] == tint).all(axis=1).mean() < 1e-3
    seen, picture = mask(v, F[:, ::-1], camera)
    assert (picture[seen] == tint).all(axis=1).mean() > 0.999


def test_the_slit_in_a_hoof_of_the_horse_is_seen(data_folder):
    V, F = obj(data_folder("horse-gallop") / "0001.obj")
    tint = np.round(rgb(LIGHT.back) * 255)
    found = []
    for azimuth in np.linspace(0, 2 * np.pi, 8, endpoint=False):
        picture = mask(V, F, Camera.fit(V, azimuth, 0.1), (400, 400))[1]
        found.append(int((picture == tint).all(axis=2).sum()))
    assert 0 < max(found) < 100


def test_the_shadow_of_a_standing_body_begins_at_its_feet(data_folder):
    V, F = obj(data_folder("makehuman-base") / "base.obj", "body")
    V = 0.1 * (V - [0, V[:, 1].min(), 0])
    sole = V[V[:, 1] < 0.01][::5][:, [0, 2]]
    ring = (sole[:, None] + 0.03 * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])).reshape(-1, 2)
    key = key_direction(Camera.fit(V))
    shade = []
    for lift in (0.0, 0.5):
        lights = make_lights(V + np.array([0, lift, 0]), F, key, QUALITIES["good"])
        size = (len(ring), 1)
        shade.append(floor_shadow(ring, 0.0, lights, np.ones(len(ring), bool), size, 1).mean())
    assert shade[0] > 0.5
    assert shade[1] < 0.6 * shade[0]


def test_a_sheet_of_a_captured_clip_fills_its_cells(crane):
    V, F = crane
    clip = MeshClip(V.astype(np.float32), Mesh(V[0], F, name="crane"), fps=0.5)
    sheet = contact_sheet(clip, 3, ("front",), cell=(120, 160), quality="draft", ground=None, title="crane")
    background = np.round(rgb(LIGHT.view) * 255)
    for k in range(3):
        cell = sheet[60:190, 10 + 124 * k : 130 + 124 * k]
        share = (np.abs(cell - background).sum(axis=2) > 30).mean()
        assert 0.1 < share < 0.6
