"""A human skeleton placed inside one mesh, and heat-equilibrium weights."""

from tempose.embedding.dressed import embed_dressed, embed_whole_or_piece
from tempose.embedding.embed import embed_skeleton, embed_skin
from tempose.embedding.embedding import Embedding
from tempose.embedding.heat import heat_weights

__all__ = [
    "Embedding",
    "embed_dressed",
    "embed_skeleton",
    "embed_skin",
    "embed_whole_or_piece",
    "heat_weights",
]
