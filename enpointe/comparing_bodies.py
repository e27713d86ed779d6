"""`enpointe compare --rig`: the dancer, what a rig of servos was asked, and what it danced."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from enpointe.figures import BodyComparisonFigures, BodyFigures, FitFigures, ReachFigures
from enpointe.preparing import Progress, silent
from enpointe.rig_motion import body_of, dancers_motion, own_motion
from enpointe.servoing import SIMULATED, ServoPerformance, servo

if TYPE_CHECKING:
    from enpointe.hardware.rig_file import Rig
    from enpointe.models import Anthropometry, Style
    from enpointe.motion import Motion
    from enpointe.motion.joint_timing import TimingKept

__all__ = ["DANCER", "BodyComparison", "Gesture", "compare_bodies"]

DANCER = "dancer"
_EVERY = 0.02


@dataclass(frozen=True, slots=True)
class Gesture:
    """How far apart the gestures of two bodies are, at equal times.

    Attributes:
        first: Name of a body.
        second: Name of another.
        reach_rms: Root mean square distance of the wrists, each from its own shoulder, in its own
            torso's frame and in its own arm lengths; None where a body has no such arms.
        joint_rms_deg: Root mean square over all joints; None of bodies with other joints.
    """

    first: str
    second: str
    reach_rms: float | None
    joint_rms_deg: float | None


@dataclass(frozen=True)
class BodyComparison:
    """One dance on the dancer, on the body of a rig, and by its servos.

    Attributes:
        rig: The servos.
        dancer: The dancer's, on the clock of the rig; None if it was of the rig's body already.
        time_scale: How many times its time the dancer's has for that; None without a dancer.
        asked: What the rig was asked to dance.
        danced: What it danced, up to a fault if there was one.
        fault: Why it stopped early, or None.
        performance: All that is to be said of the servos; None of a recording made before.
    """

    rig: Rig
    dancer: Motion | None
    time_scale: float | None
    asked: Motion
    danced: Motion
    fault: str | None
    performance: ServoPerformance | None

    @property
    def motions(self) -> Mapping[str, Motion]:
        """By name of the body: the dancer, the rig as asked, and as danced."""
        own = {f"{self.rig.name}, asked": self.asked, f"{self.rig.name}, danced": self.danced}
        return own if self.dancer is None else {DANCER: self.dancer, **own}

    @property
    def completed(self) -> bool:
        """Whether the rig came to the end."""
        return self.fault is None if self.performance is None else self.performance.completed

    @cached_property
    def gestures(self) -> tuple[Gesture, ...]:
        """How far apart every two bodies are."""
        pairs = combinations(self.motions.items(), 2)
        return tuple(_gesture(a, b, first, second) for (a, first), (b, second) in pairs)

    @cached_property
    def timing(self) -> TimingKept:
        """What of the effort came out of the servos."""
        from enpointe.motion.joint_timing import timing_kept

        return timing_kept(self.asked, self.danced, self.rig.joints)

    def summary(self) -> BodyComparisonFigures:
        """The figures that `--json` prints, SI units; the names are a promise to scripts."""
        return {
            "title": self.asked.name,
            "rig": self.rig.name,
            "completed": self.completed,
            "time_scale": self.time_scale,
            "bodies": {name: _figures(motion) for name, motion in self.motions.items()},
            "differences": [
                ReachFigures(
                    between=[each.first, each.second],
                    reach_rms=each.reach_rms,
                    joint_rms_deg=each.joint_rms_deg,
                )
                for each in self.gestures
            ],
            "servos": None if self.performance is None else self.performance.summary(),
        }


def compare_bodies(
    source: str | Path,
    *,
    rig: str | Path | Rig = "puppet",
    port: str = SIMULATED,
    effort: str | None = None,
    tempo: float | None = None,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    stand: bool = True,
    as_written: bool = False,
    backlash: float = 0.0,
    recording: str | Path | None = None,
    progress: Progress = silent,
) -> BodyComparison:
    """Dance on a rig of servos, and set it beside the dancer; or set beside her what it did before.

    Args:
        source: See `servo`.
        rig: A shipped rig's name, a TOML file, or a rig.
        port: Where the servos are; with the rig's body behind them, simulated, if left out.
        effort: See `perform`.
        tempo: See `perform`.
        style: See `perform`.
        dancer: See `perform`.
        stand: Whether a simulated body hangs on a stand, or is on its own feet.
        as_written: Dance it even if the servos can't follow.
        backlash: Degrees of play in a simulated rig's gears.
        recording: `recording.npz` of an earlier `servo`, instead of a dance now.
        progress: Told how far it is.

    Raises:
        MotionError: A recording of another dance.
        EnpointeError: Anything else that the caller can mend, in one line.
    """
    from enpointe.controllers import Recording
    from enpointe.hardware.rig_file import Rig, load_rig

    chosen = rig if isinstance(rig, Rig) else load_rig(rig)
    if recording is not None:
        told = Recording.load(Path(recording), body_of(chosen))
        written = None
        if own_motion(source, chosen) is None:
            written = dancers_motion(
                source, effort=effort, tempo=tempo, style=style, dancer=dancer, progress=progress
            )
        return _beside(chosen, written, told.reference, told.as_motion(), told.fault, None)
    done = servo(
        source,
        rig=chosen,
        port=port,
        effort=effort,
        tempo=tempo,
        style=style,
        dancer=dancer,
        stand=stand,
        as_written=as_written,
        backlash=backlash,
        progress=progress,
    )
    return _beside(chosen, done.dancer, done.motion, done.danced, done.recording.fault, done)


def _beside(
    rig: Rig,
    dancer: Motion | None,
    asked: Motion,
    danced: Motion,
    fault: str | None,
    performance: ServoPerformance | None,
) -> BodyComparison:
    from enpointe.motion.in_step import in_step

    led, scale = (None, None) if dancer is None else in_step(dancer, asked)
    return BodyComparison(rig, led, scale, asked, danced, fault, performance)


def _gesture(a: str, b: str, first: Motion, second: Motion) -> Gesture:
    from enpointe.motion.reach import has_reach, reaches

    time = np.arange(0.0, min(first.duration, second.duration) + 1e-9, _EVERY)
    reach, joints = None, None
    if has_reach(first.model) and has_reach(second.model):
        here, there = reaches(first, time), reaches(second, time)
        apart = [np.sum((here[side] - there[side]) ** 2, axis=1) for side in here]
        reach = float(np.sqrt(np.mean(apart)))
    if _joints(first) == _joints(second):
        angles = [np.array([m.sample(float(t))[0][7:] for t in time]) for m in (first, second)]
        joints = float(np.degrees(np.sqrt(np.mean((angles[0] - angles[1]) ** 2))))
    return Gesture(a, b, reach, joints)


def _joints(motion: Motion) -> list[str]:
    return [motion.model.joint(i).name for i in range(motion.model.njnt)]


def _figures(motion: Motion) -> BodyFigures:
    from enpointe.motion.reach import has_reach
    from enpointe.motion.wrist import fit_logistic, wrist_profiles

    fit = fit_logistic(wrist_profiles(motion)) if has_reach(motion.model) else None
    found = None if fit is None else FitFigures(b=fit.time, x0=fit.weight, rms=fit.rms)
    return {"duration": motion.duration, "logistic": found}
