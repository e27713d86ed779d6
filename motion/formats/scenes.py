"""Markers and skeletons as gesture scenes, and a scene's points as markers.

A GST file has no word for which way is up. Scenes made here are z up, x forward, as everywhere in
this package: axes are exchanged, which changes no number, and lengths stay in the file's own unit,
which the channel's measure names.
"""

from __future__ import annotations

import re
from math import isclose, pi

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import MotionError
from enpointe.motion.formats.guessing import UNITS
from enpointe.motion.formats.markers import Analog, MarkerMotion
from enpointe.motion.formats.skeleton import Joint, SkeletonMotion
from enpointe.motion.formats.space import DEGREES, Space
from enpointe.motion.gesture.scene import Channel, Dimension, Scene, Unit, Variable

__all__ = ["markers_of_scene", "scene_of_markers", "scene_of_skeleton"]

Array = NDArray[np.float64]
_SOME_METRES = re.compile(r"([0-9.e+-]+) m")
_ANALOG = {
    "n": Variable.FORCE,
    "nm": Variable.FORCE,
    "nmm": Variable.FORCE,
    "m": Variable.POSITION,
    "cm": Variable.POSITION,
    "mm": Variable.POSITION,
    "deg": Variable.ANGLE,
    "rad": Variable.ANGLE,
    "m/s": Variable.VELOCITY,
    "mm/s": Variable.VELOCITY,
    "m/s^2": Variable.ACCELERATION,
    "m/s2": Variable.ACCELERATION,
    "g": Variable.ACCELERATION,
}
_BY_AXES = {"".join(sorted(d.value[2:])): d for d in Dimension if d is not Dimension.RQF}


def scene_of_markers(motion: MarkerMotion, name: str = "") -> tuple[Scene, tuple[str, ...]]:
    """One unit of 3D positions, a channel a marker, and one of the analog signals at their rate.

    Args:
        motion: The markers.
        name: The scene's.

    Returns:
        The scene, and what of the motion it does not hold, one line each.

    Raises:
        MotionError: No markers.
    """
    measure = _measure(motion.space)
    channels = tuple(Channel(marker, measure=measure) for marker in motion.names)
    points = motion.positions @ motion.space.to_ours.T
    units = [Unit("markers", channels, motion.rate)]
    signals = [points.reshape(motion.frames, -1)]
    lost = []
    if motion.analog is not None:
        unit, signal, without = _of_analog(motion.analog)
        lost += without
        if unit is not None:
            units.append(unit)
            signals.append(signal)
    for what, held in (
        ("orientations", motion.orientations is not None),
        ("residuals", motion.residuals is not None),
        ("camera masks", motion.cameras is not None),
        (f"{len(motion.labels)} labels", bool(motion.labels)),
        (f"{len(motion.notes)} notes", bool(motion.notes)),
        (f"the number of the first frame, {motion.start}", motion.start != 1),
    ):
        if held:
            lost.append(what)
    return Scene(name, tuple(units), tuple(signals)), tuple(lost)


def scene_of_skeleton(motion: SkeletonMotion, name: str = "") -> tuple[Scene, tuple[str, ...]]:
    """One unit, each joint with its place in the world and the angles that the file turns it by.

    "In absolute coordinates", as the document wants motions free of a hierarchy (§4.4); the angles
    are beside them for whoever has the hierarchy. Their channel is called by the joint and the
    order in which the rotations are multiplied, "hip ZXY"; its tracks are in the channel's order.

    Args:
        motion: The skeleton.
        name: The scene's.

    Returns:
        The scene, and what of the motion it does not hold, one line each.
    """
    positions, _ = motion.world()
    points = positions @ motion.skeleton.space.to_ours.T
    measure = _measure(motion.skeleton.space)
    channels, columns = [], []
    lost = ["the hierarchy and its offsets"]
    for index, joint in enumerate(motion.skeleton.joints):
        channels.append(Channel(joint.name, measure=measure))
        columns.append(points[:, index])
        values = motion.values[:, motion.skeleton.columns(index)]
        if joint.turning:
            angles = _angles(joint, motion.skeleton.space)
            channels.append(angles)
            axes = [f"{axis.upper()}rotation" for axis in angles.dimension.axes]
            columns.append(values[:, [joint.channels.index(axis) for axis in axes]])
        if any(channel.endswith("scale") for channel in joint.channels):
            lost.append(f"scales of {joint.name!r}")
    if motion.notes:
        lost.append(f"{len(motion.notes)} notes")
    unit = Unit("skeleton", tuple(channels), motion.rate)
    return Scene(name, (unit,), (np.hstack(columns),)), tuple(lost)


