"""Dances of two key poses, and the reports of them, made once."""

from __future__ import annotations

import dataclasses

import pytest

from enpointe.comparing import Comparison, compare
from enpointe.performing import Performance, perform
from enpointe.posing import Poses, pose
from enpointe.report import ReportFiles, write_report

from .pages import HOSTILE, short_score


@pytest.fixture(scope="session")
def physical() -> Performance:
    return perform(short_score(), effort="happy")


@pytest.fixture(scope="session")
def kinematic() -> Performance:
    return perform(short_score(HOSTILE), effort="sad", controller="kinematic")


@pytest.fixture(scope="session")
def comparison() -> Comparison:
    return compare(short_score(), effort="angry", tempo=70.0)


@pytest.fixture(scope="session")
def poses() -> Poses:
    return pose(short_score(HOSTILE))


@pytest.fixture(scope="session")
def fallen(physical: Performance) -> Performance:
    """The same dance cut short, as a fall cuts it."""
    recording, measures = physical.recording, physical.measures
    assert recording is not None
    assert measures is not None
    assert physical.physics is not None
    kept = len(recording.time) // 3
    arrays = ("time", "qpos", "qvel", "effort", "position", "torque", "age", "valid")
    cut = dataclasses.replace(
        recording,
        fault="fell",
        channels={name: array[:kept] for name, array in recording.channels.items()},
        **{name: getattr(recording, name)[:kept] for name in arrays},
    )
    figures = (
        "com",
        "cop",
        "margin",
        "capture_margin",
        "foot_force",
        "slip",
        "error",
        "torque_fraction",
    )
    margin = measures.margin[:kept].copy()
    margin[-5:] = -float("inf")
    less = dataclasses.replace(
        measures,
        fell_at=float(cut.time[-6]),
        **{name: getattr(measures, name)[:kept] for name in figures} | {"margin": margin},
    )
    physics = dataclasses.replace(physical.physics, recording=cut, measures=less)
    return dataclasses.replace(physical, physics=physics)


@pytest.fixture(scope="session")
def reports(
    tmp_path_factory: pytest.TempPathFactory,
    physical: Performance,
    kinematic: Performance,
    fallen: Performance,
    comparison: Comparison,
    poses: Poses,
) -> dict[str, ReportFiles]:
    """A report of each kind, without a film."""
    dances: dict[str, Performance | Comparison | Poses] = {
        "physical": physical,
        "kinematic": kinematic,
        "fallen": fallen,
        "comparison": comparison,
        "poses": poses,
    }
    return {
        name: write_report(dance, tmp_path_factory.mktemp(name), video=False)
        for name, dance in dances.items()
    }
