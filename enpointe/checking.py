"""`enpointe check`: balance and foot contact of a movement, without dancing it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from enpointe.captured import Clock, clock_of, read_content
from enpointe.errors import EnpointeError
from enpointe.notation import Score, load_score
from enpointe.performing import perform
from enpointe.preparing import Progress, silent
from enpointe.stored import is_stored, load_stored

if TYPE_CHECKING:
    from enpointe.models import Anthropometry, Style
    from enpointe.motion import Motion
    from enpointe.motion.contact_schedule import ContactSchedule
    from enpointe.sim.motion_check import MotionCheck

__all__ = ["Check", "Slide", "check"]

SLIP_MAX, PENETRATION_MAX = 0.01, 0.01
"""m: a foot that slides or sinks farther shows."""
MEASURED = 0.15
"""s over which a captured movement is averaged before it is differentiated twice: what is slower
than 6 Hz stays, as is usual for human movement (Winter 2009)."""
FASTEST = 5
"""Joints whose speed is told."""
BEYOND_MAX = 0.5
"""Degrees: what the eye forgives a joint beyond its range."""


@dataclass(frozen=True, slots=True)
class Slide:
    """How far a foot of a file slides at most while it bears.

    Attributes:
        foot: "left" or "right".
        time: s, when it is farthest from where it came to stand.
        far: By how much, m, in the file's own size.
    """

    foot: str
    time: float
    far: float


@dataclass(frozen=True)
class Check:
    """A movement, and what is to be said of it.

    Attributes:
        name: Of the movement.
        found: All that was measured.
        clock: How the file counts its frames; the samples of the movement, from 0, without a file.
        warnings: What was doubtful in the file and how it was taken, one line each.
        contacts: Which soles stand and when, where the capture says it.
        slides: Of a file's own feet, how far each slides while it bears; none without a file.
    """

    name: str
    found: MotionCheck
    clock: Clock
    warnings: tuple[str, ...] = ()
    contacts: ContactSchedule | None = None
    slides: tuple[Slide, ...] = ()

    @property
    def slip_max(self) -> float:
        """Farthest that a foot slides while it bears, m: the file's own where there is a file."""
        return max((s.far for s in self.slides), default=self.found.slip_max)

    @property
    def faults(self) -> tuple[str, ...]:
        """What makes the answer no, in words; empty if a body could do this."""
        found, faults = self.found, []
        if found.needs_help:
            share = 100 * found.root_wrench_rms / found.weight
            faults.append(f"needs invisible help of {share:.0f} % of body weight, rms")
        if self.slip_max > SLIP_MAX:
            faults.append(f"a standing foot slides {1000 * self.slip_max:.0f} mm")
        if found.penetration_max > PENETRATION_MAX:
            faults.append(f"sinks {1000 * found.penetration_max:.0f} mm into the floor")
        worst = [b for b in found.breaches if b.beyond_deg > BEYOND_MAX]
        if worst:
            joint = f"{worst[0].joint} is {worst[0].beyond_deg:.1f}° beyond its range"
            faults.append(joint + (f", and {len(worst) - 1} more joints" if worst[1:] else ""))
        return tuple(faults)

    @property
    def answer(self) -> str:
        """Whether a body could do this, in words."""
        if self.faults:
            return f"no body could do this as it is: {'; '.join(self.faults)}"
        if not (times := len(self.found.help)):
            return "a body could do this"
        where = "one moment that has" if times == 1 else f"{times} moments that have"
        return f"a body could do this, but for {where} to be softened"

    def summary(self) -> dict[str, object]:
        """The figures that `--json` prints, SI units; the names are a promise to scripts."""
        found = self.found
        return {
            "name": self.name,
            "faults": list(self.faults),
            "duration": found.motion.duration,
            "rate": self.clock.rate,
            "first_frame": self.clock.first,
            "warnings": list(self.warnings),
            "support_margin_min": found.support_margin_min,
            "zmp_outside_fraction": found.zmp_outside_fraction,
            "contacts": {
                side: [{"start": c.start, "end": c.end, "on": str(c.on)} for c in contacts]
                for side, contacts in found.contacts.items()
            },
            "slip_max": self.slip_max,
            "slides": [
                {"foot": s.foot, "time": s.time, "frame": self.clock.frame(s.time), "far": s.far}
                for s in self.slides
            ],
            "penetration_max": found.penetration_max,
            "overlap_max": found.overlap_max,
            "flights": [
                {"start": f.start, "end": f.end, "height": f.height, "turn_deg": f.turn_deg}
                for f in found.flights
            ],
            "ballistics": [
                {
                    "start": b.start,
                    "end": b.end,
                    "rise": b.rise,
                    "rise_free": b.rise_free,
                    "rise_ratio": b.rise_ratio,
                    "fall": b.fall,
                    "off_path": b.off_path,
                    "momentum": b.momentum.tolist(),
                    "momentum_change": b.momentum_change,
                }
                for b in found.ballistics
            ],
            "turns": [
                {"start": t.start, "end": t.end, "revolutions": t.revolutions} for t in found.turns
            ],
            "joint_limit_violations": [
                {"joint": b.joint, "time": b.time, "beyond_deg": b.beyond_deg}
                for b in found.breaches
            ],
            "joint_speeds": [
                {"joint": v.joint, "time": v.time, "deg_per_s": degrees(v.speed)}
                for v in found.speeds[:FASTEST]
            ],
            "root_wrench_rms": found.root_wrench_rms,
            "impossible": [
                {
                    "start": h.start,
                    "end": h.end,
                    "first_frame": self.clock.frame(h.start),
                    "last_frame": self.clock.frame(h.end),
                    "help": h.most,
                    "why": h.why,
                }
                for h in found.help
            ],
        }

    def save_corrected(self, path: Path, progress: Progress = silent) -> Path:
        """Write the movement as BVH, with its weight where the feet that stand can hold it.

        The feet keep their places and the file its rate; see `make_danceable`.

        Raises:
            FormatError: It can't be written there.
        """
        from enpointe.motion.danceable import make_danceable
        from enpointe.motion.formats import write
        from enpointe.motion.formats.of_dancer import skeleton_of_motion

        corrected = make_danceable(
            self.found.motion,
            contacts=self.contacts,
            progress=lambda done, total: progress("correcting", done, total),
        )
        write(skeleton_of_motion(corrected.motion)[0], path)
        return path

    def lines(self) -> Sequence[tuple[str, str]]:
        """The same for people: what, and its value in words."""
        found = self.found
        outside, margin = found.zmp_outside_fraction, found.support_margin_min
        rows = [
            ("movement", f"{self.name}, {found.motion.duration:.2f} s"),
            ("support margin, least", "never on the floor" if margin is None else _mm(margin)),
            ("ZMP outside the support", "-" if outside is None else f"{100 * outside:.1f} %"),
        ]
        rows += [
            (f"{side} foot", "; ".join(f"{c.on} {c.start:.2f}–{c.end:.2f} s" for c in contacts))
            for side, contacts in found.contacts.items()
        ]
        rows += [
            ("slip, most", _mm(self.slip_max)),
            *(
                (f"{s.foot} foot slides", f"{_mm(s.far)} by frame {self.clock.frame(s.time)}")
                for s in self.slides
                if s.far > SLIP_MAX
            ),
            ("into the floor, most", _mm(found.penetration_max)),
            ("limbs in one another, most", _mm(found.overlap_max)),
        ]
        rows += [
            ("flight", f"{f.start:.2f}–{f.end:.2f} s, {_mm(f.height)} up, {f.turn_deg:.0f}°")
            for f in found.flights
        ]
        rows += [
            (
                "in free fall it would be",
                f"{_mm(b.rise_free)} up; it falls with {b.fall:.1f} m/s²,"
                f" {_mm(b.off_path)} off its path at most",
            )
            for b in found.ballistics
        ]
        rows += [
            ("turn", f"{t.start:.2f}–{t.end:.2f} s, {t.revolutions:+.2f} revolutions")
            for t in found.turns
        ]
        rows += [
            ("beyond its range", f"{b.joint} by {b.beyond_deg:.1f}° at {b.time:.2f} s")
            for b in found.breaches
        ]
        rows += [
            ("fastest joint", f"{v.joint}, {degrees(v.speed):.0f}°/s at {v.time:.2f} s")
            for v in found.speeds[:1]
        ]
        rows.append(("invisible help, rms", f"{found.root_wrench_rms:.1f} N"))
        rows += [
            (
                f"frames {self.clock.frame(h.start)}–{self.clock.frame(h.end)}",
                f"{h.most:.0f} N of help: {h.why}",
            )
            for h in found.help
        ]
        rows += [("warning", warning) for warning in self.warnings]
        rows.append(("answer", self.answer))
        return [(what, said or "never") for what, said in rows]


