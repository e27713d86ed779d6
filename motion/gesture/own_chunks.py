"""The two chunks of our own: MEAS, what channels measure, and RATE, how fast units are.

A scene that version 0.1 holds whole has neither. MEAS has, for each channel in order, a text with
its length before it: the document's notation for variable and dimension, and the unit of measure,
"EV(A) 3Drqf rad". RATE has, for each unit in order, a FLOAT64, its rate, and a ULONG, its number of
samples or 2^32 - 1 where as many count as the frames hold.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from enpointe.errors import FormatError
from enpointe.motion.gesture.fields import Fields, Notes
from enpointe.motion.gesture.scene import Channel, Dimension, Unit, Variable

__all__ = ["AS_MANY_AS_FIT", "measured", "measures", "paced", "rates"]

AS_MANY_AS_FIT = 2**32 - 1
_PLAIN_VARIABLES = (Variable.POSITION, Variable.FORCE)
_VARIABLES = {variable.label: variable for variable in Variable}
_DIMENSIONS = {dimension.value: dimension for dimension in Dimension}


def measures(units: Sequence[Unit]) -> list[str]:
    """A text a channel for MEAS; none where version 0.1 says it all."""
    channels = [channel for unit in units for channel in unit.channels]
    if all(
        not c.measure and c.variable in _PLAIN_VARIABLES and c.dimension is not Dimension.RQF
        for c in channels
    ):
        return []
    return [f"{c.variable.label} {c.dimension.value} {c.measure}" for c in channels]


def measured(channels: Sequence[Channel], fields: Fields | None, notes: Notes) -> list[Channel]:
    """Channels with what MEAS says of them; as they are, with a warning, where it does not fit."""
    if fields is None:
        return list(channels)
    try:
        described = [_described(channel, fields) for channel in channels]
    except (FormatError, KeyError, ValueError):
        notes.lose("the chunk MEAS, which does not fit the channels")
        return list(channels)
    fields.finish()
    return described


def rates(
    units: Sequence[Unit], frequency: float, counts: Sequence[int] | None, mark: str
) -> bytes:
    """RATE's bytes; none where all units have the file's rate and all its frames."""
    if counts is None and all(unit.rate == frequency for unit in units):
        return b""
    known = counts if counts is not None else [AS_MANY_AS_FIT] * len(units)
    pairs = zip(units, known, strict=True)
    return b"".join(struct.pack(mark + "dI", unit.rate, count) for unit, count in pairs)


def paced(
    count: int, frequency: float, fields: Fields | None, notes: Notes
) -> list[tuple[float, int]]:
    """Rate and number of samples of `count` units; the file's where RATE does not fit."""
    plain = [(frequency, AS_MANY_AS_FIT)] * count
    if fields is None:
        return plain
    try:
        rows = [(fields.real("a rate"), fields.long("a count")) for _ in plain]
    except FormatError:
        rows = []
    if not rows or not all(np.isfinite(rate) and 0 < rate <= frequency for rate, _ in rows):
        notes.lose("the chunk RATE, which does not fit the units")
        return plain
    fields.finish()
    return rows


def _described(channel: Channel, fields: Fields) -> Channel:
    variable, dimension, measure = fields.text("a measure").split(" ", 2)
    found = replace(
        channel,
        variable=_VARIABLES[variable],
        dimension=_DIMENSIONS[dimension],
        measure=measure,
    )
    if found.width != channel.width or found.variable.extensive != channel.variable.extensive:
        raise ValueError("another channel")
    return found
