"""Segment lengths, masses and inertias of a body from its height, mass and sex.

Source: P. de Leva, "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", Journal of
Biomechanics 29(9), 1996, pp. 1223-1230, table 4 (mass, centre of mass and radii of gyration, with
the segment lengths of the mean subject). Lengths scale with stature, masses with body mass.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType

from enpointe.errors import ModelError

__all__ = ["Anthropometry", "Segment", "Sex"]


class Sex(StrEnum):
    """The two subject groups of de Leva's table 4."""

    FEMALE = "female"
    MALE = "male"


@dataclass(frozen=True, slots=True)
class Segment:
    """One rigid segment of a body.

    Attributes:
        length: Between the segment's endpoints, m.
        mass: kg.
        com: Distance of the centre of mass from the proximal (upper, or heel) end, m.
        gyration: Radii of gyration about the sagittal, transverse and longitudinal axes through
            the centre of mass, m. The sagittal axis points forward, the transverse one sideways.
    """

    length: float
    mass: float
    com: float
    gyration: tuple[float, float, float]

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Principal moments about the sagittal, transverse and longitudinal axes, kg m^2."""
        sagittal, transverse, longitudinal = (self.mass * r * r for r in self.gyration)
        return sagittal, transverse, longitudinal


# name: (length mm, mass %, centre of mass %, sagittal %, transverse %, longitudinal %)
_Row = tuple[float, float, float, float, float, float]
_FEMALE: Mapping[str, _Row] = MappingProxyType(
    {
        "head": (200.2, 6.68, 58.94, 33.0, 35.9, 31.8),  # vertex to mid-gonion
        "upper_trunk": (142.5, 15.45, 20.77, 74.6, 50.2, 71.8),  # suprasternale to xiphion
        "middle_trunk": (205.3, 14.65, 45.12, 43.3, 35.4, 41.5),  # xiphion to omphalion
        "lower_trunk": (181.5, 12.47, 49.20, 43.3, 40.2, 44.4),  # omphalion to mid-hip
        "upper_arm": (275.1, 2.55, 57.54, 27.8, 26.0, 14.8),
        "forearm": (264.3, 1.38, 45.59, 26.1, 25.7, 9.4),
        "hand": (78.0, 0.56, 74.74, 53.1, 45.4, 33.5),  # wrist to third knuckle
        "thigh": (368.5, 14.78, 36.12, 36.9, 36.4, 16.2),
        "shank": (432.3, 4.81, 44.16, 27.1, 26.7, 9.3),  # knee to lateral malleolus
        "foot": (228.3, 1.29, 40.14, 29.9, 27.9, 13.9),  # heel to tip of the longest toe
    }
)
_MALE: Mapping[str, _Row] = MappingProxyType(
    {
        "head": (203.3, 6.94, 59.76, 36.2, 37.6, 31.2),
        "upper_trunk": (170.7, 15.96, 29.99, 71.6, 45.4, 65.9),
        "middle_trunk": (215.5, 16.33, 45.02, 48.2, 38.3, 46.8),
        "lower_trunk": (145.7, 11.17, 61.15, 61.5, 55.1, 58.7),
        "upper_arm": (281.7, 2.71, 57.72, 28.5, 26.9, 15.8),
        "forearm": (268.9, 1.62, 45.74, 27.6, 26.5, 12.1),
        "hand": (86.2, 0.61, 79.00, 62.8, 51.3, 40.1),
        "thigh": (422.2, 14.16, 40.95, 32.9, 32.9, 14.9),
        "shank": (434.0, 4.33, 44.59, 25.5, 24.9, 10.3),
        "foot": (258.1, 1.37, 44.15, 25.7, 24.5, 12.4),
    }
)
_TABLE: Mapping[Sex, Mapping[str, _Row]] = MappingProxyType({Sex.FEMALE: _FEMALE, Sex.MALE: _MALE})
_MEAN_STATURE: Mapping[Sex, float] = MappingProxyType({Sex.FEMALE: 1.735, Sex.MALE: 1.741})
_PAIRED = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")

HEIGHT_RANGE = (1.30, 2.10)
MASS_INDEX_RANGE = (14.0, 35.0)


@dataclass(frozen=True, slots=True)
class Anthropometry:
    """A dancer's measures.

    Attributes:
        height: Stature, m. The default is a dancer of 1.68 m.
        mass: Body mass, kg.
        sex: Which of de Leva's two groups.
    """

    height: float = 1.68
    mass: float = 54.0
    sex: Sex = Sex.FEMALE

    def __post_init__(self) -> None:
        """Refuse measures that no adult has.

        Raises:
            ModelError: Height outside 1.3..2.1 m or body-mass index outside 14..35 kg/m^2.
        """
        if not HEIGHT_RANGE[0] <= self.height <= HEIGHT_RANGE[1]:
            raise ModelError(
                f"height {self.height:g} m is outside {HEIGHT_RANGE[0]:g}..{HEIGHT_RANGE[1]:g} m"
            )
        index = self.mass / self.height**2
        if not MASS_INDEX_RANGE[0] <= index <= MASS_INDEX_RANGE[1]:
            low, high = (round(b * self.height**2, 1) for b in MASS_INDEX_RANGE)
            raise ModelError(
                f"mass {self.mass:g} kg at {self.height:g} m is outside {low:g}..{high:g} kg"
            )
        try:
            object.__setattr__(self, "sex", Sex(self.sex))
        except ValueError:
            known = " or ".join(sex.value for sex in Sex)
            raise ModelError(f"sex {self.sex!r} is not in de Leva's tables; use {known}") from None

    @property
    def scale(self) -> float:
        """Stature over the mean stature of the group."""
        return self.height / _MEAN_STATURE[self.sex]

    def segment(self, name: str) -> Segment:
        """The segment called `name` (one side of a paired one), scaled to this body."""
        try:
            length, mass, com, *gyration = _TABLE[self.sex][name]
        except KeyError:
            known = ", ".join(_TABLE[self.sex])
            raise ModelError(f"no segment {name!r}; there are {known}") from None
        metres = length * 1e-3 * self.scale
        fraction = mass / self._table_total()
        sagittal, transverse, longitudinal = (r * 1e-2 * metres for r in gyration)
        return Segment(
            length=metres,
            mass=self.mass * fraction,
            com=com * 1e-2 * metres,
            gyration=(sagittal, transverse, longitudinal),
        )

    def _table_total(self) -> float:
        """Per cent of all segments; the printed table sums to 100 within its rounding."""
        rows = _TABLE[self.sex]
        return sum(row[1] * (2.0 if name in _PAIRED else 1.0) for name, row in rows.items())
