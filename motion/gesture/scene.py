"""What a gesture is made of: scenes of units of channels of tracks, each unit at its own rate.

ENACTIVE D.RD3.3.1 §4.5.1 names four levels. A track is one number over time. A channel joins the
tracks of one point or one device in space. The channels of a unit are dynamically correlated (the
joints of one dancer, the keys under one hand), and units are not correlated with one another.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError

__all__ = ["Channel", "Dimension", "Scene", "Track", "Unit", "Variable", "merged"]

Array = NDArray[np.float64]


class Variable(Enum):
    """What a channel measures, by the document's letter (§4.5.1).

    Positions, velocities, accelerations and angles come from space and are extensive; forces, and
    torques with them, are intensive (§4.3.3). Power that passes between two bodies shows only where
    both kinds were recorded.
    """

    POSITION = "P"
    VELOCITY = "V"
    ACCELERATION = "G"
    ANGLE = "A"
    FORCE = "F"

    @property
    def extensive(self) -> bool:
        """Whether it comes from space (EV), and not from force (IV)."""
        return self is not Variable.FORCE

    @property
    def label(self) -> str:
        """As the document writes it: "EV(P)", "IV(F)"."""
        return f"{'EV' if self.extensive else 'IV'}({self.value})"


class Dimension(Enum):
    """In how many directions of space a channel goes, and which (§4.5.1, §4.5.4).

    RQF is the juggler's "3Drqf", three angles: r, q and f are where rho, theta and phi lie in the
    Symbol typeface. SCALAR is a number without a direction, 0D.
    """

    SCALAR = "1D0"
    X = "1Dx"
    Y = "1Dy"
    Z = "1Dz"
    XY = "2Dxy"
    YZ = "2Dyz"
    ZX = "2Dzx"
    XYZ = "3Dxyz"
    RQF = "3Drqf"

    @property
    def axes(self) -> tuple[str, ...]:
        """One letter a track, in the order of the tracks; "" for a scalar's."""
        return ("",) if self is Dimension.SCALAR else tuple(self.value[2:])

    @property
    def width(self) -> int:
        """Number of tracks."""
        return len(self.axes)


@dataclass(frozen=True, slots=True)
class Track:
    """One number over time.

    Attributes:
        channel: Name of its channel.
        axis: Its letter among the channel's axes, "" for a scalar.
        column: Where it stands in a row of its unit's signal, from 0.
    """

    channel: str
    axis: str
    column: int


@dataclass(frozen=True, slots=True)
class Channel:
    """Tracks that belong together in space.

    Attributes:
        name: As in the file.
        variable: What it measures.
        dimension: Along which axes.
        measure: Unit of measure, "m", "mm", "N", "rad", "deg"; "" where nobody said.
    """

    name: str
    variable: Variable = Variable.POSITION
    dimension: Dimension = Dimension.XYZ
    measure: str = ""

    def __post_init__(self) -> None:
        """Check the texts.

        Raises:
            MotionError: A name or a measure that no file can hold.
        """
        _check_text(self.name, "a channel's name")
        _check_text(self.measure, f"the measure of {self.name!r}")

    @property
    def label(self) -> str:
        """As the document writes it: "PK1 [EV(P), 1Dz]"."""
        return f"{self.name} [{self.variable.label}, {self.dimension.value}]"

    @property
    def width(self) -> int:
        """Number of tracks."""
        return self.dimension.width


