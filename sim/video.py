"""Films: pictures at exact times, side by side, written as GIF or MP4."""

from __future__ import annotations

import importlib.util
import itertools
import math
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw, ImageFont

from enpointe.errors import MotionError, RenderError
from enpointe.files import atomic_path
from enpointe.sim.camera import Overlays, View
from enpointe.sim.render import Painter

__all__ = ["can_write_mp4", "film", "frame_samples", "side_by_side", "write_gif", "write_mp4"]

GIF_FPS_MAX = 50.0
"""Browsers slow down GIF frames that are shorter than 20 ms."""
UNSEEN = 1e-4
"""m and rad: a thirtieth of a pixel where a dancer is 600 pixels high."""
UNCHANGED = 255
"""The palette index that is kept for "as in the frame before"."""
PALETTE_FRAMES = 12
CRF = "23"
CAPTION_PAPER, CAPTION_INK = (250, 247, 240), (48, 42, 42)
GAP = 2
"""Pixels between films that stand side by side."""


def frame_samples(time: ArrayLike, fps: float) -> NDArray[np.intp]:
    """Which sample each frame shows: the nearest to `time[0] + k / fps`, up to the last time.

    Args:
        time: (T,) s, rising, T at least 1.
        fps: Frames a second.

    Raises:
        MotionError: The times are not finite, don't rise or are none.
        RenderError: fps is not above 0.
    """
    _check_fps(fps)
    times = np.asarray(time, dtype=np.float64)
    if times.ndim != 1 or len(times) == 0:
        raise MotionError(f"a film needs times (T,), T at least 1, not {times.shape}")
    if not np.isfinite(times).all() or not (np.diff(times) > 0.0).all():
        raise MotionError("a film needs finite times that rise")
    count = math.floor((times[-1] - times[0]) * fps + 1e-6) + 1
    frames = times[0] + np.arange(count) / fps
    if len(times) == 1:
        return np.zeros(1, dtype=np.intp)
    after = np.clip(np.searchsorted(times, frames), 1, len(times) - 1)
    earlier = frames - times[after - 1] <= times[after] - frames
    nearest: NDArray[np.intp] = np.where(earlier, after - 1, after)
    return nearest


