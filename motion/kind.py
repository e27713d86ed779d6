"""The ways of getting from key pose to key pose."""

from __future__ import annotations

from enum import StrEnum

from enpointe.errors import MotionError

__all__ = ["Interpolation"]


class Interpolation(StrEnum):
    """How to get from key pose to key pose."""

    EXPRESSIVE = "expressive"
    """Along the ballet path with the effort's time, weight and space."""
    LOGISTIC = "logistic"
    """The same timing on the direct path, without space or inflection."""
    SLERP = "slerp"
    """Shortest joint rotations at constant speed."""

    @classmethod
    def named(cls, name: str) -> Interpolation:
        """The kind called `name`. Raises `MotionError` for another name."""
        try:
            return cls(name)
        except ValueError:
            kinds = ", ".join(kind.value for kind in cls)
            raise MotionError(f"no interpolation {name!r}; use {kinds}") from None
