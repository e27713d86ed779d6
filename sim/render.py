"""Pictures of a body: OpenGL where the machine has it, and a drawn sketch where it has not.

This module doesn't import mujoco until a painter is made, because importing mujoco with a
`MUJOCO_GL` that doesn't work here fails: call `gl_backend` first, and the import is safe.
"""

from __future__ import annotations

import atexit
import copy
import functools
import importlib
import os
import subprocess
import sys
import weakref
from concurrent.futures import Future
from threading import Thread
from types import TracebackType
from typing import TYPE_CHECKING, Literal, Protocol, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from enpointe.errors import RenderError
from enpointe.sim.camera import COM_INK, COM_RADIUS, SUPPORT_INK, Overlays, Projection, View

if TYPE_CHECKING:
    import mujoco

__all__ = [
    "GLPainter",
    "Painter",
    "Quality",
    "floor_height",
    "gl_backend",
    "look_for_opengl",
    "open_painter",
]

Backend = Literal["egl", "osmesa", "glfw", "cgl", "wgl"]
Quality = Literal["fast", "fine"]

PROBE_SECONDS = 30.0
SWITCHED_OFF = ("disable", "disabled", "off", "false", "0")
NOT_CHOSEN = ("", "enable", "enabled", "on", "true", "1")
NO_OPENGL = (
    "no OpenGL: apt install libegl1 libgl1-mesa-dri (or libosmesa6); using the sketch renderer"
)
PROBE = """
import mujoco
model = mujoco.MjModel.from_xml_string(
    '<mujoco><visual><quality shadowsize="64"/><global offwidth="16" offheight="16"/></visual>'
    '<worldbody><light pos="0 0 3"/><geom size="1"/></worldbody></mujoco>')
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
with mujoco.Renderer(model, 16, 16) as renderer:
    renderer.update_scene(data)
    print("drawn" if renderer.render().any() else "black", flush=True)
"""


