"""`enpointe compare` on a motion file: as it is drawn, and as gravity lets it be danced."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.comparing import Difference, differences
from enpointe.figures import FileComparisonFigures
from enpointe.performing_file import FilePerformance, perform_file
from enpointe.preparing import Progress, silent

if TYPE_CHECKING:
    from enpointe.models import Anthropometry

__all__ = ["FileComparison", "compare_file"]


@dataclass(frozen=True)
class FileComparison:
    """A motion file drawn and danced, over the same times.

    Attributes:
        performances: By name: `file`, on the dancer without weight, and `physical`.
        differences: Between the two.
    """

    performances: Mapping[str, FilePerformance]
    differences: tuple[Difference, ...]

    @property
    def physical(self) -> FilePerformance:
        """The dance, with all that is to be said of it."""
        return self.performances["physical"]

    @property
    def completed(self) -> bool:
        """Whether she danced all that was asked for, and stands at the end."""
        return self.physical.completed

    def summary(self) -> FileComparisonFigures:
        """The figures that `--json` prints."""
        return {
            "variants": {name: each.summary() for name, each in self.performances.items()},
            "differences": [each.summary() for each in self.differences],
        }


def compare_file(
    path: str | Path,
    *,
    span: tuple[float, float] | None = None,
    speed: float = 1.0,
    dancer: Anthropometry | None = None,
    mapping: str | Path | None = None,
    skeleton: str | Path | None = None,
    progress: Progress = silent,
) -> FileComparison:
    """Dance a motion file by the whole-body controller, and set it beside the file.

    The file is shown at the clock of the dance, which runs up from rest and down to it.

    Args:
        path: As for `perform_file`, as is all that follows.
        span: Start and end of what is wanted, s from the file's first frame; all if None.
        speed: How much faster than the file.
        dancer: Height, mass and sex; a dancer of 1.68 m and 54 kg if None.
        mapping: Which joints of a captured skeleton are which, as a TOML file; found if None.
        skeleton: The ASF file of an AMC file, where it does not lie beside it.
        progress: Told how far it is.

    Raises:
        FormatError: The file can't be read.
        EnpointeError: Anything else that the caller can mend, in one line.
    """
    danced = perform_file(
        path,
        span=span,
        speed=speed,
        dancer=dancer,
        mapping=mapping,
        skeleton=skeleton,
        progress=progress,
    )
    drawn = replace(
        danced, controller="kinematic", motion=danced.eased.motion, physics=None, weight=None
    )
    performances = {"file": drawn, "physical": danced}
    return FileComparison(performances, differences(performances))
