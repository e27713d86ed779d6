"""Every real motion file that there is: read whole, or refused in one line with the place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from enpointe.errors import FormatError
from enpointe.motion.formats import MarkerMotion, SkeletonMotion, formats, read

DATA = Path(__file__).resolve().parents[4] / "shared" / "data"
SUFFIXES = {suffix for each in formats() for suffix in each.suffixes}
EVERYTHING = sorted(path for path in DATA.rglob("*") if path.is_file())
FILES = [path for path in EVERYTHING if path.suffix.lower() in SUFFIXES]
OTHERS = [path for path in EVERYTHING if path.suffix.lower() not in SUFFIXES]


@pytest.mark.skipif(not FILES, reason="no shared/data beside the checkout")
def test_every_file_is_read_or_refused_with_the_place() -> None:
    """What is read has frames of finite numbers; at most one in twenty is refused."""
    refused: list[FormatError] = []
    for path in FILES:
        try:
            motion = read(path).motion
        except FormatError as error:
            refused.append(error)
            continue
        assert isinstance(motion, SkeletonMotion | MarkerMotion)
        assert motion.frames > 0, path
        if isinstance(motion, SkeletonMotion):
            assert np.isfinite(motion.values).all(), path
        else:
            assert motion.seen.any(), path
    for refusal in refused:
        assert refusal.line is not None or refusal.byte is not None, refusal
        assert "\n" not in str(refusal)
    assert len(refused) <= len(FILES) / 20, refused


@pytest.mark.skipif(not OTHERS, reason="no shared/data beside the checkout")
def test_what_is_no_motion_is_refused_with_the_place() -> None:
    """Scores, music, sound and words: none of them is taken for a movement."""
    for path in OTHERS:
        with pytest.raises(FormatError) as caught:
            read(path)
        assert caught.value.line is not None or caught.value.byte is not None, path
        assert "\n" not in str(caught.value)
