"""A simulated body behind an emulated bus: on its own feet with gravity and a floor, or hung up."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from enpointe.preparing import Progress, silent

if TYPE_CHECKING:
    import mujoco

    from enpointe.controllers import Command, Recording
    from enpointe.hardware.dynamixel import ServoRig, Statistics
    from enpointe.hardware.emulator import FaultRun
    from enpointe.hardware.rig_file import Rig
    from enpointe.motion import Motion
    from enpointe.motion.contact_schedule import ContactSchedule
    from enpointe.servo_loop import Danced
    from enpointe.sim.servo_plant import ServoPlant

__all__ = ["SETTLE", "StagedDance", "dance_on_stage", "dance_on_stand"]

SETTLE = 1.0
"""s in the first pose once the hands have let go, before the dance begins."""


@dataclass(frozen=True)
class StagedDance:
    """What a body of servos did on the simulated stage.

    Attributes:
        motion: What was to be danced, of that body, from `SETTLE` in its first pose on.
        recording: What its servos said.
        stage: What was seen of it (`ServoPlant.recorded`): the root, the contacts, the weight.
        fell: Why it did not come to the end ("fell"), or None.
        statistics: Of loop and bus.
    """

    motion: Motion
    recording: Recording
    stage: dict[str, NDArray[np.generic]]
    fell: str | None
    statistics: Statistics

    @property
    def tracking_error(self) -> NDArray[np.float64]:
        """(N, nu) joint angles seen minus those asked at the same moments, rad."""
        joints = self.motion.model.actuator_trnid[:, 0]
        places = self.motion.model.jnt_qposadr[joints]
        asked = np.array([self.motion.sample(float(t))[0][places] for t in self.stage["time"]])
        return np.asarray(np.asarray(self.stage["qpos"])[:, places] - asked)

    @property
    def root_off(self) -> float:
        """How far the root was from where it was asked to be, at most, m."""
        asked = np.array([self.motion.sample(float(t))[0][:3] for t in self.stage["time"]])
        away = np.asarray(self.stage["qpos"])[:, :3] - asked
        return float(np.linalg.norm(away, axis=1).max(initial=0.0))

    def seen(self) -> Motion:
        """What the hall saw, root and all, to be filmed and measured."""
        from enpointe.motion import Motion

        time = np.asarray(self.stage["time"], dtype=float)
        qpos = np.asarray(self.stage["qpos"], dtype=float)
        return Motion.from_qpos(
            self.motion.model,
            time - time[0],
            qpos,
            events=[event for event in self.motion.events if event.time <= time[-1] - time[0]],
            name=f"{self.motion.name}, performed",
        )


def dance_on_stage(
    motion: Motion,
    rig: Rig,
    *,
    contacts: ContactSchedule | None = None,
    faults: FaultRun | None = None,
    play: float = 0.0,
    progress: Progress = silent,
) -> StagedDance:
    """Let a body of servos dance by itself: nothing but gravity, a floor and its motors.

    The servos are those of the emulated bus, in memory and on a clock of their own, driven through
    the SDK at the rig's rate; behind them stands the simulated body. Hands hold it in the first
    pose until its torque is on. Goals lie ahead of the motion by the sag and the lag of the servos
    (`Springs`), and weight leaves a foot before it is lifted; there is no feedback of balance.

    Args:
        motion: Of the rig's body, such as `enpointe.motion.puppeteering.puppeteer` gives.
        rig: Its servos.
        contacts: Which soles bear, and when; read from the motion if None.
        faults: What goes wrong on the bus.
        play: rad of play in every servo's gears.
        progress: Told how far it is.

    Raises:
        RigError: The motion is of another body.
    """
    from enpointe.controllers import Springs, perform
    from enpointe.hardware.dynamixel import Link, ServoRig, description_of
    from enpointe.hardware.emulator import EmulatedPort, VirtualClock, bus_of
    from enpointe.hardware.stiffness import damping, stiffness
    from enpointe.motion.contact_schedule import contact_schedule
    from enpointe.servo_loop import layout_of
    from enpointe.sim.gear_play import with_play
    from enpointe.sim.servo_plant import ServoPlant

    motion, contacts = _after_standing(motion, contacts or contact_schedule(motion))
    layout = layout_of(rig, motion)
    stiff, damped = np.empty(layout.nu), np.empty(layout.nu)
    stiff[layout.actuator] = [stiffness(servo) for servo in rig.servos]
    damped[layout.actuator] = [damping(servo) for servo in rig.servos]
    springs = Springs(motion, stiff, damping=damped, contacts=contacts, lead=rig.period)
    servos = [(servo.joint, servo.sign, radians(servo.offset)) for servo in rig.servos]
    model = with_play(_spec_of(rig), _in_all(rig, play)) if play else motion.model
    stage = ServoPlant.of(model, motion.qpos[0], servos, period=rig.period)
    clock = VirtualClock()
    port = EmulatedPort(bus_of(description_of(rig), plant=stage, faults=faults), clock)
    port.setBaudRate(rig.baud)
    with ServoRig(rig, Link(port), layout, clock) as body:
        body.start(springs.first_pose)
        stage.let_go()
        recording = perform(
            motion,
            springs,
            _OnStage(body, stage),
            progress=lambda done, total: progress("servos", done, total),
        )
    return StagedDance(motion, recording, stage.recorded(), stage.fault, body.statistics)


class _OnStage:
    """A rig that can also fall over."""

    def __init__(self, rig: ServoRig, stage: ServoPlant) -> None:
        self.period, self.fault = rig.period, rig.fault
        self.read, self.observe = rig.read, rig.observe
        self._rig, self._stage = rig, stage

    def write(self, command: Command) -> None:
        """Send goals, and look whether it still stands."""
        self._rig.write(command)
        self.fault = self._rig.fault or self._stage.fault


def dance_on_stand(
    motion: Motion,
    rig: Rig,
    *,
    faults: FaultRun | None = None,
    play: float = 0.0,
    progress: Progress = silent,
) -> Danced:
    """Let a body of servos dance while it hangs by its trunk, as a puppet is first tried.

    Args:
        motion: Of the rig's body.
        rig: Its servos.
        faults: What goes wrong on the bus.
        play: rad of play in every servo's gears.
        progress: Told how far it is.

    Raises:
        RigError: The motion is of another body, or the rig can't begin.
    """
    from enpointe.hardware.dynamixel import Link, description_of
    from enpointe.hardware.emulator import EmulatedPort, VirtualClock, bus_of
    from enpointe.servo_loop import dance_on
    from enpointe.sim.stand_plant import StandPlant

    angles = motion.qpos[0, [motion.model.joint(name).qposadr[0] for name in rig.joints]]
    signs = [servo.sign for servo in rig.servos]
    offsets = [radians(servo.offset) for servo in rig.servos]
    stand = StandPlant(
        _spec_of(rig),
        angles,
        rig.joints,
        signs=signs,
        offsets=offsets,
        play=_in_all(rig, play),
    )
    clock = VirtualClock()
    port = EmulatedPort(bus_of(description_of(rig), plant=stand, faults=faults), clock)
    port.setBaudRate(rig.baud)
    return dance_on(
        Link(port),
        rig,
        motion,
        clock,
        progress=lambda done, total: progress("servos", done, total),
    )


def _spec_of(rig: Rig) -> mujoco.MjSpec:
    from enpointe.models.puppet import op3_spec, puppet_spec

    return {"op3": op3_spec, "puppet": puppet_spec}[rig.body]()


def _in_all(rig: Rig, play: float) -> dict[str, float]:
    return dict.fromkeys(rig.joints, play)


def _after_standing(motion: Motion, contacts: ContactSchedule) -> tuple[Motion, ContactSchedule]:
    """A motion that begins with `SETTLE` in its first pose, and its contacts."""
    from enpointe.motion import Event, Motion
    from enpointe.motion.contact_schedule import ContactSchedule

    step = float(motion.time[1])
    count = round(SETTLE / step)
    still = step * np.arange(count)
    qpos = np.concatenate([np.tile(motion.qpos[0], (count, 1)), motion.qpos])
    events = [Event(e.time + count * step, e.kind, e.name, e.beat) for e in motion.events]
    time = np.concatenate([still, motion.time + count * step])
    later = ContactSchedule(
        np.concatenate([[0.0], contacts.time + count * step]),
        contacts.soles,
        np.concatenate([contacts.points[:1], contacts.points]),
        np.concatenate([contacts.bears[:1], contacts.bears]),
    )
    return Motion.from_qpos(motion.model, time, qpos, events=events, name=motion.name), later