class Painter(Protocol):
    """Paints one body in any pose."""

    size: tuple[int, int]
    """Width and height of the pictures, pixels."""

    def paint(
        self, qpos: ArrayLike, *, camera: View, overlays: Overlays | None = None
    ) -> Image.Image:
        """Paint one picture.

        Args:
            qpos: (nq,) generalised positions.
            camera: Where the picture is taken from.
            overlays: What to draw over the dancer.

        Returns:
            An RGB picture of `size`.

        Raises:
            RenderError: qpos has the wrong shape or isn't finite, or the painter is closed.
        """

    def close(self) -> None:
        """Give back what the painter holds; painting afterwards is an error."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _draws(backend: str) -> bool:
    """Whether a fresh interpreter can draw a picture with this backend."""
    # Threads that numpy's linear algebra would start cost more than the picture.
    environment = {**os.environ, "MUJOCO_GL": backend, "OPENBLAS_NUM_THREADS": "1"}
    try:
        probe = subprocess.run(
            [sys.executable, "-P", "-c", PROBE],
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=PROBE_SECONDS,
            check=False,
        )
    except (OSError, subprocess.SubprocessError):
        return False
    return b"drawn" in probe.stdout


def _candidates() -> tuple[Backend, ...]:
    if sys.platform == "darwin":
        return ("cgl",)
    if sys.platform == "win32":
        return ("wgl",)
    return ("egl", "osmesa", "glfw") if os.environ.get("DISPLAY") else ("egl", "osmesa")


def _asked() -> str:
    """The backend that the user asks for; whatever draws if empty."""
    return os.environ.get("MUJOCO_GL", "").lower().strip()


@functools.cache
def _search() -> Future[Backend | None]:
    """The first backend that draws here, looked for in a thread of its own."""
    asked = _asked()
    backends = _candidates() if asked in NOT_CHOSEN else (cast(Backend, asked),)
    answer: Future[Backend | None] = Future()

    def look() -> None:
        try:
            answer.set_result(next((backend for backend in backends if _draws(backend)), None))
        except BaseException as error:
            answer.set_exception(error)

    Thread(target=look, daemon=True).start()
    return answer


def look_for_opengl() -> None:
    """Begin to look what draws here, so that who paints later waits for less.

    It takes half a second, of another processor if there is one; see `gl_backend`.
    """
    if _asked() not in SWITCHED_OFF:
        _search()


@functools.cache
def _find_backend() -> tuple[Backend | None, str | None]:
    """The backend that draws here, or None and the line to tell the user."""
    asked = _asked()
    if asked in SWITCHED_OFF:
        return None, f"OpenGL is switched off (MUJOCO_GL={asked}); using the sketch renderer"
    found = _search().result()
    os.environ["MUJOCO_GL"] = found or "off"
    if found is not None:
        _rebind(found)
        return found, None
    return None, NO_OPENGL if sys.platform == "linux" else "no OpenGL; using the sketch renderer"


def _rebind(backend: str) -> None:
    """Make an already imported mujoco use the backend: it read the variable when imported."""
    context = sys.modules.get("mujoco.rendering.classic.gl_context")
    if context is None or getattr(context, "_MUJOCO_GL", backend) == backend:
        return
    importlib.reload(context)


def gl_backend() -> Backend | None:
    """The OpenGL backend that really works on this machine, or None.

    Each candidate draws a picture in a fresh interpreter with a time limit, since a broken driver
    may take the process with it. A `MUJOCO_GL` set by the user is the only candidate. The answer
    is kept for the life of the process and written to `MUJOCO_GL` ("off" when nothing works), so
    that importing mujoco afterwards is safe and child processes need not look again.
    """
    return _find_backend()[0]


def open_painter(
    model: mujoco.MjModel, width: int, height: int, *, quality: Quality = "fast"
) -> tuple[Painter, str | None]:
    """The best painter that this machine has.

    Args:
        model: The body, with its stage.
        width: Of the pictures, pixels.
        height: Of the pictures, pixels.
        quality: "fast" for films; "fine" adds shadows and smooth edges, for stills.

    Returns:
        The painter, and one line to show the user when it is not OpenGL (else None).

    Raises:
        RenderError: The size makes no picture.
    """
    from enpointe.sim.sketch import SketchPainter

    backend, warning = _find_backend()
    if backend is not None:
        try:
            return GLPainter(model, width, height, quality=quality), None
        except (ImportError, AttributeError, RuntimeError, OSError) as error:
            first = (str(error).splitlines() or [type(error).__name__])[0]
            warning = f"OpenGL ({backend}) failed: {first}; using the sketch renderer"
    return SketchPainter(model, width, height), warning


def checked_size(width: int, height: int) -> tuple[int, int]:
    """The size, if it makes a picture.

    Raises:
        RenderError: It doesn't.
    """
    if not (8 <= width <= 8192 and 8 <= height <= 8192):
        raise RenderError(f"a picture is 8 to 8192 pixels wide and high, not {width} x {height}")
    return width, height


def checked_qpos(model: mujoco.MjModel, qpos: ArrayLike) -> NDArray[np.float64]:
    """qpos as a finite (nq,) array.

    Raises:
        RenderError: It isn't one.
    """
    pose = np.asarray(qpos, dtype=np.float64)
    if pose.shape != (model.nq,):
        raise RenderError(f"a pose of this model is ({model.nq},), not {pose.shape}")
    if not np.isfinite(pose).all():
        raise RenderError("a pose with numbers that are not finite can't be painted")
    return pose


def floor_height(model: mujoco.MjModel) -> float:
    """Height of the stage's plane in m; 0 if the model has none."""
    from mujoco import mjtGeom

    planes = np.flatnonzero(
        (model.geom_type == int(mjtGeom.mjGEOM_PLANE)) & (model.geom_bodyid == 0)
    )
    return float(model.geom_pos[planes[0], 2]) if len(planes) else 0.0