def film(
    time: ArrayLike,
    qpos: ArrayLike,
    painter: Painter,
    view: View,
    fps: float = 25.0,
    *,
    overlays: Callable[[int], Overlays | None] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Iterator[Image.Image]:
    """Paint a motion at exact frame times, one picture at a time.

    While nothing moves by more than `UNSEEN` since it was painted, its picture is shown again.

    Args:
        time: (T,) s, rising.
        qpos: (T, nq).
        painter: Open until the last picture is taken.
        view: Where the pictures are taken from.
        fps: Frames a second.
        overlays: What to draw over sample i, if anything.
        progress: Called with frames painted and frames in all, after each.

    Returns:
        The pictures, painted as they are asked for.

    Raises:
        MotionError: Times and poses don't make a motion.
        RenderError: fps is not above 0.
    """
    samples = frame_samples(time, fps)
    poses = np.asarray(qpos, dtype=np.float64)
    if poses.ndim != 2 or len(poses) != np.size(time):
        raise MotionError(f"{np.size(time)} times need (T, nq) poses, not {poses.shape}")

    def paint() -> Iterator[Image.Image]:
        painted: tuple[NDArray[np.float64], Overlays | None, Image.Image] | None = None
        for done, sample in enumerate(samples.tolist(), start=1):
            pose, marks = poses[sample], overlays(sample) if overlays is not None else None
            if painted is None or not (
                _looks_alike(pose, painted[0]) and _marked_alike(marks, painted[1])
            ):
                painted = pose, marks, painter.paint(pose, camera=view, overlays=marks)
            yield painted[2]
            if progress is not None:
                progress(done, len(samples))

    return paint()


def _looks_alike(first: ArrayLike | None, second: ArrayLike | None) -> bool:
    if first is None or second is None:
        return first is second
    return np.shape(first) == np.shape(second) and bool(
        np.allclose(first, second, rtol=0.0, atol=UNSEEN)
    )


def _marked_alike(first: Overlays | None, second: Overlays | None) -> bool:
    """Whether two pictures of one pose would be marked alike; forces are drawn as they are."""
    if first is None or second is None or first.com is not second.com:
        return first is second
    forceless = first.forces is None and second.forces is None
    return forceless and _looks_alike(first.support, second.support)


def side_by_side(
    films: Sequence[Iterable[Image.Image]], captions: Sequence[str]
) -> Iterator[Image.Image]:
    """Join films left to right, each over its caption; one that ends early holds its last picture.

    Args:
        films: Each yields pictures of one size.
        captions: One a film; an empty one leaves its strip blank.

    Raises:
        RenderError: No films, another number of captions, or a film without pictures.
    """
    if not films or len(films) != len(captions):
        raise RenderError(f"{len(films)} films side by side need as many captions, at least one")

    def join() -> Iterator[Image.Image]:
        reels = [iter(pictures) for pictures in films]
        shown = [next(reel, None) for reel in reels]
        first = [picture for picture in shown if picture is not None]
        if len(first) < len(reels):
            raise RenderError(f"film {shown.index(None) + 1} has no pictures")
        strips = [
            _caption(picture.width, text) for picture, text in zip(first, captions, strict=True)
        ]
        latest, going = first, True
        while going:
            yield _joined(latest, strips)
            shown = [next(reel, None) for reel in reels]
            going = any(picture is not None for picture in shown)
            latest = [
                new if new is not None else old for new, old in zip(shown, latest, strict=True)
            ]

    return join()


def write_gif(path: str | Path, frames: Iterable[Image.Image], fps: float) -> Path:
    """Write an endless GIF with one palette for all its frames.

    GIF counts in ticks of 10 ms: each frame lasts until the tick nearest to the next one's time,
    so that the film keeps time at any rate. A frame the same as the one before lengthens it.

    Args:
        path: The file to write.
        frames: Pictures of one size.
        fps: Frames a second, at most 50.

    Returns:
        The path.

    Raises:
        RenderError: No frames, frames of several sizes, or a rate that GIF can't show.
    """
    _check_fps(fps)
    if fps > GIF_FPS_MAX:
        raise RenderError(f"a GIF shows at most 50 frames a second, not {fps:g}: write an MP4")
    size, packed = _packed(frames)
    palette = _shared_palette(size, packed)
    # The last index stands for "unchanged"; its colour is all but the first one's, which steps in.
    lookup = [*range(UNCHANGED), 0]
    pictures = (
        _unpacked(size, pixels).quantize(palette=palette, dither=Image.Dither.NONE).point(lookup)
        for pixels in packed
    )
    ticks = [round(100.0 * frame / fps) for frame in range(len(packed) + 1)]
    durations = [10 * (end - start) for start, end in itertools.pairwise(ticks)]
    target = Path(path)
    with atomic_path(target) as unfinished:
        next(pictures).save(
            unfinished,
            format="GIF",
            save_all=True,
            append_images=pictures,
            duration=durations if len(durations) > 1 else durations[0],
            loop=0,
            palette=bytes(palette.getpalette() or []),
            optimize=True,
            transparency=UNCHANGED,
            disposal=1,
        )
    return target


def can_write_mp4() -> bool:
    """Whether `av` is installed here with an H.264 encoder."""
    if importlib.util.find_spec("av") is None:
        return False
    try:
        import av

        av.codec.Codec("libx264", "w")
    except (ImportError, OSError, ValueError):
        return False
    return True


def write_mp4(path: str | Path, frames: Iterable[Image.Image], fps: float) -> Path:
    """Write an H.264 film that plays everywhere (yuv420p, constant quality 23).

    Odd sizes are made even by repeating the last row or column.

    Args:
        path: The file to write.
        frames: Pictures of one size.
        fps: Frames a second.

    Returns:
        The path.

    Raises:
        RenderError: `av` is missing, there are no frames, or they have several sizes.
    """
    _check_fps(fps)
    if not can_write_mp4():
        raise RenderError(
            "MP4 needs the video extra: pip install 'enpointe[video]', or write a GIF"
        )
    import av

    rate = Fraction(fps).limit_denominator(1001)
    reel = _one_size(frames)
    first = next(reel, None)
    if first is None:
        raise RenderError("a film needs at least one frame")
    target = Path(path)
    with atomic_path(target) as unfinished, av.open(str(unfinished), "w", format="mp4") as box:
        stream = box.add_stream("libx264", rate=rate, options={"crf": CRF, "preset": "veryfast"})
        stream.width, stream.height = (side + side % 2 for side in first.size)
        stream.pix_fmt = "yuv420p"
        for index, picture in enumerate(itertools.chain([first], reel)):
            pixels = np.asarray(picture.convert("RGB"))
            odd = [(0, side % 2) for side in pixels.shape[:2]]
            frame = av.VideoFrame.from_ndarray(np.pad(pixels, [*odd, (0, 0)], mode="edge"))
            frame.pts, frame.time_base = index, 1 / rate
            box.mux(stream.encode(frame))
        box.mux(stream.encode())
    return target


def _check_fps(fps: float) -> None:
    if not (math.isfinite(fps) and fps > 0.0):
        raise RenderError(f"a film needs a rate above 0 frames a second, not {fps:g}")


def _one_size(frames: Iterable[Image.Image]) -> Iterator[Image.Image]:
    size: tuple[int, int] | None = None
    for frame in frames:
        size = size or frame.size
        if frame.size != size:
            raise RenderError(f"the frames of a film have one size, not {size} and {frame.size}")
        yield frame


def _packed(frames: Iterable[Image.Image]) -> tuple[tuple[int, int], list[bytes]]:
    """The size and the squeezed pixels of each frame: the palette needs to see them all first."""
    size, packed = (0, 0), []
    for frame in _one_size(frames):
        size = frame.size
        packed.append(zlib.compress(frame.convert("RGB").tobytes(), 1))
    if not packed:
        raise RenderError("a film needs at least one frame")
    return size, packed


def _unpacked(size: tuple[int, int], pixels: bytes) -> Image.Image:
    return Image.frombytes("RGB", size, zlib.decompress(pixels))


def _shared_palette(size: tuple[int, int], packed: Sequence[bytes]) -> Image.Image:
    """A picture with 256 different colours, chosen from a few frames all through the film."""
    spread = np.linspace(0, len(packed) - 1, min(PALETTE_FRAMES, len(packed)))
    chosen = sorted({round(float(index)) for index in spread})
    sheet = Image.new("RGB", (size[0], size[1] * len(chosen)))
    for place, index in enumerate(chosen):
        sheet.paste(_unpacked(size, packed[index]), (0, place * size[1]))
    found = sheet.quantize(colors=UNCHANGED, method=Image.Quantize.MEDIANCUT).getpalette() or []
    # Pillow keeps indices as they are only where no colour comes twice.
    colours = list(dict.fromkeys(zip(found[::3], found[1::3], found[2::3], strict=True)))
    greys = ((level, level, level) for level in range(256))
    colours += [grey for grey in greys if grey not in colours]
    colours = colours[:UNCHANGED]
    red, green, blue = colours[0]
    beside = ((red, green, level) for level in sorted(range(256), key=lambda at: abs(at - blue)))
    colours.append(next(colour for colour in beside if colour not in colours))
    palette = Image.new("P", (1, 1))
    palette.putpalette(list(itertools.chain.from_iterable(colours)))
    return palette


def _caption(width: int, text: str) -> Image.Image:
    """A strip with the text in its middle, as large as fits."""
    height = max(22, width // 14)
    strip = Image.new("RGB", (width, height), CAPTION_PAPER)
    pen = ImageDraw.Draw(strip)
    for points in range(max(height * 6 // 10, 9), 8, -1):
        font = ImageFont.load_default(points)
        if pen.textlength(text, font=font) <= width - 8 or points == 9:
            pen.text((width / 2, height / 2), text, fill=CAPTION_INK, font=font, anchor="mm")
            break
    return strip


def _joined(pictures: Sequence[Image.Image], strips: Sequence[Image.Image]) -> Image.Image:
    tallest = max(picture.height for picture in pictures)
    foot = max(strip.height for strip in strips)
    width = sum(picture.width for picture in pictures) + GAP * (len(pictures) - 1)
    sheet = Image.new("RGB", (width, tallest + foot), CAPTION_PAPER)
    left = 0
    for picture, strip in zip(pictures, strips, strict=True):
        sheet.paste(picture, (left, (tallest - picture.height) // 2))
        sheet.paste(strip, (left, tallest))
        left += picture.width + GAP
    return sheet
