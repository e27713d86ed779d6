"""`enpointe servo`: a score or a motion in, a dance of servos out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import RigError
from enpointe.feasibility import Feasibility, feasible
from enpointe.figures import ServoFigures
from enpointe.preparing import Progress, silent

if TYPE_CHECKING:
    import mujoco

    from enpointe.controllers import Recording
    from enpointe.hardware.dynamixel import Statistics
    from enpointe.hardware.emulator import Fault
    from enpointe.hardware.rig_file import Rig
    from enpointe.motion import Motion
    from enpointe.servo_loop import Danced

__all__ = ["EMULATED", "MEMORY", "ServoPerformance", "body_of", "rig_motion", "servo", "would"]

EMULATED, MEMORY = "emulated", "memory"
"""Ports that are none: a bus in a process of its own behind a pseudo-terminal, and one in memory
with a clock of its own, on which two runs are the same bit for bit."""
_PATIENCE = 8.0
"""ms of a pseudo-terminal: how long the emulator's process may be away."""


@dataclass(frozen=True)
class ServoPerformance:
    """A dance of servos.

    Attributes:
        rig: The servos.
        port: Where they were.
        motion: What was to be danced, of the rig's body, slowed if it had to be.
        recording: What happened.
        statistics: Of loop, bus and ending.
        feasibility: Whether the rig can dance it as written; None if that was not asked.
    """

    rig: Rig
    port: str
    motion: Motion
    recording: Recording
    statistics: Statistics
    feasibility: Feasibility | None = None

    @property
    def completed(self) -> bool:
        """Whether it came to its end, and the servos were left as they should be."""
        from enpointe.hardware.dynamixel import Ending

        return self.recording.fault is None and self.statistics.ending is Ending.PARKED

    @cached_property
    def tracking_error(self) -> NDArray[np.float64]:
        """(N, n) joint angles danced minus those asked at the same moments, rad; NaN if unread."""
        from enpointe.controllers.plant import Plant

        plant = Plant(self.motion.model)
        joints = plant.actuated_qpos
        asked = np.array([self.motion.sample(t)[0][joints] for t in self.recording.time])
        error = self.recording.qpos[:, joints] - asked
        error[~self.recording.valid] = np.nan
        return np.asarray(error[1:])

    def tracking_by_joint(self) -> dict[str, float]:
        """Root mean square of the tracking error of each joint, degrees."""
        model = self.motion.model
        names = [model.joint(int(joint)).name for joint in model.actuator_trnid[:, 0]]
        return dict(zip(names, map(float, np.degrees(_rms(self.tracking_error))), strict=True))

    def save(self, folder: Path) -> dict[str, Path]:
        """Write `motion.npz`, what was asked, and `recording.npz`, what was done."""
        from enpointe.motion.npz import save_motion

        files = {"motion": folder / "motion.npz", "recording": folder / "recording.npz"}
        save_motion(self.motion, files["motion"])
        self.recording.save(files["recording"])
        return files

    def summary(self) -> ServoFigures:
        """The figures that `--json` prints, SI units; the names are a promise to scripts."""
        from enpointe.hardware.wire import BusCycle

        late, rig = self.statistics.lateness, self.rig
        squares = self.tracking_error**2
        overall = float(np.degrees(np.sqrt(np.nanmean(squares)))) if squares.size else float("nan")
        found = self.feasibility
        return {
            "title": self.motion.name,
            "feasible": None if found is None else found.feasible,
            "time_scale": None if found is None else found.time_scale,
            "limiting_joints": None if found is None else list(found.limiting_joints),
            "rig": rig.name,
            "port": self.port,
            "completed": self.completed,
            "duration": float(self.recording.time[-1]),
            "baud": rig.baud,
            "rate": rig.rate,
            "bus_ceiling_hz": BusCycle(len(rig.servos), fast=rig.fast_read).ceiling(rig.baud),
            "achieved_hz": late.achieved,
            "deadline_misses": late.misses,
            "lateness": {"median": late.median, "p99": late.p99, "worst": late.worst},
            "frame_loss": self.statistics.frame_loss,
            "faults": list(self.statistics.faults),
            "ending": self.statistics.ending.value,
            "tracking_rms_deg": overall,
            "tracking_rms_deg_by_joint": self.tracking_by_joint(),
        }


def _rms(error: NDArray[np.float64]) -> NDArray[np.float64]:
    if not len(error):
        return np.full(error.shape[1], np.nan)
    counts = np.maximum(np.sum(np.isfinite(error), axis=0), 1)
    return np.asarray(np.sqrt(np.nansum(error**2, axis=0) / counts))


