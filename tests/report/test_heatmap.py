"""Every run is in its own cell of the map, and the map is of what varied."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import EnpointeError
from enpointe.report.heatmap import (
    FACTORS,
    count_runs,
    find_factors,
    heat_map_png,
    heat_map_svg,
    mapped_factors,
)
from enpointe.sim.trial import Outcome


def outcomes(
    factors: Sequence[dict[str, float | None]], completed: Sequence[bool] | None = None
) -> list[Outcome]:
    done = completed or [True] * len(factors)
    return [
        Outcome(i, drawn, good, None, None, 0.0, None, None, None, None, None)
        for i, (drawn, good) in enumerate(zip(factors, done, strict=True))
    ]


amounts = st.floats(-5.0, 5.0).map(lambda value: round(value, 6))


@given(
    st.lists(st.tuples(amounts, amounts, st.booleans()), min_size=2, max_size=60).filter(
        lambda rows: len({r[0] for r in rows}) > 1 and len({r[1] for r in rows}) > 1
    )
)
def test_every_run_is_counted_once(rows: list[tuple[float, float, bool]]) -> None:
    runs = outcomes([{"friction": a, "push_at": b} for a, b, _ in rows], [c for _, _, c in rows])
    completed, count = count_runs(runs, ("friction", "push_at"))
    assert count.sum() == len(rows)
    assert completed.sum() == sum(c for _, _, c in rows)
    assert np.all(completed <= count)


def test_a_push_is_towards_the_side_it_goes_to() -> None:
    ways = {"audience": 0.1, "left": np.pi / 2, "back": np.pi, "right": -1.4}
    for column, way in enumerate(ways.values()):
        runs = outcomes([{"push_direction": way, "push_at": 1.0}, {"push_direction": way}])
        _, count = count_runs(runs, ("push_direction",))
        assert np.flatnonzero(count[0]).tolist() == [column]
    _, both = count_runs(
        outcomes([{"push_direction": np.pi}, {"push_direction": -np.pi}]), ("push_direction",)
    )
    assert both[0].tolist() == [0, 0, 2, 0]


def test_the_first_two_that_varied_are_mapped() -> None:
    factors: list[dict[str, float | None]] = [
        {"noise": 1.0, "friction": 0.6 + i, "push_at": float(i)} for i in range(4)
    ]
    runs = outcomes(factors)
    assert mapped_factors(runs) == ("push_at", "friction")
    assert mapped_factors(runs, ("friction", "push_at")) == ("friction", "push_at")
    assert mapped_factors(runs[:1]) == ()
    with pytest.raises(EnpointeError, match="did not vary"):
        mapped_factors(runs, ("noise", "push_at"))


def test_a_map_of_one_factor_is_a_row() -> None:
    runs = outcomes([{"friction": 0.6 + 0.01 * i} for i in range(30)])
    assert count_runs(runs, ("friction",))[1].shape[0] == 1
    assert heat_map_png(runs, ("friction",)).startswith(b"\x89PNG")
    assert heat_map_svg(runs, ("friction",), "m").startswith("<svg")


def test_a_map_is_asked_for_by_two_names() -> None:
    assert find_factors("push_at, friction") == ("push_at", "friction")
    for text in ("", "push_at", "push_at,push_at", "push_at,wind", ",".join(FACTORS)):
        with pytest.raises(EnpointeError):
            find_factors(text)
