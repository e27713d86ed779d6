"""A dancer drawn in ink and wash on paper, without OpenGL.

Each geom is met exactly by the line of sight through each pixel (quadrics and capsules in closed
form, meshes by interpolation over their triangles), the nearest one wins, and the winner's surface
is washed with light and inked where the depth jumps.
"""

from __future__ import annotations

import functools

import mujoco
import numpy as np
from mujoco import mjtGeom
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw, ImageFilter

from enpointe.errors import RenderError
from enpointe.sim.camera import FARTHEST, NEAREST, Overlays, Projection, View
from enpointe.sim.render import Painter, checked_qpos, checked_size, floor_height

__all__ = ["SketchPainter"]

FloatArray = NDArray[np.float64]

SUPERSAMPLE = 2
PAPER_TOP, PAPER_BOTTOM = (250, 247, 240), (238, 232, 220)
GRID, SHADE = (219, 211, 197), (96, 84, 78)
GRID_REACH, GRID_STEP = 6.0, 0.5
INK = np.array([58.0, 48.0, 48.0], dtype=np.float32)
INK_JUMP = 0.03
"""m; a step in depth that gets a line."""
LAMP = np.array([-0.42, -0.66, -0.62])
"""Towards the light, in the camera's right, down and depth: over the painter's left shoulder."""
UNPAINTED = np.array([0.5, 0.5, 0.5, 1.0], dtype=np.float32)
"""MuJoCo's default geom colour, which gives way to the material's."""
ROUND = (mjtGeom.mjGEOM_SPHERE, mjtGeom.mjGEOM_ELLIPSOID, mjtGeom.mjGEOM_CAPSULE)
FACETED = (mjtGeom.mjGEOM_CYLINDER, mjtGeom.mjGEOM_BOX, mjtGeom.mjGEOM_MESH)

_Solid = tuple[FloatArray, FloatArray, NDArray[np.int32], NDArray[np.int32]]
"""Vertices (V, 3) m, normals (N, 3), and for the corners of each triangle their indices (F, 3)."""


