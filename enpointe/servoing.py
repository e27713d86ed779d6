"""`enpointe servo`: a score or a motion in, a dance of servos out."""

from __future__ import annotations

import math
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
from enpointe.rig_motion import RigMotion, rig_motion

if TYPE_CHECKING:
    from enpointe.controllers import Recording
    from enpointe.hardware.dynamixel import Statistics
    from enpointe.hardware.emulator import Fault, FaultRun
    from enpointe.hardware.rig_file import Rig
    from enpointe.models import Anthropometry, Style
    from enpointe.motion import Motion
    from enpointe.motion.joint_timing import TimingKept
    from enpointe.puppet_stage import StagedDance
    from enpointe.servo_loop import Danced

__all__ = [
    "EMULATED",
    "MEMORY",
    "SIMULATED",
    "ServoPerformance",
    "servo",
    "would",
]

EMULATED, MEMORY, SIMULATED = "emulated", "memory", "simulated"
"""Ports that are none: a bus in a process of its own behind a pseudo-terminal; one in memory with a
clock of its own, on which two runs are the same bit for bit; and the same with the rig's body
behind its servos, in MuJoCo, hung up or on its own feet."""
_NOBODY = "servos alone, no body behind them (emulated)"
_STAND = "hung on a stand, with gravity, no floor (simulated)"
_FEET = "on its own feet, with gravity and a floor, nothing held (simulated)"
_REAL = "real servos"
_MOST_PLAY = 5.0
"""Degrees: gears with more are broken."""
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
        staged: What was seen of a simulated body on its own feet; None of any other.
        stage: On what it danced, in words.
        opened: m, see `RigMotion`.
        dancer: The dancer's movement as written; None if it was of the rig's body already.
    """

    rig: Rig
    port: str
    motion: Motion
    recording: Recording
    statistics: Statistics
    feasibility: Feasibility | None = None
    staged: StagedDance | None = None
    stage: str = _REAL
    opened: float | None = None
    dancer: Motion | None = None

    @property
    def completed(self) -> bool:
        """Whether it came to its end, and the servos were left as they should be: parked, or on
        its own feet still standing."""
        from enpointe.hardware.dynamixel import Ending

        if self.staged is not None:
            return self.recording.fault is None
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

    @cached_property
    def danced(self) -> Motion:
        """What the servos did; of a simulated body on its own feet what was seen of it."""
        return self.recording.as_motion() if self.staged is None else self.staged.seen()

    @cached_property
    def timing(self) -> TimingKept | None:
        """What of the effort came out; None of a dance that ended at once."""
        if len(self.recording.time) < 2:
            return None
        from enpointe.motion.joint_timing import timing_kept

        return timing_kept(self.motion, self.danced, self.rig.joints)

    def tracking_by_joint(self) -> dict[str, float]:
        """Root mean square of the tracking error of each joint, degrees."""
        model = self.motion.model
        names = [model.joint(int(joint)).name for joint in model.actuator_trnid[:, 0]]
        return dict(zip(names, map(float, np.degrees(_rms(self.tracking_error))), strict=True))

    def save(self, folder: Path) -> dict[str, Path]:
        """Write `motion.npz`, what was asked, and `recording.npz`, what the servos said; of a
        simulated body on its own feet also `seen.npz`, its motion with the root."""
        from enpointe.motion.npz import save_motion

        files = {"motion": folder / "motion.npz", "recording": folder / "recording.npz"}
        save_motion(self.motion, files["motion"])
        self.recording.save(files["recording"])
        if self.staged is not None:
            files["seen"] = folder / "seen.npz"
            save_motion(self.staged.seen(), files["seen"])
        return files

    def summary(self) -> ServoFigures:
        """The figures that `--json` prints, SI units; the names are a promise to scripts."""
        from enpointe.hardware.wire import BusCycle

        late, rig = self.statistics.lateness, self.rig
        squares = self.tracking_error**2
        overall = float(np.degrees(np.sqrt(np.nanmean(squares)))) if squares.size else float("nan")
        found = self.feasibility
        return {
            "stage": self.stage,
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
            "positions_opened": self.opened,
            "root_off_max": None if self.staged is None else self.staged.root_off,
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
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    stand: bool = True,
    as_written: bool = False,
    faults: Sequence[Fault] = (),
    seed: int = 0,
    backlash: float = 0.0,
    progress: Progress = silent,
) -> ServoPerformance:
    """Dance on a rig of servos, or on one that is emulated.

    Args:
        source: A shipped score's name, a `.bmn` file, a motion or a recording (`.npz`) of the
            dancer or of the rig's own body, or a motion file of any other format.
        rig: A shipped rig's name, a TOML file, or a rig.
        port: A serial port; "emulated" or "memory" for a bus that is not there, "simulated" for one
            with the rig's body behind it, on a stand or on its own feet as `stand` says.
        effort: See `perform`.
        tempo: See `perform`.
        style: See `perform`.
        dancer: See `perform`.
        stand: Whether the body hangs on a stand, and need not balance; see `feasible`.
        as_written: Dance it even if the servos can't follow, and no slower than it is written.
        faults: What goes wrong on an emulated bus.
        seed: Of the faults.
        backlash: Degrees of play in every servo's gears, of a simulated body; ROBOTIS states 0.25
            for XM and XH servos, and none for the smaller ones.
        progress: Told how far it is.

    Returns:
        The dance, up to the fault if there was one; `ServoPerformance.summary` has its figures.

    Raises:
        EnpointeError: The rig can't begin, no time is enough for the movement, or anything else
            that the caller can mend.
    """
    from enpointe.hardware.dynamixel.port_users import others_on
    from enpointe.hardware.rig_file import Rig, load_rig

    chosen = rig if isinstance(rig, Rig) else load_rig(rig)
    if port not in (EMULATED, MEMORY, SIMULATED):
        if faults:
            raise RigError(f"faults happen on an emulated bus; {port} has its own")
        if (others := others_on(port)) is not None:  # before anything is computed for it
            raise RigError(others)
    if backlash and port != SIMULATED:
        raise RigError(f"gears have play where a body hangs on them: use --port {SIMULATED}")
    if not 0.0 <= backlash < _MOST_PLAY:
        raise RigError(f"a backlash is 0 to {_MOST_PLAY:g} degrees, not {backlash:g}")
    play = math.radians(backlash)
    made = rig_motion(
        source,
        chosen,
        effort=effort,
        tempo=tempo,
        style=style,
        dancer=dancer,
        progress=progress,
    )
    found = None
    if not as_written:
        found = feasible(
            made.motion, chosen, contacts=made.contacts, stand=stand, progress=progress
        )
        made = made.slowed(found)
    if port == SIMULATED and not stand:
        return _on_its_feet(chosen, made, found, _run(faults, seed), play, progress)
    danced = _danced(chosen, made.motion, port, faults, seed, play, progress)
    stage = {EMULATED: _NOBODY, MEMORY: _NOBODY, SIMULATED: _STAND + _said(play)}.get(port, _REAL)
    done = danced.recording, danced.statistics
    return ServoPerformance(
        chosen, port, made.motion, *done, found, None, stage, made.opened, made.dancer
    )


def _said(play: float) -> str:
    return f", {math.degrees(play):g} degrees of play in the gears" if play else ""


def _danced(
    rig: Rig,
    motion: Motion,
    port: str,
    faults: Sequence[Fault],
    seed: int,
    play: float,
    progress: Progress,
) -> Danced:
    from enpointe.servo_loop import dance_in_own_process

    def danced(done: float, total: float) -> None:
        progress("servos", done, total)

    if port == SIMULATED:
        from enpointe.puppet_stage import dance_on_stand

        return dance_on_stand(motion, rig, faults=_run(faults, seed), play=play, progress=progress)
    if port == MEMORY:
        return _in_memory(rig, motion, _run(faults, seed), danced)
    if port == EMULATED:
        from enpointe.hardware.dynamixel import description_of
        from enpointe.hardware.emulator import launch

        with launch(description_of(rig), faults, seed) as path:
            return dance_in_own_process(rig, motion, path, patience=_PATIENCE, progress=danced)
    return dance_in_own_process(rig, motion, port, progress=danced)


def _on_its_feet(
    rig: Rig,
    made: RigMotion,
    found: Feasibility | None,
    faults: FaultRun | None,
    play: float,
    progress: Progress,
) -> ServoPerformance:
    from enpointe.puppet_stage import dance_on_stage

    staged = dance_on_stage(
        made.motion, rig, contacts=made.contacts, faults=faults, play=play, progress=progress
    )
    done = staged.recording, staged.statistics
    stage = _FEET + _said(play)
    return ServoPerformance(
        rig, SIMULATED, staged.motion, *done, found, staged, stage, made.opened, made.dancer
    )


def would(
    source: str | Path,
    rig: Rig,
    *,
    effort: str | None = None,
    tempo: float | None = None,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    stand: bool = True,
    progress: Progress = silent,
) -> Feasibility:
    """Whether a rig can dance something, and nothing is danced; see `servo`."""
    made = rig_motion(
        source, rig, effort=effort, tempo=tempo, style=style, dancer=dancer, progress=progress
    )
    return feasible(made.motion, rig, contacts=made.contacts, stand=stand, progress=progress)


def _run(faults: Sequence[Fault], seed: int) -> FaultRun | None:
    from enpointe.hardware.emulator import FaultRun

    return FaultRun(faults, np.random.default_rng(seed)) if faults else None


def _in_memory(
    rig: Rig, motion: Motion, faults: FaultRun | None, progress: Callable[[float, float], None]
) -> Danced:
    from enpointe.hardware.dynamixel import Link, description_of
    from enpointe.hardware.emulator import EmulatedPort, VirtualClock, bus_of
    from enpointe.servo_loop import dance_on

    clock = VirtualClock()
    port = EmulatedPort(bus_of(description_of(rig), faults=faults), clock)
    port.setBaudRate(rig.baud)
    return dance_on(Link(port), rig, motion, clock, progress=progress)
