"""`enpointe perform`: a score in, a dance under gravity out."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.captured import is_motion_file
from enpointe.danced import CONTROLLERS, Danced, run_physics
from enpointe.errors import EnpointeError
from enpointe.figures import PerformanceFigures, RuleKeptFigures
from enpointe.notation import Score, load_score
from enpointe.preparing import Progress, prepare, silent

if TYPE_CHECKING:
    from enpointe.models import Anthropometry, KeyPose, Style
    from enpointe.motion import Choreography, Effort, Interpolation, Motion, RuleKept
    from enpointe.motion.weight_plan import WeightPlan
    from enpointe.motion.wrist import LogisticFit

__all__ = [
    "CONTROLLERS",
    "Performance",
    "dance",
    "has_qualities",
    "perform",
    "reference",
]

PHRASED = "as its phrases are marked"
"""The name of the effort of a dance whose phrases have qualities of their own."""


@dataclass(frozen=True, kw_only=True)
class Performance(Danced):
    """A score danced, and everything that led to it; see `Danced` for the rest.

    Attributes:
        choreography: The score solved on the dancer.
        effort: Quality that was asked.
        effort_name: Preset or numbers, or `PHRASED` where each phrase has its own.
        interpolation: How the key poses were joined.
        rules: Every rule over the whole movement, in between key poses too; empty for slerp, which
            asks nothing there.
    """

    choreography: Choreography
    effort: Effort
    effort_name: str
    interpolation: Interpolation
    rules: tuple[RuleKept, ...] = ()

    @property
    def score(self) -> Score:
        """The score as it is written."""
        return self.choreography.written

    @property
    def completed(self) -> bool:
        """Whether the dancer got to the end, and stands there."""
        return self.stood

    @property
    def broken(self) -> tuple[tuple[KeyPose, str], ...]:
        """Key poses whose certificate has a broken rule, with the certificate in words."""
        return tuple(
            (pose, str(pose.certificate)) for pose in self.choreography.key_poses if not pose.held
        )

    def asked_fit(self) -> LogisticFit | None:
        """The logistic that the wrists were asked to follow, fitted to the reference."""
        from enpointe.motion.wrist import fit_logistic, wrist_profiles

        return fit_logistic(wrist_profiles(self.motion))

    def danced_fit(self) -> LogisticFit | None:
        """The logistic fitted to what the wrists did."""
        from enpointe.motion.wrist import fit_logistic, wrist_profiles

        return fit_logistic(wrist_profiles(self.danced))

    def summary(self) -> PerformanceFigures:
        """The figures that `--json` prints, SI units; the names are a promise to scripts."""
        fit = self.danced_fit()
        figures: PerformanceFigures = {
            "title": self.score.title,
            "controller": self.controller,
            "effort": {
                "name": self.effort_name,
                "time": self.effort.time,
                "weight": self.effort.weight,
                "space": self.effort.space,
            },
            "tempo": self.choreography.tempo,
            "completed": self.completed,
            "duration": self.danced.duration,
            "rules_broken": [f"{pose.name}: {words}" for pose, words in self.broken],
            "rules": [_rule_figures(kept) for kept in self.rules],
            "logistic": None if fit is None else {"b": fit.time, "x0": fit.weight, "rms": fit.rms},
        }
        return {**figures, **self.physical_figures()}


def _rule_figures(kept: RuleKept) -> RuleKeptFigures:
    return {
        "rule": kept.rule,
        "unit": kept.unit,
        "bound": kept.bound,
        "at_least": kept.at_least,
        "worst": kept.worst,
        "at": kept.at,
        "between": list(kept.between),
        "held_fraction": kept.held,
    }


def perform(
    source: str | Path | Score,
    *,
    effort: str | None = None,
    tempo: float | None = None,
    controller: str = "pd",
    interpolation: str = "expressive",
    hold: float | None = None,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    progress: Progress = silent,
) -> Performance:
    """Dance a score.

    Args:
        source: A shipped score's name, a `.bmn` file, or a score.
        effort: A preset's name, which brings its tempo, or "time=-3.5,weight=.41,space=1". If
            None, each phrase's own where the score marks one, and else natural, at the score's own
            tempo.
        tempo: Pulses a minute; the preset's or the score's if None.
        controller: "pd", which stands on two feet; "wholebody", which balances on one as well; or
            "kinematic" for the movement without physics.
        interpolation: "expressive", "logistic" or "slerp".
        hold: Seconds that the last pose is held; with it a score of one frame is a pose to hold.
        style: The method's amounts.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.
        progress: Told how far it is.

    Returns:
        The dance; `Performance.summary` has its figures.

    Raises:
        EnpointeError: Anything that the caller can mend, in one line.

    Example:
        >>> import enpointe
        >>> dance = enpointe.perform("first-port-de-bras", effort="angry")
        >>> dance.summary()["completed"]
        True
    """
    # The score first, and before the engines load: a typing mistake should not wait for them.
    if not isinstance(source, Score) and is_motion_file(source):
        raise EnpointeError(f"{source} is a motion file, not a score: use enpointe.perform_file")
    score = source if isinstance(source, Score) else load_score(source)
    from enpointe.motion import Interpolation, find_effort

    if controller not in CONTROLLERS:
        raise EnpointeError(f"no controller {controller!r}; use {' or '.join(CONTROLLERS)}")
    if hold is not None and not (isfinite(hold) and 0.0 < hold <= LONGEST_HOLD):
        raise EnpointeError(f"a pose is held for up to {LONGEST_HOLD:g} s, not for {hold:g}")
    quality, preset_tempo, effort_name = find_effort(effort)
    kind = Interpolation.named(interpolation)
    choreography = prepare(
        score,
        tempo=tempo if tempo is not None else preset_tempo,
        style=style,
        dancer=dancer,
        still=hold is not None,
        progress=progress,
    )
    phrased = effort is None and has_qualities(score)
    return dance(
        choreography,
        quality,
        PHRASED if phrased else effort_name,
        kind,
        controller,
        phrased=phrased,
        hold=hold,
        progress=progress,
    )


def has_qualities(score: Score) -> bool:
    """Whether a phrase of a score is marked with a quality of its own."""
    return any(phrase.effort is not None for phrase in score.phrases)


LONGEST_HOLD = 600.0


def reference(
    motion: Motion, controller: str, progress: Progress = silent
) -> tuple[Motion, WeightPlan | None]:
    """A movement as a controller is asked for it, and the plan of its weight where one was made.

    The whole-body controller gets one that can be danced, with its weight over the feet that stand.
    """
    if controller != "wholebody":
        return motion, None
    from enpointe.motion.contact_schedule import contact_schedule
    from enpointe.motion.danceable import make_danceable

    if not contact_schedule(motion).steps:
        return motion, None
    made = make_danceable(motion, progress=lambda done, total: progress("weight", done, total))
    return made.motion, made.weight


def dance(
    choreography: Choreography,
    effort: Effort,
    effort_name: str,
    interpolation: Interpolation,
    controller: str,
    *,
    phrased: bool = False,
    hold: float | None = None,
    progress: Progress = silent,
) -> Performance:
    """Move and, unless kinematic, physically perform a solved score; see `perform`.

    With `phrased`, phrases that the score marks with a quality are danced in it.
    """
    from enpointe.motion import interpolate, rules_kept, ways_of

    ways = ways_of(choreography, effort, interpolation, phrased=phrased)
    motion = interpolate(
        choreography,
        effort,
        interpolation,
        ways=ways,
        hold=hold,
        progress=lambda done, total: progress("movement", done, total),
    )
    rules = rules_kept(motion, ways)
    weight, physics = None, None
    if controller != "kinematic":
        motion, weight = reference(motion, controller, progress)
        physics = run_physics(motion, controller, progress)
    return Performance(
        controller=controller,
        motion=motion,
        physics=physics,
        weight=weight,
        choreography=choreography,
        effort=effort,
        effort_name=effort_name,
        interpolation=interpolation,
        rules=rules,
    )