def servo(
    source: str | Path,
    *,
    rig: str | Path | Rig = "puppet",
    port: str = EMULATED,
    effort: str | None = None,
    tempo: float | None = None,
    stand: bool = True,
    as_written: bool = False,
    faults: Sequence[Fault] = (),
    seed: int = 0,
    progress: Progress = silent,
) -> ServoPerformance:
    """Dance on a rig of servos, or on one that is emulated.

    Args:
        source: A shipped score's name, a `.bmn` file, or a motion or a recording (`.npz`) of the
            dancer or of the rig's own body.
        rig: A shipped rig's name, a TOML file, or a rig.
        port: A serial port; "emulated" or "memory" for a bus that is not there.
        effort: See `perform`.
        tempo: See `perform`.
        stand: Whether the body hangs on a stand, and need not balance; see `feasible`.
        as_written: Dance it even if the servos can't follow, and no slower than it is written.
        faults: What goes wrong on an emulated bus.
        seed: Of the faults.
        progress: Told how far it is.

    Returns:
        The dance, up to the fault if there was one; `ServoPerformance.summary` has its figures.

    Raises:
        EnpointeError: The rig can't begin, no time is enough for the movement, or anything else
            that the caller can mend.
    """
    from enpointe.hardware.rig_file import Rig, load_rig

    chosen = rig if isinstance(rig, Rig) else load_rig(rig)
    if faults and port not in (EMULATED, MEMORY):
        raise RigError(f"faults happen on an emulated bus; {port} has its own")
    motion = rig_motion(source, chosen, effort=effort, tempo=tempo, progress=progress)
    feasibility = None
    if not as_written:
        feasibility = feasible(motion, chosen, stand=stand, progress=progress)
        motion = feasibility.slowed
    from enpointe.servo_loop import dance_in_own_process

    def danced(done: float, total: float) -> None:
        progress("servos", done, total)

    if port == MEMORY:
        found = _in_memory(chosen, motion, faults, seed, danced)
    elif port == EMULATED:
        from enpointe.hardware.dynamixel import description_of
        from enpointe.hardware.emulator import launch

        with launch(description_of(chosen), faults, seed) as path:
            found = dance_in_own_process(chosen, motion, path, patience=_PATIENCE, progress=danced)
    else:
        found = dance_in_own_process(chosen, motion, port, progress=danced)
    done = found.recording, found.statistics
    return ServoPerformance(chosen, port, motion, *done, feasibility)


def would(
    source: str | Path,
    rig: Rig,
    *,
    effort: str | None = None,
    tempo: float | None = None,
    stand: bool = True,
    progress: Progress = silent,
) -> Feasibility:
    """Whether a rig can dance something, and nothing is danced; see `servo`."""
    motion = rig_motion(source, rig, effort=effort, tempo=tempo, progress=progress)
    return feasible(motion, rig, stand=stand, progress=progress)


def _in_memory(
    rig: Rig,
    motion: Motion,
    faults: Sequence[Fault],
    seed: int,
    progress: Callable[[float, float], None],
) -> Danced:
    from enpointe.hardware.dynamixel import Link, description_of
    from enpointe.hardware.emulator import EmulatedPort, FaultRun, VirtualClock, bus_of
    from enpointe.servo_loop import dance_on

    run = FaultRun(faults, np.random.default_rng(seed)) if faults else None
    clock = VirtualClock()
    port = EmulatedPort(bus_of(description_of(rig), faults=run), clock)
    port.setBaudRate(rig.baud)
    return dance_on(Link(port), rig, motion, clock, progress=progress)


def body_of(rig: Rig) -> mujoco.MjModel:
    """The model of a rig's body."""
    from enpointe.models.puppet import op3_model, puppet_model

    return puppet_model() if rig.body == "puppet" else op3_model()


def rig_motion(
    source: str | Path,
    rig: Rig,
    *,
    effort: str | None = None,
    tempo: float | None = None,
    progress: Progress = silent,
) -> Motion:
    """A movement on the body of a rig.

    Args:
        source: See `servo`.
        rig: Whose body.
        effort: See `perform`.
        tempo: See `perform`.
        progress: Told how far it is.
    """
    from enpointe.performing import perform
    from enpointe.stored import is_stored, load_stored

    path, model = Path(source), body_of(rig)
    if is_stored(path):
        own = _own(path, model)
        if own is not None:
            return own
        danced = load_stored(path)
    else:
        danced = perform(
            source, effort=effort, tempo=tempo, controller="kinematic", progress=progress
        ).motion
    from enpointe.motion.puppeteering import puppeteer

    def posed(done: int, total: int) -> None:
        progress("puppet", done, total)

    return puppeteer(danced, model, progress=posed).motion


def _own(path: Path, model: mujoco.MjModel) -> Motion | None:
    """A motion or a recording of the rig's own body; None if the file is of another."""
    from enpointe.controllers import Recording
    from enpointe.errors import FormatError
    from enpointe.motion.npz import is_motion, load_motion

    try:
        if is_motion(path):
            return load_motion(path, model)
        return Recording.load(path, model).as_motion()
    except FormatError:
        return None
