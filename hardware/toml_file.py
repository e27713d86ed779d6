"""Reading the files in which buses and their faults are written down."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from enpointe.errors import FormatError

__all__ = ["read_toml"]


def read_toml(path: str | Path) -> dict[str, Any]:
    """The tables of a TOML file.

    Raises:
        FormatError: It can't be read, or is no TOML.
    """
    try:
        return tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise FormatError(f"no readable TOML: {reason}", path) from error
