"""Which rules a pose keeps and breaks, and by how much."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Certificate", "Cheat", "RuleResult"]


@dataclass(frozen=True, slots=True)
class RuleResult:
    """One rule, measured on one pose.

    Attributes:
        rule: Its name, with the side where it has one.
        value: Largest absolute residual, or the smallest margin where the rule is a margin.
        unit: "mm" or "deg".
        bound: What still holds: at most this residual, or at least this margin.
        held: Whether it holds.
        at_least: Whether the bound is a floor (a margin) rather than a ceiling (a residual).
        must: Whether the solver had to keep it, rather than prefer to.
        source: Where the rule is written down.
    """

    rule: str
    value: float
    unit: str
    bound: float
    held: bool
    source: str
    at_least: bool = False
    must: bool = True


@dataclass(frozen=True, slots=True)
class Cheat:
    """What a real dancer lends to a position beyond what its rules ask (Neagle 2005 §4.8).

    Attributes:
        name: In words, with its sense.
        value: How much, positive.
        unit: "deg".
    """

    name: str
    value: float
    unit: str

    def __str__(self) -> str:
        return f"{self.name} {self.value:.0f} {self.unit}"


@dataclass(frozen=True, slots=True)
class Certificate:
    """The rules of one pose.

    Attributes:
        results: One for each rule that applies.
        cheats: Of a real dancer, greatest first; the perfect one needs none.
    """

    results: tuple[RuleResult, ...]
    cheats: tuple[Cheat, ...] = ()

    @property
    def held(self) -> bool:
        """Whether every rule holds."""
        return all(result.held for result in self.results)

    @property
    def legal(self) -> bool:
        """Whether every rule holds that the solver had to keep: the pose is the one asked for."""
        return all(result.held for result in self.results if result.must)

    @property
    def broken(self) -> tuple[RuleResult, ...]:
        return tuple(result for result in self.results if not result.held)

    def __str__(self) -> str:
        if self.held:
            return f"all {len(self.results)} rules held"
        return "; ".join(
            f"{r.rule}: {r.value:.1f} {r.unit} against {r.bound:g}" for r in self.broken
        )
