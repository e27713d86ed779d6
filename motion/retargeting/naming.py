"""Landmarks found by the names that makers of skeletons and marker sets give."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from enpointe.models.anatomy import SIDES
from enpointe.motion.formats.skeleton import Skeleton
from enpointe.motion.retargeting.joint_map import END, JointMap

__all__ = ["map_markers_by_names", "map_skeleton_by_names"]

# The first name that a skeleton has is taken. CMU's ASF and BVH, MotionBuilder and Mixamo, DAZ and
# Poser, Biovision, Rokoko, SMPL.
_SIDED: Mapping[str, tuple[str, ...]] = {
    "hip": ("upleg", "femur", "thigh", "upperleg", "hip"),
    "knee": ("knee", "tibia", "shin", "lowerleg", "calf", "leg"),
    "ankle": ("ankle", "foot"),
    "toe": ("toebase", "toes", "toe", "ball"),
    "shoulder": ("humerus", "shldr", "upperarm", "arm", "shoulder"),
    "elbow": ("elbow", "radius", "forearm", "lowerarm"),
    "wrist": ("hand", "wrist"),
    "hand": ("fingers", "middle1", "handmiddle1", "mid1", "handindex1", "index1", "fingerbase"),
}
_CENTRAL: Mapping[str, tuple[str, ...]] = {
    "pelvis": ("hips", "pelvis", "root", "hip"),
    "chest": ("thorax", "chest4", "chest3", "chest2", "spine3", "spine2", "spine1", "chest"),
    "neck": ("lowerneck", "neck", "neck1", "upperneck"),
    "head": ("head",),
}
# Plug-in gait and Helen Hayes, CMU, the anatomical names of Qualisys' and OpenSim's examples, BTS.
_MARKERS: Mapping[str, tuple[str, ...]] = {
    "front_hip": ("asi", "asis", "fwt", "ias"),
    "back_hip": ("psi", "psis", "bwt", "ips"),
    "hip": ("hjc", "hip"),
    "knee": ("kne", "knee", "fle", "kneelateral", "kneelat", "lfc", "knee1", "kne1"),
    "knee+": ("knm", "mkne", "kneemed", "kneemedial", "fme", "mfc", "knee2", "kne2"),
    "ankle": ("ank", "ankle", "fal", "anklelateral", "anklelat", "lmal", "mall"),
    "ankle+": ("mma", "mank", "anklemed", "anklemedial", "tam", "mmal"),
    "heel": ("hee", "heel", "hel", "fcc"),
    "toe": ("toe", "mt2", "fm2", "fm1", "toemed", "met"),
    "toe+": ("mt5", "fm5", "toelat"),
    "shoulder": ("sho", "shoulder", "acr", "saj", "acromion", "acromium", "should"),
    "elbow": ("elb", "elbow", "hle", "lel"),
    "elbow+": ("hme", "mel", "elbm"),
    "wrist": ("wra", "wrist", "rsp", "wristlat"),
    "wrist+": ("wrb", "uhe", "wristmed"),
    "hand": ("fin", "hm2", "mcp3"),
    "front_head": ("fhd", "hdf"),
    "back_head": ("bhd", "hdb"),
}
_CENTRAL_MARKERS: Mapping[str, tuple[str, ...]] = {
    "chest_front": ("clav", "ij", "snj"),
    "chest_back": ("c7", "cv7"),
    "sternum": ("strn", "px", "sxs"),
    "back": ("t10", "tv8", "t8"),
    "sacrum": ("sacr", "sacrum", "vsacral", "vsac"),
}


def map_skeleton_by_names(skeleton: Skeleton) -> JointMap:
    """What of a skeleton the names tell; whether that is enough, `JointMap.missing` says."""
    sides, centre = _split(skeleton.names)
    points: dict[str, tuple[str, ...]] = {}
    for side in SIDES:
        for landmark, names in _SIDED.items():
            joint = _first(sides[side], names)
            if joint is not None:
                points[f"{side}_{landmark}"] = (joint,)
        _add_ends(points, skeleton, side)
    for landmark, names in _CENTRAL.items():
        joint = _first(centre, names)
        if joint is not None:
            points[landmark] = (joint,)
    return JointMap(points, frames_of(skeleton, points), "names")


def frames_of(skeleton: Skeleton, points: Mapping[str, tuple[str, ...]]) -> dict[str, str]:
    """Joints whose rotation is that of pelvis, torso, head and feet."""
    frames = {}
    names = skeleton.names
    hips = [points.get(f"{side}_hip", ("",))[0] for side in SIDES]
    if all(hip in names for hip in hips):
        frames["pelvis"] = _common(skeleton, *(names.index(hip) for hip in hips))
    shoulders = [points.get(f"{side}_shoulder", ("",))[0] for side in SIDES]
    if all(shoulder in names for shoulder in shoulders):
        frames["torso"] = _common(skeleton, *(names.index(each) for each in shoulders))
    for frame, landmark in (("head", "head"), *((f"{s}_foot", f"{s}_ankle") for s in SIDES)):
        if points.get(landmark, ("",))[0] in names:
            frames[frame] = points[landmark][0]
    return frames


def _common(skeleton: Skeleton, one: int, other: int) -> str:
    """The nearest joint that both hang on."""
    above = set()
    while one >= 0:
        above.add(one)
        one = skeleton.joints[one].parent
    while other not in above and other >= 0:
        other = skeleton.joints[other].parent
    return skeleton.names[max(other, 0)]


def _add_ends(points: dict[str, tuple[str, ...]], skeleton: Skeleton, side: str) -> None:
    """Toes and hands that are end sites."""
    names = skeleton.names
    for landmark, joint, instead in (
        ("toe_tip", "toe", "toe_tip"),
        ("toe", "ankle", "toe"),
        ("hand", "wrist", "hand"),
    ):
        above = points.get(f"{side}_{joint}")
        if f"{side}_{instead}" in points or above is None:
            continue
        ends = skeleton.joints[names.index(above[0])].ends
        if ends and max(abs(value) for value in ends[0]) > 0:
            points[f"{side}_{landmark}"] = (above[0] + END,)


def map_markers_by_names(names: Sequence[str]) -> JointMap:
    """What of a marker set the names tell."""
    sides, centre = _split(names)
    points: dict[str, tuple[str, ...]] = {}
    for side in SIDES:
        for landmark, candidates in _MARKERS.items():
            marker = _first(sides[side], candidates)
            if marker is not None:
                name = f"{side}_{landmark.removesuffix('+')}"
                points[name] = (*points.get(name, ()), marker)
    for landmark, candidates in _CENTRAL_MARKERS.items():
        marker = _first(centre, candidates)
        if marker is not None:
            points[landmark] = (marker,)
    return JointMap(points, {}, "names")


def _split(names: Iterable[str]) -> tuple[dict[str, dict[str, str]], dict[str, str]]:
    """Names by side, and those of the middle, each by what is left of it in plain letters."""
    sides: dict[str, dict[str, str]] = {side: {} for side in SIDES}
    centre: dict[str, str] = {}
    for name in names:
        bare = name.rsplit(":", 1)[-1]
        for side, rest in _readings(bare):
            sides[side].setdefault(rest, name)
        centre.setdefault(_plain(bare), name)
    return sides, centre


def _readings(name: str) -> Iterable[tuple[str, str]]:
    """What a name says if its first letters, or its last, are a side."""
    for side in SIDES:
        for prefix in (side, side[0]):
            if name.lower().startswith(prefix) and len(name) > len(prefix) + 1:
                yield side, _plain(name[len(prefix) :])
            if re.search(rf"[._ ]{prefix}$", name, re.IGNORECASE):
                yield side, _plain(name[: -len(prefix)])


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


def _first(found: Mapping[str, str], names: Sequence[str]) -> str | None:
    return next((found[name] for name in names if name in found), None)
