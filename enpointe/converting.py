"""`enpointe convert`: a motion file of any format as a file of another."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.errors import EnpointeError, MotionError
from enpointe.notation import shipped_scores
from enpointe.own_formats import OF_ANY_BODY, OWN_ENDINGS, own_writers
from enpointe.stored import is_stored, load_own, load_stored

if TYPE_CHECKING:
    import mujoco

    from enpointe.models import Anthropometry
    from enpointe.motion.formats.fitting import AnyKind, Movement

__all__ = ["LENGTHS", "Conversion", "convert"]

LENGTHS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}
"""Units that lengths can be written in, m."""

_USUAL_RATE, _USUAL_UNIT = 60.0, "mm"
_NAME_UNITS = frozenset({"C3D", "TRC", "CSV", "CSV of joints"})
"""Formats in which a length's unit has a name, as CMU's (inches / 0.45) has none."""


@dataclass(frozen=True)
class Conversion:
    """What was read and what was written.

    Attributes:
        source: The file that was read.
        read: Its format.
        written: The format of what was written.
        frames: Written; of a scene, of its fastest unit.
        rate: Of these, per second.
        channels: Numbers in a frame; of a scene, of all units together.
        warnings: What was doubtful in the source, one line each.
        lost: What the source holds and what was written does not, one line each.
        files: What was written, by what it is: "motion", and "skeleton" where that is a second.
    """

    source: Path
    read: str
    written: str
    frames: int
    rate: float
    channels: int
    warnings: tuple[str, ...]
    lost: tuple[str, ...]
    files: dict[str, Path]

    def summary(self) -> dict[str, object]:
        """The figures that `--json` prints; the names are a promise to scripts."""
        return {
            "read": self.read,
            "written": self.written,
            "frames": self.frames,
            "rate": self.rate,
            "channels": self.channels,
            "warnings": list(self.warnings),
            "lost": list(self.lost),
            "files": {what: str(path) for what, path in self.files.items()},
        }

    def lines(self) -> list[tuple[str, str]]:
        """The same for people: what, and its value in words."""
        rows = [
            ("read", f"{self.source} ({self.read})"),
            *((f"{what} written", str(path)) for what, path in self.files.items()),
            ("as", f"{self.written}, {self.frames} frames at {self.rate:g} a second"),
        ]
        rows += [("warning", line) for line in self.warnings]
        return rows + [("lost", line) for line in self.lost]


def convert(
    source: str | Path,
    target: str | Path,
    *,
    to: str | None = None,
    rate: float | None = None,
    source_rate: float | None = None,
    skeleton: str | Path | None = None,
    unit: str | None = None,
    names: str | Path | None = None,
    on_dancer: bool = False,
    mapping: str | Path | None = None,
    dancer: Anthropometry | None = None,
) -> Conversion:
    """Write a motion file as another, in any two formats between which a movement can go.

    A skeleton's movement becomes markers where the target holds these, and so do a scene's points;
    a motion of the dancer (`.npz`, keyframes) becomes a skeleton's. Markers become no skeleton, and
    neither becomes the dancer's motion, unless it is put on the dancer first.

    Args:
        source: A file of any known format, told by its content.
        target: Where to, whole or not at all. Its ending names the format.
        to: The format, whatever the ending, by its name in `enpointe.motion.formats.formats()`, or
            npz, gltf, keyframes; ros2, a JointTrajectory in YAML, or mcap, the same as a bag.
        rate: Frames per second to write; the source's if None. Places are linear between frames,
            rotations go the shortest way, nothing is filtered.
        source_rate: Frames per second of the source, where its file does not say or is wrong.
        skeleton: The ASF file of an AMC file, where it does not lie beside it.
        unit: Of the lengths written: m, cm, mm or in; the source's if None.
        names: An MNM file with other names for joints or markers.
        on_dancer: Whether a skeleton's movement or markers are put on our dancer (retargeted), so
            that what is written is hers.
        mapping: A file that says which joints or markers are which of hers; found if None.
        dancer: Whose a motion of ours is, or is to be; a dancer of 1.68 m and 54 kg if None.

    Raises:
        FormatError: The source can't be read, or the target's format can't hold it.
        EnpointeError: Anything else that the caller can mend, in one line.

    Example:
        >>> import enpointe
        >>> enpointe.convert("05_14.amc", "05_14.bvh", rate=60).frames
    """
    source, target = Path(source), Path(target)
    _refuse_a_score(source)
    writers = _writers(target, to)
    files = _files(target, writers[0])
    beside = _beside(source, skeleton)
    _refuse_to_overwrite([source, *beside], files)
    way = _Way(*_read(source, beside, dancer, writers[0].name))
    try:
        if source_rate is not None:
            way.at_source_rate(source_rate)
        if names is not None:
            way.rename(names)
        if on_dancer:
            way.put_on_dancer(source.stem, dancer, mapping)
        writer = way.fit(writers, rate)
        way.measure(unit, writer)
    except MotionError as error:
        raise EnpointeError(f"{source}: {error}") from None
    way.lose(writer.write(way.movement, target))
    lost = tuple(dict.fromkeys(way.lost))
    counts = _counted(way.movement)
    return Conversion(source, way.read, writer.name, *counts, tuple(way.warnings), lost, files)


@dataclass(frozen=True)
class _Writer:
    """A format to write, of ours or of others."""

    name: str
    kind: AnyKind
    write: Callable[[Movement, Path], tuple[str, ...]]
    companion: str | None = None


class _Way:
    """A movement on its way from one file to another, and what is said of it."""

    def __init__(
        self, movement: Movement, read: str, warnings: tuple[str, ...], lost: tuple[str, ...]
    ) -> None:
        self.movement = movement
        self.read = read
        self.warnings = [*warnings]
        self.lost = [*lost]

    def lose(self, lines: tuple[str, ...]) -> None:
        self.lost += lines

    def at_source_rate(self, rate: float) -> None:
        from enpointe.motion.formats import MarkerMotion, SkeletonMotion

        if not isinstance(self.movement, SkeletonMotion | MarkerMotion):
            raise MotionError(f"{self.read} says itself at which moments its samples are")
        self.movement = replace(self.movement, rate=rate)

    def rename(self, names: str | Path) -> None:
        from enpointe.motion.formats import MarkerMotion, SkeletonMotion
        from enpointe.motion.formats.mnm import read_names, renamed

        pairs = read_names(names)
        if not isinstance(self.movement, SkeletonMotion | MarkerMotion):
            raise MotionError(f"joints and markers go by other names; {self.read} has neither")
        self.movement, warnings = renamed(self.movement, pairs)
        self.warnings += warnings

    def put_on_dancer(
        self, name: str, dancer: Anthropometry | None, mapping: str | Path | None
    ) -> None:
        from enpointe.models.dancer import dancer_model
        from enpointe.motion.formats import MarkerMotion, SkeletonMotion
        from enpointe.motion.retargeting import retarget

        if not isinstance(self.movement, SkeletonMotion | MarkerMotion):
            raise MotionError(f"only a skeleton or markers are put on the dancer, not {self.read}")
        done = retarget(self.movement, dancer_model(dancer), mapping=mapping)
        self.movement = replace(done.motion, name=name)
        self.warnings += done.warnings
        self.lose(("the captured body: its proportions and what the dancer's joints can't do",))

    def fit(self, writers: tuple[_Writer, ...], rate: float | None) -> _Writer:
        """Makes the movement what one of the writers holds, at a rate, and names that one."""
        from enpointe.motion import Motion
        from enpointe.motion.formats.fitting import fitted, kind_of

        # A skeleton takes even samples; a scene of several rates can only be sampled as markers.
        first = isinstance(self.movement, Motion)
        if first:
            self.resample(rate)
        self.movement, lost = fitted(self.movement, [writer.kind for writer in writers])
        self.lose(lost)
        if not first:
            self.resample(rate)
        kind = kind_of(self.movement)
        return next((writer for writer in writers if writer.kind == kind), writers[0])

    def resample(self, rate: float | None) -> None:
        from enpointe.motion import Motion
        from enpointe.motion.formats.of_dancer import even_rate
        from enpointe.motion.formats.resampling import resampled
        from enpointe.motion.gesture import Scene

        if rate is None and isinstance(self.movement, Motion) and not even_rate(self.movement):
            rate = _USUAL_RATE
            self.warnings.append(f"samples come unevenly: taken {rate:g} a second; see --rate")
        if rate is None:
            return
        if isinstance(self.movement, Scene):
            raise MotionError("a scene keeps the rates of its units; markers of it have one")
        self.movement = resampled(self.movement, rate)

    def measure(self, unit: str | None, writer: _Writer) -> None:
        """Puts lengths into a unit, where one is asked for or the format must have another."""
        from enpointe.motion.formats import MarkerMotion, SkeletonMotion
        from enpointe.motion.formats.as_markers import in_unit
        from enpointe.motion.formats.guessing import unit_name

        if unit is not None and unit not in LENGTHS:
            raise EnpointeError(f"no unit of length is called {unit!r}; these: {' '.join(LENGTHS)}")
        if not isinstance(self.movement, SkeletonMotion | MarkerMotion):
            if unit not in (None, "m"):
                raise MotionError("the dancer's motions and scenes keep their own units")
            return
        moving = self.movement
        space = moving.space if isinstance(moving, MarkerMotion) else moving.skeleton.space
        if unit is None and writer.name in _NAME_UNITS and not unit_name(space.metres_per_unit):
            unit = _USUAL_UNIT
            self.warnings.append(f"{writer.name} has no unit of {space.metres_per_unit:g} m: in mm")
        if unit is not None:
            self.movement, lost = in_unit(self.movement, LENGTHS[unit])
            self.lose(lost)


def _refuse_a_score(source: Path) -> None:
    if source.suffix == ".bmn" or (str(source) in shipped_scores() and not source.exists()):
        raise EnpointeError(
            f"{source} is a score: dance it first (enpointe perform {source}), and convert the"
            " motion.npz that this writes"
        )


def _writers(target: Path, to: str | None) -> tuple[_Writer, ...]:
    """Of the format that was named, or of the ending; several where these share it (CSV)."""
    name = OWN_ENDINGS.get(target.suffix.lower()) if to is None else to.strip().lower()
    own = own_writers()
    if name in own:
        return (_Writer(name, "dancer", own[name]),)
    from enpointe.motion.formats.registry import writable

    try:
        found = writable(target, to)
    except EnpointeError as error:
        more = " " + " ".join(OWN_ENDINGS) if to is None else ", " + ", ".join(own)
        raise EnpointeError(f"{error}{more}") from None
    return tuple(
        _Writer(each.name, each.kind, each.write, each.companion)  # type: ignore[arg-type]
        for each in found
    )


def _files(target: Path, writer: _Writer) -> dict[str, Path]:
    files = {"motion": target}
    if writer.companion:
        files["skeleton"] = target.with_suffix(writer.companion)
    return files


def _beside(source: Path, skeleton: str | Path | None) -> list[Path]:
    """The second file that a first is read with."""
    from enpointe.motion.formats.amc import companion

    if source.suffix.lower() != ".amc" or not source.is_file():
        if skeleton is not None:
            raise EnpointeError(f"{source}: only an AMC file is read with a skeleton of its own")
        return []
    return [companion(source) if skeleton is None else Path(skeleton)]


def _refuse_to_overwrite(read: list[Path], files: dict[str, Path]) -> None:
    mine = {os.path.realpath(path) for path in read}
    for path in files.values():
        if os.path.realpath(path) in mine:
            raise EnpointeError(f"{path} is what is to be converted; name another file to write")


def _read(
    source: Path, beside: list[Path], dancer: Anthropometry | None, to: str
) -> tuple[Movement, str, tuple[str, ...], tuple[str, ...]]:
    from enpointe.motion.formats.amc import AMC, read_amc
    from enpointe.motion.formats.registry import sniffed

    if is_stored(source):
        for body, model in _puppets() if to in OF_ANY_BODY else ():
            if (own := load_own(source, model)) is not None:
                return own, f"a motion of the body {body}", (), ()
        return load_stored(source, dancer, flesh=to == "gltf"), "a motion of the dancer", (), ()
    found = sniffed(source)
    content = read_amc(source, beside[0]) if beside and found is AMC else found.read(source)
    return content.motion, found.name, content.warnings, content.lost


def _puppets() -> Iterator[tuple[str, mujoco.MjModel]]:
    from enpointe.models.puppet import op3_model, puppet_model

    yield "puppet", puppet_model()
    yield "op3", op3_model()


def _counted(movement: Movement) -> tuple[int, float, int]:
    """Frames, rate and numbers in a frame."""
    from enpointe.motion import Motion
    from enpointe.motion.formats import SkeletonMotion
    from enpointe.motion.formats.of_dancer import even_rate
    from enpointe.motion.gesture import Scene

    if isinstance(movement, Motion):
        rate = even_rate(movement) or (len(movement.time) - 1) / movement.duration
        return len(movement.time), rate, movement.model.nq
    if isinstance(movement, Scene):
        fastest = max(range(len(movement.units)), key=lambda i: movement.units[i].rate)
        width = sum(unit.width for unit in movement.units)
        return len(movement.signals[fastest]), movement.rate, width
    if isinstance(movement, SkeletonMotion):
        return movement.frames, movement.rate, movement.skeleton.width
    return movement.frames, movement.rate, 3 * len(movement.names)
