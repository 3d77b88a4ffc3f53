"""Deformation transfer of Sumner and Popović, plainly: what the horse's gallop on the camel is compared with.

    python benchmarks/sumner_popovic.py        renews their table in docs/results.md and the sheet

Correspondence by the non-rigid registration of trimesh, which implements section 4 of their paper; transfer
by its section 3, one sparse least squares problem for the positions of the target's vertices and of a fourth
vertex over every face, factorised once.

R. W. Sumner, J. Popović, "Deformation Transfer for Triangle Meshes", ACM TOG 23(3), 2004.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp
import trimesh
from scipy.spatial import KDTree

from real_bodies import DATA, ROOT
from results_page import line, table, write_block
from results_transfer import camel
from tempose.clips import Mesh, MeshClip
from tempose.formats import load_clip, load_mesh
from tempose.geometry import face_normals
from tempose.linalg import SparseCholesky
from tempose.metrics import edge_ratios, flipped_percent, folded_percent, volume_change
from tempose.render import contact_sheet, save_png
from tempose.rotations import from_matrix
from tempose.transfer import load_pairs

CANDIDATES = 30
COLUMNS = (
    "method",
    "correspondence s",
    "set-up s",
    "48 frames s",
    "flipped %",
    "folded %",
    "edges p1 / p99",
    "volume mean / worst %",
)


def spans(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Two edges and a scaled normal of every face as columns, (..., m, 3, 3)."""
    a, b, c = (V[..., F[:, k], :] for k in range(3))
    normal = np.cross(b - a, c - a)
    length = np.sqrt(np.linalg.norm(normal, axis=-1, keepdims=True))
    return np.stack([b - a, c - a, normal / np.maximum(length, 1e-30)], axis=-1)


def register(source: Mesh, target: Mesh, marks: np.ndarray) -> np.ndarray:
    """Bring the source's vertices onto the target: similarity of the marks, then trimesh."""
    A, B = source.vertices[marks[:, 0]], target.vertices[marks[:, 1]]
    T, *_ = trimesh.registration.procrustes(A, B)
    moved = trimesh.Trimesh(trimesh.transform_points(source.vertices, T), source.faces, process=False)
    surface = trimesh.Trimesh(target.vertices, target.faces, process=False)
    found = trimesh.registration.nricp_sumner(
        moved, surface, source_landmarks=marks[:, 0], target_positions=B, use_faces=False
    )
    return np.asarray(found)


def face_pairs(V: np.ndarray, F: np.ndarray, target: Mesh) -> np.ndarray:
    """Pairs of faces: for each of either mesh the nearest of the other that faces the same way."""

    def nearest(P: np.ndarray, N: np.ndarray, P2: np.ndarray, N2: np.ndarray) -> np.ndarray:
        near = KDTree(P2).query(P, k=CANDIDATES)[1]
        alike = np.einsum("mc,mkc->mk", N, N2[near]) > 0
        return near[np.arange(len(P)), alike.argmax(axis=1)]

    P, N = V[F].mean(axis=1), face_normals(V, F)
    P2, N2 = target.vertices[target.faces].mean(axis=1), face_normals(target.vertices, target.faces)
    forth = np.column_stack([np.arange(len(F)), nearest(P, N, P2, N2)])
    back = np.column_stack([nearest(P2, N2, P, N), np.arange(len(P2))])
    return np.unique(np.concatenate([forth, back]), axis=0)


class DeformationTransfer:
    """Find the target whose faces deform as their partners of the source."""

    def __init__(self, target: Mesh, pairs: np.ndarray) -> None:
        self.target, self.pairs = target, pairs
        F, n = target.faces, len(target.vertices)
        inverse = np.linalg.pinv(spans(target.vertices, F))[pairs[:, 1]]
        corners = np.column_stack([F, n + np.arange(len(F))])[pairs[:, 1]]
        P = len(pairs)
        # row 3 p + c: column c of the gradient of pair p as a sum over the four vertices
        weights = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
        rows = 3 * np.arange(P)[:, None, None] + np.arange(3)[None, None]
        columns = np.broadcast_to(corners[:, :, None], weights.shape)
        rows = np.broadcast_to(rows, weights.shape)
        size = n + len(F)
        self.A: Any = sp.coo_array((weights.ravel(), (rows.ravel(), columns.ravel())), (3 * P, size)).tocsr()
        normal = (self.A.T @ self.A).tocsc()
        hold = np.full(size, 1e-12 * normal.diagonal().mean())
        hold[0] = normal.diagonal().mean()
        self.solver = SparseCholesky(normal + sp.diags_array(hold))

    def frame(self, gradients: np.ndarray) -> np.ndarray:
        """Vertices for the (m, 3, 3) gradients of the source's faces; their centroid stays."""
        right = self.A.T @ gradients[self.pairs[:, 0]].transpose(0, 2, 1).reshape(-1, 3)
        V = self.solver.solve(right)[: len(self.target.vertices)]
        return V - V.mean(axis=0) + self.target.vertices.mean(axis=0)


