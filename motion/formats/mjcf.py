"""Motions as keyframes of MuJoCo: `<key>` elements of an MJCF file, one a sample.

What is written is a file that a model includes, or that is read back here.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from xml.parsers import expat
from xml.sax.saxutils import quoteattr

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError, MotionError
from enpointe.files import write_text
from enpointe.motion.formats.columns import number_text
from enpointe.motion.formats.text import finite_number, read_text
from enpointe.motion.motion import Motion

__all__ = ["read_keyframes", "write_keyframes"]

Array = NDArray[np.float64]


def write_keyframes(motion: Motion, path: Path) -> tuple[str, ...]:
    """Write every sample as a keyframe with its time, positions and velocities.

    Returns:
        What keyframes can't hold.
    """
    samples = zip(motion.time.tolist(), motion.qpos.tolist(), motion.qvel.tolist(), strict=True)
    keys = [
        f'    <key name="frame {index}" time="{number_text(time)}"'
        f' qpos="{_row(qpos)}" qvel="{_row(qvel)}"/>'
        for index, (time, qpos, qvel) in enumerate(samples)
    ]
    lines = [
        f"<mujoco model={quoteattr(motion.name)}>",
        "  <keyframe>",
        *keys,
        "  </keyframe>",
        "</mujoco>",
    ]
    write_text(path, "\n".join(lines) + "\n")
    lost = ["accelerations, which are differences of the velocities when read again"]
    return (*lost, "events") if motion.events else tuple(lost)


def read_keyframes(path: Path, model: mujoco.MjModel) -> Motion:
    """Read the keyframes of an MJCF file as a motion of a body.

    Velocities that a keyframe does not give are differences of the positions; accelerations
    are differences of the velocities.

    Args:
        path: The file.
        model: The body; its keyframes have `nq` positions and `nv` velocities.

    Raises:
        FormatError: No MJCF file, no keyframes, or some of another body or without times.
    """
    keys = _Keys(path, model)
    keys.parse(read_text(path))
    if len(keys.time) < 2:
        raise FormatError("a motion needs two keyframes at least", path, line=keys.line)
    time, qpos = np.array(keys.time), np.array(keys.qpos)
    time -= time[0]
    try:
        with np.errstate(all="ignore"):  # what is no number is refused with the motion
            if all(row is not None for row in keys.qvel):
                qvel = np.array(keys.qvel)
                qacc = np.gradient(qvel, time, axis=0) if (np.diff(time) > 0).all() else qvel
                return Motion(model, time, qpos, qvel, qacc, name=keys.name)
            return Motion.from_qpos(model, time, qpos, name=keys.name)
    except MotionError as error:
        raise FormatError(str(error), path, line=keys.line) from None


class _Keys:
    """Collects `<key>` elements; knows the line of each."""

    def __init__(self, path: Path, model: mujoco.MjModel) -> None:
        self.name = path.stem
        self.time: list[float] = []
        self.qpos: list[Array] = []
        self.qvel: list[Array | None] = []
        self.line = 1
        self._path, self._model = path, model
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.StartDoctypeDeclHandler = self._doctype

    def parse(self, text: str) -> None:
        try:
            self._parser.Parse(text.encode(), True)
        except expat.ExpatError as error:
            raise FormatError(
                f"not well-formed XML ({expat.ErrorString(error.code)})",
                self._path,
                line=error.lineno,
            ) from None

    def _doctype(self, *_: object) -> None:
        # Entities could grow without bound, and MJCF has none.
        line = self._parser.CurrentLineNumber
        raise FormatError("an MJCF file has no document type", self._path, line=line)

    def _start(self, tag: str, attributes: Mapping[str, str]) -> None:
        if tag == "mujoco":
            self.name = attributes.get("model", self.name)
        if tag != "key":
            return
        self.line = line = self._parser.CurrentLineNumber
        self.time.append(finite_number(attributes.get("time", "0"), self._path, line, "time"))
        qpos = self._numbers(attributes, "qpos", self._model.nq)
        if qpos is None:
            raise FormatError("a keyframe of a motion needs its qpos", self._path, line=line)
        self.qpos.append(qpos)
        self.qvel.append(self._numbers(attributes, "qvel", self._model.nv))

    def _numbers(self, attributes: Mapping[str, str], name: str, count: int) -> Array | None:
        if name not in attributes:
            return None
        tokens = attributes[name].split()
        if len(tokens) != count:
            raise FormatError(
                f"{name} has {len(tokens)} numbers, and the body {count}",
                self._path,
                line=self.line,
            )
        return np.array([finite_number(t, self._path, self.line, name) for t in tokens])


def _row(values: list[float]) -> str:
    return " ".join(map(number_text, values))
