"""One dance many times, each run with its own disturbances, whichever process dances it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.random import SeedSequence
from numpy.typing import NDArray

from enpointe.controllers import PD, Controller, FeedForward, Recording, WholeBody, perform
from enpointe.errors import BodyError
from enpointe.motion import Motion
from enpointe.sim.disturbance import Disturbances, Factors, draw
from enpointe.sim.disturbed_body import DisturbedBody
from enpointe.sim.measures import measure
from enpointe.sim.push import Push

__all__ = ["CONTROLLERS", "Outcome", "Trial"]

CONTROLLERS = ("wholebody", "pd")


@dataclass(frozen=True, slots=True)
class Outcome:
    """How one run went.

    Attributes:
        run: Its number, from 0.
        factors: What was drawn, by name, SI units; None for what was left as it is.
        completed: Whether she got to the end, and stands there.
        fell_at: s, or None.
        fault: Why the run stopped early, or None.
        root_force_max: Largest force on the root from anything but gravity, floor and the push
            that was asked for, N (moments over 1 m).
        support_margin_min: m, or None.
        tracking_rms_deg: All joints and samples.
        slip_max: m.
        other_contact_max: N.
        qp_failures: Periods without a solution; None for PD.
    """

    run: int
    factors: Mapping[str, float | None]
    completed: bool
    fell_at: float | None
    fault: str | None
    root_force_max: float | None
    support_margin_min: float | None
    tracking_rms_deg: float | None
    slip_max: float | None
    other_contact_max: float | None
    qp_failures: int | None


@dataclass(frozen=True)
class Trial:
    """What is danced many times. It can be pickled and sent elsewhere.

    Attributes:
        motion: What is danced.
        controller: One of `CONTROLLERS`; it knows the motion's own model, not the changed one.
        disturbances: What is drawn for each run.
        seed: With a run's number it says all that is drawn for it.
    """

    motion: Motion
    controller: str
    disturbances: Disturbances
    seed: int

    def factors(self, run: int) -> Factors:
        """What is drawn for a run."""
        seed = SeedSequence(self.seed, spawn_key=(run,))
        return draw(self.disturbances, self.motion.model, self.motion.duration, seed)

    def run(self, run: int) -> Outcome:
        """Dance once."""
        factors = self.factors(run)
        figures = factors.figures(self.motion.model, self.motion.qpos[0])
        body = DisturbedBody(self.motion, factors)
        driver = self._driver(body.period)
        try:
            recording = perform(self.motion, driver, body)
        except BodyError as error:
            return _without_figures(run, figures, f"the controller failed: {error}")
        pushed = _asked(recording.time, body.period, factors.push)
        return _outcome(run, figures, recording, pushed, driver)

    def _driver(self, period: float) -> Controller:
        if self.controller == "wholebody":
            return WholeBody(self.motion, period=period)
        return PD(self.motion, feedforward=self._planned)

    @cached_property
    def _planned(self) -> FeedForward:
        return FeedForward.along(self.motion)


def _outcome(
    run: int,
    factors: Mapping[str, float | None],
    recording: Recording,
    pushed: NDArray[np.float64],
    driver: Controller,
) -> Outcome:
    channels = recording.channels
    felt = np.asarray(channels["root_force"], dtype=float)
    happened = dataclasses.replace(
        recording,
        qpos=np.asarray(channels["true_qpos"], dtype=float),
        qvel=np.asarray(channels["true_qvel"], dtype=float),
    )
    measures = measure(happened)
    return Outcome(
        run=run,
        factors=factors,
        completed=measures.fell_at is None,
        fell_at=measures.fell_at,
        fault=recording.fault,
        root_force_max=float(np.abs(felt - pushed).max()),
        support_margin_min=measures.support_margin_min,
        tracking_rms_deg=measures.tracking_rms_deg,
        slip_max=measures.slip_max,
        other_contact_max=measures.other_contact_max,
        qp_failures=driver.workload.failures if isinstance(driver, WholeBody) else None,
    )


def _asked(time: NDArray[np.float64], period: float, push: Push | None) -> NDArray[np.float64]:
    """What of `root_force` is the push, sample by sample, (N, 6), N."""
    asked = np.zeros((len(time), 6))
    if push is not None:
        middle = time + 0.5 * period
        during = (push.start <= middle) & (middle < push.start + push.duration)
        asked[during, :3] = np.abs(np.array(push.impulse) / push.duration)
    return asked


def _without_figures(run: int, factors: Mapping[str, float | None], fault: str) -> Outcome:
    return Outcome(run, factors, False, None, fault, None, None, None, None, None, None)
