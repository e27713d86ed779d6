"""Any captured movement on our dancer, feet and all."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.models.anatomy import SIDES
from enpointe.models.dancer import dancer_model
from enpointe.models.soles import sole_geoms
from enpointe.motion.contact_schedule import ON_FLOOR, ContactSchedule, trace_soles
from enpointe.motion.formats.content import Content, Payload
from enpointe.motion.formats.registry import read
from enpointe.motion.motion import Motion
from enpointe.motion.retargeting.body import BALL, HEEL, NONE, TIP, Body
from enpointe.motion.retargeting.flips import mended
from enpointe.motion.retargeting.floor import levelled, steps_of
from enpointe.motion.retargeting.flowing import flowing
from enpointe.motion.retargeting.joint_map import JointMap
from enpointe.motion.retargeting.pinning import pinned
from enpointe.motion.retargeting.plan import Plan, make_plan
from enpointe.motion.retargeting.posing import posed
from enpointe.motion.retargeting.proposing import point_names, propose_map
from enpointe.motion.retargeting.residual import Residual, residuals
from enpointe.motion.retargeting.skating import slides
from enpointe.motion.retargeting.source import Source, source_of

__all__ = ["Retargeted", "retarget"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Retargeted:
    """A captured movement on another body.

    Attributes:
        motion: On that body, at the file's own rate.
        contacts: Which soles are meant to be on the floor, and when.
        standing: By side, (T,), when that foot stands still there: it neither slides nor is lifted.
        map: Which points of the source were taken for what.
        warnings: What was doubtful and how it was taken, one line each.
        residuals: Of each segment and part, how far its direction is from the captured one.
        scale: Size of the body over that of the captured one.
        slides: By side, (T,), how far the captured foot, in its own size, has slid since it came to
            bear, m; see `skating`.
    """

    motion: Motion
    contacts: ContactSchedule
    standing: Mapping[str, NDArray[np.bool_]]
    map: JointMap
    warnings: tuple[str, ...]
    residuals: Mapping[str, Residual]
    scale: float
    slides: Mapping[str, Array]


def retarget(
    content: Content | Payload | str | Path,
    model: mujoco.MjModel | Body | None = None,
    *,
    mapping: JointMap | str | Path | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Retargeted:
    """Put a captured movement on a body.

    Args:
        content: A motion file, or what was read from one.
        model: Whose body: a model with the dancer's names, or a `Body` that says what its own are;
            our dancer without.
        mapping: Which points are which landmarks, or a file that says so; found without.
        progress: Called with (done, all) now and then.

    Returns:
        The movement, with what it was made with.

    Raises:
        FormatError: The file, or the mapping file, can't be read.
        MotionError: A landmark is missing, or the movement is a scene, or one frame.
        ModelError: The body lacks what the dancer has.
    """
    name = Path(content).stem if isinstance(content, str | Path) else "captured"
    read_in = read(content) if isinstance(content, str | Path) else content
    payload = read_in.motion if isinstance(read_in, Content) else read_in
    warnings = read_in.warnings if isinstance(read_in, Content) else ()
    if mapping is None:
        mapping = propose_map(payload)
    elif not isinstance(mapping, JointMap):
        mapping = JointMap.load(mapping)
    mapping.check(point_names(payload), name)
    body = model if isinstance(model, Body) else Body(dancer_model() if model is None else model)
    source = levelled(mended(source_of(payload, mapping)))
    scale = body.leg / _leg(source)
    steps = steps_of(source, body, scale)
    plan = make_plan(source, body, steps, scale)
    qpos = flowing(plan, body, posed(plan, body, progress))
    qpos = pinned(plan, body, qpos)
    motion = Motion.from_qpos(body.model, source.time, qpos, name=name)
    return Retargeted(
        motion,
        _contacts(motion, body, plan),
        {side: plan.feet[side].still & (plan.feet[side].kind != TIP) for side in SIDES},
        mapping,
        (*warnings, *source.warnings),
        residuals(plan, body, motion),
        scale,
        slides(steps, source.time),
    )


def _leg(source: Source) -> float:
    """Hip to ankle along the bones, both legs' mean of medians, m."""
    lengths = [
        float(np.median(np.linalg.norm(source.points[end] - source.points[start], axis=1)))
        for side in SIDES
        for start, end in ((f"{side}_hip", f"{side}_knee"), (f"{side}_knee", f"{side}_ankle"))
    ]
    return sum(lengths) / 2


def _contacts(motion: Motion, body: Body, plan: Plan) -> ContactSchedule:
    model = motion.model
    soles = sole_geoms(model)
    points = trace_soles(motion, soles)
    bears = np.zeros(points.shape[:2], dtype=bool)
    for side, other in zip(SIDES, reversed(SIDES), strict=True):
        foot, kind = plan.feet[side], plan.feet[side].kind
        carries = (kind != NONE) & ((kind != TIP) | (plan.feet[other].kind == NONE))
        ends = body.soles_of(side)
        for end, when in (
            (HEEL, foot.flat | (kind == HEEL)),
            (BALL, foot.flat | (kind == BALL)),
            (TIP, foot.flat | (kind == BALL) | (kind == TIP)),
        ):
            bears[:, np.isin(soles, ends[end])] |= (when & carries)[:, None]
    # A foot that its joints can't lay flat bears with what of it is down.
    return ContactSchedule(motion.time, soles, points, bears & (points[:, :, 2] < ON_FLOOR))
