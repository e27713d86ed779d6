"""A movement on the body of a rig of servos, whatever it was written as."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.captured import is_motion_file, read_captured
from enpointe.errors import EnpointeError
from enpointe.preparing import Progress, silent
from enpointe.stored import is_stored, load_own

if TYPE_CHECKING:
    import mujoco

    from enpointe.feasibility import Feasibility
    from enpointe.hardware.rig_file import Rig
    from enpointe.models import Anthropometry, Style
    from enpointe.motion import Motion
    from enpointe.motion.contact_schedule import ContactSchedule

__all__ = ["RigMotion", "body_of", "dancers_motion", "own_motion", "rig_motion"]


def body_of(rig: Rig) -> mujoco.MjModel:
    """The model of a rig's body."""
    from enpointe.models.puppet import op3_model, puppet_model

    return puppet_model() if rig.body == "puppet" else op3_model()


@dataclass(frozen=True)
class RigMotion:
    """A movement on the body of a rig.

    Attributes:
        motion: Of that body.
        contacts: Which soles are to bear, and when; None if that is to be read from the motion.
        opened: m, by how much positions of the feet are wider than the dancer's on its scale, at
            most; None if it was of that body already.
        dancer: The dancer's, as written; None if it was of that body already.
    """

    motion: Motion
    contacts: ContactSchedule | None = None
    opened: float | None = None
    dancer: Motion | None = None

    def slowed(self, found: Feasibility) -> RigMotion:
        """The same as the rig can dance it.

        Raises:
            MotionError: No time scale makes it feasible.
        """
        motion = found.slowed
        if self.contacts is None or found.time_scale is None:
            return replace(self, motion=motion)
        return replace(self, motion=motion, contacts=self.contacts.slowed(found.time_scale))


def rig_motion(
    source: str | Path,
    rig: Rig,
    *,
    effort: str | None = None,
    tempo: float | None = None,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    progress: Progress = silent,
) -> RigMotion:
    """Put a movement on the body of a rig.

    Args:
        source: See `servo`.
        rig: Whose body.
        effort: See `perform`.
        tempo: See `perform`.
        style: See `perform`.
        dancer: See `perform`.
        progress: Told how far it is.

    Raises:
        EnpointeError: Anything that the caller can mend, in one line.
    """
    if (own := own_motion(source, rig)) is not None:
        return RigMotion(own)
    danced = dancers_motion(
        source, effort=effort, tempo=tempo, style=style, dancer=dancer, progress=progress
    )
    from enpointe.motion.puppeteering import puppeteer

    def posed(done: int, total: int) -> None:
        progress("puppet", done, total)

    made = puppeteer(danced, body_of(rig), progress=posed)
    return RigMotion(made.motion, made.contacts, made.opened, danced)


def own_motion(source: str | Path, rig: Rig) -> Motion | None:
    """A movement that is of the rig's body already; None if it is the dancer's."""
    path = Path(source)
    return load_own(path, body_of(rig)) if is_stored(path) else None


def dancers_motion(
    source: str | Path,
    *,
    effort: str | None = None,
    tempo: float | None = None,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    progress: Progress = silent,
) -> Motion:
    """A score, or a motion file of any format, as a movement of the dancer without weight.

    Raises:
        EnpointeError: Anything that the caller can mend, in one line.
    """
    from enpointe.performing import perform

    if is_motion_file(source):
        for name, value in {"effort": effort, "tempo": tempo}.items():
            if value is not None:
                raise EnpointeError(f"{source} is a motion file: {name} is for scores")
        return read_captured(Path(source), dancer=dancer, progress=progress).motion
    return perform(
        source,
        effort=effort,
        tempo=tempo,
        controller="kinematic",
        style=style,
        dancer=dancer,
        progress=progress,
    ).motion
