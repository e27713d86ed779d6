"""The film of a dance, or of several side by side."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from enpointe.danced import Danced
from enpointe.motion import Motion
from enpointe.preparing import Progress
from enpointe.report.ground import support_at
from enpointe.report.pictures import ASPECT, fitted_view
from enpointe.sim.camera import Overlays, View
from enpointe.sim.render import gl_backend, open_painter
from enpointe.sim.video import (
    can_write_mp4,
    film,
    frame_samples,
    side_by_side,
    write_gif,
    write_mp4,
)

__all__ = ["HALL", "FilmFile", "FilmSize", "counter", "film_of", "some_poses"]

HEIGHT_ONE, HEIGHT_SEVERAL = 600, 400
FPS, FPS_SLOW = 20.0, 10.0
"""Frames a second; slow for a GIF, which is large, and for the sketch painter, which is slow."""
FRAMES_MAX, FRAMES_MAX_SKETCHED = 700, 250
"""A long dance gets fewer frames a second instead of a film that takes minutes to paint."""
FPS_MIN = 4.0
SMALLER = 0.6
"""Scale of a GIF and of a sketched film."""
HALL = View(elevation=-9.0)
"""From the audience, a little above so that the floor is seen."""
_FITTED_POSES = 40


@dataclass(frozen=True, slots=True)
class FilmFile:
    """A film, written.

    Attributes:
        name: Of the file.
        data: Its bytes.
        mime: "video/mp4" or "image/gif".
        size: Width and height, pixels.
    """

    name: str
    data: bytes
    mime: str
    size: tuple[int, int]


@dataclass(frozen=True, slots=True)
class FilmSize:
    """How large and how fine a film is that this machine can paint in time.

    Attributes:
        width: Of each of those side by side, pixels.
        height: Pixels.
        fps: Frames a second.
        mp4: Whether it is one, and not a GIF.
    """

    width: int
    height: int
    fps: float
    mp4: bool

    @classmethod
    def of(cls, durations: Sequence[float]) -> FilmSize:
        """For dances of so many seconds, side by side if there are several."""
        mp4, sketched = can_write_mp4(), gl_backend() is None
        height = HEIGHT_SEVERAL if len(durations) > 1 else HEIGHT_ONE
        if sketched or not mp4:
            height = int(SMALLER * height)
        wanted = FPS if mp4 and not sketched else FPS_SLOW
        most = FRAMES_MAX_SKETCHED if sketched else FRAMES_MAX
        affordable = most / (max(durations) * len(durations))
        fps = max(min(wanted, affordable), FPS_MIN)
        return cls(round(ASPECT * height), height, fps, mp4)

    def write(self, folder: Path, pictures: Iterator[Image.Image]) -> FilmFile:
        """Write a film into a folder, and read it back."""
        first = next(pictures)
        name = "dance.mp4" if self.mp4 else "dance.gif"
        write = write_mp4 if self.mp4 else write_gif
        path = write(folder / name, itertools.chain([first], pictures), self.fps)
        mime = "video/mp4" if self.mp4 else "image/gif"
        return FilmFile(name, path.read_bytes(), mime, first.size)


def film_of(performances: Mapping[str, Danced], progress: Progress, view: View = HALL) -> FilmFile:
    """Film performances, side by side if there are several.

    Args:
        performances: By caption; a single one needs none.
        progress: Told how many frames are painted.
        view: From where; so far back that all are in the picture.
    """
    motions = [p.danced for p in performances.values()]
    size = FilmSize.of([motion.duration for motion in motions])
    view = fitted_view(motions[0].model, [pose for m in motions for pose in some_poses(m)], view)
    count = counter(motions, size.fps, progress)
    # One painter serves all: contexts are dear, and the variants share the body.
    painter, _ = open_painter(motions[0].model, size.width, size.height)
    with painter, TemporaryDirectory() as folder:
        reels = [
            film(
                motion.time,
                motion.qpos,
                painter,
                view,
                size.fps,
                overlays=_overlays(performance),
                progress=count,
            )
            for performance, motion in zip(performances.values(), motions, strict=True)
        ]
        several = len(performances) > 1
        return size.write(
            Path(folder), side_by_side(reels, list(performances)) if several else reels[0]
        )


def some_poses(motion: Motion) -> list[NDArray[np.float64]]:
    """Poses of a motion, evenly from all of it, to fit a view to; each (nq,)."""
    some = np.unique(np.linspace(0, len(motion.qpos) - 1, _FITTED_POSES).astype(int))
    return list(motion.qpos[some])


def counter(
    motions: Iterable[Motion], fps: float, progress: Progress
) -> Callable[[int, int], None]:
    """What `film` is to call for each frame of all the motions of one film."""
    frames = sum(len(frame_samples(motion.time, fps)) for motion in motions)
    painted = itertools.count(1)
    return lambda _done, _total: progress("film", next(painted), frames)


def _overlays(performance: Danced) -> Callable[[int], Overlays | None] | None:
    """The CoM's place on the floor and the support polygon, for a physical performance."""
    recording = performance.recording
    if recording is None:
        return None
    return lambda sample: Overlays(com=True, support=support_at(recording, sample))
