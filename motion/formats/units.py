"""The unit of length of a skeleton whose file names none."""

from __future__ import annotations

from collections import Counter
from math import hypot, log

from enpointe.motion.formats.skeleton import Joint

__all__ = ["INCH", "guessed_unit", "stature"]

INCH = 0.0254
"""m; international yard and pound agreement, 1959."""

_USUAL = {
    "metres": 1.0,
    "centimetres": 0.01,
    "millimetres": 0.001,
    "inches": INCH,
    "inches / 0.45 (CMU's)": INCH / 0.45,
}
_SMALLEST, _LARGEST = 1e-6, 1e9
_PERSON = 1.7
"""m, an adult."""

# From the tips of the toes along the bones to the tips of the fingers; a person's leg from hip to
# sole, trunk from hip to shoulder, half the shoulders and arm are .53, .29, .13 and .44 of the
# stature (Drillis and Contini 1966, as in D. Winter, Biomechanics and Motor Control of Human
# Movement, figure 4.1), and a foot reaches .12 forward of the ankle.
_CHAIN = 1.5


def stature(joints: tuple[Joint, ...]) -> float:
    """How tall a person with such bones is, in the file's units, however the skeleton rests.

    The longest way along bones through the tree of joints, over what that is to a stature. A root
    that has one joint below it is a place on the floor or a scene, and the way to there no bone.
    """
    below = Counter(joint.parent for joint in joints)
    deepest = [0.0] * len(joints)
    longest = 0.0
    for index in range(len(joints) - 1, -1, -1):
        joint = joints[index]
        for end in joint.ends:
            longest, deepest[index] = _joined(longest, deepest[index], hypot(*end))
        parent = joint.parent
        if parent >= 0 and not (below[parent] == 1 and _is_bare_root(joints[parent])):
            reach = deepest[index] + hypot(*joint.offset)
            longest, deepest[parent] = _joined(longest, deepest[parent], reach)
    return longest / _CHAIN


def _is_bare_root(joint: Joint) -> bool:
    return joint.parent < 0 and not joint.ends


def guessed_unit(joints: tuple[Joint, ...]) -> tuple[float, str]:
    """The usual unit by which the skeleton is nearest to an adult's size.

    Returns:
        Metres a unit, and a warning that says what was guessed.
    """
    height = stature(joints)
    if not _SMALLEST < height < _LARGEST:
        return 0.01, "no unit of length in the file, and no bones to guess by: centimetres taken"
    name = min(_USUAL, key=lambda each: abs(log(height * _USUAL[each] / _PERSON)))
    tall = height * _USUAL[name]
    return _USUAL[name], (
        f"no unit of length in the file: {name} taken, by which the figure is {tall:.2f} m tall"
    )


def _joined(longest: float, deepest: float, reach: float) -> tuple[float, float]:
    return max(longest, deepest + reach), max(deepest, reach)
