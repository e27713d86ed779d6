"""Which points of a source are which landmarks, and the file that says so."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from enpointe.errors import FormatError, MotionError
from enpointe.motion.retargeting.landmarks import FRAMES, LANDMARKS, NEEDED

__all__ = ["END", "JointMap"]

END = ":end"
"""What a skeleton's end site is called: the joint's name and this."""


@dataclass(frozen=True)
class JointMap:
    """Landmarks by name.

    Attributes:
        points: Of each landmark, the source's points whose mean it is: joints, end sites
            ("Head:end") or markers.
        frames: Of pelvis, torso, head and feet, the joint whose rotation is theirs; where one is
            missing (and in marker sets) the landmarks give it.
        found: How it was made: "names", "structure" or "file".
    """

    points: Mapping[str, tuple[str, ...]]
    frames: Mapping[str, str] = field(default_factory=dict)
    found: str = "file"

    def __post_init__(self) -> None:
        """Check the names.

        Raises:
            MotionError: A landmark or a frame that there is not.
        """
        for names, known in ((self.points, LANDMARKS), (self.frames, FRAMES)):
            strange = [name for name in names if name not in known]
            if strange:
                raise MotionError(f"no landmark {strange[0]!r}; these are: {', '.join(known)}")

    @property
    def missing(self) -> tuple[str, ...]:
        """Landmarks without which nothing can be retargeted."""
        points = self.points
        spines = {"left_front_hip", "right_front_hip"} <= set(points) and (
            "sacrum" in points or {"left_back_hip", "right_back_hip"} <= set(points)
        )
        return tuple(
            name for name in NEEDED if name not in points and not (spines and name.endswith("_hip"))
        )

    def check(self, names: tuple[str, ...], source: str = "the source") -> None:
        """Whether it fits a source.

        Args:
            names: The source's points.
            source: Its name, for the message.

        Raises:
            MotionError: A needed landmark is missing, or a point that the source has not.
        """
        if self.missing:
            raise MotionError(
                f"{source}: the map has no {', '.join(self.missing)}; write a mapping file "
                f"(docs/retargeting.md) with points out of: {', '.join(names)}"
            )
        known = set(names)
        for landmark, points in (
            *self.points.items(),
            *((k, (v,)) for k, v in self.frames.items()),
        ):
            strange = [point for point in points if point not in known]
            if strange:
                raise MotionError(
                    f"{source}: {landmark} is mapped to {strange[0]!r}, which is none of its "
                    f"points: {', '.join(names)}"
                )

    def save(self, path: str | Path) -> None:
        """Writes it as TOML, beside and renamed.

        Raises:
            FormatError: The file can't be written.
        """
        path = Path(path)
        lines = ["# Landmarks of a motion file: each the mean of the points named.", "[points]"]
        for name in LANDMARKS:
            if name in self.points:
                listed = ", ".join(json.dumps(point) for point in self.points[name])
                lines.append(f"{name} = [{listed}]")
        lines += ["", "# Joints whose rotation is that of a whole part.", "[frames]"]
        lines += [
            f"{name} = {json.dumps(self.frames[name])}" for name in FRAMES if name in self.frames
        ]
        beside = path.with_name(f".{path.name}.part")
        try:
            beside.write_text("\n".join(lines) + "\n", encoding="utf-8")
            beside.replace(path)
        except OSError as error:
            beside.unlink(missing_ok=True)
            raise FormatError(f"can't be written ({error.strerror or error})", path) from None

    @classmethod
    def load(cls, path: str | Path) -> JointMap:
        """Reads a mapping file.

        Raises:
            FormatError: It can't be read, is no TOML, or names what there is not.
        """
        path = Path(path)
        try:
            table = tomllib.loads(path.read_text(encoding="utf-8"))
        except OSError as error:
            raise FormatError(f"can't be read ({error.strerror or error})", path) from None
        except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            raise FormatError(f"no mapping file: {error}", path) from None
        points, frames = table.get("points", {}), table.get("frames", {})
        strange = [key for key in table if key not in ("points", "frames")]
        if strange or not isinstance(points, dict) or not isinstance(frames, dict) or not points:
            raise FormatError("a mapping file has a table [points] and, perhaps, [frames]", path)
        try:
            return cls(
                {name: _listed(name, value) for name, value in points.items()},
                {name: _listed(name, value)[0] for name, value in frames.items()},
            )
        except MotionError as error:
            raise FormatError(str(error), path) from None


def _listed(name: str, value: object) -> tuple[str, ...]:
    listed = [value] if isinstance(value, str) else value
    if not isinstance(listed, list) or not listed or not all(isinstance(v, str) for v in listed):
        raise MotionError(f"{name} must be a point's name or a list of them, not {value!r}")
    return tuple(listed)