@dataclass(frozen=True, slots=True)
class Unit:
    """Channels that are dynamically correlated and sampled together.

    Attributes:
        name: As in the file.
        channels: In the order in which a row of its signal has them; one at least.
        rate: Frames per second.
    """

    name: str
    channels: tuple[Channel, ...]
    rate: float

    def __post_init__(self) -> None:
        """Check the name, the channels and the rate.

        Raises:
            MotionError: A name that no file can hold, no channels, a rate that is no rate.
        """
        _check_text(self.name, "a unit's name")
        if not self.channels:
            raise MotionError(f"unit {self.name!r} needs one channel at least")
        if not np.isfinite(self.rate) or self.rate <= 0:
            raise MotionError(f"the rate of {self.name!r} must be above 0, got {self.rate}")

    @property
    def width(self) -> int:
        """Number of tracks."""
        return sum(channel.width for channel in self.channels)

    @property
    def tracks(self) -> tuple[Track, ...]:
        """Every track, in the order of the columns."""
        named = [
            (channel.name, axis) for channel in self.channels for axis in channel.dimension.axes
        ]
        return tuple(Track(name, axis, column) for column, (name, axis) in enumerate(named))

    def columns(self, channel: str) -> slice:
        """Where a channel stands in a row of the unit's signal.

        Raises:
            MotionError: No such channel, or two of that name.
        """
        found = [index for index, own in enumerate(self.channels) if own.name == channel]
        if len(found) != 1:
            many = "two channels" if found else "no channel"
            raise MotionError(f"unit {self.name!r} has {many} called {channel!r}")
        first = sum(own.width for own in self.channels[: found[0]])
        return slice(first, first + self.channels[found[0]].width)


@dataclass(frozen=True, eq=False)
class Scene:
    """Units that move side by side from one start, each at its own rate.

    Attributes:
        name: As in the file.
        units: Who moves; one at least.
        signals: One a unit, (T, unit.width), in the channels' measures; NaN where nothing was
            measured. Row k is the moment k / unit.rate.
    """

    name: str
    units: tuple[Unit, ...]
    signals: tuple[Array, ...]

    def __post_init__(self) -> None:
        """Check the name and the shapes.

        Raises:
            MotionError: A name that no file can hold, no units, signals that do not fit them.
        """
        _check_text(self.name, "a scene's name")
        if not self.units or len(self.units) != len(self.signals):
            raise MotionError(
                "a scene needs one unit at least and one signal a unit, got "
                f"{len(self.units)} and {len(self.signals)}"
            )
        for unit, signal in zip(self.units, self.signals, strict=True):
            if signal.ndim != 2 or signal.shape[1] != unit.width:
                raise MotionError(
                    f"the signal of {unit.name!r} must have shape (T, {unit.width}), "
                    f"got {signal.shape}"
                )

    @property
    def rate(self) -> float:
        """The highest of the units' rates, frames per second."""
        return max(unit.rate for unit in self.units)

    @property
    def duration(self) -> float:
        """s, to the end of the last sample of the longest unit."""
        pairs = zip(self.units, self.signals, strict=True)
        return max(len(signal) / unit.rate for unit, signal in pairs)

    def unit(self, name: str) -> tuple[Unit, Array]:
        """A unit and its signal (T, width).

        Raises:
            MotionError: No such unit, or two of that name.
        """
        pairs = zip(self.units, self.signals, strict=True)
        found = [(unit, signal) for unit, signal in pairs if unit.name == name]
        if len(found) != 1:
            many = "two units" if found else "no unit"
            raise MotionError(f"scene {self.name!r} has {many} called {name!r}")
        return found[0]

    def channel(self, unit: str, name: str) -> tuple[Array, Array]:
        """Times (T,) in s and values (T, channel.width) of one channel.

        Raises:
            MotionError: No such unit or channel, or two of that name.
        """
        own, signal = self.unit(unit)
        return np.arange(len(signal)) / own.rate, signal[:, own.columns(name)]


def merged(name: str, *scenes: Scene) -> Scene:
    """One scene of all their units: "two scenes can always be merged into one" (§4.5.4)."""
    return Scene(
        name,
        tuple(unit for scene in scenes for unit in scene.units),
        tuple(signal for scene in scenes for signal in scene.signals),
    )


def _check_text(text: str, what: str) -> None:
    try:
        length = len(text.encode("utf-8"))
    except UnicodeEncodeError:
        raise MotionError(f"{what} has characters that are none: {text!r}") from None
    if "\0" in text or length > 0xFFFF:
        raise MotionError(f"{what} must be under 65536 bytes of text without NUL")
