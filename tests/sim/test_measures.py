"""The figures of a performance, on recordings whose answers are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from enpointe.controllers import Recording
from enpointe.controllers.plant import Plant
from enpointe.models.foot_positions import support_hull
from enpointe.motion import Motion
from enpointe.sim.balance import margin
from enpointe.sim.measures import measure

from ..motion.dancing import danced, solved, solver

Array = NDArray[np.float64]
MODEL = solver().model
POSE = solved("first-port-de-bras").key_poses[0].qpos
PERIOD = 0.002


def standing(samples: int = 500) -> Recording:
    """A dancer as still as a statue, with equal weight on every sole."""
    plant = Plant(MODEL)
    plant.place(POSE)
    points = plant.data.geom_xpos[plant.sole_geoms] * [1, 1, 0]
    force = np.zeros((len(points), 3))
    force[:, 2] = plant.mass * 9.81 / len(points)
    time = np.arange(samples, dtype=float) * PERIOD
    still = np.zeros((samples, MODEL.nu))

    def every(value: Array) -> Array:
        return np.repeat(value[None], samples, axis=0)

    reference = Motion.from_qpos(MODEL, [0.0, float(time[-1])], np.stack([POSE, POSE]))
    channels = {
        "sole_force": every(force),
        "sole_point": every(points),
        "sole_depth": every(np.zeros(len(points))),
        "other_contacts": np.zeros(samples, dtype=int),
        "other_force": np.zeros(samples),
        "com": every(plant.com),
        "root_force": np.zeros((samples, 6)),
    }
    return Recording(
        MODEL, reference, time, every(POSE), np.zeros((samples, MODEL.nv)), still, still, still,
        still, np.ones_like(still, dtype=bool), channels, None, 1.0,
    )  # fmt: skip


def changed(recording: Recording, **channels: Array) -> Recording:
    return replace(recording, channels={**recording.channels, **channels})


def jumping(
    first: int = 100, last: int = 250, rise: float = 0.12, turn: float = np.pi
) -> Recording:
    """The statue leaves the floor between two samples, on a parabola, turning steadily."""
    recording = standing()
    force = np.array(recording.channels["sole_force"])
    com = np.array(recording.channels["com"])
    qpos = recording.qpos.copy()
    share = np.linspace(0, 1, last - first)
    force[first:last] = 0.0
    com[first:last, 2] += rise * 4 * share * (1 - share)
    qpos[first:last, 3:7] = 0.0
    qpos[first:last, 3], qpos[first:last, 6] = np.cos(turn * share / 2), np.sin(turn * share / 2)
    return replace(changed(recording, sole_force=force, com=com), qpos=qpos)


def test_a_statue_has_no_faults() -> None:
    figures = measure(standing())
    assert figures.tracking_rms_deg == pytest.approx(0.0, abs=1e-9)
    assert figures.slip_max == figures.root_force_max == figures.other_contact_max == 0.0
    assert figures.flights == ()
    assert figures.fell_at is None
    weight = MODEL.body_mass.sum() * 9.81
    np.testing.assert_allclose(figures.foot_force, weight / 2)
    hull = support_hull(np.asarray(standing().channels["sole_point"])[0, :, :2])
    assert figures.support_margin_min == pytest.approx(margin(hull, figures.com[0, :2]))


def test_a_jump_is_a_flight() -> None:
    (flight,) = measure(jumping()).flights
    assert flight.start == pytest.approx(100 * PERIOD)
    assert flight.end == pytest.approx(249 * PERIOD)
    assert flight.height == pytest.approx(0.12, rel=0.01)
    assert flight.turn_deg == pytest.approx(180.0)


@pytest.mark.parametrize("turns", [-2.0, 1.5, 3.0])
def test_turns_in_the_air_are_counted_beyond_one(turns: float) -> None:
    (flight,) = measure(jumping(turn=2 * np.pi * turns)).flights
    assert flight.turn_deg == pytest.approx(360.0 * turns, abs=0.1)


def test_a_rattle_is_no_jump() -> None:
    assert measure(jumping(100, 108)).flights == ()
    assert len(measure(jumping(100, 115)).flights) == 1


def test_in_the_air_there_is_no_margin_and_no_pressure() -> None:
    figures = measure(jumping())
    assert np.all(np.isneginf(figures.margin[100:250]))
    assert np.isnan(figures.cop[100:250]).all()
    assert figures.support_margin_min == pytest.approx(measure(standing()).support_margin_min)
    never = changed(standing(), sole_force=np.zeros((500, 12, 3)))
    assert measure(never).support_margin_min is None


def test_a_flight_may_be_the_end() -> None:
    (flight,) = measure(jumping(400, 500)).flights
    assert flight.end == pytest.approx(499 * PERIOD)


def test_a_fall_is_dated_by_the_last_sample() -> None:
    assert measure(replace(standing(), fault="fell")).fell_at == pytest.approx(499 * PERIOD)


def drifting(speed: float, *, start: int = 100) -> Recording:
    """The statue's weight wanders forwards from a sample on, at `speed` m/s."""
    recording = standing()
    com = np.array(recording.channels["com"])
    com[start:, 0] += speed * PERIOD * np.arange(len(com) - start)
    return changed(recording, com=com)


