"""Laban's effort as numbers: the logistic of distance over time, and how far the path strays.

Neagle 2005 §5.4.2-5.5.3. Between two key poses the wrist has gone the share

    y(t) = a / (1 + (t / x0)^b),   a = 1 + (1 / x0)^b

of its way at the share t of the time (eqs 5.2, 5.4), so that y(0) = 0 and y(1) = 1. Time is the
gradient b, from -2 (sustained) to -4 (sudden); weight is the centroid x0, from 0.3 (heavy) to 0.8
(light); space is 1 for a direct path and 0 for an indirect one.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from enpointe.errors import MotionError

__all__ = ["PRESETS", "Effort", "Preset", "find_effort", "logistic", "logistic_rate"]

TIME_RANGE = (-4.0, -2.0)
WEIGHT_RANGE = (0.3, 0.8)
SPACE_RANGE = (0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Effort:
    """A quality of movement.

    Attributes:
        time: Gradient b of the logistic, -2 sustained to -4 sudden.
        weight: Centroid x0 of the logistic, 0.3 heavy to 0.8 light.
        space: 1 direct to 0 indirect.
    """

    time: float
    weight: float
    space: float

    def __post_init__(self) -> None:
        """Refuse what lies outside the thesis's ranges.

        Raises:
            MotionError: A value outside its range, or not a number.
        """
        for name, value, (low, high) in (
            ("time", self.time, TIME_RANGE),
            ("weight", self.weight, WEIGHT_RANGE),
            ("space", self.space, SPACE_RANGE),
        ):
            if not low <= value <= high:
                raise MotionError(f"effort {name}={value:g} is outside {low:g}..{high:g}")


@dataclass(frozen=True, slots=True)
class Preset:
    """An emotion of the thesis.

    Attributes:
        name: What scores and the command line call it.
        effort: Its quality.
        tempo: Pulses a minute.
        source: Which tables its numbers come from.
    """

    name: str
    effort: Effort
    tempo: float
    source: str


PRESETS: Mapping[str, Preset] = MappingProxyType(
    {
        preset.name: preset
        for preset in (
            Preset(
                "natural",
                Effort(time=-3.0, weight=0.55, space=0.5),
                56.0,
                "tempo: mean of up and side in Neagle 2005 table 5.1, as table 5.3 has it for the"
                " others; effort: the thesis gives none, ours is the middle of each range",
            ),
            Preset(
                "happy",
                Effort(time=-2.42, weight=0.60, space=0.0),
                80.0,
                "Neagle 2005 tables 5.5 and 5.3",
            ),
            Preset(
                "sad",
                Effort(time=-2.19, weight=0.52, space=0.0),
                37.0,
                "Neagle 2005 tables 5.5 and 5.3",
            ),
            Preset(
                "angry",
                Effort(time=-3.51, weight=0.41, space=1.0),
                79.0,
                "Neagle 2005 tables 5.5 and 5.3 (table 5.3's -4.1 is the extreme, not the mean)",
            ),
            Preset(
                "afraid",
                Effort(time=-2.30, weight=0.52, space=0.5),
                43.0,
                "Neagle 2005 table 5.3; space is in no table, ours is the middle",
            ),
        )
    }
)


def find_effort(text: str | None) -> tuple[Effort, float | None, str]:
    """An effort by preset name or by numbers.

    Args:
        text: "happy", or "time=-3.5,weight=.41,space=1" (what is left out is natural's); None is
            natural without its tempo.

    Returns:
        The effort, the preset's tempo (None for numbers) and a name for it.

    Raises:
        MotionError: Neither a preset nor numbers in range.
    """
    if text is None:
        return PRESETS["natural"].effort, None, "natural"
    word = text.strip().lower()
    if word in PRESETS:
        preset = PRESETS[word]
        return preset.effort, preset.tempo, preset.name
    neutral = PRESETS["natural"].effort
    values = {"time": neutral.time, "weight": neutral.weight, "space": neutral.space}
    for part in word.split(","):
        match = re.fullmatch(r"\s*(time|weight|space)\s*=\s*(\S+)\s*", part)
        if match is None:
            raise MotionError(
                f"no effort {text!r}; use {', '.join(PRESETS)} or time=-3.5,weight=.41,space=1"
            )
        try:
            values[match[1]] = float(match[2])
        except ValueError:
            raise MotionError(f"effort {match[1]} needs a number, got {match[2]!r}") from None
    return Effort(**values), None, text.strip()


def logistic(t: ArrayLike, time: float, weight: float) -> NDArray[np.float64]:
    """Share of the way gone at the share `t` of the time, clamped to [0, 1] outside it.

    Args:
        t: Any shape; 0 at one key pose, 1 at the next.
        time: Gradient b < 0.
        weight: Centroid x0 > 0.
    """
    phase: NDArray[np.float64] = np.clip(np.asarray(t, dtype=float), 0.0, 1.0)
    # With c = -b > 0 the same curve without a division by zero at t = 0.
    c = -time
    grown = phase**c
    return np.asarray(grown * (1.0 + weight**c) / (grown + weight**c))


def logistic_inverse(share: ArrayLike, time: float, weight: float) -> NDArray[np.float64]:
    """The share of the time at which `logistic` has gone a share of the way, both in [0, 1]."""
    way: NDArray[np.float64] = np.clip(np.asarray(share, dtype=float), 0.0, 1.0)
    c = -time
    grown = way * weight**c / (1.0 + weight**c - way)
    return np.asarray(grown ** (1.0 / c))


def logistic_rate(t: ArrayLike, time: float, weight: float) -> NDArray[np.float64]:
    """dy/dt of `logistic`, 0 outside [0, 1]."""
    phase = np.asarray(t, dtype=float)
    inside: NDArray[np.float64] = np.clip(phase, 0.0, 1.0)
    c = -time
    rate = (1.0 + weight**c) * c * weight**c * inside ** (c - 1) / (inside**c + weight**c) ** 2
    return np.where((phase < 0) | (phase > 1), 0.0, rate)
