"""Matrices of known structure."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from tempose.geometry import edge_laplacian


def definite(edges: np.ndarray, n: int, shift: float = 0.1) -> sp.csr_array:
    """Laplacian of a graph, made definite."""
    return sp.csr_array(edge_laplacian(edges, np.ones(len(edges)), n) + shift * sp.eye_array(n))


def grid(rows: int, columns: int, shift: float = 0.1) -> sp.csr_array:
    at = np.arange(rows * columns).reshape(rows, columns)
    pairs = [(at[1:], at[:-1]), (at[:, 1:], at[:, :-1]), (at[1:, 1:], at[:-1, :-1])]
    return definite(np.concatenate([np.c_[a.ravel(), b.ravel()] for a, b in pairs]), rows * columns, shift)


def path(n: int) -> sp.csr_array:
    return definite(np.c_[np.arange(n - 1), np.arange(1, n)], n)


def star(n: int) -> sp.csr_array:
    return definite(np.c_[np.zeros(n - 1, int), np.arange(1, n)], n)


def clique(n: int) -> sp.csr_array:
    return definite(np.argwhere(np.triu(np.ones((n, n)), 1)), n)


def scattered(n: int, seed: int = 0) -> sp.csr_array:
    """Random pairs, single vertices and several components among them."""
    return definite(np.random.default_rng(seed).integers(n, size=(n, 2)), n)


GRAPHS = {
    "one": lambda: definite(np.zeros((0, 2), int), 1),
    "no edges": lambda: definite(np.zeros((0, 2), int), 50),
    "path": lambda: path(300),
    "star": lambda: star(200),
    "clique": lambda: clique(90),
    "grid": lambda: grid(25, 30),
    "two grids": lambda: sp.csr_array(sp.block_diag([grid(12, 15), grid(9, 9)])),
    "scattered": lambda: scattered(400),
    "dense and sparse": lambda: sp.csr_array(sp.block_diag([clique(150), path(150)])),
}
