"""A virtual ballet dancer that obeys gravity.

Example:
    >>> import enpointe
    >>> dance = enpointe.perform("third-port-de-bras", effort="happy")
    >>> dance.summary()["completed"]
    True
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from enpointe.lazy import lazy

if TYPE_CHECKING:
    from enpointe.checking import Check as Check
    from enpointe.checking import check as check
    from enpointe.comparing import Comparison as Comparison
    from enpointe.comparing import compare as compare
    from enpointe.comparing_bodies import BodyComparison as BodyComparison
    from enpointe.comparing_bodies import compare_bodies as compare_bodies
    from enpointe.comparing_file import FileComparison as FileComparison
    from enpointe.comparing_file import compare_file as compare_file
    from enpointe.converting import Conversion as Conversion
    from enpointe.converting import convert as convert
    from enpointe.doctor import diagnose as diagnose
    from enpointe.errors import EnpointeError as EnpointeError
    from enpointe.feasibility import Feasibility as Feasibility
    from enpointe.feasibility import feasible as feasible
    from enpointe.notating import Notation as Notation
    from enpointe.notating import notate as notate
    from enpointe.notating import recognise as recognise
    from enpointe.notation import load_score as load_score
    from enpointe.performing import Performance as Performance
    from enpointe.performing import perform as perform
    from enpointe.performing_file import FilePerformance as FilePerformance
    from enpointe.performing_file import perform_file as perform_file
    from enpointe.posing import Poses as Poses
    from enpointe.posing import pose as pose
    from enpointe.report import write_report as write_report
    from enpointe.sweeping import Sweep as Sweep
    from enpointe.sweeping import sweep as sweep

__version__ = "0.1.0"

_HOMES = {
    "BodyComparison": "enpointe.comparing_bodies",
    "Check": "enpointe.checking",
    "Comparison": "enpointe.comparing",
    "Conversion": "enpointe.converting",
    "EnpointeError": "enpointe.errors",
    "FileComparison": "enpointe.comparing_file",
    "FilePerformance": "enpointe.performing_file",
    "Feasibility": "enpointe.feasibility",
    "Notation": "enpointe.notating",
    "Performance": "enpointe.performing",
    "Poses": "enpointe.posing",
    "check": "enpointe.checking",
    "compare": "enpointe.comparing",
    "compare_bodies": "enpointe.comparing_bodies",
    "compare_file": "enpointe.comparing_file",
    "convert": "enpointe.converting",
    "diagnose": "enpointe.doctor",
    "feasible": "enpointe.feasibility",
    "load_score": "enpointe.notation",
    "notate": "enpointe.notating",
    "perform": "enpointe.performing",
    "perform_file": "enpointe.performing_file",
    "pose": "enpointe.posing",
    "recognise": "enpointe.notating",
    "Sweep": "enpointe.sweeping",
    "sweep": "enpointe.sweeping",
    "write_report": "enpointe.report",
}

__all__ = [
    "BodyComparison",
    "Check",
    "Comparison",
    "Conversion",
    "EnpointeError",
    "Feasibility",
    "FileComparison",
    "FilePerformance",
    "Notation",
    "Performance",
    "Poses",
    "Sweep",
    "__version__",
    "check",
    "compare",
    "compare_bodies",
    "compare_file",
    "convert",
    "diagnose",
    "feasible",
    "load_score",
    "notate",
    "perform",
    "perform_file",
    "pose",
    "recognise",
    "sweep",
    "write_report",
]
__getattr__, __dir__ = lazy(__name__, _HOMES)
