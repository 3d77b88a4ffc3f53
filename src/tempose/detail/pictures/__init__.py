"""Pictures of learned detail: latent space, errors of every frame, variance, before and after edits."""

from tempose.detail.pictures.latent import draw_latent
from tempose.detail.pictures.plane import LatentPlane, latent_plane
from tempose.detail.pictures.plot import draw_heldout, plot_detail
from tempose.detail.pictures.sheets import detail_sheet, edit_sheet, skin_clip, variance_sheet

__all__ = [
    "LatentPlane",
    "detail_sheet",
    "draw_heldout",
    "draw_latent",
    "edit_sheet",
    "latent_plane",
    "plot_detail",
    "skin_clip",
    "variance_sheet",
]
