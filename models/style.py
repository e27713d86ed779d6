"""What a method, a teacher or a body decides."""

from __future__ import annotations

from dataclasses import dataclass

from enpointe.models.figure import ROUNDED_ELBOW_DEG
from enpointe.models.foot_positions import DEFAULT_TURNOUT_DEG

__all__ = ["Style"]


@dataclass(frozen=True, slots=True)
class Style:
    """What a method or a teacher decides.

    Attributes:
        turnout_deg: Each foot from straight ahead.
        elbow_deg: Bend of the elbow of a rounded arm (Neagle 2005 §4.4.1).
        wrist_deg: Bend of the wrist of a rounded arm. The thesis bends it as much as the elbow
            (§4.4.4); on a hand with fingers, which carry the curve on, that breaks the line, so
            ours is less.
        wrist_break_deg: How far the hand of a stretched arm lifts, palm down. The thesis has none,
            and its author finds such arms stiff: most dancers break the wrist slightly, each by her
            own amount (§4.5.4 b). The amount is ours.
        palm_deg: Turn of the forearm from thumb-forward to the palm that faces along the curve.
            The thesis turns 90 (§4.4.4) and finds it more than its dancers' (§4.5.3 b); 80 is the
            supination of adults (AAOS).
        demi_plie_deg: Bend of the knee in a demi-plié; the heel stays down. No source prints it;
            ours leaves the ankle at 27 degrees of its 30 (Russell et al. 2010).
        demi_plie_in_fourth_deg: The same with the feet one before the other, where the back ankle
            is at the end of its range; ours.
        grand_plie_deg: Bend of the knee in a grand plié (135 +- 4.6, Fotaki 2024, 20 dancers), less
            what keeps the thighs level.
        grand_plie_rise_deg: How far the heels rise in it, but in second.
        real: A real dancer, whose hip has its range and who tips and opens the pelvis for a high
            leg; the perfect dancer keeps it square (Neagle 2005 §4.8).
    """

    turnout_deg: float = DEFAULT_TURNOUT_DEG
    elbow_deg: float = ROUNDED_ELBOW_DEG
    wrist_deg: float = 14.0
    wrist_break_deg: float = 8.0
    palm_deg: float = 80.0
    demi_plie_deg: float = 58.0
    demi_plie_in_fourth_deg: float = 50.0
    grand_plie_deg: float = 122.0
    grand_plie_rise_deg: float = 38.0
    real: bool = False
