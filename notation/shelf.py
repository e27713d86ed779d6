"""Scores on the shelf: those shipped with the package, and files; and a user's vocabulary."""

from __future__ import annotations

import difflib
import stat
from importlib import resources
from pathlib import Path

from enpointe.errors import ScoreError
from enpointe.notation.json_reader import MAX_JSON_BYTES, score_from_json
from enpointe.notation.macros import Vocabulary
from enpointe.notation.parser import parse_score
from enpointe.notation.plain_text import MAX_BYTES
from enpointe.notation.score import Score
from enpointe.notation.user_vocabulary import parse_vocabulary

__all__ = ["load_score", "load_vocabulary", "shipped_scores"]

_SUFFIX = ".bmn"


def shipped_scores() -> tuple[str, ...]:
    """Names of the scores that come with the package, in alphabetical order."""
    shelf = resources.files("enpointe.notation").joinpath("library")
    files = (entry.name for entry in shelf.iterdir())
    return tuple(sorted(name.removesuffix(_SUFFIX) for name in files if name.endswith(_SUFFIX)))


def load_score(name_or_path: str | Path, vocabulary: Vocabulary | None = None) -> Score:
    """Reads a shipped score by its name, or a score file.

    Args:
        name_or_path: One of :func:`shipped_scores`, else the path of a score: a .bmn text, or its
            JSON form, told apart by their contents.
        vocabulary: A user's own names, for a text.

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
    close = difflib.get_close_matches(source, shipped, n=3)
    hint = f"did you mean {' or '.join(close)}?" if close else f"shipped are {', '.join(shipped)}"
    of_file = Path(source).suffix and not close
    missing = "there is no such file" if of_file else f"no such file or shipped score; {hint}"
    data = _read(name_or_path, MAX_JSON_BYTES, missing)
    if data.removeprefix(b"\xef\xbb\xbf").lstrip(b" \t\r\n").startswith(b"{"):
        return score_from_json(data, source)
    return parse_score(data, source, vocabulary)


def load_vocabulary(path: str | Path) -> Vocabulary:
    """Reads a file of a user's own names for positions.

    It is written as scores are: ``benesh 1``, then for each name ``define arms``, ``define leg`` or
    ``define pose`` and the name, and under it lines as under a beat. A definition is written for
    the right: the right arm leading, the right leg working, or standing on the right leg; with the
    left it is mirrored.

    Args:
        path: The file.

    Returns:
        The vocabulary, for `load_score` and `parse_score`.

    Raises:
        ScoreError: The file can't be read, or it is wrong; with line and column.
    """
    return parse_vocabulary(_read(path, MAX_BYTES, "no such vocabulary file"), str(path))


def _read(path: str | Path, most: int, missing: str) -> bytes:
    source, file = str(path), Path(path)
    try:
        status = file.stat()
        if not stat.S_ISREG(status.st_mode):
            raise ScoreError(
                "this is not a file; give a .bmn file or the name of a shipped score", 1, 1, source
            )
        if status.st_size > most:
            raise ScoreError(
                f"too large for a score: {status.st_size} bytes, at most {most} are read",
                1,
                1,
                source,
            )
        return file.read_bytes()
    except FileNotFoundError:
        raise ScoreError(missing, 1, 1, source) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ScoreError(f"the file can't be read: {reason}", 1, 1, source) from None
