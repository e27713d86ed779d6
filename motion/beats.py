"""Musical time of a motion: the pulse that its key moments keep, and the beats they fall on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import log2

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.notation import TEMPO_RANGE

__all__ = ["Pulse", "find_pulse", "on_the_beat"]

Array = NDArray[np.float64]
_PERIODS = np.geomspace(0.30, 2.0, 420)
"""Pulses that are tried, s: from 200 to 30 a minute."""
_USUAL = 0.9
"""The pulse that is preferred where several fit alike, s: people tap at 60 to 120 a minute, and
exercises of ballet go slower."""
_PREFERENCE = 0.03
"""What a pulse twice as fast or slow as the usual one costs, in beats."""
_SPLITS = {1: 0.0, 2: 0.04, 4: 0.08, 3: 0.09}
"""Into what a beat may be split (Neagle 2005 §4.2.1), and what a frame there costs, in beats."""
_EARLY = 0.6
"""A movement starts so slowly that it is seen late: the pulse may begin this much before it, in
beats."""
_LATEST = 0.12
_LATE = 0.12
"""What a beat of such lateness costs, in beats."""
_OFFSETS = 37
_MOST_OFF = 0.15
"""A frame farther than this from its beat counts no more, so that a stray one does not sway all."""


@dataclass(frozen=True, slots=True)
class Pulse:
    """A steady pulse.

    Attributes:
        tempo: Pulses a minute.
        start: When beat 0 is, s.
        off: How far the moments are from their beats, root mean square, s.
    """

    tempo: float
    start: float
    off: float

    def beat(self, time: float) -> float:
        """The pulse at a time, counted from beat 0."""
        return (time - self.start) * self.tempo / 60.0


def find_pulse(times: Sequence[float], tempo: float | None = None) -> Pulse:
    """The pulse that key moments keep.

    Every period is tried with every phase; a moment costs how far it is, in beats, from the nearest
    beat or part of a beat, parts costing more the finer they are.

    Args:
        times: Of the key moments, s; the first is beat 0, whose start is seen late.
        tempo: Pulses a minute if they are known; estimated if None.

    Raises:
        MotionError: A tempo outside `TEMPO_RANGE`, or fewer than two moments.
    """
    if len(times) < 2:
        raise MotionError("a pulse needs two key moments at least")
    slowest, fastest = TEMPO_RANGE
    if tempo is not None and not slowest <= tempo <= fastest:
        raise MotionError(f"a tempo of {tempo:g} is outside {slowest:g} to {fastest:g} a minute")
    periods = _PERIODS if tempo is None else np.array([60.0 / tempo])
    first, later = times[0], np.array(times[1:], dtype=float)
    best = (np.inf, 60.0, float(first), 0.0)
    for period in periods:
        shifts = np.linspace(-_EARLY, _LATEST, _OFFSETS) * period
        beats = (later[None, :] - first - shifts[:, None]) / period
        cost, off = _costs(beats)
        late = _LATE * np.abs(shifts) / period
        total = cost.mean(axis=1) + late + _PREFERENCE * abs(log2(period / _USUAL))
        i = int(np.argmin(total))
        if total[i] < best[0]:
            rms = float(np.sqrt(np.mean(off[i] ** 2)) * period)
            best = (float(total[i]), float(60.0 / period), float(first + shifts[i]), rms)
    found = Pulse(best[1], best[2], best[3])
    return found if tempo is not None else _sharpened(found, later)


def on_the_beat(beat: float) -> Fraction:
    """The beat or part of a beat that a moment falls on; the nearest, coarse parts preferred."""
    choices = [(abs(beat - round(beat * n) / n) + cost, n) for n, cost in _SPLITS.items()]
    _, n = min(choices)
    return Fraction(round(beat * n), n)


def _costs(beats: Array) -> tuple[Array, Array]:
    """Of each moment its cost and its distance from the place that it is cheapest at, in beats."""
    stacked = [np.abs(beats - np.round(beats * n) / n) for n in _SPLITS]
    weighed = np.array(
        [
            np.minimum(off, _MOST_OFF) + cost
            for off, cost in zip(stacked, _SPLITS.values(), strict=True)
        ]
    )
    which = np.argmin(weighed, axis=0)
    off = np.take_along_axis(np.array(stacked), which[None], axis=0)[0]
    return weighed.min(axis=0), off


def _sharpened(pulse: Pulse, times: Array) -> Pulse:
    """Least squares through the moments that keep to their beats, the tempo to a tenth."""
    beats = np.array([float(on_the_beat(pulse.beat(t))) for t in times])
    off = np.abs(times - pulse.start - beats * 60.0 / pulse.tempo)
    good = off < _MOST_OFF * 60.0 / pulse.tempo
    if good.sum() < 2 or np.ptp(beats[good]) == 0.0:
        return pulse
    period, start = np.polyfit(beats[good], times[good], 1)
    if period <= 0.0:
        return pulse
    left = times[good] - start - period * beats[good]
    return Pulse(round(float(60.0 / period), 1), float(start), float(np.sqrt(np.mean(left**2))))
