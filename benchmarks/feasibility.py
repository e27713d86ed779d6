"""Grand battement at its tempo on a rig: what limits, the time that is enough, and the runs in it.

The rig's body stands in MuJoCo behind the emulated bus, and the rig's own loop drives it through
the real dynamixel-sdk: hung on a stand, as written and in the time that is enough there; and on its
own feet, in the time that is enough for these.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence

import numpy as np

import enpointe
from enpointe.controllers import Recording
from enpointe.feasibility import Feasibility, feasible
from enpointe.hardware.dynamixel import Link, description_of
from enpointe.hardware.emulator import Bus, EmulatedPort, VirtualClock, bus_of
from enpointe.hardware.rig_file import Rig, load_rig
from enpointe.models.puppet import op3_spec, puppet_spec
from enpointe.motion import Motion
from enpointe.motion.joint_timing import TimingKept, timing_kept
from enpointe.motion.puppeteering import Puppeteered, puppeteer
from enpointe.motion.slowing import slowed
from enpointe.puppet_stage import dance_on_stage
from enpointe.rig_motion import body_of
from enpointe.servo_loop import dance_on
from enpointe.sim.stand_plant import StandPlant

FULL = 0.999


class Watched(StandPlant):
    """Counts the milliseconds of each motor with the whole supply on it."""

    bus: Bus | None = None
    full: np.ndarray = np.zeros(())
    ticks = 0

    def advance(self, torque: Sequence[float], period: float) -> None:
        super().advance(torque, period)
        if self.bus is not None:
            duty = np.abs([servo.motor.duty for servo in self.bus.servos])
            self.full = self.full + (duty > FULL)
            self.ticks += 1


def run(rig: Rig, motion: Motion) -> tuple[Recording, dict[str, object]]:
    """The motion on the emulated bus, and what the servos had to give."""
    joints = [motion.model.joint(name).qposadr[0] for name in rig.joints]
    plant = Watched(
        {"op3": op3_spec, "puppet": puppet_spec}[rig.body](),
        motion.qpos[0, joints],
        rig.joints,
        signs=[servo.sign for servo in rig.servos],
        offsets=[np.radians(servo.offset) for servo in rig.servos],
    )
    bus = bus_of(description_of(rig), plant=plant)
    plant.bus = bus
    port = EmulatedPort(bus, VirtualClock())
    port.setBaudRate(rig.baud)
    danced = dance_on(Link(port), rig, motion, port.clock)
    recording = danced.recording
    columns = {name: i for i, name in enumerate(_actuated(motion))}
    held_back = np.asarray(recording.channels["slowed"], dtype=float)
    slowed = {joint: float(np.mean(held_back[:, columns[joint]])) for joint in rig.joints}
    full = {
        joint: float(share)
        for joint, share in zip(rig.joints, plant.full / plant.ticks, strict=True)
    }
    error = recording.qpos - np.array([motion.sample(float(t))[0] for t in recording.time])
    hinges = error[:, joints]
    return recording, {
        "fault": recording.fault,
        "whole_supply": {joint: share for joint, share in full.items() if share},
        "goals_slowed": {joint: share for joint, share in slowed.items() if share},
        "tracking_rms_deg": float(np.degrees(np.sqrt(np.mean(hinges**2)))),
        "tracking_max_deg": float(np.degrees(np.abs(hinges).max())),
        "hottest": float(recording.channels["temperature"].max()),
    }


def free(rig: Rig, made: Puppeteered, scale: float) -> dict[str, object]:
    """What a body on its own feet did, nothing holding it."""
    contacts = made.contacts.slowed(scale)
    danced = dance_on_stage(slowed(made.motion, scale), rig, contacts=contacts)
    error = np.degrees(danced.tracking_error)
    force = np.asarray(danced.stage["sole_force"])[:, :, 2]
    return {
        "fell": danced.fell,
        "opened": made.opened,
        "tracking_rms_deg": float(np.sqrt(np.mean(error**2))),
        "tracking_max_deg": float(np.abs(error).max()),
        "root_off_max": danced.root_off,
        "root_force_max": float(np.asarray(danced.stage["root_force"]).max()),
        "on_one_foot": float(np.mean((force[:, : force.shape[1] // 2].sum(axis=1) < 0.1)
                                     | (force[:, force.shape[1] // 2 :].sum(axis=1) < 0.1))),
    }  # fmt: skip


def _actuated(motion: Motion) -> list[str]:
    model = motion.model
    return [model.joint(int(joint)).name for joint in model.actuator_trnid[:, 0]]


def told(found: Feasibility) -> dict[str, object]:
    """What is short of a verdict."""
    figures = found.summary()
    kept = ("feasible", "time_scale", "time_scale_of_servos")
    because = [line for what, line in found.lines() if what == "because"]
    return {**{name: figures[name] for name in kept}, "because": because}


def effort(timing: TimingKept) -> dict[str, object]:
    """What of the effort came out."""
    return {
        "asked": None if timing.asked is None else [timing.asked.time, timing.asked.weight],
        "done": None if timing.done is None else [timing.done.time, timing.done.weight],
        "distance_rms": timing.distance_rms,
        "speed_correlation": timing.speed_correlation,
        "peak_shift": timing.peak_shift,
        "lag": timing.lag,
        "ways": timing.ways,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--score", default="grand-battement")
    parser.add_argument("--rig", default="op3")
    parser.add_argument("--json", action="store_true")
    asked = parser.parse_args()
    rig = load_rig(asked.rig)
    dance = enpointe.perform(asked.score, controller="kinematic")
    made = puppeteer(dance.motion, body_of(rig))
    floor = feasible(made.motion, rig, contacts=made.contacts)
    hung = feasible(made.motion, rig, stand=True)
    figures: dict[str, object] = {
        "score": asked.score,
        "rig": rig.name,
        "on_its_feet": told(floor),
        "on_a_stand": told(hung),
        "as_written": run(rig, made.motion)[1],
    }
    scale = hung.time_scale or hung.assessment.servo_scale
    if scale is not None:
        slow = slowed(made.motion, scale)
        recording, in_time = run(rig, slow)
        moving = [joint for joint in rig.joints if np.ptp(_angles(made.motion, joint)) > 0.3]
        timing = timing_kept(slow, recording.as_motion(), moving)
        figures |= {"in_the_time_that_is_enough": in_time, "effort": effort(timing)}
    if floor.time_scale is not None:
        figures["on_its_feet_in_time"] = free(rig, made, floor.time_scale)
    if asked.json:
        print(json.dumps(figures))
        return
    for name, value in figures.items():
        rows = value.items() if isinstance(value, dict) else [("", value)]
        for what, figure in rows:
            lines = figure if isinstance(figure, list) and what == "because" else [figure]
            for line in lines:
                print(f"{name:28} {what:22} {line}")


def _angles(motion: Motion, joint: str) -> np.ndarray:
    return motion.qpos[:, motion.model.joint(joint).qposadr[0]]


if __name__ == "__main__":
    main()
