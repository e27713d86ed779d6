"""Bodies of servos: a table-top puppet for ballet, and ROBOTIS OP3."""

from __future__ import annotations

from typing import TYPE_CHECKING

from enpointe.lazy import lazy

if TYPE_CHECKING:
    from enpointe.models.puppet.op3 import op3_model as op3_model
    from enpointe.models.puppet.op3 import op3_spec as op3_spec
    from enpointe.models.puppet.puppet import puppet_model as puppet_model
    from enpointe.models.puppet.puppet import puppet_spec as puppet_spec
    from enpointe.models.puppet.servos import SERVOS as SERVOS

_HOMES = {
    "SERVOS": "enpointe.models.puppet.servos",
    "op3_model": "enpointe.models.puppet.op3",
    "op3_spec": "enpointe.models.puppet.op3",
    "puppet_model": "enpointe.models.puppet.puppet",
    "puppet_spec": "enpointe.models.puppet.puppet",
}

__all__ = ["SERVOS", "op3_model", "op3_spec", "puppet_model", "puppet_spec"]
__getattr__, __dir__ = lazy(__name__, _HOMES)
