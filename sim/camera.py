"""Where a picture is taken from, and what is drawn over the dancer; both painters share these."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw

from enpointe.errors import RenderError

__all__ = ["VIEWS", "Overlays", "Projection", "View"]

FloatArray = NDArray[np.float64]

NEAREST = 0.05
"""m; what is closer to the camera isn't drawn."""
FARTHEST = 1.0e3
"""m; what is farther from the camera isn't drawn."""
CLOSEST_FIT = 0.5
"""m; a view is fitted with at least this much between the camera and every point."""
PIXELS_MAX = 1.0e5
"""What would lie farther outside the picture isn't drawn."""
COM_INK, SUPPORT_INK, FORCE_INK = (214, 40, 40), (33, 118, 178), (236, 134, 28)
COM_RADIUS = 0.035
"""m, of the mark on the floor below the CoM."""


@dataclass(frozen=True, slots=True)
class View:
    """A camera that looks at a point from a direction, as MuJoCo's free camera does.

    The audience sits at +x and looks towards -x, so the dancer's left (+y) is on the picture's
    right in every view from the front.

    Attributes:
        azimuth: Heading of the line of sight about z, degrees; 0 looks along +x.
        elevation: Pitch of the line of sight, degrees; -90 looks straight down.
        distance: From the camera to the point looked at, m.
        lookat: The point looked at, m. When following, x and y are offsets from the CoM.
        fovy: Vertical opening of the lens, degrees.
        follow: Keep the CoM's place on the floor where `lookat` says. The height stays fixed, so
            that a jump still rises in the picture.
    """

    azimuth: float = 180.0
    elevation: float = -6.0
    distance: float = 4.8
    lookat: tuple[float, float, float] = (0.0, 0.0, 1.0)
    fovy: float = 30.0
    follow: bool = False

    def __post_init__(self) -> None:
        numbers = (self.azimuth, self.elevation, self.distance, self.fovy, *self.lookat)
        if not all(map(math.isfinite, numbers)):
            raise RenderError("a view needs finite numbers")
        if self.distance <= 0.0 or not 0.0 < self.fovy < 180.0:
            raise RenderError(
                f"a view needs a distance above 0 m and a lens between 0 and 180 degrees, "
                f"not {self.distance:g} m and {self.fovy:g} degrees"
            )

    @classmethod
    def audience(cls) -> View:
        """From the stalls, straight in front."""
        return cls()

    @classmethod
    def wings(cls) -> View:
        """From the wing on the dancer's right: the audience is on the picture's right."""
        return cls(azimuth=90.0)

    @classmethod
    def three_quarter(cls) -> View:
        """From the front, round to the dancer's right and a little above."""
        return cls(azimuth=150.0, elevation=-16.0)

    @classmethod
    def above(cls) -> View:
        """From the flies, with the audience at the bottom of the picture, as choreographers draw.

        The dancer's left is on the picture's right, as it is from the audience.
        """
        return cls(azimuth=180.0, elevation=-90.0, distance=6.0, lookat=(0.0, 0.0, 0.0))

    @classmethod
    def named(cls, name: str) -> View:
        """The preset of that name.

        Raises:
            RenderError: There is none; the message lists those there are.
        """
        try:
            return VIEWS[name]()
        except KeyError:
            known = ", ".join(VIEWS)
            raise RenderError(f"no view is called {name!r}; choose one of: {known}") from None

    def following(self) -> View:
        """This view, moving with the CoM over the floor."""
        return replace(self, follow=True, lookat=(0.0, 0.0, self.lookat[2]))

    def aimed(self, com: ArrayLike) -> View:
        """This view with its look-at point in the world, given the CoM (3,) in m."""
        if not self.follow:
            return self
        x, y, _ = np.asarray(com, dtype=np.float64)
        if not (math.isfinite(x) and math.isfinite(y)):
            return replace(self, follow=False)
        lookat = (float(x) + self.lookat[0], float(y) + self.lookat[1], self.lookat[2])
        return replace(self, follow=False, lookat=lookat)

    def axes(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Unit vectors (3,) of the picture's right, its up, and the line of sight."""
        azimuth, elevation = math.radians(self.azimuth), math.radians(self.elevation)
        ca, sa = math.cos(azimuth), math.sin(azimuth)
        ce, se = math.cos(elevation), math.sin(elevation)
        right = np.array([sa, -ca, 0.0])
        up = np.array([-se * ca, -se * sa, ce])
        sight = np.array([ce * ca, ce * sa, se])
        return right, up, sight

    def fitted(self, points: ArrayLike, *, aspect: float = 1.0, margin: float = 1.08) -> View:
        """This direction, aimed and backed off so that every point is in the picture.

        Args:
            points: (N, 3) in m, N at least 1.
            aspect: Width over height of the picture.
            margin: How much wider than the points the picture is.

        Raises:
            RenderError: There are no points, or they are not finite.
        """
        cloud = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        if len(cloud) == 0 or not np.isfinite(cloud).all():
            raise RenderError("a view can only be fitted to finite points (N, 3), N at least 1")
        frame = np.stack(self.axes())
        seen = cloud @ frame.T
        centre = (seen.min(axis=0) + seen.max(axis=0)) / 2.0
        across, upward, deep = (seen - centre).T
        tangent = math.tan(math.radians(self.fovy) / 2.0) / margin
        before = np.maximum(np.abs(across) / aspect, np.abs(upward)) / tangent
        distance = float((np.maximum(before, CLOSEST_FIT) - deep).max())
        x, y, z = (float(number) for number in centre @ frame)
        return replace(self, lookat=(x, y, z), distance=distance, follow=False)


VIEWS: dict[str, Callable[[], View]] = {
    "audience": View.audience,
    "wings": View.wings,
    "three-quarter": View.three_quarter,
    "above": View.above,
}
"""The presets by the names that people type."""


class Projection:
    """A pinhole camera: world points to pixels of one picture.

    Args:
        view: The view, already aimed.
        width: Of the picture, pixels.
        height: Of the picture, pixels.
    """

    def __init__(self, view: View, width: int, height: int) -> None:
        right, up, sight = view.axes()
        self.rotation = np.stack([right, -up, sight])
        """(3, 3): world directions to the camera's right, down and depth."""
        self.position = np.asarray(view.lookat, dtype=np.float64) - view.distance * sight
        """(3,) m, of the camera in the world."""
        self.focal = height / 2.0 / math.tan(math.radians(view.fovy) / 2.0)
        """Pixels for a metre at a metre's depth."""
        self.centre = (width / 2.0, height / 2.0)

    def to_camera(self, points: ArrayLike) -> FloatArray:
        """World points (..., 3) m to the camera's right, down and depth (..., 3) m."""
        moved: FloatArray = np.asarray(points, dtype=np.float64) - self.position
        seen: FloatArray = moved @ self.rotation.T
        return seen

    def to_pixels(self, seen: FloatArray) -> FloatArray:
        """Camera points (..., 3) m of positive depth to pixels (..., 2), the origin top left."""
        pixels: FloatArray = self.focal * seen[..., :2] / seen[..., 2:] + np.array(self.centre)
        return pixels

    def pixels(self, points: ArrayLike) -> FloatArray:
        """World points (..., 3) m in front of the camera to pixels (..., 2)."""
        return self.to_pixels(self.to_camera(points))

    def pixels_ahead(self, points: FloatArray) -> list[tuple[float, float]] | None:
        """World points (N, 3) m as pixels; None where one is behind the camera or very far off."""
        seen = self.to_camera(points)
        if not bool(((seen[:, 2] > NEAREST) & (seen[:, 2] < FARTHEST)).all()):
            return None
        pixels = self.to_pixels(seen)
        if not bool((np.abs(pixels) < PIXELS_MAX).all()):
            return None
        return [(float(x), float(y)) for x, y in pixels]

    def floor_grid(self, middle: FloatArray, reach: float, step: float) -> list[list[float]]:
        """A square grid on the floor as pixel segments [x, y, x, y], all in front of the camera.

        Args:
            middle: Of the grid, (3,) m.
            reach: From the middle to each edge, m.
            step: Between lines, m.
        """
        lines = np.arange(-reach, reach + step / 2.0, step)
        across, along = np.meshgrid(lines, lines, indexing="ij")
        knots = np.stack([across, along, np.zeros_like(across)], axis=-1)
        seen = self.to_camera(np.concatenate([knots, knots[..., [1, 0, 2]]]) + middle)
        pixels = self.to_pixels(seen)
        drawn = (seen[..., 2] > NEAREST) & (np.abs(pixels) < PIXELS_MAX).all(axis=-1)
        segments = np.concatenate([pixels[:, :-1], pixels[:, 1:]], axis=-1)
        kept: list[list[float]] = segments[drawn[:, :-1] & drawn[:, 1:]].tolist()
        return kept


@dataclass(frozen=True, slots=True, eq=False)
class Overlays:
    """What to draw over the dancer in one picture.

    Attributes:
        com: Mark the place on the floor below the CoM.
        support: Corners of the support polygon in order, (N, 2) or (N, 3) m, or None.
        force_points: Where contact forces act, (K, 3) m, or None.
        forces: The forces on the dancer, (K, 3) N, or None.
        metres_per_newton: How long an arrow is drawn.
    """

    com: bool = False
    support: FloatArray | None = None
    force_points: FloatArray | None = None
    forces: FloatArray | None = None
    metres_per_newton: float = 1.0e-3

    def outline(self, floor: float) -> FloatArray:
        """Corners (N, 3) m of the support polygon, at the floor's height where they have none."""
        if self.support is None or len(self.support) == 0:
            return np.empty((0, 3))
        corners = np.asarray(self.support, dtype=np.float64)
        if corners.ndim != 2 or corners.shape[1] not in (2, 3):
            raise RenderError(f"a support polygon is (N, 2) or (N, 3), not {corners.shape}")
        if corners.shape[1] == 2:
            corners = np.column_stack([corners, np.full(len(corners), floor)])
        return corners

    def arrows(self) -> list[tuple[FloatArray, FloatArray]]:
        """Tail and tip (3,) m of each force worth drawing (a millimetre or more)."""
        if self.force_points is None or self.forces is None:
            return []
        tails = np.asarray(self.force_points, dtype=np.float64)
        forces = np.asarray(self.forces, dtype=np.float64)
        if tails.shape != forces.shape or tails.ndim != 2 or tails.shape[1] != 3:
            raise RenderError(
                f"forces and their points are (K, 3) each, not {forces.shape} and {tails.shape}"
            )
        lengths = forces * self.metres_per_newton
        drawn = np.isfinite(tails).all(axis=1) & (np.linalg.norm(lengths, axis=1) > 1.0e-3)
        return [
            (tail, tail + length) for tail, length in zip(tails[drawn], lengths[drawn], strict=True)
        ]

    def draw_support(
        self, canvas: Image.Image, projection: Projection, floor: float, pen_width: int
    ) -> None:
        """Draw in ink the outline of the support polygon."""
        corners = self.outline(floor)
        ends = projection.pixels_ahead(corners) if len(corners) else None
        if ends is not None:
            ImageDraw.Draw(canvas).line([*ends, ends[0]], fill=SUPPORT_INK, width=2 * pen_width)

    def draw_com(
        self, canvas: Image.Image, projection: Projection, floor: float, com: FloatArray
    ) -> None:
        """Draw in ink the mark on the floor below the CoM (3,) m."""
        turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        disc = COM_RADIUS * np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
        rim = projection.pixels_ahead(disc + np.array([com[0], com[1], floor]))
        if self.com and rim is not None:
            ImageDraw.Draw(canvas).polygon(rim, fill=COM_INK)

    def draw_forces(self, canvas: Image.Image, projection: Projection, pen_width: int) -> None:
        """Draw in ink the arrows, over the dancer: they start inside the foot."""
        pen = ImageDraw.Draw(canvas)
        for tail, tip in self.arrows():
            ends = projection.pixels_ahead(np.stack([tail, tip]))
            if ends is not None:
                _draw_arrow(pen, np.array(ends[0]), np.array(ends[1]), pen_width)


def _draw_arrow(
    pen: ImageDraw.ImageDraw, start: FloatArray, end: FloatArray, pen_width: int
) -> None:
    length = float(np.linalg.norm(end - start))
    if length < 1.0:
        return
    along = (end - start) / length
    aside = np.array([-along[1], along[0]])
    barb = min(7.0 * pen_width, length)
    neck = end - barb * along
    pen.line([tuple(start.tolist()), tuple(neck.tolist())], fill=FORCE_INK, width=2 * pen_width)
    head = (end, neck + 0.45 * barb * aside, neck - 0.45 * barb * aside)
    pen.polygon([tuple(corner.tolist()) for corner in head], fill=FORCE_INK)
