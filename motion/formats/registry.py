"""Which formats there are, and which of them a file is."""

from __future__ import annotations

from pathlib import Path

from enpointe.errors import EnpointeError, FormatError
from enpointe.motion.formats.amc import AMC
from enpointe.motion.formats.aoa import AOA
from enpointe.motion.formats.asf import ASF
from enpointe.motion.formats.ask import ASK
from enpointe.motion.formats.bap import BAP
from enpointe.motion.formats.brd import BRD
from enpointe.motion.formats.bva import BVA
from enpointe.motion.formats.bvh import BVH
from enpointe.motion.formats.c3d import C3D
from enpointe.motion.formats.content import Content, Format, Kind, Payload
from enpointe.motion.formats.csm import CSM
from enpointe.motion.formats.csv_table import CSV_JOINTS, CSV_MARKERS
from enpointe.motion.formats.gst import GST
from enpointe.motion.formats.htr import GTR, HTR
from enpointe.motion.formats.skeleton import SkeletonMotion
from enpointe.motion.formats.trc import TRC
from enpointe.motion.gesture.scene import Scene

__all__ = ["FORMATS", "formats", "read", "sniffed", "writable", "write"]

_HEAD = 4096

# One line a format; where a file could be two, the earlier is taken.
FORMATS: tuple[Format, ...] = (
    BVH,
    ASK,
    AMC,
    ASF,
    BVA,
    HTR,
    GTR,
    GST,
    C3D,
    TRC,
    CSM,
    AOA,
    BRD,
    CSV_MARKERS,
    CSV_JOINTS,
    BAP,
)


def formats() -> tuple[Format, ...]:
    """Every format that can be read or written."""
    return FORMATS


def sniffed(path: Path) -> Format:
    """The format of a file by its first bytes; its ending decides only where several fit.

    Raises:
        FormatError: It can't be opened, is empty, or is of no format that is known.
    """
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
    except OSError as error:
        raise FormatError(f"can't be read ({error.strerror or error})", path) from None
    except ValueError:
        raise FormatError("can't be read (no file can have that name)", path) from None
    if not head.strip():
        raise FormatError("the file is empty", path, line=1)
    fitting = [each for each in FORMATS if each.sniff(head)]
    named = [each for each in fitting if path.suffix.lower() in each.suffixes]
    if fitting:
        return (named or fitting)[0]
    known = ", ".join(each.name for each in FORMATS)
    raise FormatError(f"no motion file that is known; these are: {known}", path, line=1)


def read(path: str | Path) -> Content:
    """Reads a motion file of any known format, told by its content.

    Args:
        path: The file.

    Returns:
        The movement, with warnings and what the file holds beyond it.

    Raises:
        FormatError: It can't be read, or is no whole file of a known format; with the place.
    """
    return sniffed(Path(path)).read(Path(path))


def write(payload: Payload, path: str | Path, to: str | None = None) -> tuple[str, ...]:
    """Writes a movement in the format that the ending of `path` names, or in another.

    Args:
        payload: A skeleton's movement, a marker set's or a gesture scene.
        path: Where to.
        to: Name of the format, whatever the ending.

    Returns:
        What the file can't hold, one line each.

    Raises:
        EnpointeError: No format has that name or ending, or none that holds such a movement.
        FormatError: The format can't hold this movement, or the file can't be written there.
    """
    path = Path(path)
    named = writable(path, to)
    kind = _kind(payload)
    # A scene has room for joints and markers too.
    fitting = [each for each in named if each.kind in (kind, "scene")]
    if not fitting or fitting[0].write is None:
        raise EnpointeError(f"{path}: {named[0].name} holds {named[0].kind}, and this is {kind}")
    return fitting[0].write(payload, path)


def writable(path: Path, to: str | None = None) -> tuple[Format, ...]:
    """The formats of that name, or else of the ending of `path`, that can be written.

    Raises:
        EnpointeError: There is none.
    """
    writers = [each for each in FORMATS if each.write is not None]
    if to is not None:
        named = [each for each in writers if each.name.lower() == to.strip().lower()]
        known = ", ".join(each.name for each in writers)
        problem = f"no motion format to write is called {to!r}; these: {known}"
    else:
        ending = path.suffix.lower()
        named = [each for each in writers if ending in each.suffixes]
        known = " ".join(sorted({suffix for each in writers for suffix in each.suffixes}))
        problem = f"{path}: no motion format to write ends in {ending!r}; these: {known}"
    if not named:
        raise EnpointeError(problem)
    return tuple(named)


def _kind(payload: Payload) -> Kind:
    if isinstance(payload, Scene):
        return "scene"
    return "skeleton" if isinstance(payload, SkeletonMotion) else "markers"
