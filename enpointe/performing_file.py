"""`enpointe perform` on a motion file: danced under gravity where feet can dance it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from enpointe.captured import Captured, read_captured
from enpointe.danced import CONTROLLERS, HELD_UP, Danced, run_physics
from enpointe.errors import EnpointeError
from enpointe.figures import FilePerformanceFigures, StretchFigures
from enpointe.performing import reference
from enpointe.preparing import Progress, silent

if TYPE_CHECKING:
    from enpointe.models import Anthropometry
    from enpointe.motion import Motion
    from enpointe.motion.contact_schedule import ContactSchedule
    from enpointe.motion.easing import Eased
    from enpointe.motion.stretches import Obstacle, Stretch
    from enpointe.motion.weight_plan import WeightPlan

__all__ = ["FilePerformance", "perform_file"]

SPEEDS = (0.1, 3.0)
_TRIES = 4
"""How often a stretch is cut where its weight can't be held, and planned again."""
_FALLS, _ABOUT_A_FALL = 4, 0.5
"""How often a stretch is danced again without the fall, the last time the longest that she danced
before one; and s on both sides that are left out: a fall begins before the weight is past saving,
and the step that it is in goes on."""
FELL = "she falls there when it is tried"


@dataclass(frozen=True, kw_only=True)
class FilePerformance(Danced):
    """A motion file danced, as far as it can be; see `Danced` for the rest.

    Attributes:
        captured: The file on the dancer.
        asked: Start and end of what was to be danced, s of the file.
        stretch: What was danced of it, s of the file.
        others: Stretches that could have been danced instead, in order.
        obstacles: Times that can't be danced, with why, in order.
        eased: The stretch from rest to rest: which moment of the file each of its samples shows.
    """

    captured: Captured
    asked: tuple[float, float]
    stretch: Stretch
    others: tuple[Stretch, ...]
    obstacles: tuple[Obstacle, ...]
    eased: Eased

    @property
    def whole(self) -> bool:
        """Whether all that was asked for was tried."""
        missing = (self.asked[1] - self.asked[0]) - self.stretch.length
        return missing <= 1.5 / self.captured.clock.rate

    @property
    def completed(self) -> bool:
        """Whether she danced all that was asked for, and stands at the end."""
        return self.whole and self.stood

    @property
    def fell_in_file(self) -> float | None:
        """The moment of the file at which she fell, s; None if she did not."""
        fell = None if self.measures is None else self.measures.fell_at
        return None if fell is None else self.eased.source_time(fell)

    @property
    def verdict(self) -> str:
        """What of the file was danced, what not and why, in a sentence or two."""
        file, stretch = self.captured, self.stretch
        frames = f"frames {file.clock.frame(stretch.start)}–{file.clock.frame(stretch.end)}"
        part = f"{frames} of {file.path.name} ({stretch.start:.2f}–{stretch.end:.2f} s)"
        if self.recording is None:
            return f"No physics: {part} as they are drawn, without weight."
        length = self.asked[1] - self.asked[0]
        said = (
            f"{part[0].upper()}{part[1:]}, {stretch.length:.1f} s of the {length:.1f} s asked for"
        )
        fell = self.fell_in_file
        if fell is None:
            said += ", danced under gravity on the dancer's own feet"
        else:
            said += f", were tried under gravity, and she fell at {fell:.2f} s, frame"
            said += f" {file.clock.frame(fell)}"
        if not self.whole:
            said += f". The rest is not danced: {self._why_not()}"
        return f"{said}. {self._help()}"

    def _help(self) -> str:
        force = 0.0 if self.measures is None else self.measures.root_force_max
        if force > HELD_UP:
            return f"Something held the pelvis with up to {force:.3g} N: no honest dance."
        return "Nothing held her up: the force on the root was 0 N throughout."

    def _why_not(self) -> str:
        told: dict[str, list[str]] = {}
        for each in self.obstacles:
            told.setdefault(each.why, []).append(f"{each.start:.2f}–{each.end:.2f} s")
        reasons = [f"{why} ({', '.join(when)})" for why, when in told.items()]
        return "; ".join(reasons) or "she can't stand still at its ends"

    def lines(self) -> list[tuple[str, str]]:
        """The same figures for people: what, and its value in words."""
        rows = [("what", self.verdict)]
        rows += [
            ("could be danced instead", f"--span {each.start:.2f} {each.end:.2f}")
            for each in self.others
        ]
        figures = self.physical_figures()
        if figures:
            rows += [
                ("force on the root", f"{figures['root_force_max']:.3g} N"),
                ("behind the reference, rms", f"{figures['tracking_rms_deg']:.2f}°"),
                ("slip, most", f"{1000 * figures['slip_max']:.1f} mm"),
                ("contacts planned", str(figures["contacts_planned"])),
                ("contacts missed", str(len(figures["contacts_missed"]))),
                ("contacts not planned", str(len(figures["contacts_unplanned"]))),
                ("other contact, most", f"{figures['other_contact_max']:.0f} N"),
            ]
        return rows + [("warning", warning) for warning in self.captured.warnings]

    def summary(self) -> FilePerformanceFigures:
        """The figures that `--json` prints, SI units; the names are a promise to scripts."""
        fell = self.fell_in_file
        figures: FilePerformanceFigures = {
            "title": self.captured.path.name,
            "controller": self.controller,
            "effort": None,
            "tempo": None,
            "completed": self.completed,
            "duration": self.danced.duration,
            "rules_broken": [],
            "rules": [],
            "logistic": None,
            "asked": list(self.asked),
            "rate": self.captured.clock.rate,
            "first_frame": self.captured.clock.first,
            "danced": self._figures(self.stretch, None),
            "not_danced": [self._figures(each, each.why) for each in self.obstacles],
            "could_be_danced": [self._figures(each, None) for each in self.others],
            "fell_at_in_file": fell,
            "fell_at_frame": None if fell is None else self.captured.clock.frame(fell),
            "warnings": list(self.captured.warnings),
        }
        return {**figures, **self.physical_figures()}

    def _figures(self, span: Stretch | Obstacle, why: str | None) -> StretchFigures:
        return {
            "start": span.start,
            "end": span.end,
            "first_frame": self.captured.clock.frame(span.start),
            "last_frame": self.captured.clock.frame(span.end),
            "why": why,
        }


