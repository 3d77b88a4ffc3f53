"""A pose signal made of one for each window, for clips too long for a single one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tempose.signals.pose.signal import PoseSignal
from tempose.signals.windows.cover import Cover
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class WindowedPose:
    """``g(p, tick) = sum_w weight_w(tick) g_w(p)``: where in the clip one is decides which windows count."""

    windows: tuple[PoseSignal, ...]
    """(W,) g_w, each fitted to the frames of its window."""
    cover: Cover
    """Where the windows lie; its weights are twice continuously differentiable and sum to 1."""

    def __post_init__(self) -> None:
        if len(self.windows) != len(self.cover):
            raise ValueError(
                f"windows must be one for each of the cover's {len(self.cover)}, got {len(self.windows)}"
            )

    @property
    def sites(self) -> FloatArray:
        """(l, 2) sites of all windows, one window after another."""
        return np.concatenate([g.sites for g in self.windows])

    @property
    def centre(self) -> FloatArray:
        """(2,) middle of the windows' centres."""
        return np.mean([g.centre for g in self.windows], axis=0)

    @property
    def radius(self) -> float:
        """A circle about `centre` that holds all windows' circles."""
        return max(float(np.linalg.norm(g.centre - self.centre)) + g.radius for g in self.windows)

    def __call__(self, p: FloatArray, origin: FloatArray | None = None) -> FloatArray:
        """Evaluate the pose signal.

        Parameters
        ----------
        p : (..., 2) float
            Places in the pose plane.
        origin : (...) float, optional
            Ticks of the captured clip that the places come from. Without them each place is read by the
            window whose site is nearest.

        Returns
        -------
        (..., m) ndarray
            Shape coordinates.
        """
        return self._blend(p, origin, lambda g, places: g(places))

    def jacobian(self, p: FloatArray, origin: FloatArray | None = None) -> FloatArray:
        """Return the derivatives of g by the place.

        Parameters
        ----------
        p : (..., 2) float
            Places in the pose plane.
        origin : (...) float, optional
            As in a call.

        Returns
        -------
        (..., m, 2) ndarray
            By x and by y of the plane.
        """
        return self._blend(p, origin, lambda g, places: g.jacobian(places))

    def second_derivatives(self, p: FloatArray, origin: FloatArray | None = None) -> FloatArray:
        """Return the second derivatives of g by the place.

        Parameters
        ----------
        p : (..., 2) float
            Places in the pose plane.
        origin : (...) float, optional
            As in a call.

        Returns
        -------
        (..., m, 2, 2) ndarray
            As those of `PoseSignal`.
        """
        return self._blend(p, origin, lambda g, places: g.second_derivatives(places))

    def nearest_window(self, p: FloatArray) -> IntArray:
        """Return the window that has a site nearest to each place.

        Parameters
        ----------
        p : (..., 2) float
            Places in the pose plane.

        Returns
        -------
        (...) ndarray of int
            Windows.
        """
        p = np.asarray(p, dtype=np.float64)
        gaps = [np.square(p[..., None, :] - g.sites).sum(-1).min(-1) for g in self.windows]
        return np.argmin(gaps, axis=0)

    def _blend(
        self, p: FloatArray, origin: FloatArray | None, ask: Callable[[PoseSignal, FloatArray], FloatArray]
    ) -> FloatArray:
        p = np.asarray(p, dtype=np.float64)
        if origin is None:
            first, weight = self.nearest_window(p), np.zeros(p.shape[:-1])
        else:
            first, weight = self.cover(np.broadcast_to(np.asarray(origin, dtype=np.float64), p.shape[:-1]))
        places, first, weight = p.reshape(-1, 2), np.ravel(first), np.ravel(weight)
        one = self.windows[0]
        result = np.zeros((len(places), *ask(one, one.centre).shape))
        for i in np.unique(first):
            here = np.flatnonzero(first == i)
            result[here] = ask(self.windows[i], places[here])
            shared = here[weight[here] > 0]
            if len(shared):
                w = weight[shared].reshape(-1, *[1] * (result.ndim - 1))
                result[shared] = (1 - w) * result[shared] + w * ask(self.windows[i + 1], places[shared])
        return result.reshape(*p.shape[:-1], *result.shape[1:])
