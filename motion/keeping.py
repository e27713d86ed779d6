"""The rules of ballet over a whole motion: they hold in between key poses too (Neagle 2005 §5.2.3).

At every sample the target is what is asked at that moment of the way from one station to the next;
each rule that applies to it is measured on the motion as it is, corners rounded and feet grounded.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.models.certificate import RuleResult
from enpointe.models.target import PoseTarget
from enpointe.motion.interpolation import COUNT_IN
from enpointe.motion.motion import Motion
from enpointe.motion.ways import Ways

__all__ = ["RuleKept", "rules_kept"]

Array = NDArray[np.float64]
SAMPLES_A_SECOND = 50.0


@dataclass(frozen=True, slots=True)
class RuleKept:
    """One rule over a whole motion.

    Attributes:
        rule: Its name, with the side where it has one.
        unit: "mm" or "deg".
        bound: What still holds.
        at_least: Whether the bound is a floor (a margin) rather than a ceiling (a residual).
        worst: Largest residual, or smallest margin.
        at: When that is, s from the start of the motion.
        between: The names of the stations before and after that moment.
        held: Share of the samples at which it applies and holds.
        applies: Share of the motion at which it applies.
        source: Where the rule is written down.
    """

    rule: str
    unit: str
    bound: float
    at_least: bool
    worst: float
    at: float
    between: tuple[str, str]
    held: float
    applies: float
    source: str


def rules_kept(motion: Motion, ways: Ways) -> tuple[RuleKept, ...]:
    """Measure every rule over a motion.

    Args:
        motion: Made by `interpolate` with these ways.
        ways: They.

    Returns:
        One for each rule that applies anywhere, in the order in which they first do; none for
        ways on which nothing is asked.
    """
    moments = list(_moments(motion, ways))
    if not moments:
        return ()
    times = np.array([time for time, _, _ in moments])
    qpos = motion.qpos[np.searchsorted(motion.time, times - 1e-9)]
    certificates = ways.solver.certify([target for _, _, target in moments], qpos)
    found: dict[str, list[tuple[int, RuleResult]]] = {}
    for sample, certificate in enumerate(certificates):
        for result in certificate.results:
            found.setdefault(result.rule, []).append((sample, result))
    return tuple(
        _kept(results, [moments[sample][:2] for sample, _ in results], ways, len(moments))
        for results in found.values()
    )


def _moments(motion: Motion, ways: Ways) -> Iterator[tuple[float, int, PoseTarget]]:
    """Samples of the motion, the way that each is on, and what is asked there."""
    times = COUNT_IN + np.array([station.time for station in ways.stations])
    step = max(round(1.0 / (SAMPLES_A_SECOND * float(np.diff(motion.time).mean()))), 1)
    for time in motion.time[::step]:
        index = int(np.searchsorted(times, time, side="right")) - 1
        if not 0 <= index < len(times) - 1:
            continue
        target = ways[index].target
        if target is None:
            continue
        phase = np.array([(time - times[index]) / (times[index + 1] - times[index])])
        yield float(time), index, target(float(ways.shares(index, phase)[0]))


def _kept(
    results: list[tuple[int, RuleResult]],
    moments: list[tuple[float, int]],
    ways: Ways,
    samples: int,
) -> RuleKept:
    first = results[0][1]
    values = np.array([result.value for _, result in results])
    worst = int(values.argmin() if first.at_least else values.argmax())
    time, index = moments[worst]
    return RuleKept(
        rule=first.rule,
        unit=first.unit,
        bound=first.bound,
        at_least=first.at_least,
        worst=float(values[worst]),
        at=time,
        between=(ways.stations[index].pose.name, ways.stations[index + 1].pose.name),
        held=float(np.mean([result.held for _, result in results])),
        applies=len(results) / samples,
        source=first.source,
    )
