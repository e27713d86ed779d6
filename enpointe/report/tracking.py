"""What was asked of joints and what they did, over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from enpointe.comparing_bodies import BodyComparison
from enpointe.motion import Motion
from enpointe.report.chart import COM, LEFT, mark_beats, quiet, to_svg

__all__ = ["JointError", "tracking_chart", "worst_joints"]

_EVERY = 0.02


@dataclass(frozen=True, slots=True)
class JointError:
    """How far one joint was from what was asked, degrees.

    Attributes:
        joint: Its name.
        rms: Root mean square.
        most: At the most.
    """

    joint: str
    rms: float
    most: float


def worst_joints(shown: BodyComparison) -> list[JointError]:
    """Every joint of the rig, the worst first."""
    time = np.arange(0.0, min(shown.asked.duration, shown.danced.duration) + 1e-9, _EVERY)
    found = []
    for joint in shown.rig.joints:
        error = np.degrees(_angle(shown.danced, joint, time) - _angle(shown.asked, joint, time))
        rms, most = float(np.sqrt(np.mean(error**2))), float(np.abs(error).max())
        found.append(JointError(joint, rms, most))
    return sorted(found, key=lambda each: -each.rms)


@quiet
def tracking_chart(asked: Motion, danced: Motion, joints: Sequence[str], name: str) -> str:
    """Joints over time: left their angles as asked and as danced, right what lies between."""
    figure = Figure(figsize=(8.25, 0.8 + 1.05 * len(joints)))
    grid = figure.subplots(len(joints), 2, sharex=True, squeeze=False)
    end = min(asked.duration, danced.duration)
    time = np.arange(0.0, end + 1e-9, _EVERY)
    for row, ((left, right), joint) in enumerate(zip(grid, joints, strict=True)):
        wanted, came = (np.degrees(_angle(motion, joint, time)) for motion in (asked, danced))
        left.plot(time, wanted, color=LEFT, linewidth=1.0, label="asked")
        left.plot(time, came, color=COM, linewidth=1.0, linestyle=(0, (3, 2)), label="danced")
        right.plot(time, came - wanted, color=COM, linewidth=0.9)
        left.set_ylabel(joint.replace("_", "\n"), rotation=0, ha="right", va="center")
        for axes in (left, right):
            mark_beats(axes, [e for e in asked.key_events if e.time <= end], labels=row == 0)
            axes.yaxis.set_major_locator(MaxNLocator(3))
    grid[0, 0].set_title("angle, °", loc="left", pad=14)
    grid[0, 1].set_title("danced minus asked, °", loc="left", pad=14)
    for axes in grid[-1]:
        axes.set_xlabel("s")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=2)
    return to_svg(figure, name, "Angles of the joints that were farthest off, asked and danced")


def _angle(motion: Motion, joint: str, time: np.ndarray) -> np.ndarray:
    place = int(motion.model.joint(joint).qposadr[0])
    return np.asarray(np.interp(time, motion.time, motion.qpos[:, place]))
