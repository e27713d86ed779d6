"""Any motion file as a movement of the dancer, with how the file counts its frames."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.errors import EnpointeError, FormatError
from enpointe.preparing import Progress, silent
from enpointe.stored import is_stored, load_stored

if TYPE_CHECKING:
    from enpointe.models import Anthropometry
    from enpointe.motion import Motion
    from enpointe.motion.contact_schedule import ContactSchedule
    from enpointe.motion.formats import Content

__all__ = ["Captured", "Clock", "clock_of", "is_motion_file", "read_captured", "read_content"]


@dataclass(frozen=True, slots=True)
class Clock:
    """How a file counts its frames.

    Attributes:
        rate: Frames per second.
        first: Number of its first frame.
    """

    rate: float
    first: int = 0

    def frame(self, time: float) -> int:
        """The frame at, or next to, `time` seconds."""
        return self.first + round(time * self.rate)


def clock_of(motion: Motion, content: Content | None = None) -> Clock:
    """How a motion's samples are counted, or the frames of the file that it was made of."""
    from enpointe.motion.formats import MarkerMotion, SkeletonMotion

    captured = None if content is None else content.motion
    first = captured.start if isinstance(captured, SkeletonMotion | MarkerMotion) else 0
    return Clock((len(motion.time) - 1) / motion.duration, first)


@dataclass(frozen=True)
class Captured:
    """A motion file on the dancer.

    Attributes:
        path: The file.
        motion: On the dancer, from 0 s.
        contacts: Which soles stand, where and when; of a capture as a body can that does not skate.
        clock: How the file counts its frames.
        warnings: What was doubtful in the file and how it was taken, one line each.
        stored: Whether it is the dancer's own motion, which was put on nobody.
    """

    path: Path
    motion: Motion
    contacts: ContactSchedule
    clock: Clock
    warnings: tuple[str, ...]
    stored: bool


def is_motion_file(source: str | Path) -> bool:
    """Whether something is a motion file by its content, or by its ending where that is damaged."""
    path = Path(source)
    if not path.is_file() or path.suffix == ".bmn":
        return False
    from enpointe.motion.formats import formats
    from enpointe.motion.formats.registry import sniffed

    endings = {".npz", *(ending for each in formats() for ending in each.suffixes)}
    if is_stored(path) or path.suffix.lower() in endings:
        return True
    try:
        sniffed(path)
    except FormatError:
        return False
    return True


def read_captured(
    path: Path,
    *,
    dancer: Anthropometry | None = None,
    mapping: str | Path | None = None,
    skeleton: str | Path | None = None,
    progress: Progress = silent,
) -> Captured:
    """Read a motion file of any format, and put it on the dancer unless it is hers.

    Args:
        path: The file.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.
        mapping: Which joints of a captured skeleton are which, as a TOML file; found if None.
        skeleton: The ASF file of an AMC file, where it does not lie beside it.
        progress: Told how far it is.

    Raises:
        FormatError: The file can't be read.
        EnpointeError: Anything else that the caller can mend, in one line.
    """
    from enpointe.models.dancer import dancer_model
    from enpointe.motion.contact_schedule import contact_schedule
    from enpointe.motion.retargeting import retarget
    from enpointe.motion.settling import stances

    if is_stored(path):
        if mapping is not None or skeleton is not None:
            raise EnpointeError(f"{path} is the dancer's own motion: no map or skeleton applies")
        motion = load_stored(path, dancer, flesh=True)
        return Captured(path, motion, contact_schedule(motion), clock_of(motion), (), True)
    content = read_content(path, skeleton)
    made = retarget(
        content,
        dancer_model(dancer),
        mapping=mapping,
        progress=lambda done, total: progress("putting it on the dancer", done, total),
    )
    motion = replace(made.motion, name=path.stem)
    clock = clock_of(motion, content)
    contacts = stances(motion.model, made.contacts)
    return Captured(path, motion, contacts, clock, made.warnings, False)


def read_content(path: Path, skeleton: str | Path | None = None) -> Content:
    """Read a motion file of any format.

    Args:
        path: The file.
        skeleton: The ASF file of an AMC file, where it does not lie beside it.

    Raises:
        FormatError: The file can't be read.
        EnpointeError: A skeleton for a file that has its own.
    """
    from enpointe.motion.formats import read
    from enpointe.motion.formats.amc import AMC, read_amc
    from enpointe.motion.formats.registry import sniffed

    if skeleton is None:
        return read(path)
    if sniffed(path) is not AMC:
        raise EnpointeError(f"{path}: only an AMC file is read with a skeleton of its own")
    return read_amc(path, Path(skeleton))
