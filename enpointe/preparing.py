"""A score read and its key poses solved on the dancer it needs: what every verb starts from."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.notation import FloorContact, Score, load_score

if TYPE_CHECKING:
    import mujoco

    from enpointe.models import Anthropometry, Style
    from enpointe.motion import Choreography

__all__ = ["Progress", "check_reach", "model_of", "prepare", "silent"]

Progress = Callable[[str, float, float], None]
"""Called with what is being done, how much of it is done, and how much there is."""


def silent(task: str, done: float, total: float) -> None:
    """No progress shown."""


def _on_pointe(score: Score) -> bool:
    """Whether the score stands on pointe anywhere, for which the dancer puts on the shoes."""
    return any(
        leg.support is not None and leg.support.floor is FloorContact.POINTE
        for frame in score.resolved()
        for leg in frame.legs.values()
    )


def model_of(score: Score, dancer: Anthropometry | None) -> mujoco.MjModel:
    """The dancer in the shoes that a score needs; 1.68 m and 54 kg if None."""
    from enpointe.models.dancer import dancer_model

    return dancer_model(dancer, pointe_shoes=_on_pointe(score))


def check_reach(score: Score, dancer: Anthropometry | None, style: Style | None) -> None:
    """Refuse signs that this dancer's limbs do not reach, before the solver is loaded.

    Raises:
        ScoreError: With the place of the sign.
    """
    from enpointe.models.dancer import dancer_model
    from enpointe.models.figure import Figure
    from enpointe.models.target import pose_target

    figure = Figure.of(dancer_model(dancer, flesh=False))
    for frame in score.resolved():
        pose_target(frame, figure, style, source=score.source)


def prepare(
    source: str | Path | Score,
    *,
    tempo: float | None = None,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
    still: bool = False,
    progress: Progress = silent,
) -> Choreography:
    """Read a score and solve its key poses.

    Args:
        source: A shipped score's name, a `.bmn` file, or a score.
        tempo: Pulses a minute; the score's own if None.
        style: The method's amounts.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.
        still: Take a score of one frame, which is a pose to hold.
        progress: Told how far it is.

    Raises:
        ScoreError: The score can't be read or reached.
        PoseError: A frame without a pose.
    """
    score = source if isinstance(source, Score) else load_score(source)
    score.duration(tempo)
    check_reach(score, dancer, style)
    from enpointe.models import KeyPoseSolver
    from enpointe.motion import solve_key_poses

    return solve_key_poses(
        score,
        KeyPoseSolver(model_of(score, dancer)),
        style=style,
        tempo=tempo,
        still=still,
        progress=lambda done, total: progress("key poses", done, total),
    )
