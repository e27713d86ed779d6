"""Scores on the shelf: those shipped with the package, and files."""

from __future__ import annotations

import difflib
import stat
from importlib import resources
from pathlib import Path

from enpointe.errors import ScoreError
from enpointe.notation.parser import MAX_BYTES, parse_score
from enpointe.notation.score import Score

__all__ = ["load_score", "shipped_scores"]

_SUFFIX = ".bmn"


def shipped_scores() -> tuple[str, ...]:
    """Names of the scores that come with the package, in alphabetical order."""
    shelf = resources.files("enpointe.notation").joinpath("library")
    files = (entry.name for entry in shelf.iterdir())
    return tuple(sorted(name.removesuffix(_SUFFIX) for name in files if name.endswith(_SUFFIX)))


def load_score(name_or_path: str | Path) -> Score:
    """Reads a shipped score by its name, or a score file.

    Args:
        name_or_path: One of :func:`shipped_scores`, else the path of a .bmn file.

    Returns:
        The score, its `source` set to what was asked for.

    Raises:
        ScoreError: There is no such score or file, it can't be read, or it is wrong.
    """
    source = str(name_or_path)
    shipped = shipped_scores()
    if source in shipped:
        file = resources.files("enpointe.notation").joinpath("library", source + _SUFFIX)
        return parse_score(file.read_bytes(), source)
    path = Path(name_or_path)
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise ScoreError(
                "this is not a file; give a .bmn file or the name of a shipped score", 1, 1, source
            )
        if status.st_size > MAX_BYTES:
            raise ScoreError(
                f"too large for a score: {status.st_size} bytes, at most {MAX_BYTES} are read",
                1,
                1,
                source,
            )
        data = path.read_bytes()
    except FileNotFoundError:
        close = difflib.get_close_matches(source, shipped, n=3)
        hint = (
            f"did you mean {' or '.join(close)}?" if close else f"shipped are {', '.join(shipped)}"
        )
        raise ScoreError(f"no such file or shipped score; {hint}", 1, 1, source) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ScoreError(f"the file can't be read: {reason}", 1, 1, source) from None
    return parse_score(data, source)
