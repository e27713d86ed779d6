"""Whether servos can dance a movement, what stops them, and the least time scale that lets them.

Every limit of one moment is a quadratic in the speed that is left (`limits.joint_rows`, the ground
of a `Demand`), so that the least time scale is found exactly (`time_scale`); heat and overload,
which last, are tried at what is left. Slowing everything alike keeps the rhythm's proportions and
the share of the way gone at each share of the time, and so the logistic of the effort; see
docs/feasibility.md.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import RigError
from enpointe.hardware.demand import Collision, Demand, GroundRows
from enpointe.hardware.emulator.protection import OVERLOAD_SECONDS
from enpointe.hardware.heat import ROOM
from enpointe.hardware.limits import JointLimit, currents, joint_rows
from enpointe.hardware.time_scale import (
    SLOWEST,
    TOLERANCE,
    Rows,
    allowed_speeds,
    fastest_lasting,
)
from enpointe.hardware.warming import Warmth, longest_overload, warmth

__all__ = ["BODY", "Assessment", "Excess", "assess"]

Array = NDArray[np.float64]
BODY = ""
"""The joint of what the body as a whole can't do."""
_ABOVE = 1e-6
"""Relative: so much slower than the very limit, that rounding does not matter."""


@dataclass(frozen=True, slots=True)
class Excess:
    """A joint beyond one of its limits, or nearest to one, where it is worst.

    Attributes:
        joint: Its name; `BODY` for the body as a whole.
        kind: "position", "speed", "acceleration", "torque" (of the torque-speed line), "current",
            "heat", "overload", "balance", "friction", "push" or "flight".
        time: s of the movement as written.
        needed: What is asked, in `unit`.
        allowed: What there is then.
        unit: SI.
        used: `needed` beside `allowed` as the limit is tested; more than 1 is beyond.
        spans: (start, end) in s, of all moments beyond.
        time_scale: The least that keeps this limit alone; None if none does.
    """

    joint: str
    kind: str
    time: float
    needed: float
    allowed: float
    unit: str
    used: float
    spans: tuple[tuple[float, float], ...]
    time_scale: float | None


@dataclass(frozen=True)
class Assessment:
    """The verdict on a movement.

    Attributes:
        demand: What was asked, as written.
        limits: Of each joint.
        feasible: As written.
        time_scale: The least number of times its time in which it is feasible; 1 if it is as
            written; None if none helps.
        servo_scale: The same for the servos alone, without balance and collisions.
        excesses: Every limit that is broken as written, the one that needs most time first; where
            no time helps, as it is at rest.
        nearest: The joints' limits that are used most, one a joint, most first.
        decisive: What forbids a time scale a little less than the one found; None if feasible.
        warmth: As written, or at the time scale found (that of the servos, if no other was).
        repeats: How often it was to be danced without a pause.
    """

    demand: Demand = field(repr=False)
    limits: tuple[JointLimit, ...] = field(repr=False)
    feasible: bool
    time_scale: float | None
    servo_scale: float | None
    excesses: tuple[Excess, ...]
    nearest: tuple[Excess, ...]
    decisive: Excess | None
    warmth: Warmth
    repeats: int

    @property
    def limiting_joints(self) -> tuple[str, ...]:
        """Joints that are beyond a limit as written, the one that needs most time first."""
        return tuple(dict.fromkeys(e.joint for e in self.excesses if e.joint != BODY))

    @property
    def hopeless(self) -> tuple[Excess, ...]:
        """What no time scale helps."""
        return tuple(excess for excess in self.excesses if excess.time_scale is None)

    @property
    def collisions(self) -> tuple[Collision, ...]:
        """Where the body is in its own way."""
        return self.demand.collisions

    def used(self, speed: float = 1.0) -> Array:
        """(T, J), the share of its tightest limit that each joint uses, at a share of the speed."""
        most = np.full(self.demand.position.shape, -np.inf)
        for rows in joint_rows(self.demand, self.limits):
            np.maximum.at(most, (rows.sample, rows.joint), rows.used(speed))
        return most

    def summary(self) -> dict[str, object]:
        """The figures that `--json` prints, SI units; the names are a promise to scripts."""
        hottest = self.warmth.after(self.repeats)
        return {
            "feasible": self.feasible,
            "time_scale": self.time_scale,
            "time_scale_of_servos": self.servo_scale,
            "duration": float(self.demand.time[-1] - self.demand.time[0]),
            "repeats": self.repeats,
            "limiting_joints": [
                _figures(excess) for excess in self.excesses if excess.joint != BODY
            ],
            "limiting_floor": [
                _figures(excess) for excess in self.excesses if excess.joint == BODY
            ],
            "nearest": [_figures(excess) for excess in self.nearest],
            "decisive": None if self.decisive is None else _figures(self.decisive),
            "collisions": [
                {
                    "between": [c.first, c.second],
                    "start": c.start,
                    "end": c.end,
                    "time": c.time,
                    "depth": c.depth,
                }
                for c in self.collisions
            ],
            "heat": [
                {"joint": limit.joint, "celsius": float(degrees), "repeats_possible": repeats}
                for limit, degrees, repeats in zip(
                    self.limits, hottest, self.warmth.repeats(), strict=True
                )
            ],
        }


