"""The figures that `--json` prints, as types: what docs/figures.md says of each, SI units.

The names are a promise to scripts.
"""

from __future__ import annotations

from typing import TypedDict

__all__ = [
    "BodyComparisonFigures",
    "BodyFigures",
    "CheatFigures",
    "ComparisonFigures",
    "DifferenceFigures",
    "EffortFigures",
    "FileComparisonFigures",
    "FilePerformanceFigures",
    "FitFigures",
    "FlightFigures",
    "KinematicFigures",
    "LatenessFigures",
    "PerformanceFigures",
    "PhysicalFigures",
    "PoseFigures",
    "PosesFigures",
    "ReachFigures",
    "RuleFigures",
    "RuleKeptFigures",
    "ServoFigures",
    "StretchFigures",
    "SweepFailure",
    "SweepFigures",
]


class EffortFigures(TypedDict):
    """The effort that was asked."""

    name: str
    time: float
    weight: float
    space: float


class FitFigures(TypedDict):
    """The logistic that fits the wrists best."""

    b: float
    x0: float
    rms: float


class FlightFigures(TypedDict):
    """One time without load on any sole."""

    start: float
    end: float
    height: float
    turn_deg: float


class RuleKeptFigures(TypedDict):
    """One rule over a whole movement."""

    rule: str
    unit: str
    bound: float
    at_least: bool
    worst: float
    at: float
    between: list[str]
    held_fraction: float


class KinematicFigures(TypedDict):
    """What every performance has."""

    title: str
    controller: str
    effort: EffortFigures
    tempo: float
    completed: bool
    duration: float
    rules_broken: list[str]
    rules: list[RuleKeptFigures]
    logistic: FitFigures | None


class BeatFigures(TypedDict):
    """A key pose that was not reached in time, or whose weight no floor can hold."""

    beat: float | None
    time: float
    late: float | None
    outside: float


class StanceFigures(TypedDict):
    """A time at which one foot bears weight."""

    side: str
    start: float
    end: float
    force: float


class PhysicalFigures(TypedDict, total=False):
    """What a performance under gravity has besides."""

    tempo_danced: float | None
    lateness_max: float | None
    beats_not_kept: list[BeatFigures]
    contacts_planned: int
    contacts_missed: list[StanceFigures]
    contacts_unplanned: list[StanceFigures]
    fell_at: float | None
    shortfall_max: float | None
    fault: str | None
    steps: int
    root_force_max: float
    other_contact_max: float
    tracking_rms_deg: float
    support_margin_min: float | None
    slip_max: float
    flights: list[FlightFigures]
    torque_limit_fraction_max: float
    realtime_factor: float
    qp_failures: int


class PerformanceFigures(KinematicFigures, PhysicalFigures):
    """One performance; without the physical figures if it is kinematic."""


class DifferenceFigures(TypedDict):
    """How far apart two variants are."""

    between: list[str]
    wrist_path_rms: dict[str, float]
    joint_rms_deg: float


class ComparisonFigures(TypedDict):
    """Several performances of one score."""

    variants: dict[str, PerformanceFigures]
    differences: list[DifferenceFigures]


class FileComparisonFigures(TypedDict):
    """A motion file as it is drawn and as it was danced."""

    variants: dict[str, FilePerformanceFigures]
    differences: list[DifferenceFigures]


class BodyFigures(TypedDict):
    """One body of several that dance the same."""

    duration: float
    logistic: FitFigures | None


class ReachFigures(TypedDict):
    """How far apart the gestures of two bodies are."""

    between: list[str]
    reach_rms: float | None
    joint_rms_deg: float | None


class BodyComparisonFigures(TypedDict):
    """One dance on the dancer, as a rig was asked for it, and as it danced it."""

    title: str
    rig: str
    completed: bool
    time_scale: float | None
    bodies: dict[str, BodyFigures]
    differences: list[ReachFigures]
    servos: ServoFigures | None


class RuleFigures(TypedDict):
    """One rule of a key pose."""

    rule: str
    value: float
    unit: str
    bound: float
    at_least: bool
    held: bool


class CheatFigures(TypedDict):
    """What a real dancer lends to a position, by name."""

    name: str
    value: float
    unit: str


class PoseFigures(TypedDict):
    """One key pose."""

    name: str
    qpos: list[float]
    rules: list[RuleFigures]
    cheats: list[CheatFigures]
    solve_ms: float
    recognised_as: str


class PosesFigures(TypedDict):
    """The key poses of a score."""

    poses: list[PoseFigures]


class SweepFailure(TypedDict):
    """One run of a sweep that was not completed."""

    run: int
    factors: dict[str, float | None]
    fell_at: float | None
    fault: str | None


class SweepFigures(TypedDict):
    """A dance many times over."""

    disturbed_by: list[str]
    title: str
    controller: str
    duration: float
    seed: int
    runs: int
    completed_fraction: float
    completed_interval: list[float]
    runs_per_second: float | None
    root_force_max: float | None
    failures: list[SweepFailure]


class StretchFigures(TypedDict):
    """A time of a file, s and frames of it."""

    start: float
    end: float
    first_frame: int
    last_frame: int
    why: str | None


class FilePerformanceFigures(PhysicalFigures):
    """A motion file danced; what only a score has is empty."""

    title: str
    controller: str
    effort: None
    tempo: None
    completed: bool
    duration: float
    rules_broken: list[str]
    rules: list[RuleKeptFigures]
    logistic: None
    asked: list[float]
    rate: float
    first_frame: int
    danced: StretchFigures
    not_danced: list[StretchFigures]
    could_be_danced: list[StretchFigures]
    fell_at_in_file: float | None
    fell_at_frame: int | None
    warnings: list[str]


class LatenessFigures(TypedDict):
    """How late a loop woke, s."""

    median: float
    p99: float
    worst: float


class ServoFigures(TypedDict):
    """A dance of servos."""

    stage: str
    title: str
    feasible: bool | None
    time_scale: float | None
    limiting_joints: list[str] | None
    rig: str
    port: str
    completed: bool
    duration: float
    baud: int
    rate: float
    bus_ceiling_hz: float
    achieved_hz: float
    deadline_misses: int
    lateness: LatenessFigures
    frame_loss: float
    faults: list[str]
    ending: str
    positions_opened: float | None
    root_off_max: float | None
    tracking_rms_deg: float
    tracking_rms_deg_by_joint: dict[str, float]
