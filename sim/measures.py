"""The figures of a performance, as a report prints them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from enpointe.controllers import Recording
from enpointe.sim import balance, feet

__all__ = ["Flight", "Measures", "find_flights", "heading", "measure"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Flight:
    """A time without any contact.

    Attributes:
        start: s.
        end: s.
        height: Rise of the centre of mass above where it left, m.
        turn_deg: Turn of the pelvis about the vertical meanwhile, degrees.
    """

    start: float
    end: float
    height: float
    turn_deg: float


@dataclass(frozen=True)
class Measures:
    """What came of a performance; N samples, F feet of S soles, nu joints.

    Attributes:
        com: (N, 3), m.
        cop: (N, 2), m, not-a-number in the air.
        margin: (N,), CoM to the edge of the support, m, positive inside.
        foot_force: (N, 2), vertical force under the left and the right foot, N.
        slip: (N,), farthest that any loaded sole has slid, m.
        error: (N, nu), joints behind their reference, rad.
        torque_fraction: (N, nu), torque given over torque limit.
        flights: In order.
        capture_margin: (N,), capture point to the edge of the support, m, positive inside.
        fell_at: s from which the weight never came back over the feet, or None.
        root_force_max: N.
        other_contact_max: Largest force of a contact that was no sole on the floor, N.
    """

    com: Array
    cop: Array
    margin: Array
    foot_force: Array
    slip: Array
    error: Array
    torque_fraction: Array
    flights: tuple[Flight, ...]
    capture_margin: Array
    fell_at: float | None
    root_force_max: float
    other_contact_max: float

    @property
    def tracking_rms_deg(self) -> float:
        """Root mean square over all joints and samples."""
        return float(np.degrees(np.sqrt(np.mean(self.error**2))))

    @property
    def joint_rms_deg(self) -> Array:
        """(nu,)."""
        return np.asarray(np.degrees(np.sqrt(np.mean(self.error**2, axis=0))))

    @property
    def support_margin_min(self) -> float | None:
        """Least margin while anything bears weight, m; None if nothing ever does."""
        standing = self.margin[np.isfinite(self.margin)]
        return float(standing.min()) if len(standing) else None

    @property
    def slip_max(self) -> float:
        """m."""
        return float(self.slip.max())

    @property
    def torque_limit_fraction_max(self) -> float:
        return float(self.torque_fraction.max())


def measure(recording: Recording) -> Measures:
    """Measure a simulated performance.

    Args:
        recording: With the channels that `SimulatedBody` observes.
    """
    channels = recording.channels
    points = np.asarray(channels["sole_point"], dtype=float)
    forces = np.asarray(channels["sole_force"], dtype=float)
    com = np.asarray(channels["com"], dtype=float)
    hulls = balance.supports(points, forces)
    margins = balance.margins(hulls, com[:, :2])
    cop = np.array([balance.centre_of_pressure(p, f) for p, f in zip(points, forces, strict=True)])
    limit = recording.model.actuator_forcerange[:, 1]
    capture = _capture_margins(recording, hulls, com)
    return Measures(
        com=com,
        cop=cop,
        margin=margins,
        foot_force=feet.ground_forces(recording.model, forces)[:, :, 2],
        slip=balance.slip(points, forces).max(axis=1),
        error=_joint_error(recording),
        torque_fraction=np.abs(recording.effort) / limit,
        flights=find_flights(
            recording.time, recording.qpos, com, forces[:, :, 2].sum(axis=1) <= balance.LOADED
        ),
        capture_margin=capture,
        fell_at=_fell_at(recording, margins, capture),
        root_force_max=float(np.max(channels["root_force"])),
        other_contact_max=float(np.max(channels["other_force"])),
    )


def _capture_margins(recording: Recording, hulls: list[Array], com: Array) -> Array:
    """Margins of the capture point  c + c' sqrt(h / g)  (Hof et al. 2005, extrapolated CoM).

    Where it is outside the support, no foot on that support stops the fall.
    """
    gravity = float(-recording.model.opt.gravity[2])
    velocity = np.gradient(com, recording.time, axis=0) if len(com) > 1 else np.zeros_like(com)
    points = [balance.extrapolated_com(c, v, gravity) for c, v in zip(com, velocity, strict=True)]
    return balance.margins(hulls, np.array(points))


def _fell_at(recording: Recording, margins: Array, capture: Array) -> float | None:
    """When the fall began: the dance ends with a fault, or with the weight past saving.

    A dancer may pass through positions that no statue holds; she has fallen if she is still outside
    her support at the end.
    """
    if recording.fault is None and capture[-1] >= -TOPPLING:
        return None
    inside = np.flatnonzero(margins >= 0.0)
    return float(recording.time[inside[-1]]) if len(inside) else 0.0


TOPPLING = 0.005
"""How far outside its support the capture point may end before the dancer counts as falling, m."""


def _joint_error(recording: Recording) -> Array:
    joints = recording.model.jnt_qposadr[recording.model.actuator_trnid[:, 0]]
    wanted = np.array([recording.reference.sample(float(t))[0][joints] for t in recording.time])
    return np.asarray(recording.qpos[:, joints] - wanted)


def find_flights(
    time: Array, qpos: Array, com: Array, aloft: NDArray[np.bool_]
) -> tuple[Flight, ...]:
    """Times in the air, but for the shortest.

    Args:
        time: (N,), s, evenly spaced.
        qpos: (N, nq).
        com: (N, 3), m.
        aloft: (N,), whether nothing bears weight.
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], aloft, [False]]).astype(int)))
    flights = []
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        if (end - start) * (time[1] - time[0]) < MIN_FLIGHT:
            continue
        yaw = heading(qpos[start:end])
        flights.append(
            Flight(
                float(time[start]),
                float(time[end - 1]),
                float(com[start:end, 2].max() - com[start, 2]),
                float(np.degrees(yaw[-1] - yaw[0])),
            )
        )
    return tuple(flights)


MIN_FLIGHT = 0.02
"""Shorter times in the air are a rattle of the contact, not a jump, s."""


def heading(qpos: Array) -> Array:
    """Which way the pelvis faces, (N,), rad to the left of where x points, without jumps.

    Args:
        qpos: (N, nq), the root first.
    """
    w, x, y, z = qpos[:, 3:7].T
    return np.asarray(np.unwrap(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))))
