"""`enpointe pose`: key poses solved, certified, and drawn."""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.errors import EnpointeError
from enpointe.notation import (
    ArmsPosition,
    FeetPosition,
    Frame,
    Score,
    Side,
    load_score,
    names,
    shipped_scores,
)
from enpointe.notation.vocabulary import find_arms, find_feet
from enpointe.performing import check_reach

if TYPE_CHECKING:
    import mujoco

    from enpointe.models import Anthropometry, KeyPose, Style

__all__ = ["Poses", "pose", "vocabulary_score"]


@dataclass(frozen=True)
class Poses:
    """Solved key poses and the score they come from.

    Attributes:
        score: One frame a pose.
        key_poses: In the order of the frames.
        model: The dancer who takes them.
    """

    score: Score
    key_poses: tuple[KeyPose, ...]
    model: mujoco.MjModel

    @property
    def held(self) -> bool:
        """Whether every rule holds in every pose."""
        return all(key_pose.held for key_pose in self.key_poses)

    def summary(self) -> dict[str, object]:
        """The figures that `--json` prints."""
        return {
            "poses": [
                {
                    "name": p.name,
                    "qpos": p.qpos.tolist(),
                    "rules": [
                        {
                            "rule": r.rule,
                            "value": r.value,
                            "unit": r.unit,
                            "bound": r.bound,
                            "at_least": r.at_least,
                            "held": r.held,
                        }
                        for r in p.certificate.results
                    ],
                    "solve_ms": p.solve_ms,
                }
                for p in self.key_poses
            ]
        }


def pose(
    source: str | Path | Score,
    *,
    style: Style | None = None,
    dancer: Anthropometry | None = None,
) -> Poses:
    """Solve key poses.

    Args:
        source: A position's name such as "arms fifth en haut" or "feet fourth", a shipped score, a
            `.bmn` file, or a score.
        style: The method's amounts.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.

    Raises:
        ScoreError: The score can't be read or reached.
        EnpointeError: No such name.
    """
    score = source if isinstance(source, Score) else _find(source)
    check_reach(score, dancer, style)
    from enpointe.models import KeyPoseSolver, dancer_model, pose_target

    solver = KeyPoseSolver(dancer_model(dancer))
    name = None if len(score.frames) > 1 else score.title
    targets = [
        pose_target(frame, solver.figure, style, source=score.source, name=name)
        for frame in score.resolved()
    ]
    return Poses(score, tuple(solver.solve(target) for target in targets), solver.model)


def vocabulary_score(name: str) -> Score | None:
    """A score of one frame that shows a position of the vocabulary, or None for another name.

    The rest of the body stands in first position with the arms en bas; where one side leads, it is
    the right.
    """
    part, _, position = name.partition(" ")
    feet, arms = FeetPosition("first"), ArmsPosition("fifth en bas")
    if part == "feet" and (entry := find_feet(position)) is not None:
        feet = FeetPosition(entry.name, Side.RIGHT if entry.crossed else None)
    elif part == "arms" and (arms_entry := find_arms(position)) is not None:
        leading = Side.RIGHT if arms_entry.needs_leading else None
        arms = ArmsPosition(arms_entry.name, leading)
    else:
        return None
    frame = Frame(beat=Fraction(0), feet=feet, arms=arms)
    return Score(name, "Cecchetti", (4, 4), 60.0, (frame,))


def _find(source: str | Path) -> Score:
    text = str(source).strip()
    score = vocabulary_score(text.lower())
    if score is not None:
        return score
    if text in shipped_scores() or text.endswith(".bmn") or Path(text).exists():
        return load_score(source)
    known = [*names(), *shipped_scores()]
    close = difflib.get_close_matches(text.lower(), known, n=3)
    hint = f"; did you mean {' or '.join(repr(c) for c in close)}?" if close else ""
    raise EnpointeError(
        f"no position, shipped score or .bmn file called {text!r}{hint} "
        "(`enpointe pose --list` names them)"
    )
