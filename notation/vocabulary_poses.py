"""Named positions of the whole body, each a macro over legs, arms, head, body and facing.

They are written here for a dancer who stands on the left leg; on the right leg everything is its
mirror image. With 0 the audience and + to the dancer's left, -45 faces corner 1 and 45 corner 2.

Sources: Grant (Technical Manual and Dictionary of Classical Ballet, as copied by students), Neagle
2005 §4.2.2 and §4.7.2, Joffrey Ballet (facings), balletclassroom 2012 (Cecchetti's body positions).
Where `ours` says so, no source that we could read settles the point. No source gives amounts: all
degrees of head and body are ours.
"""

from __future__ import annotations

from dataclasses import dataclass

from enpointe.notation.signs import Bend, Direction, LegPosition, Orientation, Side

__all__ = ["POSES", "PoseEntry"]

ERECT = Orientation()


@dataclass(frozen=True, slots=True)
class PoseEntry:
    """A named position of the whole body, standing on the left leg.

    Attributes:
        name: The name that scores are written with.
        leg: The right leg.
        arms: Name of the position of the arms.
        leading: The arm that leads; None where both do the same.
        description: One line for people.
        source: Where the position is defined.
        bend: The left knee.
        head: Orientation of the head.
        body: Orientation of the body.
        facing: Degrees from the audience; None for a position that may face anywhere.
        ours: What no source settles and we chose.
        aliases: Other names for exactly this position.
    """

    name: str
    leg: LegPosition
    arms: str
    leading: Side | None
    description: str
    source: str
    bend: Bend = Bend.STRAIGHT
    head: Orientation = ERECT
    body: Orientation = ERECT
    facing: float | None = None
    ours: str = ""
    aliases: tuple[str, ...] = ()


_GRANT = "Grant"
_JOFFREY = "Joffrey Ballet; balletclassroom 2012"
_DEVANT = LegPosition("tendu", Direction.DEVANT)
_SECONDE = LegPosition("tendu", Direction.SECONDE)
_DERRIERE = LegPosition("tendu", Direction.DERRIERE)
_ARABESQUE = LegPosition("arabesque", Direction.DERRIERE, 90.0)
_ATTITUDE_DEVANT = LegPosition("attitude", Direction.DEVANT, 90.0)
_ATTITUDE = LegPosition("attitude", Direction.DERRIERE, 90.0)
_STANDING, _WORKING = Side.LEFT, Side.RIGHT

_ARABESQUES = (
    PoseEntry(
        "first arabesque",
        _ARABESQUE,
        "first arabesque",
        _STANDING,
        "in profile on the leg far from the audience, its arm forward at eye level",
        f"{_GRANT}; Neagle 2005 §4.2.2",
        facing=90.0,
    ),
    PoseEntry(
        "second arabesque",
        _ARABESQUE,
        "second arabesque",
        _WORKING,
        "as the first with the arms changed, the head turned to the audience",
        f"{_GRANT}; Neagle 2005 §4.2.2",
        head=Orientation(turn=-30.0, tilt=-8.0),
        facing=90.0,
    ),
    PoseEntry(
        "third arabesque",
        _ARABESQUE,
        "third arabesque",
        _STANDING,
        "as the first with both arms forward, the far one at eye level",
        f"{_GRANT}; Neagle 2005 §4.2.2",
        head=Orientation(bend=-5.0),
        facing=90.0,
    ),
    PoseEntry(
        "fourth arabesque",
        _ARABESQUE,
        "first arabesque",
        _STANDING,
        "the first on a bent leg, the one near the audience, facing a front corner",
        "Neagle 2005 §4.7.2 (arms as in the first)",
        bend=Bend.DEMI_PLIE,
        facing=-45.0,
        ours="which arm: the thesis has the first's, Grant the arm of the raised leg forward",
    ),
    PoseEntry(
        "fifth arabesque",
        _ARABESQUE,
        "third arabesque",
        _WORKING,
        "on a bent leg, the one near the audience, both arms forward, the far one higher",
        _GRANT,
        bend=Bend.DEMI_PLIE,
        head=Orientation(bend=-5.0),
        facing=-45.0,
    ),
)

