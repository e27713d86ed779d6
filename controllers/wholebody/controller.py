"""The whole-body controller: at each period one quadratic programme over the whole body."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.gains import Gains
from enpointe.controllers.protocol import Command, State
from enpointe.controllers.wholebody.constraints import (
    Constraint,
    FloatingBase,
    FrictionPyramids,
    JointRange,
    TorqueLimits,
    joint_torques,
)
from enpointe.controllers.wholebody.contacts import PlannedSoles, Uptake
from enpointe.controllers.wholebody.instant import Instant, Observer
from enpointe.controllers.wholebody.problem import WholeBodyProblem
from enpointe.controllers.wholebody.reference import Reference
from enpointe.controllers.wholebody.rows import places
from enpointe.controllers.wholebody.standing_place import StandingPlace
from enpointe.controllers.wholebody.step_adjustment import StepAdjustment
from enpointe.controllers.wholebody.tasks import (
    AngularMomentum,
    CentreOfMass,
    Contact,
    Landing,
    Orientation,
    Posture,
    SwingFoot,
    Task,
)
from enpointe.motion import Motion
from enpointe.motion.contact_schedule import ContactSchedule

__all__ = ["DEFAULT_TASKS", "STEPPING_TASKS", "WholeBody", "Workload"]

Array = NDArray[np.float64]
PERIOD = 0.002
"""s between commands: 500 Hz. Trials held alike from 100 to 1000 Hz."""
FRICTION = 0.6
"""Planned below the floor's friction of 1, as a dancer does not count on the last of it: the least
of the floors that a sweep draws. With 0.7 she slid there, where weight goes from foot to foot."""
DEFAULT_TASKS: tuple[Task, ...] = (
    CentreOfMass(),
    AngularMomentum(),
    Contact(),
    Landing(),
    Orientation(),
    Posture(),
    SwingFoot(),
)
STEPPING_TASKS: tuple[Task, ...] = (
    CentreOfMass(weight=1000.0),
    AngularMomentum(weight=1.0),
    Contact(pivots=True),
    Landing(),
    Orientation(),
    Posture(),
    SwingFoot(weight=100.0),
)
"""For steps that follow one another: what trunk, arms and a leg in the air take up of the weight's
error in one they can't give back before the next, so that they take up less; and feet that carry
may turn."""
TONE_FREQUENCY = 2 * np.pi * 1.0
"""rad/s. Joints are held softly to what the programme integrates to, a third of the frequency that
plain PD is given, so that a body without torque control can be driven as well."""
TONE_MEMORY = 0.05
"""s over which the integrated targets forget where they began."""


@dataclass(slots=True)
class Workload:
    """What control cost.

    Attributes:
        commands: How many were asked for.
        failures: How many of them had no solution and fell back.
        building: s spent on measuring the state and writing problems down.
        solving: s spent on solving them.
    """

    commands: int = 0
    failures: int = 0
    building: float = 0.0
    solving: float = 0.0


class WholeBody:
    """Accelerations and floor forces that keep balance and follow a motion, solved at each period.

    The command carries the torques of the solution, and beside them the joints' integrated
    positions and velocities with a soft stiffness towards them, which is what a servo follows.
    Where a programme has no solution, the last torques are held with the stiffness of plain PD
    towards the reference, and the failure is counted.

    Args:
        motion: What to dance.
        contacts: Which soles it was planned to stand on, of the same model; read from the motion if
            None.
        model: The controller's own picture of the body; the motion's model if None.
        tasks: What is wished for.
        constraints: What must hold; root, friction, torques and joint ranges if None.
        period: s between commands.
        friction: Planned coefficient.

    Attributes:
        workload: What control cost so far.
        problem: The last programme, to be looked at; None before the first command.
        unknowns: Its solution; None if it has none.
    """

    def __init__(
        self,
        motion: Motion,
        *,
        contacts: ContactSchedule | None = None,
        model: mujoco.MjModel | None = None,
        tasks: Sequence[Task] = DEFAULT_TASKS,
        constraints: Sequence[Constraint] | None = None,
        period: float = PERIOD,
        friction: float = FRICTION,
    ) -> None:
        self.motion = motion
        self.tasks = tuple(tasks)
        self.workload = Workload()
        self.problem: WholeBodyProblem | None = None
        self.unknowns: Array | None = None
        self._observer = Observer(model or motion.model, friction)
        plant = self._observer.plant
        self.constraints = tuple(
            constraints
            if constraints is not None
            else (
                FloatingBase(),
                FrictionPyramids(),
                TorqueLimits(plant.torque_limit),
                JointRange.of(self._observer.model),
            )
        )
        self._reference = Reference(motion, self._observer)
        self._schedule = PlannedSoles(self._reference, contacts)
        self._place = StandingPlace()
        self._steps = (
            None
            if contacts is None
            else StepAdjustment(self._schedule, self._reference.time, self._observer.feet)
        )
        self._uptake = Uptake(len(self._observer.soles))
        self._active = np.empty(0, dtype=np.int64)
        self._period = period
        self._fallback = Gains.suggested(motion.model, motion.qpos[0])
        plant.place(motion.qpos[0])
        inertia = plant.joint_inertia()
        self._stiffness = inertia * TONE_FREQUENCY**2
        self._damping = 2 * inertia * TONE_FREQUENCY
        self._angles, self._dofs = places(plant.actuated_qpos), places(plant.actuated_dofs)
        self._torque = np.zeros(plant.model.nu)
        self._position = np.zeros(plant.model.nu)
        self._velocity = np.zeros(plant.model.nu)

    def reset(self, state: State) -> None:
        """Begin from `state`: nothing is remembered of a performance before."""
        self.workload = Workload()
        self.problem = self.unknowns = None
        self._observer.place(state.qpos, state.qvel)
        self._active, _ = self._schedule.split(0.0, self._observer.clearance())
        self._place.reset(self._observer.points(), self._reference.points[0], self._active)
        self._uptake.reset(self._active)
        if self._steps is not None:
            self._steps.reset()
        self._torque[:] = 0.0
        self._position[:] = state.qpos[self._angles]
        self._velocity[:] = state.qvel[self._dofs]

    def command(self, t: float, state: State) -> Command:
        """Solve for this period."""
        start = perf_counter()
        self.problem = self.build(t, state)
        self.problem.separate  # noqa: B018
        built = perf_counter()
        self.unknowns = self.problem.solve()
        solved = perf_counter()
        self.workload.commands += 1
        self.workload.building += built - start
        self.workload.solving += solved - built
        if self.unknowns is None:
            self.workload.failures += 1
            return self._fall_back(t, state)
        return self._obey(self.problem.instant, self.unknowns)

    def build(self, t: float, state: State) -> WholeBodyProblem:
        """The programme at `t` seconds in `state`, not yet solved."""
        self._observer.place(state.qpos, state.qvel)
        active, due = self._schedule.split(t, self._observer.clearance(), self._active)
        self._active = active
        capacity = self._uptake.follow(active, self._period)
        instant = self._observer.instant(active, capacity, due)
        goal = self._reference.at(t)
        place = self._place.follow(instant.points, goal.points, active, self._period)
        goal = goal.placed(place)
        if self._steps is not None:
            goal = self._steps.follow(t, instant, goal, self._period)
        return WholeBodyProblem.build(instant, goal, self.tasks, self.constraints)

    def _obey(self, instant: Instant, unknowns: Array) -> Command:
        dt, keep = self._period, math.exp(-self._period / TONE_MEMORY)
        acceleration = unknowns[self._dofs]
        angle, speed = instant.qpos[self._angles], instant.qvel[self._dofs]
        velocity = speed + keep * (self._velocity - speed)
        position = angle + keep * (self._position - angle)
        self._position = position + velocity * dt + 0.5 * acceleration * dt**2
        self._velocity = velocity + acceleration * dt
        self._torque = joint_torques(instant, unknowns)
        return Command(self._position, self._velocity, self._torque, self._stiffness, self._damping)

    def _fall_back(self, t: float, state: State) -> Command:
        qpos, qvel, _ = self.motion.sample(t)
        self._position = np.array(state.qpos[self._angles])
        self._velocity = np.array(state.qvel[self._dofs])
        return Command(
            qpos[self._angles],
            qvel[self._dofs],
            self._torque,
            self._fallback.stiffness,
            self._fallback.damping,
        )
