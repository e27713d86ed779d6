"""From a sign on the stave to a point in space, and to the elbow that ballet puts before it.

All points are in the frame of the girdle that carries the limb (the torso for arms, the pelvis for
legs), so that an arm keeps its place on the stave when the body inclines: signs are read as if
written before the tilt, one of the two ways notators have (Neagle 2005 §4.7.2 d, e).
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import ScoreError
from enpointe.models.anatomy import side_sign
from enpointe.models.figure import Figure
from enpointe.notation import Depth, Side, Sign

__all__ = ["elbow_of_rounded_arm", "extremity", "limb_root"]

Vector = NDArray[np.float64]
LEAST_DEPTH = 0.2
"""How far before or behind the shoulder a named position stays, as a share of the reach."""
_GRAZE = 1e-3
"""A sign may lie this much (m) outside the sphere of reach before it is refused."""


def limb_root(figure: Figure, side: Side, *, leg: bool) -> Vector:
    """Shoulder in the torso's frame, or hip in the pelvis' frame, (3,), m."""
    return (figure.hips if leg else figure.shoulders)[side]


def extremity(
    figure: Figure,
    side: Side,
    sign: Sign,
    length: float,
    *,
    leg: bool = False,
    root: Vector | None = None,
    gives: bool = False,
    source: str | None = None,
) -> Vector:
    """Where a sign puts a wrist or ankle (or, with the bone's length, an elbow or knee).

    Height by eq. 4.1; a level extremity by eq. 4.2, whose width is what Pythagoras leaves (of its
    two roots, the one nearer to the written width); one in front or behind by width and eq. 4.3,
    with the squares on the differences that the printed formula lost:
    y^2 = l^2 - (x - c_x)^2 - (z - c_z)^2.

    Args:
        figure: The dancer's lengths.
        side: Whose limb.
        sign: Width, height and depth on the stave.
        length: Distance from `root`, m.
        leg: Measure on the leg's lines and from the hip.
        root: Centre of the limb's sphere in the girdle's frame; shoulder or hip if None.
        gives: A named position gives way to the body: for a dancer whose arm is too short for its
            height, it comes nearer to the shoulder's height until `LEAST_DEPTH` of the reach is
            left for the depth. A sign that somebody wrote is refused instead.
        source: Name of the score, for errors.

    Returns:
        The point (3,) in the girdle's frame, m.

    Raises:
        ScoreError: The limb is too short to get there.
    """
    centre = limb_root(figure, side, leg=leg) if root is None else root
    origin = figure.pelvis_origin if leg else figure.torso_origin
    outward = side_sign(side)
    z = figure.height(sign.height, leg=leg) - origin[2]
    rise = z - centre[2]
    y = outward * sign.width * figure.full_width(leg=leg)
    if sign.depth is Depth.LEVEL:
        beyond = length**2 - rise**2
        _check_reach(beyond, length, sign, leg, source)
        aside = sqrt(max(beyond, 0.0))
        places = (centre[1] + outward * aside, centre[1] - outward * aside)
        return np.array([centre[0], min(places, key=lambda place: abs(place - y)), z])
    if gives:
        most = sqrt(max((1 - LEAST_DEPTH**2) * length**2 - (y - centre[1]) ** 2, 0.0))
        rise = min(max(rise, -most), most)
        z = centre[2] + rise
    beyond = length**2 - rise**2 - (y - centre[1]) ** 2
    _check_reach(beyond, length, sign, leg, source)
    ahead = 1.0 if sign.depth is Depth.FRONT else -1.0
    return np.array([centre[0] + ahead * sqrt(max(beyond, 0.0)), y, z])


def _check_reach(beyond: float, length: float, sign: Sign, leg: bool, source: str | None) -> None:
    if beyond >= -2 * _GRAZE * length:
        return
    limb, joint = ("leg", "hip") if leg else ("arm", "shoulder")
    short = sqrt(length**2 - beyond) - length
    line, column = (sign.at.line, sign.at.column) if sign.at else (1, 1)
    raise ScoreError(
        f"this sign is {short * 100:.0f} cm beyond the reach of the {limb}; "
        f"bring it closer to the {joint}",
        line,
        column,
        source,
    )


def elbow_of_rounded_arm(figure: Figure, side: Side, wrist: Vector) -> Vector:
    """The elbow of a rounded arm: neither dropped nor lifted out of the slope of the arm.

    It lies in the plane of the line shoulder-wrist and a horizontal (Neagle 2005 eqs 4.6, 4.7), on
    the outer or back side.

    Args:
        figure: The dancer's lengths.
        side: Whose arm.
        wrist: In the torso's frame, (3,), m.

    Returns:
        The elbow in the torso's frame, (3,), m.
    """
    shoulder = figure.shoulders[side]
    u = wrist - shoulder
    reach2 = float(u @ u)
    inner = (reach2 + figure.upper_arm**2 - figure.forearm**2) / (2 * reach2) * u
    aside = sqrt(max(figure.upper_arm**2 - float(inner @ inner), 0.0))
    outward = side_sign(side)
    level = outward * np.cross([0.0, 0.0, 1.0], u)
    norm = float(np.linalg.norm(level))
    if norm < 1e-9:
        level, norm = np.array([0.0, outward, 0.0]), 1.0
    return np.asarray(shoulder + inner + aside * level / norm, dtype=np.float64)
