"""What each joint did: how far behind its reference it was, and how much strength it took."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from enpointe.controllers import Recording
from enpointe.report.chart import GREY, INK, LEFT, RIGHT, quiet, to_svg
from enpointe.sim.measures import Measures

__all__ = ["JointRow", "joint_chart", "joint_rows"]

Array = NDArray[np.float64]
_COLOURS = {"left": LEFT, "right": RIGHT, "": GREY}
_BESIDE = {"left": 0.2, "right": -0.2, "": 0.0}
"""How far above its joint's place a side's bar is drawn."""


@dataclass(frozen=True, slots=True)
class JointRow:
    """One joint.

    Attributes:
        joint: Its name without the side.
        side: "left", "right", or "" for a joint of the trunk.
        rms_deg: Root mean square of the tracking error.
        max_deg: Its greatest.
        torque: Greatest share of the torque limit.
    """

    joint: str
    side: str
    rms_deg: float
    max_deg: float
    torque: float


def joint_rows(recording: Recording, measures: Measures) -> tuple[JointRow, ...]:
    """Every actuated joint, in the model's order."""
    model = recording.model
    rows = []
    for i, rms in enumerate(measures.joint_rms_deg):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, i) or f"actuator {i}"
        side, _, rest = name.partition("_")
        sided = side in ("left", "right")
        rows.append(
            JointRow(
                (rest if sided else name).replace("_", " "),
                side if sided else "",
                float(rms),
                float(np.degrees(np.abs(measures.error[:, i]).max())),
                float(measures.torque_fraction[:, i].max()),
            )
        )
    return tuple(rows)


@quiet
def joint_chart(rows: Sequence[JointRow], name: str) -> str:
    """Tracking error and torque, joint by joint, the worst tracked at the top."""
    worst: dict[str, float] = {}
    for row in rows:
        worst[row.joint] = max(worst.get(row.joint, 0.0), row.rms_deg)
    order = sorted(worst, key=lambda joint: worst[joint])
    figure = Figure(figsize=(8.25, 0.95 + 0.25 * len(order)))
    error, torque = figure.subplots(1, 2, sharey=True)
    for side, colour in _COLOURS.items():
        mine = [row for row in rows if row.side == side]
        thick = 0.36 if side else 0.5
        y = [order.index(row.joint) + _BESIDE[side] for row in mine]
        greatest = [row.max_deg for row in mine]
        # One line with gaps, not a line for each joint: an artist costs more than what it draws.
        ends = [at for end in greatest for at in (0.0, end, np.nan)]
        error.plot(ends, np.repeat(y, 3), color=colour, linewidth=0.8)
        error.plot(greatest, y, color=colour, linestyle="none", marker="|", markersize=4)
        error.barh(y, [row.rms_deg for row in mine], height=thick, color=colour)
        torque.barh(y, [100.0 * row.torque for row in mine], height=thick, color=colour)
    error.set_yticks(range(len(order)), order)
    error.set_ylim(-0.7, len(order) - 0.3)
    error.set_title("behind the reference")
    error.set_xlabel("degrees: bar rms, tick greatest")
    torque.set_title("greatest torque")
    torque.set_xlabel("% of the joint's limit")
    error.set_xlim(left=0.0)
    torque.set_xlim(0.0, max(100.0, 105.0 * max(row.torque for row in rows)))
    torque.axvline(100.0, color=INK, linewidth=0.8)
    for axes in (error, torque):
        axes.tick_params(axis="y", length=0)
    handles = [
        Patch(color=_COLOURS[side], label=label)
        for side, label in (("left", "left"), ("right", "right"), ("", "trunk and neck"))
    ]
    figure.legend(handles=handles, loc="outside upper left", ncols=3, handlelength=1.0)
    return to_svg(figure, name, "Tracking error and greatest torque of each joint")
