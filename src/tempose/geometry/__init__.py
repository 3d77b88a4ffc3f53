"""Geometry of triangle meshes on plain arrays."""

from tempose.geometry.collapses import Collapses, collapse_edges
from tempose.geometry.defects import Defects, find_defects
from tempose.geometry.laplacian import cotangent_laplacian, cotangents, edge_laplacian, mass_matrix
from tempose.geometry.normals import face_areas, face_normals, vertex_areas, vertex_normals
from tempose.geometry.topology import (
    boundary_edges,
    edge_list,
    face_components,
    k_rings,
    vertex_adjacency,
    vertex_components,
    weld,
)

__all__ = [
    "Collapses",
    "Defects",
    "boundary_edges",
    "collapse_edges",
    "cotangent_laplacian",
    "cotangents",
    "edge_laplacian",
    "edge_list",
    "face_areas",
    "face_components",
    "face_normals",
    "find_defects",
    "k_rings",
    "mass_matrix",
    "vertex_adjacency",
    "vertex_areas",
    "vertex_components",
    "vertex_normals",
    "weld",
]