def test_weight_that_ends_outside_the_feet_has_fallen_when_it_left_them() -> None:
    figures = measure(drifting(0.4))
    outside = np.flatnonzero(figures.margin < 0.0)
    assert 100 < outside[0] < 499
    assert figures.fell_at == pytest.approx((outside[0] - 1) * PERIOD)


def test_weight_that_is_still_inside_but_too_fast_has_fallen() -> None:
    """The capture point, c + c' sqrt(h / g), is out before the weight is (Hof et al. 2005)."""
    figures = measure(drifting(0.3, start=490))
    assert figures.margin.min() > 0.0
    assert figures.capture_margin[-1] < -0.005
    assert figures.fell_at == pytest.approx(499 * PERIOD)


def test_a_capture_point_is_ahead_by_speed_and_height() -> None:
    """Weight over the very middle, moving slowly forwards: nearer to the toes by v sqrt(h / g)."""
    still, moving = measure(standing()), measure(drifting(0.02))
    assert still.capture_margin == pytest.approx(still.margin)
    ahead = 0.02 * np.sqrt(moving.com[-1, 2] / 9.81)
    hull = support_hull(np.asarray(standing().channels["sole_point"])[0, :, :2])
    point = moving.com[-1, :2] + [ahead, 0.0]
    assert moving.capture_margin[-1] == pytest.approx(margin(hull, point), abs=1e-6)
    assert moving.fell_at is None


def test_who_comes_back_over_her_feet_has_not_fallen() -> None:
    recording = standing()
    com = np.array(recording.channels["com"])
    com[100:400, 0] += 0.4 * np.sin(np.linspace(0, np.pi, 300)) ** 2
    figures = measure(changed(recording, com=com))
    assert figures.margin.min() < -0.1
    assert figures.fell_at is None


def test_a_joint_that_lags_shows() -> None:
    recording = standing()
    qpos = recording.qpos.copy()
    qpos[:, 7 + 4] += np.radians(3.0)
    figures = measure(replace(recording, qpos=qpos))
    assert figures.joint_rms_deg[4] == pytest.approx(3.0)
    assert np.delete(figures.joint_rms_deg, 4).max() == pytest.approx(0.0, abs=1e-9)
    assert figures.tracking_rms_deg == pytest.approx(3.0 / np.sqrt(MODEL.nu))


def test_the_most_used_muscle_is_found() -> None:
    recording = standing()
    effort = recording.effort.copy()
    effort[7, 3] = -0.8 * MODEL.actuator_forcerange[3, 1]
    assert measure(replace(recording, effort=effort)).torque_limit_fraction_max == pytest.approx(
        0.8
    )


def test_foreign_forces_are_found() -> None:
    recording = standing()
    pull, bump = np.zeros((500, 6)), np.zeros(500)
    pull[30, 2], bump[40] = 12.0, 34.0
    figures = measure(changed(recording, root_force=pull, other_force=bump))
    assert (figures.root_force_max, figures.other_contact_max) == (12.0, 34.0)


def test_sliding_shows() -> None:
    recording = standing()
    points = np.array(recording.channels["sole_point"])
    points[250:, 3, 1] += 0.004
    assert measure(changed(recording, sole_point=points)).slip_max == pytest.approx(0.004)


def test_weight_on_one_side_is_on_that_foot() -> None:
    recording = standing()
    names = [MODEL.geom(int(g)).name for g in Plant(MODEL).sole_geoms]
    force = np.zeros((500, 12, 3))
    force[:, [n.startswith("left") for n in names], 2] = 80.0
    figures = measure(changed(recording, sole_force=force))
    np.testing.assert_allclose(figures.foot_force, [[480.0, 0.0]] * 500)


def test_standing_still_the_pressure_is_under_the_weight() -> None:
    """On a real performance: during the hold at the end the CoP is below the CoM, within 1 mm."""
    figures = danced("third-port-de-bras", "happy").measures
    held = slice(-100, None)
    apart = np.linalg.norm(figures.cop[held] - figures.com[held, :2], axis=1)
    assert apart.max() < 0.001
    weight = MODEL.body_mass.sum() * 9.81
    np.testing.assert_allclose(figures.foot_force[held].sum(axis=1), weight, rtol=0.005)


def test_dancing_the_pressure_stays_within_the_support() -> None:
    recording = danced("third-port-de-bras", "happy").recording
    figures = danced("third-port-de-bras", "happy").measures
    points = np.asarray(recording.channels["sole_point"])
    forces = np.asarray(recording.channels["sole_force"])
    for i in range(0, len(points), 25):
        hull = support_hull(points[i, forces[i, :, 2] > 0, :2])
        assert margin(hull, figures.cop[i]) >= -1e-9


def test_on_average_the_pressure_is_under_the_weight() -> None:
    """Sway and the limbs' angular momentum part CoP and CoM, but over a whole dance they cancel."""
    figures = danced("third-port-de-bras", "happy").measures
    apart = (figures.cop - figures.com[:, :2])[100:]
    assert np.linalg.norm(apart.mean(axis=0)) < 0.002
