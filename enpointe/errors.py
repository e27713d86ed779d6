"""The one exception tree: a message says what is wrong, where, and what to do."""

from __future__ import annotations

from pathlib import Path

__all__ = [
    "BodyError",
    "EnpointeError",
    "FormatError",
    "ModelError",
    "MotionError",
    "PoseError",
    "RenderError",
    "RigError",
    "ScoreError",
]


class EnpointeError(Exception):
    """Anything that a user can mend. The command line prints it as one line and exits with 2."""


class ScoreError(EnpointeError):
    """A score that can't be read or danced, with the place in its text.

    Attributes:
        message: What is wrong and what to do, without the place.
        line: Line in the source, from 1.
        column: Column in the source, from 1.
        source: File name or the name of a shipped score; None for a bare string.
    """

    def __init__(self, message: str, line: int, column: int, source: str | None = None) -> None:
        self.message = message
        self.line = line
        self.column = column
        self.source = source
        super().__init__(f"{source or 'score'}:{line}:{column}: {message}")


class FormatError(EnpointeError):
    """A file that is not what it says it is, with the line or the byte where that shows."""

    def __init__(
        self,
        message: str,
        file: str | Path,
        *,
        line: int | None = None,
        byte: int | None = None,
    ) -> None:
        self.message = message
        self.file = str(file)
        self.line = line
        self.byte = byte
        place = f":{line}" if line is not None else f" at byte {byte}" if byte is not None else ""
        super().__init__(f"{file}{place}: {message}")


class ModelError(EnpointeError):
    """A body that can't be built, or a name that the model doesn't have."""


class PoseError(EnpointeError):
    """A key pose that no rule-abiding body can take."""


class MotionError(EnpointeError):
    """A motion or an effort that makes no sense (times going back, wrong shapes, unknown names)."""


class BodyError(EnpointeError):
    """A body that can't do what the controller asks (wrong shapes, values that are no numbers)."""


class RenderError(EnpointeError):
    """No picture can be drawn on this machine; says which package is missing."""


class RigError(EnpointeError):
    """A rig of servos, a bus or a description of one that can't be used."""
