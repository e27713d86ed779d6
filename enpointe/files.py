"""Writing files whole or not at all: beside the target first, then renamed onto it.

POSIX renames within a folder are atomic, so a reader sees the old file or the new one, never a
part, whatever stops the writer.
"""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from uuid import uuid4

from enpointe.errors import EnpointeError

__all__ = ["atomic_path", "refuse_unwritable", "write_bytes", "write_text"]

_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
_FORBIDDEN = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})


def write_text(path: str | Path, text: str) -> Path:
    """Writes text as UTF-8 with the line ends as they are in `text`.

    Args:
        path: Where to; folders on the way are made.
        text: The whole content.

    Returns:
        The path written.

    Raises:
        EnpointeError: The file can't be written there; what was there before is untouched.
    """
    return write_bytes(path, text.encode("utf-8"))


def write_bytes(path: str | Path, data: bytes) -> Path:
    """Writes bytes.

    Args:
        path: Where to; folders on the way are made.
        data: The whole content.

    Returns:
        The path written.

    Raises:
        EnpointeError: The file can't be written there; what was there before is untouched.
    """
    with atomic_path(path) as beside:
        beside.write_bytes(data)
    return Path(path)


@contextmanager
def atomic_path(path: str | Path) -> Iterator[Path]:
    """Yields a path beside `path` to write to; renames it onto `path` when the block ends well.

    The yielded path has the same suffix, for writers that choose a format by it. When the block
    raises, or is interrupted, what it wrote is removed and `path` is as it was. A link is
    followed, so that the file it points to is replaced and the link stays.

    Args:
        path: Where the file is to be; folders on the way are made.

    Yields:
        A path in the same folder at which nothing exists yet.

    Raises:
        EnpointeError: The file can't be written there, or the block wrote nothing.

    Example:
        >>> with atomic_path("dance.gif") as beside:
        ...     image.save(beside)
    """
    path = Path(path)
    try:
        target = Path(os.path.realpath(path))
        target.parent.mkdir(parents=True, exist_ok=True)
        _refuse_what_is_not_a_file(path, target)
    except (OSError, ValueError) as problem:
        raise _explained(problem, path) from problem
    beside = target.with_name(f".{uuid4().hex[:12]}{target.suffix}")
    try:
        yield beside
        _put_in_place(beside, target)
    except OSError as problem:
        if _is_about_the_write(problem, beside, target):
            raise _explained(problem, path) from problem
        raise
    finally:
        with suppress(OSError):
            beside.unlink(missing_ok=True)


class _LeftUnwrittenError(Exception):
    """Raised to leave a file unwritten."""


def refuse_unwritable(path: str | Path) -> None:
    """Make sure of a file before work that can't be done again; nothing is left behind.

    Args:
        path: Where the file is to be.

    Raises:
        EnpointeError: It can't be written there.
    """
    path = Path(path)
    made = [folder for folder in path.parents if not folder.exists()]
    try:
        with suppress(_LeftUnwrittenError), atomic_path(path) as beside:
            beside.touch()
            raise _LeftUnwrittenError
    finally:
        for folder in made:
            with suppress(OSError):
                folder.rmdir()


def _refuse_what_is_not_a_file(path: Path, target: Path) -> None:
    """Renaming onto a device or a pipe would replace it, and onto a folder fails late."""
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if target.exists() and not target.is_file():
        raise EnpointeError(
            f"cannot write {_shown(path)}: it is a device or a pipe; name an ordinary file"
        )


def _put_in_place(beside: Path, target: Path) -> None:
    if not beside.exists():
        raise EnpointeError(f"cannot write {_shown(target)}: its writer wrote nothing")
    # On the disk before the rename is: after a power cut the name must not lead to an empty file.
    with beside.open("rb") as written:
        os.fsync(written.fileno())
    if target.exists():
        shutil.copymode(target, beside)
    beside.replace(target)


def _is_about_the_write(problem: OSError, *files: Path) -> bool:
    """Whether an error in the block is of our files, not of another that the block had open."""
    if problem.filename is None:
        return problem.errno in _FULL | {errno.EIO}
    return bool({str(file) for file in files} & {str(problem.filename), str(problem.filename2)})


def _explained(problem: OSError | ValueError, path: Path) -> EnpointeError:
    code = problem.errno if isinstance(problem, OSError) else None
    what = f"cannot write {_shown(path)}"
    if code in _FULL:
        return EnpointeError(f"{what}: no space left there; free some or choose another folder")
    if code in _FORBIDDEN:
        return EnpointeError(
            f"{what}: no leave to write in {_shown(path.parent)}; choose another folder"
        )
    if code in {errno.ENOTDIR, errno.EEXIST}:
        return EnpointeError(
            f"{what}: {_shown(_file_on_the_way(path))} is a file where a folder should be; "
            "choose another folder"
        )
    if code == errno.EISDIR:
        return EnpointeError(f"{what}: it is a folder; name a file")
    if code == errno.ENAMETOOLONG:
        return EnpointeError(f"{what}: the name is too long; choose a shorter one")
    reason = (problem.strerror if isinstance(problem, OSError) else None) or str(problem)
    return EnpointeError(f"{what}: {reason}; choose another folder")


def _file_on_the_way(path: Path) -> Path:
    """The first part of the path that exists and is no folder."""
    for folder in reversed(path.parents):
        if folder.exists() and not folder.is_dir():
            return folder
    return path.parent


def _shown(path: Path) -> str:
    """The path in a message of one line, whatever is in its name."""
    text = str(path)
    return text if text.isprintable() else repr(text)
