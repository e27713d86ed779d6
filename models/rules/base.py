"""A rule of ballet: a named residual with a unit, a bound and a source."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from enpointe.models.kinematics import SymbolicBody
from enpointe.models.target import PoseTarget

__all__ = ["Kind", "Rule", "Symbols"]


class Kind(Enum):
    """How the solver treats a rule."""

    EQUAL = "equal"
    """A constraint: the residual is zero."""
    AT_LEAST = "at least"
    """A constraint: every component of the residual is at least the bound."""
    PREFER = "prefer"
    """A cost: the residual is small."""
    CHECK = "check"
    """Not given to the solver, since other rules imply it; certified all the same."""
    CHECK_AT_LEAST = "check at least"
    """A margin that is not given to the solver, since other rules leave it no freedom to act."""

    @property
    def is_margin(self) -> bool:
        """Whether the residual has a floor rather than a ceiling."""
        return self in (Kind.AT_LEAST, Kind.CHECK_AT_LEAST)

    @property
    def is_constraint(self) -> bool:
        """Whether the solver must keep it."""
        return self in (Kind.EQUAL, Kind.AT_LEAST)


class Symbols:
    """The numbers of a target as symbols, so that one compiled problem serves many poses."""

    def __init__(self) -> None:
        self._symbols: dict[str, ca.SX] = {}

    def __call__(self, name: str, rows: int = 1) -> ca.SX:
        """The parameter `name` (rows, 1), the same symbol at each call."""
        if name not in self._symbols:
            self._symbols[name] = ca.SX.sym(name, rows)
        return self._symbols[name]

    @property
    def vector(self) -> ca.SX:
        """All parameters in order of their first use, (P, 1)."""
        return ca.vertcat(*self._symbols.values()) if self._symbols else ca.SX(0, 1)

    def fill(self, values: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
        """The numbers for `vector`, (P,)."""
        parts: Iterable[NDArray[np.float64]] = (
            np.asarray(values[name], dtype=float).ravel() for name in self._symbols
        )
        return np.concatenate([np.empty(0), *parts])


@dataclass(frozen=True)
class Rule(ABC):
    """One rule of ballet.

    Class attributes say what a certificate prints; `residual` says what it means.

    Attributes:
        name: Short, in the words of a ballet class.
        unit: "mm" or "deg".
        bound: Largest absolute residual that still holds, in `unit`; for `Kind.AT_LEAST` the least
            residual that holds.
        kind: How the solver treats it.
        weight: Of a cost, per SI unit squared.
        source: Where the rule is written down.
    """

    name: ClassVar[str]
    unit: ClassVar[str]
    bound: ClassVar[float]
    kind: ClassVar[Kind]
    source: ClassVar[str]
    weight: ClassVar[float] = 1.0

    @property
    def label(self) -> str:
        """The name, with the side where a rule has one."""
        return self.name

    @property
    def per_unit(self) -> float:
        """What turns the SI residual into `unit`."""
        return {"mm": 1e3, "deg": 180.0 / np.pi}[self.unit]

    @abstractmethod
    def residual(self, body: SymbolicBody, symbols: Symbols) -> ca.SX:
        """The residual (n, 1), m or rad: zero where the rule is kept to the letter."""

    @abstractmethod
    def values(self, target: PoseTarget) -> dict[str, NDArray[np.float64]]:
        """The numbers of `target` for the symbols that `residual` uses."""


@dataclass(frozen=True)
class SidedRule(Rule):
    """A rule of one limb."""

    side: str

    @property
    def label(self) -> str:
        return f"{self.side} {self.name}"
