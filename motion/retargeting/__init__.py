"""Any skeleton or marker set onto a dancer, or onto any body with the same landmarks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from enpointe.lazy import lazy

if TYPE_CHECKING:
    from enpointe.motion.retargeting.body import Body as Body
    from enpointe.motion.retargeting.joint_map import JointMap as JointMap
    from enpointe.motion.retargeting.proposing import propose_map as propose_map
    from enpointe.motion.retargeting.residual import Residual as Residual
    from enpointe.motion.retargeting.retargeting import Retargeted as Retargeted
    from enpointe.motion.retargeting.retargeting import retarget as retarget

_HOMES = {
    "Body": "enpointe.motion.retargeting.body",
    "JointMap": "enpointe.motion.retargeting.joint_map",
    "Residual": "enpointe.motion.retargeting.residual",
    "Retargeted": "enpointe.motion.retargeting.retargeting",
    "propose_map": "enpointe.motion.retargeting.proposing",
    "retarget": "enpointe.motion.retargeting.retargeting",
}

__all__ = ["Body", "JointMap", "Residual", "Retargeted", "propose_map", "retarget"]
__getattr__, __dir__ = lazy(__name__, _HOMES)