def perform_file(
    path: str | Path,
    *,
    span: tuple[float, float] | None = None,
    speed: float = 1.0,
    controller: str = "wholebody",
    dancer: Anthropometry | None = None,
    mapping: str | Path | None = None,
    skeleton: str | Path | None = None,
    progress: Progress = silent,
) -> FilePerformance:
    """Dance a motion file, ours or a capture, under gravity.

    It is put on the dancer, feet on the floor; the longest stretch that feet can dance is taken;
    its weight is led to where the standing feet can hold it; she starts at rest and comes to rest,
    the first and last half second of the stretch taking a second each (`enpointe.motion.easing`).
    Where she falls in a capture, that is told, and the longest stretch without the fall is danced;
    after the fourth fall, the longest that she had danced before one.

    Args:
        path: A file of any format that `convert` reads, or of the dancer's own.
        span: Start and end of what is wanted, s from the file's first frame; all if None.
        speed: How much faster than the file.
        controller: As for `perform`; "kinematic" moves all of the span, and nothing is changed.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.
        mapping: Which joints of a captured skeleton are which, as a TOML file; found if None.
        skeleton: The ASF file of an AMC file, where it does not lie beside it.
        progress: Told how far it is.

    Raises:
        FormatError: The file can't be read.
        EnpointeError: Anything else that the caller can mend, in one line.

    Example:
        >>> import enpointe
        >>> dance = enpointe.perform_file("05_12.amc", span=(2.0, 6.0))
        >>> dance.completed
    """
    path = Path(path)
    if controller not in CONTROLLERS:
        raise EnpointeError(f"no controller {controller!r}; use {' or '.join(CONTROLLERS)}")
    if not SPEEDS[0] <= speed <= SPEEDS[1]:
        raise EnpointeError(f"a speed of {speed:g} is not in {SPEEDS[0]:g} to {SPEEDS[1]:g}")
    captured = read_captured(
        path, dancer=dancer, mapping=mapping, skeleton=skeleton, progress=progress
    )
    asked = _asked(captured, span)
    if controller == "kinematic":
        return _moved(captured, asked, speed)
    return _attempt(captured, asked, speed, controller, progress)


def _attempt(
    captured: Captured,
    asked: tuple[float, float],
    speed: float,
    controller: str,
    progress: Progress,
) -> FilePerformance:
    """Dance the longest stretch; where she falls in it, the longest that leaves the fall out."""
    from enpointe.motion.stretches import Obstacle

    falls: list[Obstacle] = []
    danced: list[tuple[float, float]] = []
    chosen = _choose(captured, asked, speed, falls)
    while True:
        motion, weight, contacts = _possible(captured, chosen.eased, controller, progress)
        dance = FilePerformance(
            controller=controller,
            motion=motion,
            physics=run_physics(motion, controller, progress, contacts),
            weight=weight,
            captured=captured,
            asked=asked,
            stretch=chosen.stretch,
            others=chosen.others,
            obstacles=chosen.obstacles,
            eased=chosen.eased,
        )
        fell = dance.fell_in_file
        if fell is None or captured.stored or len(falls) == _FALLS:
            return dance
        falls.append(Obstacle(max(fell - _ABOUT_A_FALL, 0.0), fell + _ABOUT_A_FALL, FELL))
        danced.append((chosen.stretch.start, falls[-1].start))
        longest = max(danced, key=lambda span: span[1] - span[0])
        known = longest if len(falls) == _FALLS else None
        try:
            chosen = _choose(captured, asked, speed, falls, known)
        except EnpointeError:
            return dance


