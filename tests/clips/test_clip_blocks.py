"""Blocks cover every frame once; reading one tells where the first bad number is."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tempose.clips.blocks import cut_blocks, read_block


@pytest.mark.parametrize(("frames", "each", "held"), [(10, 6, 20), (7, 100, 3), (0, 5, 9), (4, 0, 2)])
def test_blocks_follow_one_another_and_hold_what_they_may(frames, each, held):
    blocks = list(cut_blocks(frames, each, held))
    assert_array_equal(
        np.concatenate([np.arange(b.start, b.stop) for b in blocks] or [[]]), np.arange(frames)
    )
    assert all(b.stop - b.start == 1 or (b.stop - b.start) * each <= held for b in blocks)


def test_the_first_bad_number_is_named():
    V = np.zeros((6, 4, 3), dtype=np.float32)
    V[4, 2, 1], V[5, 3, 0] = np.nan, np.inf
    assert read_block(V, slice(0, 4)).dtype == np.float64
    with pytest.raises(
        ValueError, match="heights must be finite, found NaN or infinity in frame 4, vertex 2"
    ):
        read_block(V, slice(3, 6), "heights")
