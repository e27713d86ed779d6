"""Motions on disk: nothing is lost, and a damaged file is an error with the file's name."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from enpointe.errors import FormatError
from enpointe.motion import Event, Motion
from enpointe.motion.npz import load_arrays, load_motion, motion_arrays, save_motion

from .dancing import solver, tiny_model
from .test_motion import swinging


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    path = tmp_path / "swing.npz"
    save_motion(swinging(), path)
    return path


def same(a: Motion, b: Motion) -> bool:
    return (
        all(
            np.array_equal(getattr(a, n), getattr(b, n))
            and getattr(a, n).dtype == getattr(b, n).dtype
            for n in ("time", "qpos", "qvel", "qacc")
        )
        and a.events == b.events
        and a.name == b.name
    )


def test_nothing_is_lost(stored: Path) -> None:
    assert same(load_motion(stored, tiny_model()), swinging())


def test_hard_numbers_and_names_survive(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    time = np.r_[0.0, np.cumsum(rng.uniform(1e-300, 1e-3, 9))]
    qpos, qvel, qacc = (
        rng.normal(size=(10, n)) * 10.0 ** rng.integers(-300, 300, (10, n)) for n in (8, 7, 7)
    )
    events = (
        Event(0.0, "key pose", "à la seconde · 第五", None),
        Event(1e-9, "contact", "", 1 / 3),
    )
    motion = Motion(tiny_model(), time, qpos, qvel, qacc, events, "pas de chat\n")
    save_motion(motion, tmp_path / "m.npz")
    assert same(load_motion(tmp_path / "m.npz", tiny_model()), motion)


def test_a_motion_without_events(tmp_path: Path) -> None:
    motion = Motion.from_qpos(tiny_model(), [0.0, 1.0], np.tile([0, 0, 0, 1, 0, 0, 0, 0], (2, 1)))
    save_motion(motion, tmp_path / "m.npz")
    assert load_motion(tmp_path / "m.npz", tiny_model()).events == ()


@pytest.mark.parametrize("at", range(24))
def test_a_file_cut_short_is_refused(stored: Path, at: int) -> None:
    data = stored.read_bytes()
    cut = int(np.random.default_rng(at).integers(0, len(data)))
    stored.write_bytes(data[:cut])
    with pytest.raises(FormatError) as refused:
        load_motion(stored, tiny_model())
    assert str(stored) in str(refused.value)


def test_flipped_bytes_are_noticed_or_do_not_matter(stored: Path) -> None:
    data, rng = stored.read_bytes(), np.random.default_rng(11)
    refused = 0
    for _ in range(300):
        hurt = bytearray(data)
        hurt[int(rng.integers(len(hurt)))] ^= int(rng.integers(1, 256))
        stored.write_bytes(bytes(hurt))
        try:
            unharmed = same(load_motion(stored, tiny_model()), swinging())
        except FormatError as error:
            refused += 1
            unharmed = "\n" not in str(error)
        assert unharmed
    assert refused > 200


@pytest.mark.parametrize(
    "content", [b"", b"benesh 1\n", b"\x93NUMPY\x01\x00", b"PK\x05\x06" + bytes(18)]
)
def test_another_file_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "x.npz"
    path.write_bytes(content)
    with pytest.raises(FormatError):
        load_motion(path, tiny_model())


def test_a_plain_array_is_refused(tmp_path: Path) -> None:
    np.save(tmp_path / "x.npy", np.zeros(3))
    with pytest.raises(FormatError):
        load_motion(tmp_path / "x.npy", tiny_model())


def test_pickles_are_never_opened(tmp_path: Path) -> None:
    arrays = motion_arrays(swinging()) | {"name": np.array([{"a": 1}], dtype=object)}
    np.savez(tmp_path / "x.npz", format=np.array("enpointe motion 1"), **arrays)
    with pytest.raises(FormatError):
        load_motion(tmp_path / "x.npz", tiny_model())


def test_a_missing_file_and_a_folder(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="there is no such file"):
        load_motion(tmp_path / "no.npz", tiny_model())
    with pytest.raises(FormatError):
        load_motion(tmp_path, tiny_model())


def test_another_body_is_refused(stored: Path) -> None:
    with pytest.raises(FormatError, match=r"a body with coordinates \(401, 8\), not 43"):
        load_motion(stored, solver().model)


def test_another_format_says_which(stored: Path) -> None:
    with pytest.raises(
        FormatError, match="expected 'enpointe recording 1', found 'enpointe motion 1'"
    ):
        load_arrays(stored, "enpointe recording 1")


def test_a_format_from_the_future_is_refused(tmp_path: Path) -> None:
    arrays: dict[str, Any] = motion_arrays(swinging())
    np.savez(tmp_path / "x.npz", format=np.array("enpointe motion 2"), **arrays)
    with pytest.raises(FormatError, match="enpointe motion 2"):
        load_motion(tmp_path / "x.npz", tiny_model())


@pytest.mark.parametrize("name", motion_arrays(swinging()))
def test_a_missing_part_is_named(tmp_path: Path, name: str) -> None:
    arrays: dict[str, Any] = motion_arrays(swinging())
    del arrays[name]
    np.savez(tmp_path / "x.npz", format=np.array("enpointe motion 1"), **arrays)
    with pytest.raises(FormatError, match=name):
        load_motion(tmp_path / "x.npz", tiny_model())


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("qpos", np.array(1.0)),
        ("qpos", np.zeros((3, 8))),
        ("qvel", np.full((401, 7), np.nan)),
        ("qacc", np.array(["a"])),
        ("time", np.array(0.0)),
        ("time", np.zeros(401)),
        ("event_time", np.zeros(7)),
        ("event_time", np.array(["a", "b"])),
        ("event_kind", np.array("key pose")),
    ],
)
def test_parts_that_do_not_fit_are_refused(tmp_path: Path, name: str, value: np.ndarray) -> None:
    arrays = motion_arrays(swinging()) | {name: value}
    np.savez(tmp_path / "x.npz", format=np.array("enpointe motion 1"), **arrays)
    with pytest.raises(FormatError):
        load_motion(tmp_path / "x.npz", tiny_model())
