"""When a dancer really gets to the key poses, and so the tempo that she really keeps."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from enpointe.motion.motion import Motion

__all__ = ["KEPT", "arrivals", "danced_tempo", "lateness", "tempo_kept"]

Array = NDArray[np.float64]
_NEAR = 0.1
"""A pose is reached when this share of the way from the pose before is left: of a short way a body
under gravity may leave a twentieth undone that it is off its reference anyway."""
KEPT = 0.04
"""A beat is kept when its key pose is reached this near its time, s: a 25th of a pulse at 60."""


def arrivals(danced: Motion, asked: Motion) -> Array:
    """The moment of arrival at each key pose but the first, (K - 1,), s; NaN if never.

    A key pose is reached at the first moment between the key pose before and the one after it when
    the joints' distance (root mean square) to it falls to `_NEAR` of the distance at the start of
    the way. The logistic slows as it arrives, so this is a little before the beat, by equal shares
    in a performance and in its reference: compare the two, not either with the beat.

    Args:
        danced: What happened.
        asked: The reference, whose key poses and times count.
    """
    events = asked.key_events
    moments = []
    for before, after in pairwise(events):
        pose = asked.sample(after.time)[0][7:]
        late = after.time + 0.5 * (after.time - before.time)
        inside = (danced.time >= before.time) & (danced.time <= late)
        away = np.sqrt(np.mean((danced.qpos[inside, 7:] - pose) ** 2, axis=1))
        reached = np.flatnonzero(away <= _NEAR * away[0]) if len(away) else np.empty(0, dtype=int)
        moments.append(danced.time[inside][reached[0]] if len(reached) else np.nan)
    return np.array(moments)


def lateness(danced: Motion, asked: Motion) -> Array:
    """How much later than the reference each key pose but the first is reached, (K - 1,), s.

    Negative where it is reached earlier, NaN where it never is.
    """
    return arrivals(danced, asked) - arrivals(asked, asked)


def danced_tempo(danced: Motion, asked: Motion) -> tuple[float, float]:
    """The tempo kept, in pulses a minute, and the largest lateness at a key pose, s.

    The tempo is the slope of the beats over the moments of arrival, corrected for where in its way
    each arrival is counted (least squares); NaN where a key pose is never reached.
    """
    return tempo_kept(lateness(danced, asked), asked)


def tempo_kept(late: Array, asked: Motion) -> tuple[float, float]:
    """The same as `danced_tempo`, from the `lateness` of each key pose but the first."""
    beats = np.array([event.beat or 0.0 for event in asked.key_events[1:]])
    times = np.array([event.time for event in asked.key_events[1:]]) + late
    if len(beats) < 2 or not np.all(np.isfinite(times)):
        return float("nan"), float("nan")
    slope = np.polyfit(times, beats, 1)[0]
    return float(60.0 * slope), float(np.abs(late).max())
