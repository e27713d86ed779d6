"""`enpointe pose`: key poses solved, certified, and drawn."""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.errors import EnpointeError
from enpointe.figures import PosesFigures
from enpointe.notation import Score, load_score, names, parse_score, shipped_scores
from enpointe.notation.vocabulary import find_arms, find_feet, find_pose
from enpointe.preparing import check_reach

if TYPE_CHECKING:
    import mujoco

    from enpointe.models import Anthropometry, KeyPose, Style

__all__ = ["Poses", "find_score", "pose", "vocabulary_score"]


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

    def summary(self) -> PosesFigures:
        """The figures that `--json` prints."""
        from enpointe.models.recognition import recognise

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
                    "cheats": [
                        {"name": c.name, "value": c.value, "unit": c.unit}
                        for c in p.certificate.cheats
                    ],
                    "solve_ms": p.solve_ms,
                    "recognised_as": recognise(self.model, p.qpos).name,
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
    score = source if isinstance(source, Score) else find_score(source)
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

    The rest of the body stands in first position with the arms en bas, a working leg beside the
    other, arms a la seconde. Where one side leads or works, it is the right.
    """
    part, _, position = name.partition(" ")
    closed = position.removesuffix(" open")
    if part == "feet" and (entry := find_feet(closed)) is not None:
        spread = " open" if closed != position else ""
        front = " right front" if entry.crossed else ""
        lines = [f"feet: {entry.name}{spread}{front}", _ARMS_AT_REST]
    elif part == "arms" and (arms := find_arms(position)) is not None:
        leads = " right leads" if arms.needs_leading else ""
        lines = ["feet: first", f"arms: {arms.name}{leads}"]
    elif name in names() and position.startswith("pointed"):
        other = "seconde" if position.endswith("seconde") else _OPPOSITE[position.split()[-1]]
        lines = [f"left leg: pointed {other}", _WIDE, f"right leg: {position}"]
    elif name in names() and part == "leg":
        lines = [_ON_THE_LEFT, _WIDE, f"right leg: {position}"]
    elif part == "pose" and find_pose(position) is not None:
        lines = [f"pose: {position} on left"]
    else:
        return None
    header = f'benesh 1\ntitle: "{name}"\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\nbeat 0:\n'
    return parse_score(header + "\n".join(lines) + "\n", name)


_ARMS_AT_REST = "arms: fifth en bas"
_WIDE = "arms: a la seconde"
_OPPOSITE = {"devant": "derrière", "derrière": "devant"}
_ON_THE_LEFT = "left foot: 0 wide, 1 high, level"


def find_score(source: str | Path) -> Score:
    """The score of a position's name, a shipped score's, or a `.bmn` file."""
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