class SketchPainter(Painter):
    """Paints with NumPy and Pillow alone: needs no OpenGL, driver or display.

    Visual geom groups 0 to 2 are drawn; planes become the paper floor.

    Args:
        model: The body, with its stage.
        width: Of the pictures, pixels.
        height: Of the pictures, pixels.

    Raises:
        RenderError: The size makes no picture.
    """

    def __init__(self, model: mujoco.MjModel, width: int, height: int) -> None:
        self.size = checked_size(width, height)
        self._model = model
        self._data = mujoco.MjData(model)
        self._floor = floor_height(model)
        self._geoms = [int(geom) for geom in range(model.ngeom) if _drawn(model, geom)]
        self._colours = np.zeros((model.ngeom, 3), dtype=np.float32)
        self._faces: dict[int, _Solid] = {}
        for geom in self._geoms:
            self._colours[geom] = 255.0 * np.clip(_rgba(model, geom)[:3], 0.0, 1.0)
            if _kind(model, geom) in FACETED:
                self._faces[geom] = _faces(model, geom)
        self._open = True

    def paint(
        self, qpos: ArrayLike, *, camera: View, overlays: Overlays | None = None
    ) -> Image.Image:
        """Paint one picture; see `Painter.paint`."""
        if not self._open:
            raise RenderError("this painter is closed")
        self._data.qpos[:] = checked_qpos(self._model, qpos)
        with np.errstate(all="ignore"):
            mujoco.mj_kinematics(self._model, self._data)
            mujoco.mj_comPos(self._model, self._data)
            com = np.array(self._data.subtree_com[0])
            view = camera.aimed(com)
            width, height = (SUPERSAMPLE * side for side in self.size)
            projection = Projection(view, width, height)
            canvas = _empty_stage(view, self.size, self._floor).copy()
            self._cast_shadow(canvas, projection)
            marks = overlays if overlays is not None else Overlays()
            marks.draw_support(canvas, projection, self._floor, SUPERSAMPLE)
            film = _Film(projection, width, height)
            for geom in self._geoms:
                self._expose(film, geom)
            canvas = film.over(canvas, self._colours)
            marks.draw_com(canvas, projection, self._floor, com)
            marks.draw_forces(canvas, projection, SUPERSAMPLE)
        return canvas.reduce(SUPERSAMPLE)

    def _expose(self, film: _Film, geom: int) -> None:
        kind, size = _kind(self._model, geom), self._model.geom_size[geom]
        place = np.array(self._data.geom_xpos[geom])
        turn = np.array(self._data.geom_xmat[geom]).reshape(3, 3)
        if not (np.isfinite(place).all() and np.isfinite(turn).all()):
            return
        if kind in (mjtGeom.mjGEOM_SPHERE, mjtGeom.mjGEOM_ELLIPSOID):
            film.expose_ellipsoid(geom, place, turn, np.where(size > 0.0, size, size[0]))
        elif kind == mjtGeom.mjGEOM_CAPSULE:
            axis = turn[:, 2] * size[1]
            film.expose_capsule(geom, place - axis, place + axis, float(size[0]))
        else:
            film.expose_faces(geom, place, turn, self._faces[geom])

    def _cast_shadow(self, canvas: Image.Image, projection: Projection) -> None:
        """Soft shadows straight below each geom, fainter the higher it is."""
        coarse = 8
        mask = Image.new("L", (canvas.width // coarse, canvas.height // coarse), 0)
        pen = ImageDraw.Draw(mask)
        turn = np.linspace(0.0, 2.0 * np.pi, 20, endpoint=False)
        circle = np.column_stack([np.cos(turn), np.sin(turn)])
        heights = self._data.geom_xpos[:, 2] - self._floor
        for geom in sorted(self._geoms, key=lambda geom: -heights[geom]):
            height = float(heights[geom])
            if not -0.2 < height < 6.0:
                continue
            turned = np.array(self._data.geom_xmat[geom]).reshape(3, 3)
            flat = turned[:2] * self._model.geom_aabb[geom].ravel()[3:]
            spread = flat @ flat.T + np.eye(2) * (0.02 + 0.05 * max(height, 0.0)) ** 2
            if not np.isfinite(spread).all():
                continue
            spots = self._data.geom_xpos[geom, :2] + circle @ np.linalg.cholesky(spread).T
            ellipse = np.column_stack([spots, np.full(len(spots), self._floor)])
            rim = projection.pixels_ahead(ellipse)
            if rim is not None:
                darkness = int(125.0 / (1.0 + 2.2 * max(height, 0.0)))
                pen.polygon([(x / coarse, y / coarse) for x, y in rim], fill=darkness)
        mask = mask.filter(ImageFilter.GaussianBlur(canvas.height / coarse / 60.0))
        fallen = mask.getbbox()
        if fallen is not None:
            left, top, right, bottom = (coarse * side for side in fallen)
            soft = mask.crop(fallen).resize((right - left, bottom - top), Image.Resampling.BICUBIC)
            canvas.paste(SHADE, (left, top, right, bottom), soft)

    def close(self) -> None:
        """Painting afterwards is an error; there is nothing to free."""
        self._open = False


class _Film:
    """Depth, surface normal and geom at each pixel, of whatever is nearest."""

    def __init__(self, projection: Projection, width: int, height: int) -> None:
        self._projection = projection
        focal, (cx, cy) = projection.focal, projection.centre
        self._x = ((np.arange(width) + 0.5 - cx) / focal).astype(np.float32)
        self._y = ((np.arange(height) + 0.5 - cy) / focal).astype(np.float32)
        self._depth = np.full((height, width), np.inf, dtype=np.float32)
        self._normal = np.zeros((height, width, 3), dtype=np.float32)
        self._geom = np.full((height, width), -1, dtype=np.int32)

    def _window(self, low: FloatArray, high: FloatArray) -> tuple[slice, slice] | None:
        """Rows and columns that a box (3,) to (3,) in camera space can cover; None if none."""
        if not (low[2] > NEAREST and high[2] < FARTHEST):
            return None
        spans = []
        for axis, side in ((1, self._y), (0, self._x)):
            near = low[axis] / (low[2] if low[axis] < 0.0 else high[2])
            far = high[axis] / (low[2] if high[axis] > 0.0 else high[2])
            first, last = np.searchsorted(side, [near, far])
            if first >= last:
                return None
            spans.append(slice(int(first), int(last)))
        return spans[0], spans[1]

    def _rays(
        self, window: tuple[slice, slice], centre: FloatArray
    ) -> tuple[NDArray[np.float32], ...]:
        """Rays (x, y, 1) of a window, and how far each passes `centre` at its depth, in m.

        Ray and geom are met from there, not from the camera: small differences of large squares
        would eat up a finger's breadth.
        """
        x, y = self._x[None, window[1]], self._y[window[0], None]
        cx, cy, cz = centre.astype(np.float32)
        return x, y, cz * x - cx, cz * y - cy

    def _keep(
        self, geom: int, window: tuple[slice, slice], depth: NDArray[np.float32]
    ) -> tuple[NDArray[np.intp], NDArray[np.intp], FloatArray]:
        """Record a geom where it is nearest (nan is nowhere); rows, columns, camera points."""
        rows, columns = np.nonzero((depth < self._depth[window]) & (depth > NEAREST))
        nearest = depth[rows, columns]
        rows, columns = rows + window[0].start, columns + window[1].start
        self._depth[rows, columns] = nearest
        self._geom[rows, columns] = geom
        points = np.stack([self._x[columns], self._y[rows], np.ones_like(nearest)], axis=1)
        return rows, columns, (points * nearest[:, None]).astype(np.float64)

    def expose_ellipsoid(
        self, geom: int, place: FloatArray, turn: FloatArray, radii: FloatArray
    ) -> None:
        """An ellipsoid at `place` (3,) m, axes the columns of `turn` (3, 3), radii (3,) m."""
        centre = self._projection.to_camera(place)
        axes = self._projection.rotation @ turn
        extent = np.sqrt(((axes * radii) ** 2).sum(axis=1))
        window = self._window(centre - extent, centre + extent)
        if window is None:
            return
        quadric = (axes / radii**2) @ axes.T
        q = quadric.astype(np.float32)
        x, y, dx, dy = self._rays(window, centre)
        a = q[0, 0] * x * x + 2 * q[0, 2] * x + q[2, 2]
        a = a + y * (q[1, 1] * y + 2 * q[1, 2] + 2 * q[0, 1] * x)
        b = dx * (q[0, 0] * x + q[0, 1] * y + q[0, 2]) + dy * (q[0, 1] * x + q[1, 1] * y + q[1, 2])
        c = dx * (q[0, 0] * dx + 2 * q[0, 1] * dy) + q[1, 1] * dy * dy - 1
        depth = np.float32(centre[2]) - (b + np.sqrt(b * b - a * c)) / a
        rows, columns, points = self._keep(geom, window, depth)
        self._normal[rows, columns] = _unit((points - centre) @ quadric)

    def expose_capsule(self, geom: int, start: FloatArray, end: FloatArray, radius: float) -> None:
        """A capsule between the centres of its ends (3,) m."""
        a, b = self._projection.to_camera(start), self._projection.to_camera(end)
        window = self._window(np.minimum(a, b) - radius, np.maximum(a, b) + radius)
        if window is None:
            return
        axis = b - a
        length2 = max(float(axis @ axis), 1e-12)
        x, y, dx, dy = self._rays(window, a)
        bx, by, bz = axis.astype(np.float32)
        ray2 = x * x + (y * y + 1)
        along, reach, gap2 = bx * x + (by * y + bz), dx * x + dy * y, dx * dx + dy * dy
        offset = bx * dx + by * dy
        # The side: the ray meets the infinite cylinder, then is asked where along the axis.
        qa = length2 * ray2 - along * along
        qb = length2 * reach - offset * along
        discriminant = qb * qb - qa * (length2 * (gap2 - radius * radius) - offset * offset)
        step = -(qb + np.sqrt(np.maximum(discriminant, 0))) / np.maximum(qa, np.float32(1e-12))
        station = offset + step * along
        # The ends: where that place is off the axis, the nearer end's sphere instead.
        tail = station <= 0
        cb = np.where(tail, reach, reach - along)
        cc = np.where(tail, gap2, gap2 - 2 * offset + length2) - radius * radius
        ends = -(cb + np.sqrt(cb * cb - ray2 * cc)) / ray2
        side = (station > 0) & (station < length2) & (discriminant >= 0)
        depth = np.float32(a[2]) + np.where(side, step, ends)
        rows, columns, points = self._keep(geom, window, depth)
        foot = np.clip((points - a) @ axis / length2, 0.0, 1.0)
        self._normal[rows, columns] = _unit(points - a - foot[:, None] * axis)

    def expose_faces(self, geom: int, place: FloatArray, turn: FloatArray, solid: _Solid) -> None:
        """A solid at `place` (3,) m, turned by `turn` (3, 3)."""
        vertices, normals, corners, bends = solid
        seen = self._projection.to_camera(vertices @ turn.T + place)
        low, high = seen.min(axis=0), seen.max(axis=0)
        window = self._window(low, high)
        if window is None:
            return
        flat = seen[:, :2] / seen[:, 2:]
        # (F,) each: the sides opposite to the three corners, twice the area (front faces only).
        (x0, y0), (x1, y1), (x2, y2) = (flat[corners[:, corner]].T for corner in range(3))
        area = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
        ahead = np.flatnonzero(area < -1e-12)
        ahead = ahead[np.argsort(-seen[corners[ahead], 2].sum(axis=1))]
        # Over a triangle 1/depth and normal/depth are linear in the picture: corner weights
        # (F, 3, 3) from (x, y, 1), then their slopes (F, 3, 4).
        weights = np.array(
            [
                [y1 - y2, y2 - y0, y0 - y1],
                [x2 - x1, x0 - x2, x1 - x0],
                [x1 * y2 - x2 * y1, x2 * y0 - x0 * y2, x0 * y1 - x1 * y0],
            ]
        )
        weights = weights[..., ahead].transpose(2, 0, 1) / area[ahead, None, None]
        bent = (normals @ (self._projection.rotation @ turn).T)[bends[ahead]]
        values = np.concatenate([np.ones((len(ahead), 3, 1)), bent], axis=2)
        slopes = weights @ (values / seen[corners[ahead], 2:])
        rows, columns = window
        stencil = Image.new("I", (columns.stop - columns.start, rows.stop - rows.start), 0)
        pen = ImageDraw.Draw(stencil)
        pixels = self._projection.to_pixels(seen) - (columns.start + 0.5, rows.start + 0.5)
        for label, outline in enumerate(pixels[corners[ahead]].reshape(-1, 6).tolist(), start=1):
            pen.polygon(outline, fill=label)
        labels = np.asarray(stencil)
        v, u = np.nonzero(labels)
        x, y = self._x[u + columns.start], self._y[v + rows.start]
        rays = np.column_stack([x, y, np.ones_like(x)])
        local = np.einsum("pi,pij->pj", rays, slopes[labels[v, u] - 1])
        depth = np.full(labels.shape, np.nan, dtype=np.float32)
        # A pixel on the rim lies a little outside its triangle: hold its depth to the mesh's.
        depth[v, u] = np.clip(1.0 / local[:, 0], low[2], high[2])
        across = np.zeros((*labels.shape, 3))
        across[v, u] = local[:, 1:]
        v, u, _ = self._keep(geom, window, depth)
        self._normal[v, u] = _unit(across[v - rows.start, u - columns.start])

    def over(self, canvas: Image.Image, colours: NDArray[np.float32]) -> Image.Image:
        """Wash and ink what was exposed, over the canvas; `colours` (ngeom, 3) from 0 to 255."""
        rows = np.flatnonzero((self._geom >= 0).any(axis=1))
        columns = np.flatnonzero((self._geom >= 0).any(axis=0))
        if len(rows) == 0:
            return canvas
        window = (
            slice(max(rows[0] - 2, 0), rows[-1] + 3),
            slice(max(columns[0] - 2, 0), columns[-1] + 3),
        )
        depth, geom, normal = self._depth[window], self._geom[window], self._normal[window]
        body = geom >= 0
        picture = np.array(canvas)
        part = picture[window]
        lamp = (LAMP / np.linalg.norm(LAMP)).astype(np.float32)
        surface = normal[body]
        light = 0.5 + 0.5 * (surface @ lamp)
        wash = colours[geom[body]] * (0.5 + 0.62 * light)[:, None]
        wash += 62.0 * np.square(np.square(light))[:, None]
        grazing = np.clip(1.0 + surface[:, 2] * 2.2, 0.0, 1.0)[:, None] * 0.35
        part[body] = np.clip(wash + grazing * (INK - wash), 0.0, 255.0).astype(np.uint8)
        far = np.where(body, depth, np.float32(FARTHEST))
        line = np.zeros(body.shape, dtype=bool)
        down, across = (np.abs(np.diff(far, axis=axis)) > INK_JUMP for axis in (0, 1))
        line[1:] |= down
        line[:-1] |= down
        line[:, 1:] |= across
        line[:, :-1] |= across
        part[line] = (0.2 * part[line] + 0.8 * INK).astype(np.uint8)
        return Image.fromarray(picture)


def _unit(vectors: FloatArray) -> FloatArray:
    length = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    unit: FloatArray = vectors / np.maximum(length, 1e-12)[:, None]
    return unit


def _kind(model: mujoco.MjModel, geom: int) -> mjtGeom:
    # The enumeration's own == says no to NumPy's integers.
    return mjtGeom(int(model.geom_type[geom]))


def _drawn(model: mujoco.MjModel, geom: int) -> bool:
    shown = model.geom_group[geom] <= 2 and _kind(model, geom) in ROUND + FACETED
    return bool(shown and _rgba(model, geom)[3] > 0.05)


def _rgba(model: mujoco.MjModel, geom: int) -> NDArray[np.float32]:
    material = int(model.geom_matid[geom])
    own: NDArray[np.float32] = model.geom_rgba[geom]
    if material >= 0 and bool((own == UNPAINTED).all()):
        own = model.mat_rgba[material]
    return own


def _faces(model: mujoco.MjModel, geom: int) -> _Solid:
    """The triangles of a box, cylinder or mesh in its own frame."""
    kind, size = _kind(model, geom), np.array(model.geom_size[geom])
    if kind == mjtGeom.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        vertices = model.mesh_vert[first : first + count].astype(np.float64)
        first, count = model.mesh_normaladr[mesh], model.mesh_normalnum[mesh]
        normals = model.mesh_normal[first : first + count].astype(np.float64)
        first, count = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
        faces = slice(first, first + count)
        return vertices, normals, model.mesh_face[faces], model.mesh_facenormal[faces]
    if kind == mjtGeom.mjGEOM_BOX:
        square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        outward = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
        return _prism(size[:2] * square, outward, outward, float(size[2]))
    turn = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    return _prism(size[0] * circle, circle, np.roll(circle, -1, axis=0), float(size[1]))


def _prism(ring: FloatArray, starts: FloatArray, ends: FloatArray, half: float) -> _Solid:
    """An upright prism over a ring (n, 2), with the normals at both edges of each side (n, 2)."""
    up = np.tile([0.0, 0.0, 1.0], (len(ring), 1))
    low, high = (np.column_stack([ring, level * up[:, 2]]) for level in (-half, half))
    low_next, high_next = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
    here, there = (np.column_stack([normal, 0.0 * up[:, 2]]) for normal in (starts, ends))
    sides = ((low, low_next, high_next), (low, high_next, high))
    lids = ((half * up, high, high_next), (-half * up, low_next, low))
    bent = ((here, there, there), (here, there, here), (up, up, up), (-up, -up, -up))
    vertices, normals = (
        np.concatenate([np.stack(corners, axis=1) for corners in parts]).reshape(-1, 3)
        for parts in (sides + lids, bent)
    )
    indices = np.arange(len(vertices), dtype=np.int32).reshape(-1, 3)
    return vertices, normals, indices, indices


@functools.lru_cache(maxsize=4)
def _empty_stage(view: View, size: tuple[int, int], floor: float) -> Image.Image:
    """Paper with a faint grid of half metres on the floor; kept while the camera stands still."""
    width, height = (SUPERSAMPLE * side for side in size)
    fade = np.linspace(0.0, 1.0, height)[:, None, None]
    tone = (1.0 - fade) * np.array(PAPER_TOP) + fade * np.array(PAPER_BOTTOM)
    canvas = Image.fromarray(np.broadcast_to(tone, (height, width, 3)).round().astype(np.uint8))
    pen = ImageDraw.Draw(canvas)
    middle = np.array([*np.round(view.lookat[:2]), floor])
    for segment in Projection(view, width, height).floor_grid(middle, GRID_REACH, GRID_STEP):
        pen.line(segment, fill=GRID, width=SUPERSAMPLE)
    return canvas
