"""Marker movements for the tests: made by hand, and by hypothesis."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from enpointe.motion.formats import Analog, Label, MarkerMotion, Space

NAMES = ("C7", "L.Heel", "head top", "RTOE")


def marker_motion(frames: int = 7, *, gaps: bool = False, rich: bool = False) -> MarkerMotion:
    """A figure of four markers, about 1.7 m tall, in millimetres with z up."""
    rng = np.random.default_rng(3)
    heights = np.array([1450.0, 30.0, 1720.0, 20.0])
    positions = rng.normal(0.0, 90.0, (frames, len(NAMES), 3)).astype(np.float32).astype(float)
    positions[..., 2] = (heights + rng.normal(0.0, 2.0, (frames, 4))).astype(np.float32)
    if gaps:
        positions[1, 2] = positions[2, :2] = positions[-1, -1] = np.nan
    seen = np.isfinite(positions).all(axis=2)
    shape = positions.shape[:2]
    residuals = rng.integers(0, 255, shape).astype(np.float32) * np.float32(0.125)
    analog = Analog(
        ("Fz", "EMG"), ("N", "V"), 300.0, rng.normal(size=(3 * frames, 2)).astype(np.float32)
    )
    return MarkerMotion(
        NAMES,
        100.0,
        positions,
        Space(0.001, "z"),
        start=11,
        residuals=np.where(seen, residuals, np.nan).astype(np.float32) if rich else None,
        cameras=np.where(seen, rng.integers(0, 128, shape), 0).astype(np.uint8) if rich else None,
        analog=analog if rich else None,
        labels=(Label(0.25, "Foot Strike", "anna", "Left"), Label(61.5, "Foot Off", "", "Right"))
        if rich
        else (),
        notes={"SUBJECTS:NAMES": '["anna", "bo"]', "SUBJECTS:AGES": "[7, 8]"} if rich else {},
    )


@st.composite
def marker_motions(draw: st.DrawFn) -> MarkerMotion:
    """Any movement of up to four markers and five frames, any finite numbers, some gaps."""
    frames, markers = draw(st.integers(1, 5)), draw(st.integers(1, 4))
    finite = st.floats(-1e6, 1e6, width=64)
    positions = draw(hnp.arrays(float, (frames, markers, 3), elements=finite))
    gaps = draw(hnp.arrays(bool, (frames, markers)))
    positions[gaps] = np.nan
    words = st.text("abcXYZ019_.-:é", min_size=1, max_size=8)
    names = draw(st.lists(words, min_size=markers, max_size=markers))
    space = Space(draw(st.sampled_from([0.001, 0.01, 1.0, 0.0254])), draw(st.sampled_from("xyz")))
    rate = draw(st.sampled_from([25.0, 30.0, 119.88, 120.0, 1000.0, 59.94]))
    return MarkerMotion(tuple(names), rate, positions, space, start=draw(st.integers(0, 70000)))