class GLPainter(Painter):
    """Paints with MuJoCo's classic OpenGL renderer.

    Visual geom groups 0 to 2 are shown; collision geoms (group 3) and above are not. The model is
    copied, so that the settings made here don't show elsewhere.

    Args:
        model: The body, with its stage.
        width: Of the pictures, pixels.
        height: Of the pictures, pixels.
        quality: "fast" draws no shadows, no reflections and jagged edges; "fine" draws them all,
            about six times slower without a graphics card.

    Raises:
        RenderError: The machine has no OpenGL, or the size makes no picture.
    """

    def __init__(
        self, model: mujoco.MjModel, width: int, height: int, *, quality: Quality = "fast"
    ) -> None:
        self.size = checked_size(width, height)
        backend, warning = _find_backend()
        if backend is None:
            raise RenderError(str(warning))
        import mujoco

        self._model = copy.copy(model)
        self._data = mujoco.MjData(self._model)
        self._floor = floor_height(model)
        visual = self._model.vis
        visual.global_.offwidth, visual.global_.offheight = width, height
        visual.quality.offsamples = 4 if quality == "fine" else 0
        visual.quality.shadowsize = 2048 if quality == "fine" else 1
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = [1, 1, 1, 0, 0, 0]
        self._option.sitegroup[:] = 0
        self._camera = mujoco.MjvCamera()
        self._renderer = mujoco.Renderer(self._model, height, width)
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
            self._renderer.scene.flags[flag] = quality == "fine"
        # Freed at exit while the context's own module still stands, if nobody closes the painter.
        self._release = weakref.finalize(self, self._renderer.close)
        self._release.atexit = False
        atexit.register(self._release)

    def paint(
        self, qpos: ArrayLike, *, camera: View, overlays: Overlays | None = None
    ) -> Image.Image:
        """Paint one picture; see `Painter.paint`."""
        if not self._release.alive:
            raise RenderError("this painter is closed")
        import mujoco

        self._data.qpos[:] = checked_qpos(self._model, qpos)
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_camlight(self._model, self._data)
        com = self._data.subtree_com[0]
        view = camera.aimed(com)
        self._model.vis.global_.fovy = view.fovy
        self._camera.azimuth = view.azimuth
        self._camera.elevation = view.elevation
        self._camera.distance = view.distance
        self._camera.lookat[:] = view.lookat
        self._renderer.update_scene(self._data, self._camera, self._option)
        if overlays is not None:
            self._mark_floor(overlays, com)
        picture = Image.fromarray(self._renderer.render())
        if overlays is not None:
            overlays.draw_forces(picture, Projection(view, *self.size), 1)
        return picture

    def _mark_floor(self, overlays: Overlays, com: NDArray[np.float64]) -> None:
        from mujoco import mjtGeom

        lift = self._floor + 0.004
        if overlays.com:
            ground = np.array([com[0], com[1], lift])
            up = np.array([0.0, 0.0, 0.003])
            self._connect(mjtGeom.mjGEOM_CYLINDER, COM_RADIUS, ground - up, ground + up, COM_INK)
        corners = overlays.outline(lift)
        for here, there in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            self._connect(mjtGeom.mjGEOM_CAPSULE, 0.005, here, there, SUPPORT_INK)

    def _connect(
        self,
        kind: int,
        width: float,
        tail: NDArray[np.float64],
        tip: NDArray[np.float64],
        ink: tuple[int, int, int],
    ) -> None:
        import mujoco

        scene = self._renderer.scene
        if scene.ngeom >= scene.maxgeom:
            return
        geom = scene.geoms[scene.ngeom]
        colour = np.array([*ink, 255], dtype=np.float32) / np.float32(255.0)
        mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.eye(3).ravel(), colour)
        mujoco.mjv_connector(geom, kind, width, tail, tip)
        scene.ngeom += 1

    def close(self) -> None:
        """Free the OpenGL context."""
        self._release()
        atexit.unregister(self._release)
