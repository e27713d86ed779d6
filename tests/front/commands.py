"""Helpers of the tests of the command line: scores as text, and what a command answers."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import pytest

from enpointe.cli import _run

from ..motion.dancing import written_score
from ..notation.texts import frame

SHORT = written_score(
    "feet: fifth right front; arms: fifth en bas",
    "arms: à la seconde; head: turn right 20",
    tempo=90,
)
ALOFT = frame("  left leg: pointed devant\n  right leg: pointed derrière")
"""A frame with nobody on the floor, and no jump that leads there."""


def refused(capfd: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The one line with which a command is refused."""
    assert _run(list(arguments)) == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert err.endswith("\n")
    assert err.count("\n") == 1
    assert err.startswith("enpointe: ")
    assert "fault of ours" not in err
    return err


def one_object(text: str) -> Mapping[str, Any]:
    """The one line of JSON that a command printed."""
    assert text.count("\n") == 1
    value = json.loads(text, parse_constant=lambda c: pytest.fail(f"{c} is no JSON"))
    assert isinstance(value, dict)
    return value