_ATTITUDES = (
    PoseEntry(
        "attitude devant",
        _ATTITUDE_DEVANT,
        "fourth en haut",
        _STANDING,
        "the bent leg in front, the arm of the supporting side overhead",
        f"{_GRANT}, attitude",
        ours="arms, as in croisé devant",
    ),
    PoseEntry(
        "attitude derrière",
        _ATTITUDE,
        "fourth en haut",
        _WORKING,
        "the bent leg behind, the arm of its side overhead",
        f"{_GRANT}, attitude",
        head=Orientation(turn=-30.0, bend=-10.0),
        aliases=("attitude",),
    ),
    PoseEntry(
        "attitude croisée devant",
        _ATTITUDE_DEVANT,
        "fourth en haut",
        _STANDING,
        "facing a front corner, the bent leg in front and near the audience",
        f"{_GRANT}, attitude",
        head=Orientation(turn=-30.0),
        facing=45.0,
        ours="head",
    ),
    PoseEntry(
        "attitude croisée derrière",
        _ATTITUDE,
        "fourth en haut",
        _WORKING,
        "facing a front corner on the leg near the audience, eyes to the raised hand",
        f"{_GRANT}, attitude croisée",
        head=Orientation(turn=-30.0, bend=-10.0),
        facing=-45.0,
        aliases=("attitude croisée",),
    ),
    PoseEntry(
        "attitude effacée devant",
        _ATTITUDE_DEVANT,
        "fourth en haut",
        _STANDING,
        "facing a front corner, the bent leg in front and far from the audience",
        f"{_GRANT}, attitude",
        head=Orientation(turn=30.0),
        facing=-45.0,
        ours="arms and head, as in effacé devant",
    ),
    PoseEntry(
        "attitude effacée derrière",
        _ATTITUDE,
        "fourth en haut",
        _WORKING,
        "facing a front corner on the leg far from the audience, the head to the audience",
        f"{_GRANT}, attitude effacée; balletforblind (facing, head)",
        head=Orientation(turn=-40.0, bend=-8.0),
        facing=45.0,
        aliases=("attitude effacée",),
    ),
)

_DIRECTIONS = (
    PoseEntry(
        "croisé devant",
        _DEVANT,
        "fourth en haut demi-seconde",
        _STANDING,
        "to a front corner, the leg near the audience in front",
        _JOFFREY,
        head=Orientation(tilt=-10.0),
        body=Orientation(tilt=-4.0),
        facing=45.0,
    ),
    PoseEntry(
        "à la quatrième devant",
        _DEVANT,
        "à la seconde",
        None,
        "to the audience, the leg in front",
        _JOFFREY,
        facing=0.0,
        aliases=("quatrième devant",),
    ),
    PoseEntry(
        "écarté",
        _SECONDE,
        "fourth en haut",
        _WORKING,
        "to a front corner, the leg near the audience to the side, eyes to the raised hand",
        f"{_JOFFREY}; {_GRANT}",
        head=Orientation(turn=-30.0, bend=-10.0),
        facing=45.0,
        aliases=("écarté devant",),
    ),
    PoseEntry(
        "effacé devant",
        _DEVANT,
        "fourth en haut demi-seconde",
        _STANDING,
        "to a front corner, the leg far from the audience in front, the body slightly back",
        _JOFFREY,
        head=Orientation(turn=20.0, tilt=8.0),
        body=Orientation(bend=-4.0),
        facing=-45.0,
        ours="arms and head",
        aliases=("effacé",),
    ),
    PoseEntry(
        "à la seconde",
        _SECONDE,
        "à la seconde",
        None,
        "to the audience, the leg to the side",
        _JOFFREY,
        facing=0.0,
        aliases=("second",),
    ),
    PoseEntry(
        "épaulé",
        _DERRIERE,
        "second arabesque",
        _WORKING,
        "to a front corner, the leg near the audience behind, its arm forward",
        f"Grant, épaulement (head and shoulders); {_JOFFREY}",
        head=Orientation(turn=-30.0, tilt=-8.0),
        body=Orientation(turn=10.0),
        facing=45.0,
        ours="which leg, and the arms",
        aliases=("épaulé derrière",),
    ),
    PoseEntry(
        "à la quatrième derrière",
        _DERRIERE,
        "à la seconde",
        None,
        "to the audience, the leg behind",
        _JOFFREY,
        facing=0.0,
        aliases=("quatrième derrière",),
    ),
    PoseEntry(
        "croisé derrière",
        _DERRIERE,
        "fourth en haut demi-seconde",
        _WORKING,
        "to a front corner, the leg far from the audience behind",
        _JOFFREY,
        head=Orientation(tilt=10.0),
        body=Orientation(tilt=4.0),
        facing=-45.0,
        ours="arms, as in attitude croisée",
    ),
)

POSES: tuple[PoseEntry, ...] = (*_ARABESQUES, *_ATTITUDES, *_DIRECTIONS)
"""The five arabesques, the attitudes, and Cecchetti's eight directions of the body in his order."""
