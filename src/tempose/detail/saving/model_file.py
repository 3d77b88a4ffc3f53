"""A fitted model of detail as one small ``.tempose`` file."""

from __future__ import annotations

import os
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tempose.detail.basis import DetailBasis
from tempose.detail.multiresolution import CoarseBasis
from tempose.detail.regions import region_shares
from tempose.detail.residuals import check_basis
from tempose.detail.saving.packing import pack, unpack
from tempose.detail.saving.tree import from_arrays, to_arrays
from tempose.models import load_model, save_model
from tempose.rigging import Rig
from tempose.rigging.motion_arrays import motion_from_arrays, motion_to_arrays
from tempose.rigging.saving import rig_from_arrays, rig_to_arrays

if TYPE_CHECKING:
    from tempose.detail.model import DetailModel

KIND = "detail"
"""As in the header of the file."""
_COARSE = ("mean", "owner", "share")


def write_detail_model(model: DetailModel, path: str | os.PathLike[str]) -> Path:
    """Write a fitted model.

    Parameters
    ----------
    model : DetailModel
        Fitted.
    path : path-like
        Where to.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    OSError
        If the place cannot be written.
    TypeError
        If its learner is of a kind that cannot be saved.
    """
    arrays: dict[str, Any]
    arrays, rig = rig_to_arrays(model.rig_)
    motions: list[dict[str, Any]] = []
    for i, motion in enumerate(model.motions_[1:], 1):
        arrays |= motion_to_arrays(motion, model.rig_.skin.skeleton, f"motions/{i}")
        motions.append({"fps": motion.fps, "name": motion.name, "source": asdict(motion.source)})
    kept = model.detail_ if model.coarse_ is None else model.coarse_.basis
    arrays["detail/modes"] = kept.modes.reshape(len(kept.modes), -1)
    arrays["detail/coordinates"] = kept.coordinates
    if model.coarse_ is not None:
        for name in _COARSE:
            arrays[f"coarse/{name}"] = getattr(model.coarse_, name)
    tree = to_arrays(model.predictor_, "predictor", arrays)
    packed = {name: pack(array) for name, array in arrays.items()}
    header = {
        "options": {
            "learner": model.report_["learner"],
            "basis": model.basis,
            "tolerance": model.tolerance,
            "resolution": model.resolution,
            "folds": model.folds,
        },
        "rig": rig,
        "motions": motions,
        "step": model.detail_.step,
        "predictor": tree,
        "report": model.report_,
        "packed": {name: how for name, (_, how) in packed.items()},
        "made_from": model.rig_.skin.mesh.source.path,
    }
    stored: dict[str, Any] = {name: data for name, (data, _) in packed.items()}
    return save_model(path, KIND, stored, header)


def read_detail_model(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Read a fitted model.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    options : dict
        Arguments of the constructor.
    state : dict
        What `fit` has set, by attribute.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it is no model of detail, cut short, or of a newer version; the message names it.
    """
    packed, header = load_model(path, KIND)
    try:
        arrays = {name: unpack(packed[name], how) for name, how in header["packed"].items()}
        for name, array in arrays.items():
            if array.dtype.kind == "f" and not name.endswith("/tips") and not np.isfinite(array).all():
                raise ValueError(f"{name} must be finite")
        options = dict(header["options"])
        check_basis(options["basis"])
        rig = rig_from_arrays(arrays, header["rig"])
        shares = region_shares(rig.skin.weights)
        motions = [rig.motion]
        for i, entry in enumerate(header["motions"], 1):
            motions.append(motion_from_arrays(arrays, entry, rig.skin.skeleton, f"motions/{i}"))
        detail, coarse = _detail(arrays, header, rig)
        if sum(motion.n_frames for motion in motions) != len(detail.coordinates):
            raise ValueError(f"detail/coordinates of {len(detail.coordinates)} frames, not of the motions")
        state = {
            "rig_": rig,
            "motions_": tuple(motions),
            "detail_": detail,
            "coarse_": coarse,
            "shares_": shares,
            "predictor_": from_arrays(header["predictor"], arrays),
            "report_": dict(header["report"]),
        }
    except (AttributeError, LookupError, OverflowError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: a model of detail whose parts do not fit together: {error}") from None
    return options, state


def _detail(
    arrays: dict[str, Any], header: dict[str, Any], rig: Rig
) -> tuple[DetailBasis, CoarseBasis | None]:
    modes, coordinates, step = arrays["detail/modes"], arrays["detail/coordinates"], float(header["step"])
    n = len(rig.skin.mesh.vertices)
    coarse = "coarse/owner" in arrays
    count = modes.shape[-1] // 3 if coarse else n
    if modes.dtype != np.int16 or modes.shape != (1 + coordinates.shape[1], 3 * count):
        raise ValueError(f"detail/modes of type {modes.dtype} and shape {modes.shape}")
    if not 0 < step < np.inf:
        raise ValueError(f"step must be positive, got {step}")
    basis = DetailBasis(modes.reshape(-1, count, 3), step, coordinates)
    if not coarse:
        return basis, None
    mean, owner, share = (arrays[f"coarse/{name}"] for name in _COARSE)
    if mean.shape != (n, 3) or owner.shape != (n,) or share.shape != (n,) or owner.max() >= count:
        raise ValueError(f"coarse/mean of shape {mean.shape} and coarse/owner of shape {owner.shape}")
    found = CoarseBasis(basis, mean, owner, share)
    return found.raised(rig.skin), found
