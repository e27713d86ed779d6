"""Draws the pictures of the README and the docs from the dancer herself.

    python docs/make_images.py

It needs OpenGL (`enpointe doctor` says whether there is any) and writes docs/images/*.png, each
below 300 kB. The bottom of dance.png shows the dance that is measured by

    enpointe perform third-port-de-bras --effort happy
"""

from __future__ import annotations

import copy
import io
import re
from pathlib import Path
from xml.etree import ElementTree

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.spatial.transform import Rotation

from enpointe.notation.stave_ink import SPACE
from enpointe.sim.camera import View
from enpointe.sim.render import gl_backend

IMAGES = Path(__file__).parent / "images"
MOST_BYTES = 300_000
INK, SOFT, LEFT, RIGHT = "#2b2930", "#8a8690", "#24507e", "#b8552c"
PAPER = "#fdfcfa"
PIXELS_A_METRE = 164
TALLEST = 2.02
"""m of the picture above the floor; and below it:"""
BELOW = 0.13
_SVG = "{http://www.w3.org/2000/svg}"

if gl_backend() is None:
    raise SystemExit("no OpenGL here: enpointe doctor says what to install")
mpl.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
import mujoco  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.patches import PathPatch  # noqa: E402
from matplotlib.path import Path as Outline  # noqa: E402
from matplotlib.transforms import Affine2D  # noqa: E402

import enpointe  # noqa: E402
from enpointe.models import dancer_model  # noqa: E402
from enpointe.motion import PRESETS, logistic  # noqa: E402
from enpointe.motion.wrist import wrist_paths  # noqa: E402
from enpointe.notation import Score, Side, names, stave_svg  # noqa: E402

plt.rcParams.update(
    {"font.family": "DejaVu Sans", "font.size": 8.5, "text.color": INK, "axes.edgecolor": SOFT}
)


class CutOut:
    """Paints a dancer without the room, on nothing, at a fixed scale from straight in front."""

    def __init__(self, model: mujoco.MjModel, width: float, *, oversample: int = 3) -> None:
        model = copy.copy(model)
        self._model, self._times = model, oversample
        height = TALLEST + BELOW
        self.size = (round(width * PIXELS_A_METRE), round(height * PIXELS_A_METRE))
        self._large = tuple(oversample * n for n in self.size)
        model.vis.global_.offwidth, model.vis.global_.offheight = self._large
        model.vis.quality.offsamples = 0
        self._data = mujoco.MjData(model)
        self._painter = mujoco.Renderer(model, self._large[1], self._large[0])
        # From far away and through a long lens, so that metres are metres all over the picture.
        distance = 40.0
        model.vis.global_.fovy = float(np.degrees(2 * np.arctan(height / 2 / distance)))
        view = View(elevation=-4.0, lookat=(0.0, 0.0, height / 2 - BELOW), distance=distance)
        self._camera = mujoco.MjvCamera()
        self._camera.azimuth, self._camera.elevation = view.azimuth, view.elevation
        self._camera.distance, self._camera.lookat[:] = view.distance, view.lookat
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = [1, 1, 1, 0, 0, 0]

    def __call__(self, qpos: NDArray[np.float64]) -> Image.Image:
        """The dancer, RGBA."""
        self._data.qpos[:] = qpos
        mujoco.mj_forward(self._model, self._data)
        self._painter.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = False
        self._painter.update_scene(self._data, self._camera, self._option)
        colour = self._painter.render().astype(float)
        self._painter.enable_segmentation_rendering()
        self._painter.update_scene(self._data, self._camera, self._option)
        geoms = self._painter.render()[:, :, 0]
        self._painter.disable_segmentation_rendering()
        bodies = np.where(geoms >= 0, self._model.geom_bodyid[geoms], 0)
        alpha = (bodies > 0).astype(float)[:, :, None]
        return _shrunk(np.concatenate([colour * alpha, 255 * alpha], axis=2), self._times)


