"""What remeshing does to one edge of a half-edge mesh: flip it, collapse it, split it."""

from __future__ import annotations

from numba import njit

from tempose.samples.half_edges import HalfEdges, after, before


@njit(cache=True)
def flip(mesh: HalfEdges, h: int) -> None:
    """Turn the edge of two triangles into the other diagonal of their quad.

    Parameters
    ----------
    mesh : HalfEdges
        Changed in place.
    h : int
        One half-edge of the edge.
    """
    start, twin, out = mesh.start, mesh.twin, mesh.out
    t = twin[h]
    hn, hp, tn, tp = after(h), before(h), after(t), before(t)
    a, b, c, d = start[h], start[t], start[hp], start[tp]
    bc, ca, ad, db = twin[hn], twin[hp], twin[tn], twin[tp]
    start[h], start[hn], start[hp] = d, c, a
    start[t], start[tn], start[tp] = c, d, b
    for i, j in ((hn, ca), (hp, ad), (tn, db), (tp, bc)):
        twin[i], twin[j] = j, i
    out[a], out[b], out[c], out[d] = hp, tp, t, h


@njit(cache=True)
def collapse(mesh: HalfEdges, h: int) -> None:
    """Pull the start of a half-edge into its end; two faces and a vertex die.

    Parameters
    ----------
    mesh : HalfEdges
        Changed in place.
    h : int
        The half-edge; its ends must have exactly two neighbours in common.
    """
    start, twin, out = mesh.start, mesh.twin, mesh.out
    t = twin[h]
    hn, hp, tn, tp = after(h), before(h), after(t), before(t)
    a, b, c, d = start[h], start[t], start[hp], start[tp]
    k = h
    while True:
        start[k] = b
        k = twin[before(k)]
        if k == h:
            break
    cb, ac, da, bd = twin[hn], twin[hp], twin[tn], twin[tp]
    twin[cb], twin[ac], twin[da], twin[bd] = ac, cb, bd, da
    out[a], out[b], out[c], out[d] = -1, bd, cb, da
    for k in (h, hn, hp, t, tn, tp):
        start[k] = -1


@njit(cache=True)
def split(mesh: HalfEdges, h: int, m: int, face: int) -> None:
    """Put a vertex on an edge and join it to the two opposite corners.

    Parameters
    ----------
    mesh : HalfEdges
        Changed in place.
    h : int
        One half-edge of the edge.
    m : int
        Index of the new vertex.
    face : int
        Index of the first of two new faces.
    """
    start, twin, out = mesh.start, mesh.twin, mesh.out
    t = twin[h]
    hn, hp, tp = after(h), before(h), before(t)
    b, c, d = start[t], start[hp], start[tp]
    x, y = 3 * face, 3 * face + 3
    cb, bd = twin[hn], twin[tp]
    start[hn], start[t] = m, m
    start[x], start[x + 1], start[x + 2] = m, b, c
    start[y], start[y + 1], start[y + 2] = b, m, d
    for i, j in ((x + 1, cb), (x + 2, hn), (x, y), (y + 2, bd), (y + 1, tp)):
        twin[i], twin[j] = j, i
    out[m], out[b], out[c], out[d] = x, y, x + 2, y + 2
