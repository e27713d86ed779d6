"""Stills of key poses and the sheet that shows them all."""

from __future__ import annotations

import io
from collections.abc import Iterable, Sequence
from dataclasses import replace

import mujoco
import numpy as np
from matplotlib import font_manager
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from enpointe.sim.camera import View
from enpointe.sim.render import open_painter

__all__ = ["ASPECT", "contact_sheet", "fitted_view", "jpeg", "stills"]

Array = NDArray[np.float64]
ASPECT = 0.8
"""Width over height of a picture: room for arms à la seconde and en haut."""
STILL = (400, 500)
JPEG_QUALITY = 86
SHEET_COLUMNS = 5
_FLESH = 0.10
"""Flesh about a joint that must be in the picture too, m."""
_PAPER, _INK, _BROKEN = (252, 250, 245), (43, 38, 38), (168, 32, 32)


def fitted_view(
    model: mujoco.MjModel, poses: Iterable[Array], view: View, *, follow: bool = False
) -> View:
    """The view, so far back that the dancer is in the picture in every pose.

    Args:
        model: The dancer.
        poses: Each (nq,).
        view: From where.
        follow: Go with the CoM over the floor, so that who travels is no smaller for it.
    """
    data = mujoco.MjData(model)
    clouds = []
    for qpos in poses:
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        place = np.array([*data.subtree_com[0, :2], 0.0]) if follow else np.zeros(3)
        clouds.append(data.xpos[1:] - place)
        clouds.append(data.site_xpos - place)
    points = np.concatenate(clouds)
    corners = [points + np.array([0.0, y, z]) for y in (-_FLESH, _FLESH) for z in (-0.06, _FLESH)]
    fitted = view.fitted(np.concatenate(corners), aspect=ASPECT, margin=1.06)
    return replace(fitted, follow=follow)


def stills(
    model: mujoco.MjModel, poses: Sequence[Array], views: Sequence[View]
) -> tuple[list[list[Image.Image]], str | None]:
    """A picture of each pose from each view; poses that come back are painted once.

    Args:
        model: The dancer.
        poses: Each (nq,).
        views: Aimed already.

    Returns:
        By pose and then by view; and the line to show when OpenGL did not draw them.
    """
    painter, warning = open_painter(model, *STILL, quality="fine")
    painted: dict[bytes, list[Image.Image]] = {}
    with painter:
        for qpos in poses:
            key = np.round(qpos, 4).tobytes()
            if key not in painted:
                painted[key] = [painter.paint(qpos, camera=view) for view in views]
    return [painted[np.round(qpos, 4).tobytes()] for qpos in poses], warning


def jpeg(picture: Image.Image, width: int | None = None) -> bytes:
    """The picture as JPEG, made smaller to `width` pixels if given."""
    if width is not None and width < picture.width:
        height = round(picture.height * width / picture.width)
        picture = picture.resize((width, height), Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    picture.save(buffer, format="JPEG", quality=JPEG_QUALITY, optimize=True)
    return buffer.getvalue()


def contact_sheet(
    rows: Sequence[Sequence[Image.Image]], titles: Sequence[str], notes: Sequence[tuple[str, bool]]
) -> bytes:
    """All poses on one PNG: poses of one view side by side, of more views one below the other.

    Args:
        rows: Pictures by pose and then by view.
        titles: One for each pose.
        notes: One for each pose, and whether it is bad news.
    """
    views = max(len(row) for row in rows)
    columns = SHEET_COLUMNS if views == 1 else 1
    columns = min(columns, len(rows))
    width, height = rows[0][0].size
    strip, gap = height // 8, 8
    cell = (views * width + (views - 1) * gap, height + strip)
    lines = -(-len(rows) // columns)
    size = (columns * (cell[0] + gap) + gap, lines * (cell[1] + gap) + gap)
    sheet = Image.new("RGB", size, _PAPER)
    pen = ImageDraw.Draw(sheet)
    for i, (row, title, (note, broken)) in enumerate(zip(rows, titles, notes, strict=True)):
        left = gap + (i % columns) * (cell[0] + gap)
        top = gap + (i // columns) * (cell[1] + gap)
        for v, picture in enumerate(row):
            sheet.paste(picture, (left + v * (width + gap), top))
        middle = left + cell[0] // 2
        _write(pen, title, middle, top + height + strip * 3 // 10, cell[0], strip // 3, _INK)
        ink = _BROKEN if broken else _INK
        _write(pen, note, middle, top + height + strip * 7 // 10, cell[0], strip // 4, ink)
    buffer = io.BytesIO()
    sheet.save(buffer, format="PNG")
    return buffer.getvalue()


def _write(
    pen: ImageDraw.ImageDraw,
    text: str,
    x: float,
    y: float,
    width: float,
    size: int,
    ink: tuple[int, int, int],
) -> None:
    """A line about (x, y), smaller or cut where it is too long."""
    text = " ".join(text.split())
    path = font_manager.findfont("DejaVu Sans")
    font = ImageFont.truetype(path, size)
    while size > 9 and pen.textlength(text, font=font) > width:
        size -= 1
        font = ImageFont.truetype(path, size)
    while len(text) > 1 and pen.textlength(text, font=font) > width:
        text = text[:-2] + "…"
    pen.text((x, y), text, fill=ink, font=font, anchor="mm")