def _asked(captured: Captured, span: tuple[float, float] | None) -> tuple[float, float]:
    duration = captured.motion.duration
    start, end = span or (0.0, duration)
    if not (isfinite(start) and isfinite(end) and 0.0 <= start < end):
        raise EnpointeError(f"a span goes from one second to a later one, not {start:g} to {end:g}")
    if start >= duration or end > duration + 1.0 / captured.clock.rate:
        raise EnpointeError(
            f"{captured.path} is {duration:.2f} s long; {start:g} to {end:g} s is not in it"
        )
    return start, min(end, duration)


def _moved(captured: Captured, asked: tuple[float, float], speed: float) -> FilePerformance:
    """The span as it is, without physics."""
    from enpointe.motion.easing import cut
    from enpointe.motion.stretches import Stretch

    eased: Eased = cut(captured.motion, captured.contacts, *asked, speed)
    return FilePerformance(
        controller="kinematic",
        motion=eased.motion,
        captured=captured,
        asked=asked,
        stretch=Stretch(*asked),
        others=(),
        obstacles=(),
        eased=eased,
    )


@dataclass(frozen=True)
class _Chosen:
    """What is to be danced of a file."""

    stretch: Stretch
    others: tuple[Stretch, ...]
    obstacles: tuple[Obstacle, ...]
    eased: Eased


def _choose(
    captured: Captured,
    asked: tuple[float, float],
    speed: float,
    falls: Iterable[Obstacle],
    known: tuple[float, float] | None = None,
) -> _Chosen:
    """The longest stretch whose weight can be held, and in which she has not fallen.

    Args:
        captured: The file.
        asked: What of it is wanted, s.
        speed: How much faster than the file.
        falls: Times that are not to be tried again.
        known: Start and end of what is to be danced if there is anything in it; of all that is
            asked without.

    Raises:
        EnpointeError: There is none.
    """
    from enpointe.motion.easing import ease
    from enpointe.motion.stretches import obstacles, outside_the_feet, stretches
    from enpointe.motion.weight_plan import plan_weight

    contacts = _steps(captured, captured.contacts)
    found = [*obstacles(captured.motion, contacts), *falls]
    found.sort(key=lambda each: each.start)
    for _ in range(_TRIES):
        possible = stretches(captured.motion, contacts, found, asked)
        if not possible:
            break
        wanted = [each for each in possible if known and _lies_in(each, known)] or possible
        longest = max(wanted, key=lambda each: each.length)
        eased = ease(captured.motion, captured.contacts, longest.start, longest.end, speed)
        eased = replace(eased, contacts=_steps(captured, eased.contacts))
        more: tuple[Obstacle, ...] = ()
        if not captured.stored:
            plan = plan_weight(eased.motion, eased.contacts, eased.motion)
            more = outside_the_feet(plan, np.interp(plan.time, eased.motion.time, eased.source))
        if not more:
            others = tuple(each for each in possible if each != longest)
            return _Chosen(longest, others, _within(found, asked), eased)
        found = sorted([*found, *more], key=lambda each: each.start)
    why = "; ".join(dict.fromkeys(each.why for each in _within(found, asked)))
    raise EnpointeError(
        f"{captured.path}: no half second of it can be danced on feet: {why or 'too short'}"
    )


def _lies_in(stretch: Stretch, span: tuple[float, float]) -> bool:
    return span[0] - 1e-9 <= stretch.start and stretch.end <= span[1] + 1e-9


def _steps(captured: Captured, contacts: ContactSchedule) -> ContactSchedule:
    """Steps that a body can take; the dancer's own are that already.

    Taken of what is danced, so that a foot is led from stance to stance in the time it has there.
    """
    from enpointe.motion.settling import led

    return contacts if captured.stored else led(contacts)


def _within(found: Iterable[Obstacle], asked: tuple[float, float]) -> tuple[Obstacle, ...]:
    return tuple(each for each in found if each.end >= asked[0] and each.start <= asked[1])


def _possible(
    captured: Captured, eased: Eased, controller: str, progress: Progress
) -> tuple[Motion, WeightPlan | None, ContactSchedule | None]:
    """A reference that gravity and the floor allow; what is the dancer's own goes as scores do.

    Returns:
        It, its weight, and what it stands on where that is not read from it.
    """
    if captured.stored:
        return *reference(eased.motion, controller, progress), None
    from enpointe.motion.danceable import make_danceable

    made = make_danceable(
        eased.motion,
        contacts=eased.contacts,
        progress=lambda done, total: progress("weight", done, total),
    )
    return replace(made.motion, name=captured.motion.name), made.weight, made.contacts
