"""The contacts of a capture, as steps that a body can take."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import find_objects, label

from enpointe.models.anatomy import SIDES
from enpointe.motion.contact_schedule import ON_FLOOR, ContactSchedule, without_chatter
from enpointe.motion.foot_turns import held_headings, turned_about

__all__ = ["SHORTEST_FLIGHT", "led", "stances"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
SHORTEST_FLIGHT = 0.1
"""s: a shorter time without a sole on the floor is a step seen late; what stood stays down until
something else stands."""
MOST_SLIDE = 0.03
"""m: a standing foot that slides no farther is taken to stand still; one that is farther from where
it rests is on its way."""
_MOST_GLIDE = 0.065
"""m: the same of a foot that bears alone, which can't be on its way. Seen were glides of 51 and 58
mm in .06 and .13 s, of feet that pivoted, and of 76 mm in .36 s, which was a slide."""
_RESTING, _RESTS = 0.1, 0.08
"""m/s and s: slower than the first for as long as the second, a foot rests."""


def stances(model: mujoco.MjModel, contacts: ContactSchedule) -> ContactSchedule:
    """The same contacts as a body can have them that does not skate.

    - contacts, and gaps in them, too short to shift weight in are left out;
    - a foot that comes down with its heel first, or leaves so, is flat meanwhile: nobody balances
      on a heel that rolls; and a heel as low as the floor bears beside the toes;
    - a foot turns no more than it must while it stands (`foot_turns`);
    - a foot stays where it rests while it stands: one that lands is seen to stand before it rests,
      and where its heel leaves the floor the rest seems to jump; one that carries alone glides a
      little only in the eyes of the camera;
    - farther from there it is on its way, low over the floor, while the other foot stands, or is
      nearer to where it does. If none is, it stands already where it will rest, or still where it
      did.

    Args:
        model: Whose soles they are.
        contacts: Evenly sampled.
    """
    contacts, period = _bridged(contacts), _period(contacts)
    bears, points = contacts.bears.copy(), contacts.points.copy()
    _lay_down(model, contacts.soles, bears, points)
    feet = [_soles_of(model, contacts.soles, side) for side in SIDES]
    for side in SIDES:
        _flatten(model, contacts.soles, side, bears, points)
        _hold_heading(*_parts_of(model, contacts.soles, side), bears, points, period)
    astray = [
        _plant(foot, bears, points, period, np.asarray(~bears[:, other].any(axis=1)))
        for foot, other in zip(feet, reversed(feet), strict=True)
    ]
    for foot, away, other in zip(feet, astray, reversed(astray), strict=True):
        bears[np.ix_((away > MOST_SLIDE) & (away > other), foot)] = False
    return _bridged(ContactSchedule(contacts.time, contacts.soles, points, bears))


def led(contacts: ContactSchedule) -> ContactSchedule:
    """The same stances; soles go from each to the next by a smooth step at height 0.

    Where a captured foot comes and goes, its soles jump by centimetres from sample to sample: they
    are seen to stand, or not to.

    Args:
        contacts: Evenly sampled.
    """
    contacts = _bridged(contacts)
    points = contacts.points.copy()
    for sole, standing in enumerate(contacts.bears.T):
        if standing.any():
            points[:, sole] = _stepped(points[:, sole], standing)
    return ContactSchedule(contacts.time, contacts.soles, points, contacts.bears)


def _period(contacts: ContactSchedule) -> float:
    return float(np.median(np.diff(contacts.time)))


def _bridged(contacts: ContactSchedule) -> ContactSchedule:
    """The same without contacts, and gaps in them, too short to shift weight in."""
    period = _period(contacts)
    bears, points = without_chatter(contacts.bears, period), contacts.points.copy()
    _carry(bears, points, period)
    return ContactSchedule(contacts.time, contacts.soles, points, bears)


def _carry(bears: Mask, points: Array, period: float) -> None:
    """Bridge short times with nothing down by what stood before them, where it stood."""
    for (gap,) in find_objects(label(~bears.any(axis=1))[0]):
        short = (gap.stop - gap.start) * period < SHORTEST_FLIGHT - 1e-9
        if short and gap.start > 0 and gap.stop < len(bears):
            bears[gap], points[gap] = bears[gap.start - 1], points[gap.start - 1]


def _flatten(
    model: mujoco.MjModel, soles: NDArray[np.int64], side: str, bears: Mask, points: Array
) -> None:
    """Lay a foot flat where only its heel bears beside a time when it is flat.

    It lies in place, or, farther away, where its heel is: one that strikes early glides on to where
    it will stand.
    """
    heel, toes = _parts_of(model, soles, side)
    foot = _soles_of(model, soles, side)
    on_heel, on_toes = (np.asarray(bears[:, part].any(axis=1)) for part in (heel, toes))
    flat = np.asarray(bears[:, foot].all(axis=1))
    for (stance,) in find_objects(label(on_heel | on_toes)[0]):
        rows = np.arange(stance.start, stance.stop)
        stood = rows[flat[rows]]
        if len(stood):
            alone = rows[on_heel[rows] & ~on_toes[rows]]
            nearest = stood[np.abs(alone[:, None] - stood).argmin(axis=1)]
            gone = points[np.ix_(alone, heel)] - points[np.ix_(nearest, heel)]
            gone = gone.mean(axis=1, keepdims=True) * [1.0, 1.0, 0.0]
            gone[np.linalg.norm(gone, axis=2) < MOST_SLIDE] = 0.0
            points[np.ix_(alone, foot)] = points[np.ix_(nearest, foot)] + gone
            bears[np.ix_(alone, foot)] = True


def _lay_down(model: mujoco.MjModel, soles: NDArray[np.int64], bears: Mask, points: Array) -> None:
    """Let a heel that lies on the floor bear beside toes that do."""
    for side in SIDES:
        heel, toes = _parts_of(model, soles, side)
        beside = bears[:, toes].any(axis=1, keepdims=True)
        bears[:, heel] |= beside & (points[:, heel, 2] < ON_FLOOR)


def _parts_of(
    model: mujoco.MjModel, soles: NDArray[np.int64], side: str
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of a foot's heel, and of its toes."""
    bodies = model.geom_bodyid[soles]
    heel, toes = (bodies == model.body(f"{side}_{part}").id for part in ("foot", "toe"))
    return np.flatnonzero(heel), np.flatnonzero(toes)


