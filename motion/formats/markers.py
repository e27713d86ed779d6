"""Points in space over time, as optical and magnetic systems record them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.motion.formats.space import Space

__all__ = ["Analog", "Label", "MarkerMotion"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Label:
    """A moment that a file names.

    Attributes:
        time: s from the start of the recording.
        name: What happens.
        subject: Whose it is, or "".
        context: "Left", "Right", "General" or "".
    """

    time: float
    name: str
    subject: str = ""
    context: str = ""


@dataclass(frozen=True)
class Analog:
    """Signals sampled beside the markers.

    Attributes:
        names: One a channel.
        units: One a channel, "" where the file has none.
        rate: Samples per second.
        values: (N, channels), in those units.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    rate: float
    values: NDArray[np.floating[Any]]


@dataclass(frozen=True)
class MarkerMotion:
    """A set of markers.

    Attributes:
        names: One a marker, as in the file.
        rate: Frames per second.
        positions: (T, M, 3), file units; NaN where a marker was not seen.
        space: Units and axes.
        start: Number of the first frame in the file.
        orientations: (T, M, 4), quaternions w x y z, where the system measures them.
        residuals: (T, M), file units, NaN where a marker was not seen, where the file has them.
        cameras: (T, M) bit masks of the cameras that saw a marker, where the file has them.
        analog: Signals beside the markers.
        labels: Moments that the file names, in order of time.
        notes: What else the file says, by name.
    """

    names: tuple[str, ...]
    rate: float
    positions: Array
    space: Space = field(default_factory=Space)
    start: int = 1
    orientations: Array | None = None
    residuals: NDArray[np.floating[Any]] | None = None
    cameras: NDArray[np.uint8] | None = None
    analog: Analog | None = None
    labels: tuple[Label, ...] = ()
    notes: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check shapes and the rate.

        Raises:
            MotionError: Arrays that do not fit one another, a rate that is no rate.
        """
        if self.positions.ndim != 3 or self.positions.shape[1:] != (len(self.names), 3):
            raise MotionError(
                f"positions must have shape (T, {len(self.names)}, 3), got {self.positions.shape}"
            )
        shape = self.positions.shape[:2]
        for name, array, expected in (
            ("orientations", self.orientations, (*shape, 4)),
            ("residuals", self.residuals, shape),
            ("cameras", self.cameras, shape),
        ):
            if array is not None and array.shape != expected:
                raise MotionError(f"{name} must have shape {expected}, got {array.shape}")
        if not np.isfinite(self.rate) or self.rate <= 0:
            raise MotionError(f"a rate must be above 0, got {self.rate}")

    @property
    def frames(self) -> int:
        """T."""
        return len(self.positions)

    @property
    def seen(self) -> NDArray[np.bool_]:
        """(T, M), whether a marker has a position."""
        seen: NDArray[np.bool_] = np.all(np.isfinite(self.positions), axis=2)
        return seen
