"""Balance over time, as columns that a spreadsheet reads.

The world's axes: x forward to the audience, y to the dancer's left, z up, the floor at z = 0.
Forces are those of the floor on the dancer. Cells without a value (a centre of pressure in the air)
are empty.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers import Recording
from enpointe.files import atomic_path
from enpointe.sim import balance
from enpointe.sim.feet import SIDES, foot_states, ground_forces

__all__ = ["COLUMNS", "BalanceTable", "balance_table"]

Array = NDArray[np.float64]
COLUMNS: Mapping[str, tuple[str, str]] = {
    "time": ("s", "from the start; the state at this moment, and the floor's forces 2 ms later"),
    "com_x": ("m", "centre of mass"),
    "com_y": ("m", "centre of mass"),
    "com_z": ("m", "centre of mass"),
    "com_velocity_x": ("m/s", "of the centre of mass"),
    "com_velocity_y": ("m/s", "of the centre of mass"),
    "com_velocity_z": ("m/s", "of the centre of mass"),
    "support_area": ("m2", "hull of the soles that bear weight"),
    "com_margin": ("m", "centre of mass to the edge of the support, positive inside"),
    "cop_x": ("m", "centre of pressure, from the forces under the soles"),
    "cop_y": ("m", "centre of pressure, from the forces under the soles"),
    "zmp_x": ("m", "zero-moment point, from the movement of the body alone"),
    "zmp_y": ("m", "zero-moment point, from the movement of the body alone"),
    "xcom_x": ("m", "extrapolated centre of mass (Hof et al. 2005)"),
    "xcom_y": ("m", "extrapolated centre of mass (Hof et al. 2005)"),
    "margin_of_stability": ("m", "extrapolated centre of mass to the edge, positive inside"),
    "left_force_x": ("N", "floor on left foot"),
    "left_force_y": ("N", "floor on left foot"),
    "left_force_z": ("N", "floor on left foot, positive up"),
    "right_force_x": ("N", "floor on right foot"),
    "right_force_y": ("N", "floor on right foot"),
    "right_force_z": ("N", "floor on right foot, positive up"),
    "left_foot": ("", "flat, demi-pointe, pointe, heel or air"),
    "right_foot": ("", "flat, demi-pointe, pointe, heel or air"),
    "airborne": ("", "1 without weight on any sole"),
    "slip": ("m", "farthest that a loaded sole has slid since it took weight"),
    "penetration": ("m", "deepest sole in the floor, positive down"),
    "angular_momentum_x": ("kg m2/s", "about the centre of mass, right-hand rule"),
    "angular_momentum_y": ("kg m2/s", "about the centre of mass, right-hand rule"),
    "angular_momentum_z": ("kg m2/s", "about the centre of mass, right-hand rule"),
    "other_force": ("N", "largest contact that was no sole on the floor"),
    "root_force": ("N", "largest force on the root that is neither gravity nor contact"),
}
"""Unit and meaning of every column, in order."""


@dataclass(frozen=True)
class BalanceTable:
    """Balance sample by sample.

    Attributes:
        columns: By the names of `COLUMNS`, (N,) each.
    """

    columns: Mapping[str, NDArray[np.generic]]

    def save(self, path: Path) -> None:
        """Write a CSV file, beside and renamed: a line of names with units, then the samples."""
        heads = [f"{name} [{unit}]" if unit else name for name, (unit, _) in COLUMNS.items()]
        with atomic_path(path) as beside, beside.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(heads)
            for row in zip(*(self.columns[name].tolist() for name in COLUMNS), strict=True):
                writer.writerow([_cell(value) for value in row])


def balance_table(recording: Recording) -> BalanceTable:
    """Measure balance at every sample of a simulated performance.

    Args:
        recording: With the channels that `SimulatedBody` observes.
    """
    model, channels = recording.model, recording.channels
    points = np.asarray(channels["sole_point"], dtype=float)
    forces = np.asarray(channels["sole_force"], dtype=float)
    gravity, mass = float(-model.opt.gravity[2]), float(model.body_mass.sum())
    com, velocity, momentum = _movement(recording)
    acceleration, momentum_rate = (_rate(v, recording.time) for v in (velocity, momentum))
    hulls = balance.supports(points, forces)
    xcom = np.array(
        [balance.extrapolated_com(c, v, gravity) for c, v in zip(com, velocity, strict=True)]
    )
    zmp = np.array(
        [
            balance.zero_moment_point(c, a, rate, mass, gravity)
            for c, a, rate in zip(com, acceleration, momentum_rate, strict=True)
        ]
    )
    cop = np.array([balance.centre_of_pressure(p, f) for p, f in zip(points, forces, strict=True)])
    feet = ground_forces(model, forces)
    states = [foot_states(model, f) for f in forces]
    columns: dict[str, NDArray[np.generic]] = {
        "time": recording.time,
        **_axes("com", com),
        **_axes("com_velocity", velocity),
        "support_area": np.array([balance.area(h) for h in hulls]),
        "com_margin": balance.margins(hulls, com[:, :2]),
        **_axes("cop", cop),
        **_axes("zmp", zmp),
        **_axes("xcom", xcom),
        "margin_of_stability": balance.margins(hulls, xcom),
        **_axes("left_force", feet[:, 0]),
        **_axes("right_force", feet[:, 1]),
        **{f"{side}_foot": np.array([str(s[side]) for s in states]) for side in SIDES},
        "airborne": (forces[:, :, 2].sum(axis=1) <= balance.LOADED).astype(int),
        "slip": balance.slip(points, forces).max(axis=1),
        "penetration": np.array(
            [balance.penetration(np.asarray(d, dtype=float)) for d in channels["sole_depth"]]
        ),
        **_axes("angular_momentum", momentum),
        "other_force": np.asarray(channels["other_force"], dtype=float),
        "root_force": np.asarray(channels["root_force"], dtype=float).max(axis=1),
    }
    return BalanceTable({name: columns[name] for name in COLUMNS})


def _movement(recording: Recording) -> tuple[Array, Array, Array]:
    """Centre of mass, its velocity, and angular momentum about it, (N, 3) each."""
    model = recording.model
    data = mujoco.MjData(model)
    com, velocity, momentum = np.empty((3, len(recording.time), 3))
    for i, (qpos, qvel) in enumerate(zip(recording.qpos, recording.qvel, strict=True)):
        data.qpos[:], data.qvel[:] = qpos, qvel
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_subtreeVel(model, data)
        com[i], velocity[i] = data.subtree_com[0], data.subtree_linvel[0]
        momentum[i] = data.subtree_angmom[0]
    return com, velocity, momentum


def _rate(values: Array, time: Array) -> Array:
    return np.gradient(values, time, axis=0) if len(time) > 1 else np.zeros_like(values)


def _axes(name: str, values: Array) -> dict[str, NDArray[np.generic]]:
    return {f"{name}_{axis}": values[:, i] for i, axis in enumerate("xyz"[: values.shape[1]])}


def _cell(value: object) -> object:
    if not isinstance(value, float):
        return value
    return f"{value:.9g}" if np.isfinite(value) else ""