def measures(V: np.ndarray, mesh: Mesh, turns: np.ndarray) -> list[str]:
    ratios = edge_ratios(V, mesh.faces, mesh.vertices)
    volume = volume_change(V, mesh.faces, mesh.vertices)
    return [
        f"{flipped_percent(V, mesh.faces, mesh.vertices, turns).mean():.3f}",
        f"{folded_percent(V, mesh.faces, mesh.vertices).mean():.3f}",
        f"{ratios.p1:.2f} / {ratios.p99:.2f}",
        f"{volume.mean():.1f} / {volume[np.abs(volume).argmax()]:.1f}",
    ]


def nearest_rotations(G: np.ndarray) -> np.ndarray:
    U, _, Vt = np.linalg.svd(G)
    sign = np.linalg.det(U @ Vt)
    U[..., 2] *= sign[..., None]
    return from_matrix(U @ Vt)


def gallop() -> tuple[MeshClip, Mesh, Mesh, np.ndarray]:
    """Clip, its reference in the size of the clip, the camel, and the marked vertices of both."""
    folder = DATA / "horse-camel-poses"
    clip, horse = load_clip(DATA / "horse-gallop", fps=24), load_mesh(folder / "horse_ref.obj")
    target, pairs = load_mesh(folder / "camel_ref.obj"), load_pairs(folder / "horse_camel.cons")
    marks = np.column_stack([pairs.source, pairs.target])
    # the reference is stored in another size than the clip
    edge = np.diff(np.asarray(clip.vertices[0], dtype=np.float64)[clip.faces[:, :2]], axis=1)
    edge_ref = np.diff(horse.vertices[horse.faces[:, :2]], axis=1)
    size = np.median(np.linalg.norm(edge, axis=-1) / np.maximum(np.linalg.norm(edge_ref, axis=-1), 1e-12))
    return clip, horse.with_vertices(float(size) * horse.vertices), target, marks


def main() -> None:
    clip, horse, target, marks = gallop()
    start = time.perf_counter()
    found = face_pairs(register(horse, target, marks), horse.faces, target)
    matched = time.perf_counter()
    solver = DeformationTransfer(target, found)
    ready = time.perf_counter()
    rest = np.linalg.pinv(spans(horse.vertices, horse.faces))
    G = np.stack([spans(np.asarray(V, dtype=np.float64), clip.faces) @ rest for V in clip.vertices])
    V = np.stack([solver.frame(g) for g in G])
    done = time.perf_counter()
    partner = np.zeros(len(target.faces), dtype=np.int64)
    partner[found[:, 1]] = found[:, 0]
    turns = nearest_rotations(G)[:, partner]
    ours = camel(0.0)
    seconds = ours.report["seconds"]
    times = (f"{matched - start:.1f}", f"{ready - matched:.1f}", f"{done - ready:.2f}")
    own = ("-", f"{seconds['set-up']:.1f}", f"{seconds['frames']:.2f}")
    rows = [
        line("Sumner-Popović, plain", *times, *measures(V, target, turns)),
        line("Tempose", *own, *measures(np.asarray(ours.clip.vertices), target, turns)),
    ]
    print("\n".join(rows))
    write_block("sumner-popovic", table(COLUMNS, rows))
    theirs = MeshClip(V.astype(np.float32), replace(target, name="Sumner, Popovic"), 24)
    mine = MeshClip(ours.clip.vertices, replace(target, name="Tempose"), 24)
    shown = [int(t) for t in np.linspace(0, 23, 6)]
    sheet = contact_sheet([clip, theirs, mine], frames=shown, views=("side",))
    save_png(sheet, ROOT / "docs" / "gallery" / "sumner-popovic-camel.png")


if __name__ == "__main__":
    main()