def _mm(metres: float) -> str:
    return f"{1000 * metres:.1f} mm"


def check(
    source: str | Path | Score | Motion,
    *,
    effort: str | None = None,
    tempo: float | None = None,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    mapping: str | Path | None = None,
    skeleton: str | Path | None = None,
    progress: Progress = silent,
) -> Check:
    """Look at balance and foot contact of a movement, without physics.

    Args:
        source: A motion; a motion file of any format, which is put on the dancer first; a file of
            the dancer's own, as `enpointe perform` writes them; or a score, whose movement is
            looked at as it is composed.
        effort: As for `perform`; of a score alone.
        tempo: As for `perform`; of a score alone.
        style: The method's amounts; of a score alone.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.
        mapping: Which joints of a captured skeleton are which, as a TOML file; found if None.
        skeleton: The ASF file of an AMC file, where it does not lie beside it.
        progress: Told how far it is.

    Raises:
        FormatError: The file can't be read.
        EnpointeError: Anything else that the caller can mend, in one line.

    Example:
        >>> import enpointe
        >>> enpointe.check("first-port-de-bras").faults
        ()
    """
    if isinstance(source, str | Path) and _is_capture(Path(source)):
        return _checked_capture(Path(source), dancer, mapping, skeleton, progress)
    if mapping is not None or skeleton is not None:
        what = source if isinstance(source, str | Path) else "what is to be checked"
        raise EnpointeError(f"{what} is no captured file: no map or skeleton applies")
    if isinstance(source, str | Path) and is_stored(Path(source)):
        motion = load_stored(Path(source), dancer)
    elif isinstance(source, str | Path | Score):
        motion = perform(
            source if isinstance(source, Score) else load_score(source),
            effort=effort,
            tempo=tempo,
            controller="kinematic",
            style=style,
            dancer=dancer,
            progress=progress,
        ).motion
    else:
        motion = source
    from enpointe.sim.motion_check import check_motion

    progress("looking", 0, 1)
    found = check_motion(motion)
    progress("looking", 1, 1)
    return Check(motion.name, found, clock_of(motion))


def _is_capture(path: Path) -> bool:
    return path.is_file() and path.suffix != ".bmn" and not is_stored(path)


def _checked_capture(
    path: Path,
    dancer: Anthropometry | None,
    mapping: str | Path | None,
    skeleton: str | Path | None,
    progress: Progress,
) -> Check:
    from enpointe.models.dancer import dancer_model
    from enpointe.motion.retargeting import retarget
    from enpointe.sim.motion_check import check_motion

    content = read_content(path, skeleton)
    made = retarget(
        content,
        dancer_model(dancer, flesh=False),
        mapping=mapping,
        progress=lambda done, total: progress("putting it on the dancer", done, total),
    )
    motion = replace(made.motion, name=path.stem)
    progress("looking", 0, 1)
    found = check_motion(motion, made.contacts, averaged_over=MEASURED)
    progress("looking", 1, 1)
    slides = tuple(
        Slide(side, float(motion.time[int(np.argmax(far))]), float(far.max()))
        for side, far in made.slides.items()
    )
    return Check(path.stem, found, clock_of(motion, content), made.warnings, made.contacts, slides)
