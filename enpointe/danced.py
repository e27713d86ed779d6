"""What every performance is, whatever was performed: a reference, and what a body made of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from enpointe.preparing import Progress, silent

if TYPE_CHECKING:
    from enpointe.controllers import Recording
    from enpointe.figures import PhysicalFigures
    from enpointe.motion import Motion
    from enpointe.motion.contact_schedule import ContactSchedule
    from enpointe.motion.weight_plan import WeightPlan
    from enpointe.sim.measures import Measures

__all__ = ["CONTROLLERS", "HELD_UP", "Danced", "Physics", "run_physics"]

CONTROLLERS = ("kinematic", "pd", "wholebody")
HELD_UP = 1e-6
"""A force on the root above this, N, is help."""


@dataclass(frozen=True)
class Physics:
    """What came of a reference under gravity.

    Attributes:
        recording: What happened.
        measures: Its figures.
        shortfall: Most that the floor could not give of the force and moment that the movement
            asks of it, N (moments over 1 m).
        qp_failures: Periods for which the whole-body controller found no solution and fell back;
            None for other controllers.
    """

    recording: Recording
    measures: Measures
    shortfall: float
    qp_failures: int | None


def run_physics(
    motion: Motion,
    controller: str,
    progress: Progress = silent,
    contacts: ContactSchedule | None = None,
) -> Physics:
    """Dance a reference by pd or wholebody on the simulated stage.

    Args:
        motion: The reference.
        controller: One of `CONTROLLERS`, not "kinematic".
        progress: Told how far it is.
        contacts: Which soles the reference was planned to stand on; read from it if None.
    """
    from enpointe.controllers import PD, FeedForward, WholeBody
    from enpointe.controllers import perform as run
    from enpointe.controllers.wholebody import DEFAULT_TASKS, STEPPING_TASKS
    from enpointe.sim.body import SimulatedBody
    from enpointe.sim.measures import measure

    planned = FeedForward.along(motion, contacts)
    tasks = DEFAULT_TASKS if contacts is None else STEPPING_TASKS
    driver = (
        WholeBody(motion, contacts=contacts, tasks=tasks)
        if controller == "wholebody"
        else PD(motion, feedforward=planned)
    )
    recording = run(
        motion,
        driver,
        SimulatedBody.at_start_of(motion),
        progress=lambda done, total: progress("dance", done, total),
    )
    failures = driver.workload.failures if isinstance(driver, WholeBody) else None
    return Physics(recording, measure(recording), float(planned.shortfall.max()), failures)


@dataclass(frozen=True, kw_only=True)
class Danced:
    """A dance and its reference.

    Attributes:
        controller: One of `CONTROLLERS`.
        motion: The reference: what was to be danced.
        physics: What came of it; None for a kinematic performance.
        weight: Where the centre of mass was planned to go; None where no plan was needed.
    """

    controller: str
    motion: Motion
    physics: Physics | None = None
    weight: WeightPlan | None = None

    @property
    def recording(self) -> Recording | None:
        """What happened; None for a kinematic performance."""
        return None if self.physics is None else self.physics.recording

    @property
    def measures(self) -> Measures | None:
        """Figures of the recording; None for a kinematic performance."""
        return None if self.physics is None else self.physics.measures

    @cached_property
    def danced(self) -> Motion:
        """What was really danced: the recording as a motion, or the motion itself."""
        return self.motion if self.recording is None else self.recording.as_motion()

    @property
    def stood(self) -> bool:
        """Whether the dancer got to the end of the reference, and stands there."""
        return self.measures is None or self.measures.fell_at is None

    def save(self, folder: Path) -> dict[str, Path]:
        """Write `motion.npz` and, of a physical performance, `recording.npz` and `balance.csv`.

        Returns:
            The paths by name.
        """
        from enpointe.motion.npz import save_motion

        files = {"motion": folder / "motion.npz"}
        save_motion(self.danced, files["motion"])
        if self.recording is not None:
            files["recording"] = folder / "recording.npz"
            self.recording.save(files["recording"])
            from enpointe.sim.balance_table import balance_table

            files["balance"] = folder / "balance.csv"
            balance_table(self.recording).save(files["balance"])
        return files

    def physical_figures(self) -> PhysicalFigures:
        """The figures of a dance under gravity; none of a kinematic one."""
        if self.physics is None:
            return {}
        from enpointe.physical_figures import physical_figures

        physics = self.physics
        figures = physical_figures(
            physics.recording, physics.measures, physics.shortfall, self.weight
        )
        if physics.qp_failures is not None:
            figures["qp_failures"] = physics.qp_failures
        return figures