def _figures(excess: Excess) -> dict[str, object]:
    return {
        "joint": excess.joint or None,
        "limit": excess.kind,
        "time": excess.time,
        "needed": excess.needed,
        "allowed": excess.allowed,
        "unit": excess.unit,
        "used": excess.used,
        "spans": [list(span) for span in excess.spans],
        "time_scale": excess.time_scale,
    }


def assess(demand: Demand, limits: Sequence[JointLimit], *, repeats: int = 1) -> Assessment:
    """Look at a movement for servos.

    Args:
        demand: What it asks of each joint and of the floor.
        limits: In the order of its joints.
        repeats: How often it is danced without a pause between, for the heat.

    Raises:
        RigError: Other joints than the movement's, or no repeat.
    """
    if tuple(limit.joint for limit in limits) != demand.joints:
        raise RigError("limits must be of the movement's joints, in their order")
    if repeats < 1:
        raise RigError(f"a movement is danced once at least, not {repeats} times")
    return _Judgement(demand, tuple(limits), repeats).verdict()


class _Judgement:
    """One movement before its limits."""

    def __init__(self, demand: Demand, limits: tuple[JointLimit, ...], repeats: int) -> None:
        self._demand, self._limits, self._repeats = demand, limits, repeats
        self._models = [limit.model for limit in limits]
        self._rows = joint_rows(demand, limits) + [_ground_rows(g) for g in demand.ground]

    def verdict(self) -> Assessment:
        demand, limits = self._demand, self._limits
        servos = [rows for rows in self._rows if (rows.joint >= 0).all()]
        servo_speed = fastest_lasting(allowed_speeds(servos), self._lasts)
        speed = None
        if not demand.collisions:
            speed = fastest_lasting(allowed_speeds(self._rows), self._lasts)
        feasible = speed is not None and speed >= 1.0
        scale = _scale(speed)
        excesses = sorted(self._excesses(), key=_urgency)
        danced = scale or _scale(servo_speed) or 1.0
        return Assessment(
            demand=demand,
            limits=limits,
            feasible=feasible,
            time_scale=scale,
            servo_scale=_scale(servo_speed),
            excesses=tuple(excesses),
            nearest=tuple(self._nearest()),
            decisive=None if feasible or speed is None else self._decisive(speed),
            warmth=warmth(
                demand.time * danced, currents(demand, limits, 1.0 / danced), self._models
            ),
            repeats=self._repeats,
        )

    def _lasting(self, speed: float) -> dict[str, Array]:
        """Shares of the limits of what lasts, (J,), by kind."""
        time = self._demand.time / speed
        current = currents(self._demand, self._limits, speed)
        return {
            "heat": warmth(time, current, self._models).used(self._repeats),
            "overload": longest_overload(time, current, self._models),
        }

    def _lasts(self, speed: float) -> bool:
        return all(bool(np.all(used <= 1.0)) for used in self._lasting(speed).values())

    def _excesses(self) -> Iterator[Excess]:
        for kind in dict.fromkeys(rows.kind for rows in self._rows):
            alike = [rows for rows in self._rows if rows.kind == kind]
            broken = {
                int(joint)
                for rows in alike
                for joint in np.unique(rows.joint[rows.used() > 1.0 + TOLERANCE])
            }
            for joint in sorted(broken):
                yield self._excess(kind, joint, [r.only(r.joint == joint) for r in alike])
        lasting = self._lasting(1.0)
        for kind, used in lasting.items():
            for joint in np.flatnonzero(used > 1.0).tolist():
                yield self._lasting_excess(kind, joint, float(used[joint]))

    def _excess(self, kind: str, joint: int, rows: list[Rows]) -> Excess:
        time = self._demand.time
        allowed = allowed_speeds(rows)
        speed = allowed[0][1] if allowed else None
        looked_at = 1.0 if allowed else 1.0 / SLOWEST
        used = np.concatenate([each.used(looked_at) for each in rows])
        samples = np.concatenate([each.sample for each in rows])
        worst = int(np.argmax(used))
        beyond = np.zeros(len(time), dtype=bool)
        beyond[samples[used > 1.0 + TOLERANCE]] = True
        place = (int(samples[worst]), float(used[worst]), looked_at)
        needed, limit, unit = self._meaning(kind, joint, *place)
        return Excess(
            BODY if joint < 0 else self._limits[joint].joint,
            kind,
            float(time[samples[worst]]),
            needed,
            limit,
            unit,
            float(used[worst]),
            _spans(time, beyond),
            None if speed is None else 1.0 / speed,
        )

    def _lasting_excess(self, kind: str, joint: int, used: float) -> Excess:
        def lasts(speed: float) -> bool:
            return float(self._lasting(speed)[kind][joint]) <= 1.0

        speed = fastest_lasting(((1.0 / SLOWEST, 1.0),), lasts)
        needed, limit, unit = self._meaning(kind, joint, -1, used, 1.0)
        end = float(self._demand.time[-1])
        scale = None if speed is None else 1.0 / speed
        name = self._limits[joint].joint
        return Excess(name, kind, end, needed, limit, unit, used, ((0.0, end),), scale)

    def _meaning(
        self, kind: str, joint: int, sample: int, used: float, speed: float
    ) -> tuple[float, float, str]:
        """What a share of a limit is in SI, at a share of the speed: needed, allowed, unit."""
        demand = self._demand
        if joint < 0:
            found = next(ground for ground in demand.ground if ground.kind == kind)
            return used - 1.0, 0.0, found.unit
        limit = self._limits[joint]
        if kind == "position":
            angle = float(demand.position[sample, joint])
            return angle, limit.upper if angle > limit.upper else limit.lower, "rad"
        if kind == "torque":
            load = demand.static[sample, joint] + speed**2 * demand.dynamic[sample, joint]
            turning = speed * demand.velocity[sample, joint] * np.copysign(1.0, load)
            return abs(float(load)), limit.torque_left(float(turning)), "N m"
        allowed, unit = {
            "speed": (limit.greatest_speed, "rad/s"),
            "acceleration": (limit.greatest_acceleration, "rad/s^2"),
            "current": (limit.greatest_current, "A"),
            "heat": (limit.model.initial["Temperature Limit"] - ROOM, "K"),
            "overload": (OVERLOAD_SECONDS, "s"),
        }[kind]
        return used * allowed, allowed, unit

    def _nearest(self) -> list[Excess]:
        """Each joint's limit that is used most."""
        joints: dict[int, Excess] = {}
        for kind in dict.fromkeys(rows.kind for rows in self._rows):
            alike = [rows for rows in self._rows if rows.kind == kind]
            if (alike[0].joint < 0).all():
                continue
            for joint in range(len(self._limits)):
                found = self._excess(kind, joint, [r.only(r.joint == joint) for r in alike])
                if joint not in joints or found.used > joints[joint].used:
                    joints[joint] = found
        return sorted(joints.values(), key=lambda excess: -excess.used)

    def _decisive(self, speed: float) -> Excess | None:
        """Which limit a little more speed would break."""
        faster = min(speed * (1.0 + 1e-3), 1.0)
        beyond = [
            (float(used[worst := int(np.argmax(used))]), rows.kind, int(rows.joint[worst]))
            for rows in self._rows
            if (used := rows.used(faster)).max(initial=0.0) > 1.0
        ]
        lasting = self._lasting(faster)
        beyond += [
            (float(used.max()), kind, int(np.argmax(used)))
            for kind, used in lasting.items()
            if used.max() > 1.0
        ]
        if not beyond:
            return None
        share, kind, joint = max(beyond)
        if kind in lasting:
            return self._lasting_excess(kind, joint, share)
        alike = [rows.only(rows.joint == joint) for rows in self._rows if rows.kind == kind]
        return self._excess(kind, joint, alike)


def _scale(speed: float | None) -> float | None:
    """Times the time, for the share of the speed that is left."""
    if speed is None or speed >= 1.0:
        return None if speed is None else 1.0
    return (1.0 + _ABOVE) / speed


def _ground_rows(ground: GroundRows) -> Rows:
    nobody = np.full(len(ground.sample), -1)
    return Rows(
        ground.kind,
        nobody,
        ground.sample,
        ground.dynamic,
        np.zeros(len(ground.sample)),
        ground.constant,
    )


def _spans(time: Array, beyond: NDArray[np.bool_]) -> tuple[tuple[float, float], ...]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], beyond.astype(int), [0]])))
    return tuple(
        (float(time[start]), float(time[end - 1]))
        for start, end in zip(edges[::2], edges[1::2], strict=True)
    )


def _urgency(excess: Excess) -> tuple[float, float]:
    scale = np.inf if excess.time_scale is None else excess.time_scale
    return -scale, -excess.used