def _shrunk(premultiplied: NDArray[np.float64], times: int) -> Image.Image:
    """Mean of squares of `times` pixels, colours weighed by their opacity."""
    h, w, _ = premultiplied.shape
    blocks = premultiplied.reshape(h // times, times, w // times, times, 4).mean(axis=(1, 3))
    alpha = np.maximum(blocks[:, :, 3:], 1e-6) / 255
    blocks[:, :, :3] /= alpha
    return Image.fromarray(blocks.clip(0, 255).astype(np.uint8), "RGBA")


def faded(picture: Image.Image, opacity: float) -> Image.Image:
    """The picture, seen through."""
    out = picture.copy()
    out.putalpha(out.getchannel("A").point(lambda a: round(a * opacity)))
    return out


def save(figure: Figure, name: str) -> None:
    """As a PNG of few colours."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100, facecolor=PAPER)
    plt.close(figure)
    picture = Image.open(buffer).convert("RGB").quantize(200, dither=Image.Dither.NONE)
    path = IMAGES / name
    path.parent.mkdir(exist_ok=True)
    picture.save(path, optimize=True)
    size = path.stat().st_size
    assert size < MOST_BYTES, f"{name} has {size} bytes"
    print(f"{path.name}: {picture.width} x {picture.height}, {size // 1000} kB")


def canvas(width: int, height: int) -> tuple[Figure, Axes]:
    """A figure with one axes whose unit is the pixel, y down."""
    figure = plt.figure(figsize=(width / 100, height / 100), facecolor=PAPER)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.axis("off")
    return figure, axes


_CODES = {
    "M": [Outline.MOVETO],
    "L": [Outline.LINETO],
    "Q": [Outline.CURVE3] * 2,
    "C": [Outline.CURVE4] * 3,
}


def outline(drawing: str) -> Outline:
    """SVG path data with the absolute commands M, L, Q, C and Z."""
    points: list[tuple[float, ...]] = []
    codes = []
    for command, numbers in re.findall(r"([MLQCZ])([^MLQCZ]*)", drawing):
        if command == "Z":
            points.append((0.0, 0.0))
            codes.append(Outline.CLOSEPOLY)
            continue
        places = np.array([float(n) for n in numbers.replace(",", " ").split()]).reshape(-1, 2)
        points += [tuple(place) for place in places]
        codes += _CODES[command] * (len(places) // len(_CODES[command]))
    return Outline(points, codes)


def draw_frame(
    axes: Axes, group: ElementTree.Element, top: float, x: float, y: float, scale: float
) -> None:
    """One frame of our own SVG stave, whose top line is at `top`, the middle of that at (x, y)."""
    texts = {element.get("class"): element for element in group.iter(f"{_SVG}text")}
    middle = float(texts["frame-number"].attrib["x"])
    placed = Affine2D().translate(-middle, -top).scale(scale).translate(x, y)
    for element in group.iter(f"{_SVG}path"):
        a = element.attrib
        patch = PathPatch(
            placed.transform_path(outline(a["d"])),
            facecolor="none" if a.get("fill") == "none" else INK,
            edgecolor=INK if "stroke" in a else "none",
            linewidth=float(a.get("stroke-width", 0)) * scale * 0.72,
            capstyle="butt",
        )
        axes.add_patch(patch)
    count = texts["count"]
    px, py = placed.transform((middle, float(count.attrib["y"])))
    size = float(count.attrib["font-size"]) * scale * 0.72
    axes.text(px, py, count.text or "", family="DejaVu Serif", size=size, ha="center")


def draw_stave(axes: Axes, columns: list[float], y: float, scale: float, score: Score) -> None:
    """The first frames of a score on five lines, a frame over each column."""
    svg = ElementTree.fromstring(stave_svg(score))
    groups = {g.get("id"): g for g in svg.iter(f"{_SVG}g") if g.get("class") == "frame"}
    lines = [p for p in svg.iter(f"{_SVG}path") if p.get("class") == "stave-line"]
    top = float(np.asarray(outline(lines[0].attrib["d"]).vertices)[0, 1])
    pitch = columns[1] - columns[0]
    left, right = columns[0] - 0.526 * pitch, columns[-1] + 0.491 * pitch
    for line in range(5):
        level = y + line * SPACE * scale
        axes.plot([left, right], [level, level], color=INK, linewidth=0.8)
    for bar in (left, 0.5 * (columns[0] + columns[1]), right):
        axes.plot([bar, bar], [y, y + 4 * SPACE * scale], color=INK, linewidth=1.2)
    for row, number in enumerate(score.metre):
        level = y + (1 + 2 * row) * SPACE * scale
        axes.text(
            left + 24,
            level,
            str(number),
            family="DejaVu Serif",
            weight="bold",
            size=23,
            ha="center",
            va="center_baseline",
        )
    for n, column in enumerate(columns):
        draw_frame(axes, groups[f"frame-{n}"], top, column, y, scale)


def paste(axes: Axes, picture: Image.Image, x: float, floor: float) -> None:
    """Stand a cut-out at (x, floor), in pixels of the canvas."""
    width, height = picture.size
    bottom = floor + BELOW * PIXELS_A_METRE
    box = (x - width / 2, x + width / 2, bottom, bottom - height)
    axes.imshow(np.asarray(picture), extent=box, interpolation="antialiased", zorder=3)


def dance() -> None:
    """The stave, the dancer on each of its frames, and what her feet and wrists did meanwhile."""
    danced = enpointe.perform("third-port-de-bras", effort="happy")
    recording, measures = danced.recording, danced.measures
    assert recording is not None
    assert measures is not None
    times = danced.choreography.key_times[:5]
    width, height = 1200, 838
    columns = [148.0 + 228 * i for i in range(5)]
    figure, axes = canvas(width, height)
    axes.text(28, 34, danced.score.title, family="DejaVu Serif", size=15)
    axes.text(
        width - 28,
        34,
        f"{danced.score.method}, danced {danced.effort_name}, "
        f"{danced.choreography.tempo:g} beats a minute",
        family="DejaVu Serif",
        style="italic",
        size=10,
        ha="right",
        color=SOFT,
    )
    draw_stave(axes, columns, 104, 1.32, danced.score)
    floor = 566.0
    axes.plot([28, width - 28], [floor, floor], color="#d9d3c8", linewidth=1.2, zorder=0)
    cut_out = CutOut(dancer_model(), 1.9)
    motion = danced.danced
    for n, column in enumerate(columns):
        shade = mpl.patches.Ellipse((column, floor + 4), 96, 13, color="#e7e0d4", linewidth=0)
        axes.add_patch(shade)
        if n:
            begin, end = times[n - 1], times[n]
            for share in (0.3, 0.45, 0.6, 0.75):
                ghost = cut_out(motion.sample(begin + share * (end - begin))[0])
                paste(axes, faded(ghost, 0.2), column, floor)
        paste(axes, cut_out(motion.sample(times[n])[0]), column, floor)
    axes.set(xlim=(0, width), ylim=(height, 0))
    _plots(figure, axes, danced, times, columns, (width, height))
    save(figure, "dance.png")


def _plots(
    figure: Figure,
    page: Axes,
    danced: enpointe.Performance,
    times: NDArray[np.float64],
    columns: list[float],
    size: tuple[int, int],
) -> None:
    """Wrist speed and force on each foot, each key time below its frame."""
    recording, measures = danced.recording, danced.measures
    assert recording is not None
    assert measures is not None
    model, time = recording.model, recording.time
    width, height = size
    scale = (columns[1] - columns[0]) / (times[1] - times[0])
    first = times[0] - (columns[0] - 28) / scale
    last = times[0] + (width - 28 - columns[0]) / scale
    inside = (time >= first) & (time <= last)
    panels = []
    for top, tall in ((610, 78), (716, 92)):
        box = (28 / width, 1 - (top + tall) / height, 1 - 56 / width, tall / height)
        panel = figure.add_axes(box, facecolor="none")
        panel.set(xlim=(first, last), xticks=[], yticks=[])
        for spine in ("top", "right", "left"):
            panel.spines[spine].set_visible(False)
        for t in times:
            panel.axvline(t, color="#e4dfd6", linewidth=0.9, zorder=0)
        panels.append(panel)
    every = 2
    paths = wrist_paths(model, recording.qpos[inside][::every])
    for side, colour, line in ((Side.LEFT, LEFT, "-"), (Side.RIGHT, RIGHT, (0, (3, 2)))):
        speed = np.linalg.norm(np.gradient(paths[side], time[inside][::every], axis=0), axis=1)
        panels[0].plot(time[inside][::every], speed, color=colour, linewidth=1.6, linestyle=line)
    panels[0].set_ylim(bottom=0)
    weight = float(model.body_mass.sum()) * 9.81
    forces = measures.foot_force[inside]
    panels[1].plot(time[inside], forces.sum(axis=1), color=SOFT, linewidth=1.0)
    panels[1].plot(time[inside], forces[:, 0], color=LEFT, linewidth=1.4)
    panels[1].plot(time[inside], forces[:, 1], color=RIGHT, linewidth=1.4)
    panels[1].axhline(weight, color=SOFT, linewidth=0.7, linestyle=(0, (1, 2)))
    panels[1].set_ylim(0, 1.28 * weight)
    fastest = max(float(np.max(line.get_ydata())) for line in panels[0].lines[5:])
    page.text(28, 602, "speed of the wrists", size=8.5, color=SOFT)
    page.text(width - 28, 602, f"at most {fastest:.1f} m/s", size=8.5, color=SOFT, ha="right")
    page.text(28, 710, "floor under the feet", size=8.5, color=SOFT)
    page.text(
        width - 28, 710, f"body weight {weight:.0f} N, dotted", size=8.5, color=SOFT, ha="right"
    )
    page.text(28, 827, "left", size=8.5, color=LEFT, weight="bold")
    page.text(58, 827, "right", size=8.5, color=RIGHT, weight="bold")
    page.text(96, 827, "both feet", size=8.5, color=SOFT, weight="bold")
    page.text(
        width - 28,
        827,
        f"no force on the root; centre of mass at least "
        f"{1e3 * (measures.support_margin_min or 0):.0f} mm inside the support; "
        f"feet slip {1e3 * measures.slip_max:.1f} mm",
        size=8.5,
        color=SOFT,
        ha="right",
    )


def turned(qpos: NDArray[np.float64], degrees: float) -> NDArray[np.float64]:
    """The pose turned about the vertical, to the dancer's left."""
    turn = Rotation.from_euler("z", degrees, degrees=True)
    out = qpos.copy()
    out[:3] = turn.apply(qpos[:3])
    out[3:7] = (turn * Rotation.from_quat(qpos[3:7], scalar_first=True)).as_quat(scalar_first=True)
    return out


def positions() -> None:
    """Every named position of the arms, solved by `enpointe pose`."""
    known = names("arms")
    rows, across = 2, (len(known) + 1) // 2
    pitch, tall = 170, 196
    figure, axes = canvas(across * pitch + 10, rows * tall + 6)
    cut_out = CutOut(dancer_model(), 1.62)
    for n, name in enumerate(known):
        x = 5 + pitch * (n % across + 0.5)
        top = tall * (n // across)
        qpos = enpointe.pose(f"arms {name}").key_poses[0].qpos
        # From the front an arabesque arm points at the reader and is not seen.
        picture = cut_out(turned(qpos, -60.0) if "arabesque" in name else qpos)
        picture = picture.crop((0, 0, picture.width, round(1.33 * PIXELS_A_METRE)))
        # Cut at the knee; the scale is smaller than that of dance.png.
        share = 0.68
        w, h = picture.width * share, picture.height * share
        box = (x - w / 2, x + w / 2, top + 8 + h, top + 8)
        axes.imshow(np.asarray(picture), extent=box, interpolation="antialiased")
        axes.text(x, top + 8 + h + 20, name, ha="center", size=8.5, family="DejaVu Serif")
    axes.set(xlim=(0, across * pitch + 10), ylim=(rows * tall + 6, 0))
    save(figure, "positions.png")


def efforts() -> None:
    """The logistic of each preset and its speed."""
    figure, pair = plt.subplots(1, 2, figsize=(9, 3.1), facecolor=PAPER)
    t = np.linspace(0, 1, 301)
    colours = ("#6b6770", "#d18f1e", "#2f6690", "#b33a3a", "#5b8c5a")
    lines = ("-", "-", (0, (5, 2)), "-", (0, (1.5, 1.5)))
    for preset, colour, line in zip(PRESETS.values(), colours, lines, strict=True):
        way = logistic(t, preset.effort.time, preset.effort.weight)
        style = {"color": colour, "linestyle": line, "linewidth": 1.8}
        pair[0].plot(t, way, label=preset.name, **style)
        pair[1].plot(t, np.gradient(way, t), **style)
    for axes, title in zip(pair, ("share of the way", "speed, ways a movement"), strict=True):
        axes.set_facecolor("none")
        axes.set(xlim=(0, 1), ylim=(0, None), title=title, xlabel="share of the time")
        axes.spines[["top", "right"]].set_visible(False)
    pair[0].legend(frameon=False)
    figure.tight_layout()
    save(figure, "efforts.png")


if __name__ == "__main__":
    dance()
    positions()
    efforts()