def _soles_of(model: mujoco.MjModel, soles: NDArray[np.int64], side: str) -> NDArray[np.int64]:
    return np.union1d(*_parts_of(model, soles, side))


def _hold_heading(
    heel: NDArray[np.int64], toes: NDArray[np.int64], bears: Mask, points: Array, period: float
) -> None:
    """Turn a foot in its stances no more than it must, about the middle of what bears."""
    foot = np.union1d(heel, toes)
    stands = np.asarray(bears[:, foot].any(axis=1))
    ahead = points[:, toes, :2].mean(axis=1) - points[:, heel, :2].mean(axis=1)
    heading = np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0]))
    angle = np.where(stands, held_headings(heading, stands, 1.0 / period) - heading, 0.0)
    share = bears[:, foot] / np.maximum(bears[:, foot].sum(axis=1, keepdims=True), 1)
    centre = (share[:, :, None] * points[:, foot, :2]).sum(axis=1)
    points[:, foot] = turned_about(points[:, foot], centre, angle)


def _plant(foot: NDArray[np.int64], bears: Mask, points: Array, period: float, alone: Mask) -> Mask:
    """Keep a foot where it rests for as long as it stands; it may turn there.

    Its place is the mean of the soles that bear; where others take over, it has not moved.

    Returns:
        (T,), how far it seems to be from there, m; infinite where it does not stand.
    """
    astray = np.full(len(bears), np.inf)
    for (stance,) in find_objects(label(bears[:, foot].any(axis=1))[0]):
        bearing, placed = bears[stance, foot], points[stance][:, foot, :2]
        both = (bearing[1:] & bearing[:-1])[:, :, None]
        steps = np.sum(np.diff(placed, axis=0) * both, axis=1) / np.maximum(both.sum(axis=1), 1)
        way = np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])
        back = _home(way, period, alone[stance]) - way
        points[stance, foot, :2] += back[:, None]
        astray[stance] = np.linalg.norm(back, axis=1)
    return astray


def _home(way: Array, period: float, alone: Mask) -> Array:
    """(K, 2), where a foot that goes along a way (K, 2) rests, or comes to rest, or did.

    A foot that bears alone all the way from one rest to the next, and that not far, has not moved:
    what is seen is the body's drift, or a glide that no weight can make.
    """
    speed = np.linalg.norm(np.diff(way, axis=0, prepend=way[:1]), axis=1) / period
    rests = [
        run
        for (run,) in find_objects(label(speed < _RESTING)[0])
        if (run.stop - run.start) * period >= _RESTS
    ] or [slice(0, len(way))]
    places = [way[rests[0]]]
    ends = [rests[0].stop]
    for run in rests[1:]:
        here = np.median(way[run], axis=0)
        carries = alone[ends[-1] - 1 : run.start + 1].all()
        most = _MOST_GLIDE if carries else MOST_SLIDE
        if np.linalg.norm(here - np.median(places[-1], axis=0)) < most:
            places[-1] = np.vstack([places[-1], way[run]])
            ends[-1] = run.stop
        else:
            # On its way from one place to another it is at the nearer.
            there = np.median(places[-1], axis=0)
            between = way[ends[-1] : run.start]
            nearer = np.linalg.norm(between - there, axis=1) < np.linalg.norm(
                between - here, axis=1
            )
            ends[-1] += int(nearer.sum())
            places.append(way[run])
            ends.append(run.stop)
    ends[-1] = len(way)
    lengths = np.diff([0, *ends])
    return np.repeat([np.median(place, axis=0) for place in places], lengths, axis=0)


def _stepped(points: Array, standing: Mask) -> Array:
    """A sole's places (T, 3) where it stands, and a smooth step between them."""
    rows = np.arange(len(points))
    stood = np.flatnonzero(standing)
    following = np.searchsorted(stood, rows)
    after = stood[np.minimum(following, len(stood) - 1)]
    before = np.where(standing, rows, stood[np.maximum(following - 1, 0)])
    share = np.clip((rows - before) / np.maximum(after - before, 1), 0.0, 1.0)
    share = (share**2 * (3.0 - 2.0 * share))[:, None]
    stepped = (1.0 - share) * points[before] + share * points[after]
    stepped[:, 2] = 0.0
    return np.asarray(stepped)
