"""Runs as they finish, one line each, so that a sweep that was stopped goes on where it was."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from types import TracebackType
from typing import IO

from enpointe.errors import EnpointeError, FormatError
from enpointe.files import write_text
from enpointe.sim.trial import Outcome

__all__ = ["Journal"]

_FORMAT = "enpointe sweep 1"


class Journal:
    """A file of JSON lines: what is swept, and then the outcome of each finished run.

    A last line that was cut off half-written is dropped.

    Args:
        path: The file; begun if it isn't there.
        configuration: What tells one sweep from another.

    Attributes:
        outcomes: What was there already.

    Raises:
        EnpointeError: It can't be written, or is of another sweep.
        FormatError: It is no journal.
    """

    def __init__(self, path: Path, configuration: str) -> None:
        self._path = path
        if not path.exists():
            write_text(path, self._header(configuration))
        self.outcomes = self._read(configuration)
        self._file: IO[str] | None = None

    def __enter__(self) -> Journal:
        """Ready to be added to."""
        try:
            self._file = self._path.open("a", encoding="utf-8")
        except OSError as problem:
            raise self._unwritable(problem) from problem
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Nothing is lost: every line was written when it came."""
        if self._file is not None:
            self._file.close()

    def add(self, outcome: Outcome) -> None:
        """Write one run down, at once."""
        assert self._file is not None
        try:
            self._file.write(json.dumps(asdict(outcome)) + "\n")
            self._file.flush()
        except OSError as problem:
            raise self._unwritable(problem) from problem

    def _header(self, configuration: str) -> str:
        return json.dumps({"format": _FORMAT, "configuration": configuration}) + "\n"

    def _read(self, configuration: str) -> tuple[Outcome, ...]:
        try:
            text = self._path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as problem:
            reason = f"the journal of a sweep can't be read ({problem})"
            raise FormatError(reason, self._path) from problem
        whole, _, cut = text.rpartition("\n")
        first, *lines = whole.split("\n")
        header = self._object(first, 1)
        if header.get("format") != _FORMAT:
            raise FormatError("not the journal of a sweep", self._path, line=1)
        if header.get("configuration") != configuration and not lines:
            # Stopped before its first run: there is nothing to lose.
            write_text(self._path, self._header(configuration))
            return ()
        if header.get("configuration") != configuration:
            raise EnpointeError(
                f"{self._path} is of another sweep (score, effort, dancer, disturbances, seed or"
                " enpointe differ); choose another --out, or remove that file"
            )
        if cut:
            write_text(self._path, whole + "\n")
        return tuple(self._outcome(line, number) for number, line in enumerate(lines, start=2))

    def _outcome(self, line: str, number: int) -> Outcome:
        try:
            return Outcome(**self._object(line, number))  # type: ignore[arg-type]
        except TypeError:
            raise FormatError("not the outcome of a run", self._path, line=number) from None

    def _object(self, line: str, number: int) -> Mapping[str, object]:
        try:
            value = json.loads(line)
        except ValueError:
            value = None
        if not isinstance(value, dict):
            raise FormatError("not the journal of a sweep", self._path, line=number)
        return value

    def _unwritable(self, problem: OSError) -> EnpointeError:
        return EnpointeError(
            f"cannot write {self._path}: {problem.strerror}; what was finished before is kept"
        )
