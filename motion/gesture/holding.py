"""Slower units in a file of one frequency: each value is held until the next.

A GST file has one frequency (§4.5.4) and a scene may have several rates (§4.3.2). The file takes
the highest. Sample k of a unit of rate r first stands in frame ceil(k F / r) of a file of frequency
F, the first frame that is not before it, and is repeated until sample k + 1 does. Those first
frames give the samples back exactly. All is counted in whole numbers: a rounded ratio would, in a
long recording, put a sample into its neighbour's frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

__all__ = ["Holding"]

Indices = NDArray[np.int64]
_EXACT = 2**62
_NEAR = 1e-14


@dataclass(frozen=True, slots=True)
class Holding:
    """A unit's samples among the frames of a file.

    Attributes:
        frames: Numerator of frames a sample, F / r in lowest terms.
        samples: Its denominator.
    """

    frames: int
    samples: int

    @classmethod
    def of(cls, frequency: float, rate: float) -> Holding:
        """For a unit of `rate`, not above the file's `frequency`."""
        ratio = Fraction(frequency) / Fraction(rate)
        return cls(ratio.numerator, ratio.denominator)

    def frames_for(self, count: int) -> int:
        """Frames that a file needs to hold `count` samples."""
        return self.first_frame(count - 1) + 1 if count else 0

    def first_frame(self, sample: int) -> int:
        """Where a sample first stands."""
        return -(-sample * self.frames // self.samples)

    def samples_before(self, frame: int) -> int:
        """How many samples first stand in a frame before this one."""
        return (frame - 1) * self.samples // self.frames + 1 if frame > 0 else 0

    def first_frames(self, start: int, stop: int) -> Indices:
        """First frames of the samples from `start` to `stop`, (stop - start,)."""
        return -_floors(-np.arange(start, stop, dtype=np.int64), self.frames, self.samples)

    def held(self, start: int, stop: int) -> Indices:
        """Which sample each frame from `start` to `stop` holds, (stop - start,)."""
        return _floors(np.arange(start, stop, dtype=np.int64), self.samples, self.frames)


def _floors(numbers: Indices, numerator: int, denominator: int) -> Indices:
    """Floors of numbers * numerator / denominator, which are to be of a file's size.

    Two rates that are no whole numbers make a ratio too long for machine integers: then in floating
    point, and in Python's integers where that is too near a whole number to tell.
    """
    if not numbers.size:
        return numbers
    largest = int(max(abs(numbers[0]), abs(numbers[-1]), 1))
    if max(largest * numerator, denominator) < _EXACT:
        return numbers * numerator // denominator
    scaled = numbers * float(Fraction(min(numerator, denominator * _EXACT), denominator))
    floors = np.floor(scaled)
    unsure = np.abs(scaled - np.rint(scaled)) <= _NEAR * np.maximum(np.abs(scaled), 1.0)
    floors[unsure] = [int(n) * numerator // denominator for n in numbers[unsure]]
    whole: Indices = floors.astype(np.int64)
    return whole
