"""`enpointe compare`: the same phrase by rotation alone, by expression, and by physics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from enpointe.danced import Danced
from enpointe.figures import ComparisonFigures, DifferenceFigures
from enpointe.notation import Score, Side, load_score
from enpointe.performing import PHRASED, Performance, dance, has_qualities
from enpointe.preparing import Progress, prepare, silent

if TYPE_CHECKING:
    import mujoco

    from enpointe.models import Anthropometry, Style

__all__ = ["VARIANTS", "Comparison", "Difference", "compare", "differences"]

VARIANTS: Mapping[str, tuple[str, str]] = {
    "slerp": ("slerp", "kinematic"),
    "logistic": ("logistic", "kinematic"),
    "expressive": ("expressive", "kinematic"),
    "physical": ("expressive", "pd"),
}
"""Name of a variant: its interpolation and its controller."""


@dataclass(frozen=True, slots=True)
class Difference:
    """How far apart two variants are.

    Attributes:
        first: Name of a variant.
        second: Name of another.
        wrist_path_rms: Root mean square distance of the wrists at equal times, m, by side.
        joint_rms_deg: Root mean square over all joints at equal times.
    """

    first: str
    second: str
    wrist_path_rms: Mapping[Side, float]
    joint_rms_deg: float

    def summary(self) -> DifferenceFigures:
        """The figures that `--json` prints."""
        return {
            "between": [self.first, self.second],
            "wrist_path_rms": {str(side): far for side, far in self.wrist_path_rms.items()},
            "joint_rms_deg": self.joint_rms_deg,
        }


@dataclass(frozen=True)
class Comparison:
    """Several performances of one score.

    Attributes:
        performances: By name of the variant, in the order of `VARIANTS`.
        differences: Between every two of them.
    """

    performances: Mapping[str, Performance]
    differences: tuple[Difference, ...]

    @property
    def completed(self) -> bool:
        """Whether the physical dancer got to the end."""
        return all(p.completed for p in self.performances.values())

    def summary(self) -> ComparisonFigures:
        """The figures that `--json` prints."""
        return {
            "variants": {name: p.summary() for name, p in self.performances.items()},
            "differences": [d.summary() for d in self.differences],
        }


def compare(
    source: str | Path | Score,
    *,
    effort: str | None = None,
    tempo: float | None = None,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    progress: Progress = silent,
) -> Comparison:
    """Dance a score by every variant.

    Args:
        source: A shipped score's name, a `.bmn` file, or a score.
        effort: A preset's name, which brings its tempo, or numbers; natural, at the score's own
            tempo, if None.
        tempo: Pulses a minute; the preset's or the score's if None.
        style: The method's amounts.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.
        progress: Told how far it is.

    Raises:
        EnpointeError: Anything that the caller can mend, in one line.
    """
    score = source if isinstance(source, Score) else load_score(source)
    from enpointe.motion import Interpolation, find_effort

    quality, preset_tempo, name = find_effort(effort)
    choreography = prepare(
        score,
        tempo=tempo if tempo is not None else preset_tempo,
        style=style,
        dancer=dancer,
        progress=progress,
    )
    phrased = effort is None and has_qualities(score)
    performances = {
        variant: dance(
            choreography,
            quality,
            PHRASED if phrased else name,
            Interpolation(kind),
            controller,
            phrased=phrased,
            progress=progress,
        )
        for variant, (kind, controller) in VARIANTS.items()
    }
    return Comparison(performances, differences(performances))


def differences(performances: Mapping[str, Danced]) -> tuple[Difference, ...]:
    """How far apart every two performances are, at the times of the first one's reference."""
    time = next(iter(performances.values())).motion.time
    danced = {name: _at(p, time) for name, p in performances.items()}
    names = list(danced)
    return tuple(
        _difference(a, b, performances[a].motion.model, danced[a], danced[b])
        for i, a in enumerate(names)
        for b in names[i + 1 :]
    )


def _at(performance: Danced, time: NDArray[np.float64]) -> NDArray[np.float64]:
    motion = performance.danced
    return np.array([motion.sample(float(t))[0] for t in time])


def _difference(
    first: str,
    second: str,
    model: mujoco.MjModel,
    a: NDArray[np.float64],
    b: NDArray[np.float64],
) -> Difference:
    from enpointe.motion.wrist import wrist_paths

    paths_a, paths_b = wrist_paths(model, a), wrist_paths(model, b)
    return Difference(
        first,
        second,
        {
            side: float(np.sqrt(np.mean(np.sum((paths_a[side] - paths_b[side]) ** 2, axis=1))))
            for side in Side
        },
        float(np.degrees(np.sqrt(np.mean((a[:, 7:] - b[:, 7:]) ** 2)))),
    )
