"""Movement in time: motions, effort, expressive interpolation and its baselines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from enpointe.lazy import lazy

if TYPE_CHECKING:
    from enpointe.motion.effort import PRESETS as PRESETS
    from enpointe.motion.effort import Effort as Effort
    from enpointe.motion.effort import find_effort as find_effort
    from enpointe.motion.effort import logistic as logistic
    from enpointe.motion.interpolation import Choreography as Choreography
    from enpointe.motion.interpolation import interpolate as interpolate
    from enpointe.motion.interpolation import solve_key_poses as solve_key_poses
    from enpointe.motion.interpolation import ways_of as ways_of
    from enpointe.motion.keeping import RuleKept as RuleKept
    from enpointe.motion.keeping import rules_kept as rules_kept
    from enpointe.motion.kind import Interpolation as Interpolation
    from enpointe.motion.motion import Event as Event
    from enpointe.motion.motion import Motion as Motion
    from enpointe.motion.retargeting.joint_map import JointMap as JointMap
    from enpointe.motion.retargeting.proposing import propose_map as propose_map
    from enpointe.motion.retargeting.retargeting import Retargeted as Retargeted
    from enpointe.motion.retargeting.retargeting import retarget as retarget
    from enpointe.motion.wrist import fit_logistic as fit_logistic
    from enpointe.motion.wrist import wrist_profiles as wrist_profiles

_HOMES = {
    "Choreography": "enpointe.motion.interpolation",
    "Effort": "enpointe.motion.effort",
    "Event": "enpointe.motion.motion",
    "Interpolation": "enpointe.motion.kind",
    "JointMap": "enpointe.motion.retargeting.joint_map",
    "Motion": "enpointe.motion.motion",
    "PRESETS": "enpointe.motion.effort",
    "Retargeted": "enpointe.motion.retargeting.retargeting",
    "RuleKept": "enpointe.motion.keeping",
    "find_effort": "enpointe.motion.effort",
    "fit_logistic": "enpointe.motion.wrist",
    "interpolate": "enpointe.motion.interpolation",
    "logistic": "enpointe.motion.effort",
    "propose_map": "enpointe.motion.retargeting.proposing",
    "retarget": "enpointe.motion.retargeting.retargeting",
    "rules_kept": "enpointe.motion.keeping",
    "solve_key_poses": "enpointe.motion.interpolation",
    "wrist_profiles": "enpointe.motion.wrist",
    "ways_of": "enpointe.motion.interpolation",
}

__all__ = [
    "PRESETS",
    "Choreography",
    "Effort",
    "Event",
    "Interpolation",
    "JointMap",
    "Motion",
    "Retargeted",
    "RuleKept",
    "find_effort",
    "fit_logistic",
    "interpolate",
    "logistic",
    "propose_map",
    "retarget",
    "rules_kept",
    "solve_key_poses",
    "ways_of",
    "wrist_profiles",
]
__getattr__, __dir__ = lazy(__name__, _HOMES)
