"""`enpointe notate`: a motion in, a score out; and what a single pose is called."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.errors import EnpointeError, FormatError
from enpointe.files import write_text
from enpointe.notation import Side, Sign, format_score, stave_svg
from enpointe.notation.writer import frame_lines

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from enpointe.models import Anthropometry
    from enpointe.models.reading import ReadFrame
    from enpointe.models.recognition import Recognition
    from enpointe.motion import Motion
    from enpointe.motion.notating import NotatedMotion
    from enpointe.notation import Score

__all__ = ["Notation", "SeenPose", "is_seen", "notate", "recognise", "see"]


@dataclass(frozen=True)
class Notation:
    """A motion written down.

    Attributes:
        notated: The score, with the moments that its frames were read from.
    """

    notated: NotatedMotion

    @property
    def score(self) -> Score:
        return self.notated.score

    def summary(self) -> dict[str, object]:
        """The figures that `--json` prints; the names are a promise to scripts."""
        pulse = self.notated.pulse
        return {
            "title": self.score.title,
            "tempo": self.score.tempo,
            "tempo_estimated": self.notated.estimated,
            "off_beat_rms": pulse.off,
            "frames": [
                {
                    "beat": float(each.frame.beat),
                    "time": each.time,
                    "name": each.recognition.name,
                    "named": each.recognition.named,
                    "distance_deg": each.recognition.distance,
                    "written": [*frame_lines(each.frame)],
                    "signs": signs_as_numbers(each.recognition.signs),
                }
                for each in self.notated.frames
            ],
        }

    def save(self, folder: Path, name: str) -> dict[str, Path]:
        """Write `NAME.bmn` and `NAME.svg`; returns their paths."""
        return {
            "score": write_text(folder / f"{name}.bmn", format_score(self.score)),
            "stave": write_text(folder / f"{name}.svg", stave_svg(self.score)),
        }


@dataclass(frozen=True)
class SeenPose:
    """A configuration that somebody has, and what it is called.

    Attributes:
        name: Where it comes from.
        qpos: (nq,).
        recognition: What it is called.
    """

    name: str
    qpos: NDArray[np.float64]
    recognition: Recognition

    def summary(self) -> dict[str, object]:
        """The figures that `--json` prints."""
        seen = self.recognition
        parts = {"arms": seen.arms, "feet": seen.feet, "pose": seen.pose}
        parts |= {f"{side} leg": match for side, match in seen.legs.items()}
        return {
            "poses": [
                {
                    "name": self.name,
                    "qpos": self.qpos.tolist(),
                    "recognised_as": seen.name,
                    "named": seen.named,
                    "distance_deg": seen.distance,
                    "parts": [
                        {
                            "part": part,
                            "nearest": match.name,
                            "also": [*match.names[1:]],
                            "named": match.named,
                            "distance": match.distance,
                            "unit": match.unit,
                            "worst": match.worst,
                            "worst_distance": match.worst_distance,
                            "alternatives": [each.name for each in seen.alternatives[part]],
                        }
                        for part, match in parts.items()
                        if match is not None
                    ],
                    "signs": signs_as_numbers(seen.signs),
                }
            ]
        }


def notate(
    source: str | Path | Motion,
    *,
    tempo: float | None = None,
    metre: tuple[int, int] = (4, 4),
    dancer: Anthropometry | None = None,
) -> Notation:
    """Read a motion back into a score.

    Args:
        source: A motion, or a file of one (`.npz`, as `enpointe perform` writes it).
        tempo: Pulses a minute; estimated if None.
        metre: Pulses in a bar, and the note value of a pulse.
        dancer: Height, mass and sex of the dancer in the file; 1.68 m and 54 kg if None.

    Raises:
        FormatError: The file can't be read.
        MotionError: Nothing moves, or a tempo that can't be danced.

    Example:
        >>> import enpointe
        >>> dance = enpointe.perform("first-port-de-bras", controller="kinematic")
        >>> enpointe.notate(dance.motion).score.frames[2].arms.name
        'à la seconde'
    """
    from enpointe.motion.notating import read_motion

    motion = _motion(source, dancer) if isinstance(source, str | Path) else source
    return Notation(read_motion(motion, tempo, metre=metre))


def recognise(qpos: ArrayLike, *, dancer: Anthropometry | None = None) -> Recognition:
    """Name a configuration of the dancer, or say what is nearest and how far.

    Args:
        qpos: (nq,); any, legal or not.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.

    Raises:
        PoseError: A configuration of another size, or one that is not finite.

    Example:
        >>> import enpointe
        >>> solved = enpointe.pose("arms fourth en haut")
        >>> str(enpointe.recognise(solved.key_poses[0].qpos).arms)
        'fourth en haut right leads'
    """
    from enpointe.models.dancer import dancer_model
    from enpointe.models.recognition import recognise as recognise_with

    return recognise_with(dancer_model(dancer, flesh=False), qpos)


def is_seen(source: str) -> bool:
    """Whether this is a configuration to be looked at: FILE.npy, FILE.npz or FILE.npz@SECONDS."""
    path, _ = _at_time(source)
    return path.suffix in (".npz", ".npy")


def see(source: str, *, dancer: Anthropometry | None = None) -> SeenPose:
    """Name a configuration from a file.

    Args:
        source: A `.npy` file of one configuration, or a motion `.npz`, with `@SECONDS` for a moment
            other than its start.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.

    Raises:
        FormatError: The file can't be read.
        PoseError: No configuration of this dancer.
        EnpointeError: A moment that is no number, or beyond the motion.
    """
    import numpy as np

    path, moment = _at_time(source)
    if path.suffix == ".npy":
        if moment:
            raise EnpointeError(f"{path} is one pose; leave out '@{moment}'")
        try:
            qpos = np.asarray(np.load(path, allow_pickle=False), dtype=np.float64)
        except (OSError, ValueError, EOFError, TypeError) as error:
            raise FormatError(f"no configuration can be read ({error})", path) from None
        return SeenPose(source, qpos, recognise(qpos, dancer=dancer))
    motion = _motion(path, dancer)
    seconds = _seconds(moment, motion.duration)
    qpos = motion.sample(seconds)[0]
    return SeenPose(f"{motion.name} at {seconds:g} s", qpos, recognise(qpos, dancer=dancer))


def signs_as_numbers(signs: ReadFrame) -> dict[str, object]:
    """Raw signs for JSON: stave units, degrees, and how each foot meets the floor."""
    read: dict[str, object] = {}
    for side in Side:
        read[f"{side} hand"] = _numbers(signs.hands[side])
        if side in signs.elbows:
            read[f"{side} elbow"] = _numbers(signs.elbows[side])
        leg = signs.legs[side]
        read[f"{side} foot"] = {
            **_numbers(leg.foot),
            "floor": None if leg.support is None else str(leg.support.floor),
            "bend": None if leg.support is None else str(leg.support.bend),
        }
        if leg.knee is not None:
            read[f"{side} knee"] = _numbers(leg.knee)
    for name, part in (("head", signs.head), ("body", signs.body), ("pelvis", signs.pelvis)):
        read[name] = {"turn": part.turn, "tilt": part.tilt, "bend": part.bend}
    read["facing"] = signs.facing_degrees
    return read


def _numbers(sign: Sign) -> dict[str, object]:
    return {
        "width": sign.width,
        "height": sign.height,
        "depth": str(sign.depth),
        "straight": sign.straight,
    }


def _motion(path: str | Path, dancer: Anthropometry | None) -> Motion:
    from enpointe.models.dancer import dancer_model
    from enpointe.motion.npz import load_motion

    return load_motion(Path(path), dancer_model(dancer, flesh=False))


def _at_time(source: str) -> tuple[Path, str]:
    name, mark, moment = source.rpartition("@")
    return (Path(name), moment) if mark and Path(name).suffix == ".npz" else (Path(source), "")


def _seconds(moment: str, duration: float) -> float:
    if not moment:
        return 0.0
    try:
        seconds = float(moment)
    except ValueError:
        seconds = float("nan")
    if not 0.0 <= seconds <= duration:
        raise EnpointeError(
            f"'@{moment}' is no moment of this motion; write seconds from 0 to {duration:.2f}"
        )
    return seconds
