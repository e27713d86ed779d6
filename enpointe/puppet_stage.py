"""A body of servos that stands by itself: emulated bus, motors, gravity and a floor, in one."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from enpointe.preparing import Progress, silent

if TYPE_CHECKING:
    from enpointe.controllers import Command, Recording
    from enpointe.hardware.dynamixel import ServoRig, Statistics
    from enpointe.hardware.rig_file import Rig
    from enpointe.motion import Motion
    from enpointe.sim.servo_plant import ServoPlant

__all__ = ["SETTLE", "StagedDance", "dance_on_stage"]

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


def dance_on_stage(motion: Motion, rig: Rig, *, progress: Progress = silent) -> StagedDance:
    """Let a body of servos dance by itself: nothing but gravity, a floor and its motors.

    The servos are those of the emulated bus, in memory and on a clock of their own, driven through
    the SDK at the rig's rate; behind them stands the simulated body. Hands hold it in the first
    pose until its torque is on. Goals lie ahead of the motion by the sag of the servos (`Springs`);
    there is no feedback of balance.

    Args:
        motion: Of the rig's body, such as `enpointe.motion.puppeteering.puppeteer` gives.
        rig: Its servos.
        progress: Told how far it is.

    Raises:
        RigError: The motion is of another body.
    """
    from enpointe.controllers import Springs, perform
    from enpointe.hardware.dynamixel import Link, ServoRig, description_of
    from enpointe.hardware.emulator import EmulatedPort, VirtualClock, bus_of
    from enpointe.hardware.stiffness import stiffness
    from enpointe.servo_loop import layout_of
    from enpointe.sim.servo_plant import ServoPlant

    motion = _after_standing(motion)
    layout = layout_of(rig, motion)
    stiff = np.empty(layout.nu)
    stiff[layout.actuator] = [stiffness(servo) for servo in rig.servos]
    springs = Springs(motion, stiff)
    servos = [(servo.joint, servo.sign, radians(servo.offset)) for servo in rig.servos]
    stage = ServoPlant.of(motion.model, motion.qpos[0], servos, period=rig.period)
    clock = VirtualClock()
    port = EmulatedPort(bus_of(description_of(rig), plant=stage), clock)
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
        statistics = body.statistics
    return StagedDance(motion, recording, stage.recorded(), stage.fault, statistics)


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


def _after_standing(motion: Motion) -> Motion:
    """A motion that begins with `SETTLE` in its first pose."""
    from enpointe.motion import Event, Motion

    step = float(motion.time[1])
    count = round(SETTLE / step)
    time = np.concatenate([step * np.arange(count), motion.time + count * step])
    qpos = np.concatenate([np.tile(motion.qpos[0], (count, 1)), motion.qpos])
    events = [Event(e.time + count * step, e.kind, e.name, e.beat) for e in motion.events]
    return Motion.from_qpos(motion.model, time, qpos, events=events, name=motion.name)
