"""How readily soles bear over time."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.motion.contact_schedule import ContactSchedule


@settings(max_examples=60)
@given(
    st.lists(st.tuples(st.booleans(), st.booleans()), min_size=2, max_size=60),
    st.floats(0.02, 1.0),
    st.floats(0.5, 4.0),
)
def test_weight_comes_and_goes_gently(
    pattern: list[tuple[bool, bool]], seconds: float, scale: float
) -> None:
    bears = np.array(pattern)
    time = 0.01 * np.arange(len(bears), dtype=float)
    schedule = ContactSchedule(time, np.arange(2), np.zeros((len(bears), 2, 3)), bears)
    shares = schedule.shares(seconds)
    assert np.all(shares[~bears] == 0.0)
    assert np.all((shares >= 0.0) & (shares <= 1.0))
    together = bears[1:] & bears[:-1]
    assert np.abs(np.diff(shares, axis=0))[together].max(initial=0.0) <= 0.01 / seconds + 1e-9
    assert np.all(shares[:, bears.all(axis=0)] == 1.0)
    slower = schedule.slowed(scale)
    np.testing.assert_allclose(slower.shares(seconds * scale), shares, atol=1e-9)