def markers_of_scene(scene: Scene) -> tuple[MarkerMotion, tuple[str, ...]]:
    """The 3D positions of a scene as markers, in metres unless all have one other unit of length.

    Args:
        scene: With 3D positions in one rate; several units of that rate are put side by side.

    Returns:
        The markers, and what of the scene they do not hold, one line each. Lengths without a
        measure are metres.

    Raises:
        MotionError: No 3D positions, or some of different rates or lengths of time, or in a measure
            that is no length.
    """
    found, lost = [], []
    for unit, signal in zip(scene.units, scene.signals, strict=True):
        first = 0
        for channel in unit.channels:
            own = signal[:, first : first + channel.width]
            first += channel.width
            if channel.variable is Variable.POSITION and channel.dimension is Dimension.XYZ:
                found.append((unit, channel, own))
            else:
                lost.append(f"channel {channel.label} of unit {unit.name!r}")
    if not found:
        raise MotionError(f"scene {scene.name!r} has no 3D positions to make markers of")
    kinds = {(unit.rate, len(own)) for unit, _, own in found}
    if len(kinds) > 1:
        listed = ", ".join(f"{length} at {rate:g} Hz" for rate, length in sorted(kinds))
        raise MotionError(f"markers have one rate and length, these positions have {listed}")
    lengths = [_metres(channel) for _, channel, _ in found]
    metres = lengths[0] if len(set(lengths)) == 1 else 1.0
    several = len({unit.name for unit, _, _ in found}) > 1
    names = tuple(f"{u.name}:{c.name}" if several else c.name for u, c, _ in found)
    positions = np.stack(
        [
            own if length == metres else own * length
            for length, (_, _, own) in zip(lengths, found, strict=True)
        ],
        axis=1,
    )
    motion = MarkerMotion(names, found[0][0].rate, positions, Space(metres, up="z"))
    return motion, tuple(lost)


def _of_analog(analog: Analog) -> tuple[Unit | None, Array, list[str]]:
    channels, kept, lost = [], [], []
    for column, (name, measure) in enumerate(zip(analog.names, analog.units, strict=True)):
        variable = _ANALOG.get(measure.strip().lower().replace(" ", ""))
        if variable is None:
            lost.append(f"analog signal {name!r} in {measure!r}, neither in space nor a force")
        else:
            channels.append(Channel(name, variable, Dimension.SCALAR, measure))
            kept.append(column)
    unit = Unit("analog", tuple(channels), analog.rate) if channels else None
    signal = np.asarray(analog.values[:, kept], dtype=np.float64)
    return unit, signal, lost


def _angles(joint: Joint, space: Space) -> Channel:
    dimension = _BY_AXES["".join(sorted(joint.product.lower()))]
    unit = space.radians_per_unit
    measure = "deg" if isclose(unit, DEGREES) else "rad" if unit == 1.0 else f"{unit / pi!r} pi rad"
    return Channel(f"{joint.name} {joint.product}", Variable.ANGLE, dimension, measure)


def _measure(space: Space) -> str:
    for name, metres in UNITS.items():
        if isclose(space.metres_per_unit, metres, rel_tol=1e-12):
            return name
    return f"{space.metres_per_unit!r} m"


def _metres(channel: Channel) -> float:
    if not channel.measure:
        return 1.0
    if channel.measure in UNITS:
        return UNITS[channel.measure]
    several = _SOME_METRES.fullmatch(channel.measure)
    try:
        length = float(several[1]) if several else 0.0
    except ValueError:
        length = 0.0
    if not np.isfinite(length) or length <= 0:
        raise MotionError(f"{channel.name!r} is in {channel.measure!r}, which is no known length")
    return length
