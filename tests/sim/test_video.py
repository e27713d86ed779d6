"""Films keep time, size and order, and are written whole or not at all."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import ArrayLike
from PIL import Image, ImageDraw
from PIL.GifImagePlugin import GifImageFile

from enpointe.errors import MotionError, RenderError
from enpointe.sim.camera import Overlays, View
from enpointe.sim.render import Painter
from enpointe.sim.video import (
    UNSEEN,
    can_write_mp4,
    film,
    frame_samples,
    side_by_side,
    write_gif,
    write_mp4,
)

needs_av = pytest.mark.skipif(not can_write_mp4(), reason="av is not installed")


def clock(count: int, size: tuple[int, int] = (60, 40)) -> list[Image.Image]:
    """Pictures with a bar that moves on in each."""
    pictures = []
    for index in range(count):
        picture = Image.new("RGB", size, (245, 240, 230))
        left = index * (size[0] - 6) // max(count - 1, 1)
        ImageDraw.Draw(picture).rectangle((left, 5, left + 5, 30), fill=(180, 20, 40))
        pictures.append(picture)
    return pictures


class GreyPainter(Painter):
    """Paints the first coordinate as a grey."""

    size = (16, 12)

    def paint(
        self, qpos: ArrayLike, *, camera: View, overlays: Overlays | None = None
    ) -> Image.Image:
        level = int(np.asarray(qpos)[0]) + (100 if overlays is not None else 0)
        return Image.new("RGB", self.size, (level, level, level))

    def close(self) -> None:
        """Nothing to give back."""


def level(picture: Image.Image) -> int:
    return int(np.asarray(picture)[0, 0, 0])


def broken(pictures: list[Image.Image]) -> Iterator[Image.Image]:
    yield from pictures
    raise RuntimeError("the painter died")


@given(
    steps=st.lists(st.floats(1e-3, 0.5), min_size=0, max_size=60),
    start=st.floats(-5.0, 5.0),
    fps=st.floats(1.0, 60.0),
)
def test_each_frame_shows_the_nearest_sample(steps: list[float], start: float, fps: float) -> None:
    time = start + np.concatenate([[0.0], np.cumsum(steps)])
    samples = frame_samples(time, fps)
    frames = time[0] + np.arange(len(samples)) / fps
    gaps = np.abs(frames[:, None] - time)
    np.testing.assert_allclose(gaps[np.arange(len(frames)), samples], gaps.min(axis=1))
    assert frames[-1] <= time[-1] + 1e-6
    assert frames[-1] + 1.0 / fps > time[-1]


def test_a_film_paints_marks_and_tells_how_far_it_is() -> None:
    time = np.arange(0.0, 1.0001, 0.01)
    qpos = np.arange(101.0)[:, None]
    heard: list[tuple[int, int]] = []
    pictures = list(
        film(
            time,
            qpos,
            GreyPainter(),
            View(),
            10.0,
            overlays=lambda sample: Overlays(com=True) if sample >= 50 else None,
            progress=lambda done, total: heard.append((done, total)),
        )
    )
    grey = [0, 10, 20, 30, 40, *range(150, 201, 10)]
    assert [level(picture) for picture in pictures] == grey
    assert heard == [(done, 11) for done in range(1, 12)]


class CountingPainter(GreyPainter):
    """Counts its pictures."""

    def __init__(self) -> None:
        self.painted: list[float] = []

    def paint(
        self, qpos: ArrayLike, *, camera: View, overlays: Overlays | None = None
    ) -> Image.Image:
        self.painted.append(float(np.asarray(qpos)[0]))
        return super().paint(qpos, camera=camera, overlays=overlays)


def test_what_stands_still_is_painted_once() -> None:
    """And a slow movement is never behind by more than can be seen."""
    time = np.arange(40) / 10.0
    rise = np.concatenate([np.zeros(20), 0.3 * UNSEEN * np.arange(20)])
    painter = CountingPainter()
    assert len(list(film(time, rise[:, None], painter, View(), 10.0))) == 40
    assert painter.painted[0] == 0.0
    assert len(painter.painted) == 5
    assert np.diff(painter.painted) == pytest.approx(1.2 * UNSEEN)


def test_marks_that_change_are_painted() -> None:
    foot, toes = np.eye(3)[:, :2], 0.5 * np.eye(3)[:, :2]
    marks = [None, Overlays(support=foot), Overlays(support=foot), Overlays(support=toes)]
    marks += [Overlays(support=toes, com=True), Overlays(support=toes[:2], com=True)]
    pushed = Overlays(
        support=toes[:2], com=True, force_points=np.zeros((1, 3)), forces=np.eye(3)[:1]
    )
    marks += [pushed, pushed]
    painter = CountingPainter()
    films = film(np.arange(8.0), np.zeros((8, 1)), painter, View(), 1.0, overlays=marks.__getitem__)
    assert len(list(films)) == 8
    assert len(painter.painted) == 7


@pytest.mark.parametrize(
    ("time", "qpos"),
    [
        ([], np.empty((0, 2))),
        ([0.0, 0.0], np.zeros((2, 2))),
        ([0.0, float("inf")], np.zeros((2, 2))),
        ([0.0, 1.0], np.zeros((3, 2))),
    ],
)
def test_what_is_no_motion_is_an_error_before_anything_is_painted(
    time: list[float], qpos: np.ndarray
) -> None:
    with pytest.raises(MotionError):
        film(time, qpos, GreyPainter(), View())


@pytest.mark.parametrize("fps", [0.0, -1.0, float("nan"), float("inf")])
def test_a_rate_that_is_none_is_an_error(tmp_path: Path, fps: float) -> None:
    with pytest.raises(RenderError, match="rate"):
        write_gif(tmp_path / "a.gif", clock(2), fps)


@pytest.mark.parametrize("fps", [8.0, 12.0, 15.0, 24.0, 25.0, 29.97, 30.0, 50.0])
def test_a_gif_keeps_its_frames_and_its_time(tmp_path: Path, fps: float) -> None:
    path = write_gif(tmp_path / "dance.gif", iter(clock(23)), fps)
    with GifImageFile(path) as gif:
        assert (gif.n_frames, gif.size, gif.info["loop"]) == (23, (60, 40), 0)
        duration = 0
        for index in range(23):
            gif.seek(index)
            duration += gif.info["duration"]
            assert abs(duration - 1000.0 * (index + 1) / fps) <= 5.0 + 1e-6
    assert [file.name for file in tmp_path.iterdir()] == ["dance.gif"]


def test_a_gif_looks_like_its_frames_and_shares_one_palette(tmp_path: Path) -> None:
    pictures = clock(12)
    path = write_gif(tmp_path / "dance.gif", pictures, 25.0)
    with Image.open(path) as gif:
        for index, picture in enumerate(pictures):
            gif.seek(index)
            wrong = np.asarray(gif.convert("RGB")).astype(int) - np.asarray(picture).astype(int)
            assert np.abs(wrong).max() < 16
    data = path.read_bytes()
    descriptors = [at for at in range(len(data)) if data[at : at + 4] == b"\x21\xf9\x04\x05"]
    local = [data[at + 8 + 9] & 0x80 for at in descriptors if data[at + 8] == 0x2C]
    assert local
    assert not any(local)


def test_equal_frames_lengthen_the_gif(tmp_path: Path) -> None:
    path = write_gif(tmp_path / "still.gif", clock(1) * 10, 10.0)
    with GifImageFile(path) as gif:
        assert gif.info["duration"] * gif.n_frames == 1000


def test_a_gif_faster_than_browsers_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match="50 frames a second"):
        write_gif(tmp_path / "a.gif", clock(2), 60.0)


@pytest.mark.parametrize("writer", [write_gif, pytest.param(write_mp4, marks=needs_av)])
def test_nothing_is_half_written(tmp_path: Path, writer: object) -> None:
    assert callable(writer)
    path = tmp_path / f"film.{'gif' if writer is write_gif else 'mp4'}"
    path.write_bytes(b"the film of yesterday")
    with pytest.raises(RuntimeError, match="died"):
        writer(path, broken(clock(3)), 25.0)
    with pytest.raises(RenderError, match="at least one"):
        writer(path, [], 25.0)
    with pytest.raises(RenderError, match="one size"):
        writer(path, [*clock(2), *clock(2, (30, 40))], 25.0)
    assert path.read_bytes() == b"the film of yesterday"
    assert list(tmp_path.iterdir()) == [path]


@needs_av
@pytest.mark.parametrize("size", [(60, 40), (61, 41)])
def test_an_mp4_keeps_its_frames_and_its_time(tmp_path: Path, size: tuple[int, int]) -> None:
    import av

    path = write_mp4(tmp_path / "dance.mp4", clock(23, size), 29.97)
    with av.open(str(path)) as box:
        stream = box.streams.video[0]
        times, pictures = [], []
        for frame in box.decode(stream):
            assert frame.pts is not None
            assert frame.time_base is not None
            times.append(float(frame.pts * frame.time_base))
            pictures.append(frame.to_ndarray(format="rgb24"))
        assert (stream.codec_context.name, stream.codec_context.pix_fmt) == ("h264", "yuv420p")
    assert pictures[0].shape == (40 + size[1] % 2 * 2, 60 + size[0] % 2 * 2, 3)
    np.testing.assert_allclose(times, np.arange(23) / 29.97, atol=1e-3)
    truth = np.asarray(clock(23, size)[10]).astype(int)
    assert np.abs(pictures[10][: size[1], : size[0]].astype(int) - truth).mean() < 12


def test_mp4_without_av_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("enpointe.sim.video.can_write_mp4", lambda: False)
    with pytest.raises(RenderError, match=r"pip install 'enpointe\[video\]'"):
        write_mp4(tmp_path / "a.mp4", clock(2), 25.0)


def test_films_stand_side_by_side_over_their_captions() -> None:
    short = [Image.new("RGB", (40, 30), (level, 0, 0)) for level in (10, 20)]
    long = [Image.new("RGB", (60, 50), (0, level, 0)) for level in (10, 20, 30)]
    sheets = list(side_by_side([short, iter(long)], ["physical", "kinematic"]))
    assert len(sheets) == 3
    assert len({sheet.size for sheet in sheets}) == 1
    width, height = sheets[0].size
    assert width >= 100
    assert height > 50
    reds = [np.asarray(sheet)[20, 10, 0] for sheet in sheets]
    greens = [np.asarray(sheet)[20, width - 10, 1] for sheet in sheets]
    assert reds == [10, 20, 20]
    assert greens == [10, 20, 30]
    strip = np.asarray(sheets[0].convert("L"))[50:]
    assert (strip[:, :40] < 128).any()
    assert (strip[:, -60:] < 128).any()


@pytest.mark.parametrize(
    ("films", "captions"), [([], []), ([clock(1)], ["a", "b"]), ([clock(1), []], ["a", "b"])]
)
def test_films_that_cannot_be_joined_are_errors(
    films: list[list[Image.Image]], captions: list[str]
) -> None:
    with pytest.raises(RenderError):
        list(side_by_side(films, captions))
