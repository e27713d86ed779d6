"""Files are written whole or not at all, and what can't be written is said in one line."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NoReturn

import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import EnpointeError
from enpointe.files import atomic_path, refuse_unwritable, write_bytes, write_text

OLD = b"what was here before"


def in_a_child(code: str, *arguments: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=60,
        cwd=arguments[0].parent,
    )


def names(folder: str | Path) -> list[str]:
    return sorted(entry.name for entry in Path(folder).iterdir())


def one_line(caught: pytest.ExceptionInfo[EnpointeError], *parts: str) -> None:
    message = str(caught.value)
    assert "\n" not in message
    for part in parts:
        assert part in message


@given(data=st.binary(max_size=2000), before=st.none() | st.binary(max_size=100))
def test_bytes_come_back_as_they_were_and_nothing_else_is_left(
    data: bytes, before: bytes | None
) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "dance.bin"
        if before is not None:
            path.write_bytes(before)
        assert write_bytes(path, data) == path
        assert path.read_bytes() == data
        assert names(folder) == ["dance.bin"]


@given(text=st.text(st.characters(codec="utf-8"), max_size=300))
def test_text_comes_back_with_its_own_line_ends(text: str) -> None:
    with TemporaryDirectory() as folder:
        path = write_text(Path(folder) / "dance.bmn", text)
        assert path.read_bytes().decode("utf-8") == text


def test_folders_on_the_way_are_made(tmp_path: Path) -> None:
    assert write_text(tmp_path / "a" / "b" / "c.txt", "x").read_text() == "x"


def test_the_path_beside_is_new_near_and_of_the_same_suffix(tmp_path: Path) -> None:
    with atomic_path(tmp_path / "dance.gif") as beside:
        assert beside.parent == tmp_path
        assert beside.suffix == ".gif"
        assert not beside.exists()
        beside.write_bytes(b"GIF89a")
        assert not (tmp_path / "dance.gif").exists()
    assert (tmp_path / "dance.gif").read_bytes() == b"GIF89a"


@given(
    written=st.binary(max_size=500),
    existed=st.booleans(),
    problem=st.sampled_from([RuntimeError, KeyboardInterrupt, SystemExit, MemoryError]),
)
def test_a_block_that_raises_changes_nothing_and_its_error_passes(
    written: bytes, existed: bool, problem: type[BaseException]
) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "dance.bin"
        if existed:
            path.write_bytes(OLD)

        def spoil() -> NoReturn:
            with atomic_path(path) as beside:
                beside.write_bytes(written)
                raise problem

        with pytest.raises(problem):
            spoil()
        assert names(folder) == (["dance.bin"] if existed else [])
        assert not existed or path.read_bytes() == OLD


def broken(call: Callable[..., Any], at: list[int], code: int) -> Callable[..., Any]:
    """The same call, failing with `code` once the counter runs out."""

    def stand_in(*arguments: Any, **options: Any) -> Any:
        at[0] -= 1
        if at[0] == 0:
            raise OSError(code, os.strerror(code))
        return call(*arguments, **options)

    return stand_in


@given(
    step=st.integers(1, 4),
    code=st.sampled_from([errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG]),
    data=st.binary(min_size=1, max_size=200),
)
def test_a_disk_that_fails_at_any_step_leaves_the_old_file_or_the_new(
    step: int, code: int, data: bytes
) -> None:
    with TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        path = Path(folder) / "dance.bin"
        path.write_bytes(OLD)
        countdown = [step]
        patch.setattr(Path, "write_bytes", broken(Path.write_bytes, countdown, code))
        patch.setattr(os, "fsync", broken(os.fsync, countdown, code))
        patch.setattr(Path, "replace", broken(Path.replace, countdown, code))
        if step <= 3:
            with pytest.raises(EnpointeError) as caught:
                write_bytes(path, data)
            one_line(caught, str(path))
            assert path.read_bytes() == OLD
        else:
            write_bytes(path, data)
            assert path.read_bytes() == data
        assert names(folder) == ["dance.bin"]


def test_a_process_that_dies_half_way_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "dance.bin"
    path.write_bytes(OLD)
    code = (
        "import os, sys; from enpointe.files import atomic_path\n"
        "with atomic_path(sys.argv[1]) as beside:\n"
        "    beside.write_bytes(b'half'); os._exit(9)\n"
    )
    died = in_a_child(code, path)
    assert died.returncode == 9, died.stderr
    assert path.read_bytes() == OLD


def test_a_file_larger_than_the_system_allows_is_no_space_and_leaves_nothing(
    tmp_path: Path,
) -> None:
    pytest.importorskip("resource")
    code = (
        "import resource, signal, sys; from enpointe.errors import EnpointeError\n"
        "from enpointe.files import write_bytes\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))\n"
        "try: write_bytes(sys.argv[1], bytes(1_000_000))\n"
        "except EnpointeError as problem: print(problem)\n"
    )
    child = in_a_child(code, tmp_path / "dance.bin")
    assert "no space left" in child.stdout, child.stderr
    assert len(child.stdout.splitlines()) == 1
    assert names(tmp_path) == []


def test_an_error_of_another_file_in_the_block_is_not_taken_for_ours(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError), atomic_path(tmp_path / "dance.bin"):
        (tmp_path / "no such file").read_bytes()
    assert names(tmp_path) == []


def test_a_writer_that_writes_nothing_is_an_error(tmp_path: Path) -> None:
    with (
        pytest.raises(EnpointeError, match="wrote nothing") as caught,
        atomic_path(tmp_path / "x.mp4"),
    ):
        pass
    one_line(caught, "x.mp4")


def test_a_file_where_a_folder_should_be_is_named(tmp_path: Path) -> None:
    (tmp_path / "out").write_bytes(OLD)
    for path in (tmp_path / "out" / "dance.txt", tmp_path / "out" / "deep" / "dance.txt"):
        with pytest.raises(EnpointeError) as caught:
            write_text(path, "x")
        one_line(caught, f"{tmp_path / 'out'} is a file where a folder should be")
    assert (tmp_path / "out").read_bytes() == OLD


def test_a_folder_is_not_a_file(tmp_path: Path) -> None:
    with pytest.raises(EnpointeError) as caught:
        write_text(tmp_path, "x")
    one_line(caught, "it is a folder")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_a_pipe_or_a_device_is_never_replaced(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(EnpointeError) as caught:
        write_text(tmp_path / "pipe", "x")
    one_line(caught, "a device or a pipe")
    assert (tmp_path / "pipe").is_fifo()


def test_names_too_long_or_impossible_are_one_line(tmp_path: Path) -> None:
    for name in ("n" * 300, "a\0b", "line\nbreak/" + "n" * 300, "x/" * 3000):
        with pytest.raises(EnpointeError) as caught:
            write_text(tmp_path / name, "x")
        one_line(caught, "cannot write")


@pytest.mark.skipif(getattr(os, "geteuid", lambda: 1)() == 0, reason="root may write anywhere")
def test_a_read_only_folder_is_said(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(EnpointeError) as caught:
        write_text(tmp_path / "dance.txt", "x")
    one_line(caught, "no leave to write")


@pytest.mark.parametrize("code", [errno.EACCES, errno.EPERM, errno.EROFS])
def test_a_folder_that_refuses_is_said_to_root_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int
) -> None:
    def refuse(path: Path, _data: bytes) -> NoReturn:
        raise OSError(code, os.strerror(code), str(path))

    monkeypatch.setattr(Path, "write_bytes", refuse)
    with pytest.raises(EnpointeError) as caught:
        write_text(tmp_path / "dance.txt", "x")
    one_line(caught, "no leave to write", str(tmp_path))


def test_a_folder_is_made_sure_of_and_left_as_it_was(tmp_path: Path) -> None:
    refuse_unwritable(tmp_path / "new" / "newer" / "a.npz")
    assert list(tmp_path.iterdir()) == []
    there = write_text(tmp_path / "a.txt", "as it was")
    refuse_unwritable(there)
    assert there.read_text(encoding="utf-8") == "as it was"
    with pytest.raises(EnpointeError, match="is a file where a folder should be"):
        refuse_unwritable(there / "b.npz")


def test_a_link_stays_and_the_file_it_points_to_is_replaced(tmp_path: Path) -> None:
    real = tmp_path / "real.txt"
    real.write_text("old")
    link = tmp_path / "link.txt"
    link.symlink_to(real)
    write_text(link, "new")
    assert link.is_symlink()
    assert real.read_text() == "new"


def test_the_leave_to_read_a_file_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "dance.txt"
    path.write_text("old")
    path.chmod(0o640)
    write_text(path, "new")
    assert path.stat().st_mode & 0o777 == 0o640


def test_of_two_writers_one_wins_whole(tmp_path: Path) -> None:
    path = tmp_path / "dance.bin"
    contents = [bytes([letter]) * 200_000 for letter in b"abcdefgh"]
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda data: write_bytes(path, data), contents))
    assert path.read_bytes() in contents
    assert names(tmp_path) == ["dance.bin"]
