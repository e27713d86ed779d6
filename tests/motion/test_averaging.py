"""The window that movement is averaged over."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import windows

from enpointe.motion.averaging import parzen


@pytest.mark.parametrize("count", [1, 3, 5, 7, 9, 11, 101, 251])
def test_the_window_is_parzens(count: int) -> None:
    np.testing.assert_allclose(parzen(count), windows.parzen(count, sym=True), atol=1e-14)
