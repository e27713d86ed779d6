"""The movements of a dance: from one key pose to the next, repeats of the same one together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from enpointe.motion import Choreography, Motion
from enpointe.motion.wrist import Profile
from enpointe.notation import ResolvedFrame, Side
from enpointe.notation.writer import format_beat

__all__ = ["Movement", "danced_tempo", "movements"]

_SAME = 1e-4
"""Key poses this close, m and rad, are the same."""


@dataclass(frozen=True, slots=True)
class Movement:
    """A way from one key pose to another, danced once or more.

    Attributes:
        title: From which position of the arms to which.
        beats: Where it is danced, for people.
        starts: Names of the key poses that it starts from, one for each repeat.
    """

    title: str
    beats: str
    starts: tuple[str, ...]

    def of(self, profiles: Iterable[Profile]) -> tuple[Profile, ...]:
        """Those profiles that are of this movement."""
        return tuple(p for p in profiles if p.start in self.starts)


def movements(choreography: Choreography) -> tuple[Movement, ...]:
    """The movements of a score in the order of their first appearance."""
    poses, frames = choreography.key_poses, choreography.score.resolved()
    alike: list[list[int]] = []
    for i in range(len(poses) - 1):
        for group in alike:
            pairs = ((poses[i], poses[group[0]]), (poses[i + 1], poses[group[0] + 1]))
            if all(np.allclose(a.qpos, b.qpos, rtol=0.0, atol=_SAME) for a, b in pairs):
                group.append(i)
                break
        else:
            alike.append([i])
    return tuple(_movement(choreography, frames, group) for group in alike)


def _movement(
    choreography: Choreography, frames: tuple[ResolvedFrame, ...], group: list[int]
) -> Movement:
    first = group[0]
    start, end = _arms(frames[first]), _arms(frames[first + 1])
    spans = [f"{format_beat(frames[i].beat)}–{format_beat(frames[i + 1].beat)}" for i in group]
    named = start is not None and end is not None and start != end
    return Movement(
        f"{start} to {end}" if named else f"beats {spans[0]}",
        f"beats {_listed(spans)}",
        tuple(choreography.key_poses[i].name for i in group),
    )


def _arms(frame: ResolvedFrame) -> str | None:
    """The named position of both arms, or None."""
    named = {frame.arms[side].named for side in Side}
    position = named.pop()
    return None if named or position is None else position.name


def _listed(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def danced_tempo(motion: Motion, choreography: Choreography) -> float | None:
    """The tempo that comes out: beats against the times when their key poses are most nearly taken.

    The first and the last key pose are held and have no moment of their own, and neither has one
    that the pose before or after repeats.

    Args:
        motion: What was danced.
        choreography: What it was to be.

    Returns:
        Pulses a minute by linear regression, or None with fewer than two such moments.
    """
    poses, events = choreography.key_poses, motion.key_events
    beats, moments = [], []
    for i in range(1, len(events) - 1):
        around = (poses[i - 1].qpos, poses[i + 1].qpos)
        if any(np.allclose(poses[i].qpos, q, rtol=0.0, atol=_SAME) for q in around):
            continue
        begin = (events[i - 1].time + events[i].time) / 2
        end = (events[i].time + events[i + 1].time) / 2
        inside = np.flatnonzero((motion.time >= begin) & (motion.time <= end))
        gap = np.linalg.norm(motion.qpos[inside, 7:] - poses[i].qpos[7:], axis=1)
        beats.append(float(choreography.score.frames[i].beat))
        moments.append(float(motion.time[inside[np.argmin(gap)]]))
    if len(beats) < 2:
        return None
    return 60.0 / float(np.polyfit(beats, moments, 1)[0])
