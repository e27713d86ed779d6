"""Scenes of every kind, and what makes two of them the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from enpointe.motion.gesture import (
    Channel,
    Dimension,
    Encoding,
    GestureReader,
    Scene,
    Unit,
    Variable,
)

NAMES = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=12)
CHANNELS = st.builds(
    Channel,
    NAMES,
    st.sampled_from(Variable),
    st.sampled_from(Dimension),
    st.one_of(st.sampled_from(["", "m", "mm", "N", "rad"]), NAMES),
)
RATES = st.one_of(
    st.sampled_from([25.0, 100.0, 119.88, 120.0, 300.0, 1000.0, 4000.0]),
    st.floats(0.5, 20_000.0),
)
UNITS = st.builds(Unit, NAMES, st.lists(CHANNELS, min_size=1, max_size=4).map(tuple), RATES)
ENCODINGS = st.builds(
    Encoding,
    st.sampled_from(["float32", "float64"]),
    order=st.sampled_from(["big", "little"]),
    block_size=st.one_of(st.none(), st.integers(1, 5000)),
)


@st.composite
def scenes(draw: st.DrawFn, most_units: int = 3, most_samples: int = 40) -> Scene:
    """Any scene, with normal signals of any size."""
    units = tuple(draw(st.lists(UNITS, min_size=1, max_size=most_units)))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    sizes = [draw(st.integers(0, most_samples)) for _ in units]
    scale = draw(st.sampled_from([1e-6, 1.0, 1e6]))
    signals = tuple(
        scale * rng.normal(size=(size, unit.width)) for size, unit in zip(sizes, units, strict=True)
    )
    return Scene(draw(NAMES), units, signals)


def keyboard(frames: int = 6, rate: float = 4000.0) -> Scene:
    """Two keys with position and force, every number of which is another."""
    channels = (
        Channel("PK", Variable.POSITION, Dimension.Z),
        Channel("pad", Variable.FORCE, Dimension.XY),
    )
    values = np.arange(1.0, 1.0 + 3 * frames).reshape(frames, 3)
    return Scene("keys", (Unit("hand", channels, rate),), (values,))


def read_all(path: Path, *, unsigned: bool = False) -> tuple[Scene, tuple[str, ...]]:
    """A scene and the warnings."""
    with GestureReader(path, unsigned=unsigned) as reader:
        return reader.scene(), reader.warnings


def assert_same(found: Scene, expected: Scene, within: float = 0.0) -> None:
    """Same names, units and channels, and signals within a tolerance."""
    assert found.name == expected.name
    assert found.units == expected.units
    for one, other in zip(found.signals, expected.signals, strict=True):
        assert one.shape == other.shape
        assert one.dtype == np.float64
        np.testing.assert_allclose(one, other, rtol=0, atol=within)
