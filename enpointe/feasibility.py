"""`enpointe servo --dry-run`: whether a rig can dance a movement, and how much slower if not."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.errors import MotionError
from enpointe.preparing import Progress, silent

if TYPE_CHECKING:
    from enpointe.hardware.demand import Collision, Demand
    from enpointe.hardware.feasibility import Assessment, Excess
    from enpointe.hardware.rig_file import Rig
    from enpointe.motion import Motion
    from enpointe.motion.contact_schedule import ContactSchedule
    from enpointe.sim.joint_loads import JointLoads

__all__ = ["Feasibility", "collision_words", "demand_of", "excess_amount", "feasible"]

_TOUCHING = 5e-4
"""m: shapes that are in one another by less than this touch, and do not collide."""


@dataclass(frozen=True)
class Feasibility:
    """A movement, a rig, and the verdict.

    Attributes:
        motion: On the rig's body, as written.
        rig: Its servos.
        stand: Whether the body hangs on a stand, and need not balance.
        assessment: What was found, in numbers.
    """

    motion: Motion
    rig: Rig
    stand: bool
    assessment: Assessment

    @property
    def feasible(self) -> bool:
        """Whether the rig can dance it as written."""
        return self.assessment.feasible

    @property
    def time_scale(self) -> float | None:
        """The least number of times its time in which it can; None if slowing does not help."""
        return self.assessment.time_scale

    @property
    def limiting_joints(self) -> tuple[str, ...]:
        """Joints that are beyond a limit as written, the one that needs most time first."""
        return self.assessment.limiting_joints

    @cached_property
    def slowed(self) -> Motion:
        """The movement as the rig can dance it.

        Raises:
            MotionError: No time scale makes it feasible; says why.
        """
        from enpointe.motion.slowing import slowed

        if self.time_scale is None:
            raise MotionError(f"no time is enough for {self.motion.name}: {self.reasons[0]}")
        return self.motion if self.time_scale == 1.0 else slowed(self.motion, self.time_scale)

    @property
    def reasons(self) -> tuple[str, ...]:
        """What stands in the way as written, one line each, the worst first; empty if nothing."""
        found = [collision_words(each) for each in self.assessment.collisions]
        return (*found, *(self.excess_words(each) for each in self.assessment.excesses))

    def excess_words(self, excess: Excess) -> str:
        """One limit in words: joint, moment, by how much, and the time that it needs."""
        help_ = (
            "no time helps"
            if excess.time_scale is None
            else f"{excess.time_scale:.2f} times the time is enough"
        )
        who = excess.joint or "the body"
        return f"{who} at {self.moment(excess.time)}: {excess_amount(excess)}; {help_}"

    def moment(self, time: float) -> str:
        """A moment in seconds, and between which key poses it is."""
        events = self.motion.key_events
        before = [event for event in events if event.time <= time + 1e-9]
        after = [event for event in events if event.time > time + 1e-9]
        if before and after:
            return f"{time:.2f} s, {before[-1].name} to {after[0].name}"
        return f"{time:.2f} s"

    def summary(self) -> dict[str, object]:
        """The figures that `--json` prints, SI units; the names are a promise to scripts."""
        return {
            **self.assessment.summary(),
            "rig": self.rig.name,
            "stand": self.stand,
            "reasons": list(self.reasons),
        }

    def lines(self) -> list[tuple[str, str]]:
        """The same for people: what, and its value in words; of each joint its worst limit."""
        scale, servos = self.time_scale, self.assessment.servo_scale
        if self.feasible:
            return [("feasible", "as written")]
        rows = [("feasible", "in no time" if scale is None else f"in {scale:.3f} times its time")]
        if scale is None and servos is not None:
            rows.append(("the servos alone", f"in {servos:.3f} times its time"))
        rows += [("because", collision_words(each)) for each in self.assessment.collisions]
        shown: set[str] = set()
        for excess in self.assessment.excesses:
            if excess.joint not in shown:
                rows.append(("because", self.excess_words(excess)))
            shown.add(excess.joint)
        return rows


_WORDS = {
    "speed": "the limit of speed",
    "acceleration": "what the rotor can be accelerated with",
    "current": "the limit of current",
    "position": "the range",
}


def excess_amount(excess: Excess) -> str:
    """What is asked and what there is, in the units that people read."""
    from math import degrees

    needed, allowed = excess.needed, excess.allowed
    match excess.kind:
        case "position" | "speed" | "acceleration":
            unit = {"rad": "°", "rad/s": "°/s", "rad/s^2": "°/s²"}[excess.unit]
            values = f"{degrees(needed):.0f}{unit}, and {_WORDS[excess.kind]} is"
            return f"{values} {degrees(allowed):.0f}{unit}"
        case "torque":
            left = f"has {allowed:.2f} N m" if allowed > 0.0 else "gives none"
            return (
                f"{needed:.2f} N m, and the servo {left} at that speed"
                f" ({100 * excess.used:.0f} % of the voltage)"
            )
        case "current":
            return f"{needed:.2f} A, and the limit of current is {allowed:.2f} A"
        case "heat":
            return f"{needed:.0f} K warmer than the room, and {allowed:.0f} K shut it down"
        case "overload":
            return f"overloaded for {needed:.1f} s, and {allowed:.1f} s shut it down"
        case "balance":
            return f"the zero-moment point is {1000 * needed:.0f} mm beyond the support"
        case "push":
            return f"the floor would have to pull with {100 * needed:.0f} % of the weight"
        case "friction":
            return f"soles slide: {100 * needed:.0f} % of the weight beyond what friction holds"
    return f"in the air {100 * needed:.0f} % of the weight off free fall"


def collision_words(collision: Collision) -> str:
    """A collision in words."""
    parts, depth = f"{collision.first} and {collision.second}", 1000 * collision.depth
    return f"{parts} are {depth:.0f} mm in one another at {collision.time:.2f} s; no time helps"


def feasible(
    motion: Motion,
    rig: Rig | str | Path,
    *,
    contacts: ContactSchedule | None = None,
    stand: bool = False,
    repeats: int = 1,
    voltage: float | None = None,
    reserve: float | None = None,
    progress: Progress = silent,
) -> Feasibility:
    """Look at a movement for a rig of servos, without dancing it.

    Args:
        motion: Of the rig's body.
        rig: A shipped rig's name, a TOML file, or a rig.
        contacts: Which soles bear, and when; read from the movement if None.
        stand: Hang the body on a stand: no balance is asked, and legs carry nothing but themselves.
        repeats: How often it is danced without a pause, for the heat.
        voltage: V of the supply; what the servos' datasheets recommend if None.
        reserve: Share of the supply kept for the servos' regulators; a twentieth if None.
        progress: Told how far it is.

    Returns:
        The verdict; `summary` has its figures, `slowed` the movement as the rig can dance it.

    Raises:
        RigError: No such rig, or a supply that its servos do not take.
        MotionError: The movement is of another body.

    Example:
        >>> import enpointe
        >>> found = enpointe.feasible(motion, "op3")
        >>> found.feasible, found.time_scale, found.limiting_joints
        (False, 1.41, ('r_hip_pitch',))
    """
    from enpointe.hardware.feasibility import assess
    from enpointe.hardware.limits import RESERVE, limits_of
    from enpointe.hardware.rig_file import load_rig
    from enpointe.sim.joint_loads import joint_loads

    found = load_rig(rig) if isinstance(rig, str | Path) else rig
    limits = limits_of(found, voltage=voltage, reserve=RESERVE if reserve is None else reserve)
    names = {motion.model.joint(j).name for j in range(motion.model.njnt)}
    if missing := [joint for joint in found.joints if joint not in names]:
        raise MotionError(
            f"{motion.name} is of a body without {', '.join(missing[:3])}: put it on the body of"
            f" the rig {found.name!r} first"
        )
    progress("loads", 0, 1)
    loads = joint_loads(motion, contacts, stand=stand)
    progress("loads", 1, 1)
    demand = demand_of(loads, stand=stand).of_joints(found.joints)
    return Feasibility(motion, found, stand, assess(demand, limits, repeats=repeats))


def demand_of(loads: JointLoads, *, stand: bool = False) -> Demand:
    """What was found of a movement's loads, as servos are asked for it."""
    from enpointe.hardware.demand import Demand, GroundRows
    from enpointe.sim.floor_limits import floor_limits

    ground = () if stand else floor_limits(loads)
    return Demand(
        loads.joints,
        loads.time,
        loads.position,
        loads.velocity,
        loads.acceleration,
        loads.static,
        loads.dynamic,
        tuple(GroundRows(g.kind, g.unit, g.sample, g.constant, g.dynamic) for g in ground),
        _collisions(loads),
    )


def _collisions(loads: JointLoads) -> tuple[Collision, ...]:
    from enpointe.hardware.demand import Collision

    found = []
    for overlap in loads.overlaps:
        worst = int(overlap.depth.argmax())
        inside = overlap.depth > _TOUCHING
        if not inside.any():
            continue
        first, last = (float(loads.time[i]) for i in (inside.argmax(), -1 - inside[::-1].argmax()))
        depth, moment = float(overlap.depth[worst]), float(loads.time[worst])
        found.append(Collision(overlap.first, overlap.second, first, last, moment, depth))
    return tuple(found)
