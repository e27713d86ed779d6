"""What the dancer looks like: lofted limbs, a bun, ballet hands and slippers.

Purely visual: no geom here has mass or takes part in contacts. Shapes are drawn for a stature of
1.68 m and scale with each bone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco

from enpointe.models.anatomy import NECK_RISE, SIDES, Skeleton, side_sign
from enpointe.models.anthropometry import Sex
from enpointe.models.loft import Ring, loft

__all__ = ["add_flesh"]

_DRAWN_FOR = 1.68
_CROWN_DRAWN_AT = 0.2825


@dataclass(frozen=True, slots=True)
class _Wardrobe:
    skin: tuple[float, float, float]
    top: tuple[float, float, float]
    tights: tuple[float, float, float]
    shoes: tuple[float, float, float]
    hair: tuple[float, float, float]


_BALLERINA = _Wardrobe(
    skin=(0.90, 0.73, 0.63),
    top=(0.17, 0.19, 0.33),
    tights=(0.93, 0.79, 0.77),
    shoes=(0.89, 0.64, 0.62),
    hair=(0.20, 0.13, 0.10),
)
_DANSEUR = _Wardrobe(
    skin=(0.84, 0.66, 0.55),
    top=(0.90, 0.90, 0.89),
    tights=(0.22, 0.23, 0.26),
    shoes=(0.30, 0.30, 0.32),
    hair=(0.16, 0.11, 0.08),
)

# (share of the bone's length from its upper end, depth half-width, breadth half-width, shift), m
_Profile = Sequence[tuple[float, float, float, float]]
_UPPER_ARM: _Profile = (
    (-0.135, 0.010, 0.009, 0.0),
    (-0.120, 0.024, 0.022, 0.0),
    (-0.070, 0.039, 0.037, 0.0),
    (0.02, 0.047, 0.043, 0.0),
    (0.18, 0.045, 0.040, 0.0),
    (0.50, 0.039, 0.036, 0.0),
    (0.85, 0.033, 0.032, 0.0),
    (1.05, 0.030, 0.030, 0.0),
)
_FOREARM: _Profile = (
    (-0.06, 0.030, 0.030, 0.0),
    (0.05, 0.034, 0.034, 0.0),
    (0.25, 0.035, 0.034, 0.0),
    (0.60, 0.028, 0.027, 0.0),
    (0.90, 0.022, 0.019, 0.0),
    (1.04, 0.022, 0.017, 0.0),
)
_THIGH: _Profile = (
    (-0.16, 0.050, 0.045, -0.006),
    (0.00, 0.082, 0.077, -0.006),
    (0.18, 0.085, 0.080, -0.003),
    (0.45, 0.076, 0.071, 0.0),
    (0.72, 0.062, 0.058, 0.002),
    (0.92, 0.053, 0.050, 0.004),
    (1.04, 0.048, 0.046, 0.004),
)
_SHANK: _Profile = (
    (-0.06, 0.045, 0.044, 0.002),
    (0.03, 0.049, 0.047, 0.002),
    (0.14, 0.049, 0.047, -0.006),
    (0.30, 0.053, 0.050, -0.013),
    (0.47, 0.047, 0.044, -0.010),
    (0.70, 0.034, 0.032, -0.004),
    (0.88, 0.027, 0.026, 0.0),
    (1.03, 0.029, 0.026, 0.0),
)
# (height, depth half-width, breadth half-width, shift forward), m
_PELVIS: _Profile = (
    (-0.088, 0.030, 0.025, -0.004),
    (-0.065, 0.070, 0.080, -0.006),
    (-0.020, 0.098, 0.146, -0.012),
    (0.030, 0.099, 0.153, -0.013),
    (0.080, 0.088, 0.142, -0.007),
    (0.130, 0.078, 0.123, 0.0),
    (0.200, 0.073, 0.112, 0.0),
)
_LEOTARD: _Profile = (
    (-0.035, 0.072, 0.112, 0.0),
    (0.020, 0.074, 0.112, 0.0),
    (0.090, 0.083, 0.122, 0.002),
    (0.150, 0.094, 0.134, 0.009),
    (0.190, 0.098, 0.141, 0.010),
    (0.235, 0.087, 0.143, 0.003),
    (0.262, 0.078, 0.142, 0.000),
)
_SHOULDERS: _Profile = (
    (0.225, 0.080, 0.138, 0.000),
    (0.262, 0.0775, 0.1415, 0.000),
    (0.295, 0.068, 0.147, -0.003),
    (0.315, 0.055, 0.135, -0.008),
    (0.333, 0.047, 0.097, -0.012),
    (0.350, 0.043, 0.066, -0.013),
    (0.372, 0.040, 0.047, -0.013),
    (0.390, 0.036, 0.040, -0.013),
)
_NECK: _Profile = (
    (-0.060, 0.044, 0.052, -0.010),
    (-0.020, 0.043, 0.045, -0.008),
    (0.030, 0.043, 0.043, -0.004),
    (0.100, 0.045, 0.044, 0.004),
)
_HEAD: _Profile = (
    (0.066, 0.016, 0.018, 0.062),
    (0.075, 0.030, 0.030, 0.052),
    (0.095, 0.056, 0.046, 0.030),
    (0.130, 0.078, 0.060, 0.016),
    (0.170, 0.091, 0.069, 0.006),
    (0.210, 0.095, 0.073, 0.001),
    (0.245, 0.086, 0.068, -0.003),
    (0.270, 0.060, 0.048, -0.006),
    (0.282, 0.025, 0.020, -0.008),
)
# (share from heel to ball, half-height, half-breadth), m; the bottom lies on the sole.
_FOOT = (
    (-0.02, 0.010, 0.012),
    (0.02, 0.022, 0.021),
    (0.12, 0.034, 0.028),
    (0.30, 0.046, 0.030),
    (0.48, 0.044, 0.031),
    (0.72, 0.028, 0.036),
    (0.94, 0.018, 0.040),
    (1.06, 0.014, 0.039),
)
_TOES = (
    (-0.20, 0.012, 0.036),
    (0.05, 0.014, 0.039),
    (0.5, 0.012, 0.035),
    (0.9, 0.010, 0.022),
    (1.0, 0.006, 0.012),
)
# Ballet hand: index long, middle finger towards the thumb, little finger just parted.
# Base, middle joint and tip: forward (thumb side), towards the palm, down; m.
_FINGERS = {
    "index": ((0.026, 0.000, -0.078), (0.029, 0.005, -0.116), (0.029, 0.013, -0.150)),
    "middle": ((0.009, 0.001, -0.083), (0.012, 0.018, -0.119), (0.015, 0.036, -0.144)),
    "ring": ((-0.010, 0.001, -0.081), (-0.008, 0.013, -0.117), (-0.004, 0.029, -0.144)),
    "little": ((-0.026, 0.000, -0.074), (-0.029, 0.004, -0.103), (-0.031, 0.012, -0.128)),
    "thumb": ((0.024, 0.008, -0.022), (0.037, 0.021, -0.058), (0.029, 0.031, -0.088)),
}


def add_flesh(spec: mujoco.MjSpec, skeleton: Skeleton) -> None:
    """Clothe every body of the dancer in `spec`."""
    female = skeleton.measures.sex is Sex.FEMALE
    tailor = _Tailor(spec, skeleton, _BALLERINA if female else _DANSEUR)
    tailor.trunk()
    tailor.head(bun=female)
    for side in SIDES:
        tailor.arm(side)
        tailor.leg(side)


class _Tailor:
    def __init__(self, spec: mujoco.MjSpec, skeleton: Skeleton, wardrobe: _Wardrobe) -> None:
        self._spec = spec
        self._skeleton = skeleton
        self._size = skeleton.measures.height / _DRAWN_FOR
        for name in ("skin", "top", "tights", "shoes", "hair"):
            spec.add_material(
                name=name,
                rgba=[*getattr(wardrobe, name), 1],
                specular=0.35 if name == "shoes" else 0.12,
                shininess=0.3,
            )
        spec.add_material(name="eyes", rgba=[0.12, 0.09, 0.08, 1])
        spec.add_material(name="lips", rgba=[0.74, 0.36, 0.36, 1])

    def trunk(self) -> None:
        waist = self._skeleton.waist_height / (0.1757 * self._size)
        chest = self._skeleton.torso_length / (0.3368 * self._size)
        self._standing_loft("pelvis", "pelvis_flesh", _PELVIS, "top", waist)
        self._standing_loft("torso", "leotard", _LEOTARD, "top", chest)
        self._standing_loft("torso", "shoulders", _SHOULDERS, "skin", chest)

    def head(self, *, bun: bool) -> None:
        """Drawn above a woman's neck; a shorter neck sinks the head to where its crown is."""
        crown = self._skeleton.head_and_neck - NECK_RISE
        sink = crown / self._size - _CROWN_DRAWN_AT
        self._standing_loft("head", "neck", _NECK, "skin")
        face = [(z + sink, deep, broad, shift) for z, deep, broad, shift in _HEAD]
        self._standing_loft("head", "face", face, "skin")

        def feature(
            name: str,
            pos: tuple[float, float, float],
            size: tuple[float, float, float],
            material: str,
        ) -> None:
            self._ellipsoid("head", name, (pos[0], pos[1], pos[2] + sink), size, material)

        feature("hair", (-0.012, 0, 0.214), (0.098, 0.0805, 0.0815), "hair")
        feature("nose", (0.094, 0, 0.150), (0.014, 0.009, 0.017), "skin")
        feature("mouth", (0.083, 0, 0.114), (0.009, 0.019, 0.005), "lips")
        if bun:
            feature("bun", (-0.092, 0, 0.258), (0.037, 0.042, 0.037), "hair")
        for side in SIDES:
            s = side_sign(side)
            feature(f"{side}_eye", (0.0855, s * 0.031, 0.171), (0.006, 0.012, 0.006), "eyes")
            feature(f"{side}_ear", (-0.002, s * 0.070, 0.158), (0.014, 0.007, 0.022), "skin")

    def arm(self, side: str) -> None:
        skeleton = self._skeleton
        self._hanging_loft(f"{side}_upper_arm", _UPPER_ARM, skeleton.upper_arm, "skin")
        self._hanging_loft(f"{side}_forearm", _FOREARM, skeleton.forearm, "skin")
        palm = (
            (-0.1, 0.020, 0.015, 0.0),
            (0.15, 0.024, 0.016, 0.002),
            (0.6, 0.035, 0.014, 0.0),
            (0.95, 0.035, 0.010, 0.0),
            (1.06, 0.028, 0.007, 0.0),
        )
        self._hanging_loft(f"{side}_hand", palm, 0.082 * self._size, "skin")
        inward = -side_sign(side)
        for finger, joints in _FINGERS.items():
            base, middle, tip = ((x, inward * y, z) for x, y, z in joints)
            self._capsule(f"{side}_hand", f"{side}_{finger}_1", base, middle, 0.0082)
            self._capsule(f"{side}_hand", f"{side}_{finger}_2", middle, tip, 0.0068)

    def leg(self, side: str) -> None:
        skeleton = self._skeleton
        self._hanging_loft(f"{side}_thigh", _THIGH, skeleton.thigh, "tights")
        self._hanging_loft(f"{side}_shank", _SHANK, skeleton.shank, "tights")
        sole = -skeleton.ankle_height
        length = skeleton.heel_back + skeleton.ball_forward
        self._sole_loft(f"{side}_foot", _FOOT, -skeleton.heel_back, length, sole)
        self._sole_loft(f"{side}_toe", _TOES, 0.0, skeleton.toe_length, -0.012)
        self._ellipsoid(
            f"{side}_foot", f"{side}_instep", (0, 0, 0), (0.034, 0.030, 0.036), "tights"
        )

    def _standing_loft(
        self, body: str, name: str, profile: _Profile, material: str, stretch: float = 1.0
    ) -> None:
        k = self._size
        rings = [
            Ring(z * k * stretch, deep * k, broad * k, shift * k)
            for z, deep, broad, shift in profile
        ]
        self._mesh(body, name, rings, "z", material)

    def _hanging_loft(self, body: str, profile: _Profile, length: float, material: str) -> None:
        k = self._size
        rings = [
            Ring(-share * length, deep * k, broad * k, shift * k)
            for share, deep, broad, shift in profile
        ]
        self._mesh(body, f"{body}_flesh", rings, "z", material)

    def _sole_loft(
        self,
        body: str,
        profile: Sequence[tuple[float, float, float]],
        start: float,
        length: float,
        sole: float,
    ) -> None:
        k = self._size
        rings = [
            Ring(start + share * length, tall * k, broad * k, sole + tall * k)
            for share, tall, broad in profile
        ]
        self._mesh(body, f"{body}_flesh", rings, "x", "shoes")

    def _mesh(self, body: str, name: str, rings: Sequence[Ring], axis: str, material: str) -> None:
        vertices, faces = loft(rings, axis)
        self._spec.add_mesh(
            name=name, uservert=vertices.ravel(), userface=faces.ravel(), smoothnormal=True
        )
        self._add(body, name, mujoco.mjtGeom.mjGEOM_MESH, material, meshname=name)

    def _ellipsoid(
        self,
        body: str,
        name: str,
        pos: tuple[float, float, float],
        size: tuple[float, float, float],
        material: str,
    ) -> None:
        k = self._size
        self._add(
            body,
            name,
            mujoco.mjtGeom.mjGEOM_ELLIPSOID,
            material,
            pos=[k * v for v in pos],
            size=[k * v for v in size],
        )

    def _capsule(
        self,
        body: str,
        name: str,
        start: tuple[float, float, float],
        end: tuple[float, float, float],
        radius: float,
    ) -> None:
        k = self._size
        self._add(
            body,
            name,
            mujoco.mjtGeom.mjGEOM_CAPSULE,
            "skin",
            fromto=[k * v for v in (*start, *end)],
            size=[k * radius, 0, 0],
        )

    def _add(
        self, body: str, name: str, kind: mujoco.mjtGeom, material: str, **shape: object
    ) -> None:
        self._spec.body(body).add_geom(
            name=name,
            type=kind,
            material=material,
            contype=0,
            conaffinity=0,
            group=1,
            mass=0,
            **shape,
        )
