"""What a sweep changes is drawn from its seed and its number alone, and reaches the body alone."""

from __future__ import annotations

import copy
import math

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.random import SeedSequence

from enpointe.controllers import PD, Command, perform
from enpointe.errors import EnpointeError
from enpointe.models.soles import sole_geoms
from enpointe.sim.body import SimulatedBody
from enpointe.sim.disturbance import KINDS, USUAL, Disturbances, Factors, draw
from enpointe.sim.disturbed_body import DisturbedBody
from enpointe.sim.trial import Trial

from .test_body import FIRST_POSE, MODEL, limp, still

ALL = Disturbances.parse("all")
seeds = st.integers(0, 2**32)


def drawn(disturbances: Disturbances, seed: int, run: int = 0) -> dict[str, float | None]:
    factors = draw(disturbances, MODEL, 4.0, SeedSequence(seed, spawn_key=(run,)))
    return factors.figures(MODEL, FIRST_POSE)


@given(seeds, st.integers(0, 10**6))
def test_a_run_is_what_its_seed_and_number_say(seed: int, run: int) -> None:
    first = drawn(ALL, seed, run)
    assert first == drawn(ALL, seed, run)
    assert first != drawn(ALL, seed, run + 1)
    assert first != drawn(ALL, seed + 1, run)


@given(seeds, st.sets(st.sampled_from([*KINDS])))
def test_leaving_one_kind_out_leaves_the_others_as_they_were(seed: int, left_out: set[str]) -> None:
    kept = Disturbances({n: r for n, r in ALL.ranges.items() if n not in left_out | {"com"}})
    everything = Disturbances({n: r for n, r in ALL.ranges.items() if n != "com"})
    whole, part = drawn(everything, seed), drawn(kept, seed)
    for name, value in part.items():
        assert value is None or value == whole[name]
    assert (part["push_at"] is None) == ("push" in left_out)


@given(seeds)
def test_amounts_are_within_their_ranges(seed: int) -> None:
    factors = draw(ALL, MODEL, 4.0, SeedSequence(seed))
    assert factors.mass is not None
    assert factors.com is not None
    assert np.all(np.abs(factors.mass - 1.0) <= 0.1)
    lengths = np.linalg.norm(factors.com[1:], axis=1)
    np.testing.assert_allclose(lengths, 0.01)
    for name, value in (
        ("friction", factors.friction),
        ("softness", factors.softness),
        ("rate", 1.0 / (factors.period or math.nan)),
    ):
        low, high = KINDS[name].usual
        assert value is not None
        assert low - 1e-9 <= value <= high + 1e-9
    assert factors.push is not None
    assert 0.0 <= factors.push.start <= 3.0
    assert math.hypot(*factors.push.impulse) == pytest.approx(5.0)
    assert factors.push.impulse[2] == 0.0


def test_what_is_asked_for_can_be_written_down() -> None:
    assert tuple(Disturbances.parse(None).ranges) == USUAL
    assert Disturbances.parse("none").ranges == {}
    read = Disturbances.parse("push=8, mass ,friction=0.4:1")
    assert read.ranges == {"mass": (0.1, 0.1), "friction": (0.4, 1.0), "push": (8.0, 8.0)}
    assert list(read.ranges) == ["mass", "friction", "push"]
    assert len(read.words()) == 3


@pytest.mark.parametrize(
    "text", ["wind", "push=-1", "push=2:1", "push=a", "push=nan", "mass=2", "", "rate=1e9"]
)
def test_what_makes_no_sense_is_refused(text: str) -> None:
    with pytest.raises(EnpointeError):
        Disturbances.parse(text)


def test_only_a_copy_is_changed() -> None:
    before = copy.copy(MODEL)
    factors = draw(ALL, MODEL, 4.0, SeedSequence(5))
    changed = factors.applied(MODEL)
    for name in ("body_mass", "body_inertia", "body_ipos", "geom_friction", "geom_solref"):
        np.testing.assert_array_equal(getattr(MODEL, name), getattr(before, name))
        assert np.any(getattr(changed, name) != getattr(before, name))
    assert factors.mass is not None
    np.testing.assert_allclose(changed.body_mass, MODEL.body_mass * factors.mass)
    assert changed.body_subtreemass[0] == pytest.approx(changed.body_mass.sum())


def test_the_floor_is_as_slippery_as_drawn() -> None:
    """A sole on a tilted floor: the friction of the contact itself, as MuJoCo mixes it."""
    changed = Factors(friction=0.3, softness=0.02).applied(MODEL)
    data = mujoco.MjData(changed)
    data.qpos[:] = FIRST_POSE
    data.qpos[2] -= 0.002
    mujoco.mj_forward(changed, data)
    soles = set(sole_geoms(changed).tolist())
    touching = [c for c in data.contact if soles & set(c.geom.tolist())]
    assert touching
    for contact in touching:
        assert contact.friction[0] == pytest.approx(0.3)
        assert contact.solref[0] == pytest.approx(0.02)


# -- Senses ------------------------------------------------------------------------------------


def test_without_disturbance_it_is_the_simulated_body() -> None:
    motion = still(0.1)
    plain = perform(motion, PD(motion), SimulatedBody.at_start_of(motion))
    same = perform(motion, PD(motion), DisturbedBody(motion, Factors()))
    for name in ("time", "qpos", "qvel", "effort"):
        np.testing.assert_array_equal(getattr(plain, name), getattr(same, name))


@pytest.mark.parametrize("delay", [0.002, 0.006])
def test_what_is_read_is_as_old_as_the_delay(delay: float) -> None:
    body, clear = (DisturbedBody(still(1.0), Factors(delay=d)) for d in (delay, None))
    past = [clear.read().qpos]
    for _ in range(20):
        body.write(limp())
        clear.write(limp())
        past.append(clear.read().qpos)
        seen = body.read()
        older = past[max(len(past) - 1 - round(delay / body.period), 0)]
        np.testing.assert_allclose(seen.qpos, older, atol=1e-12)
        assert seen.time == clear.read().time
        assert np.all(seen.age == delay)


def test_a_delay_of_half_a_period_is_half_way() -> None:
    body, clear = (DisturbedBody(still(1.0), Factors(delay=d)) for d in (0.001, None))
    for each in (body, clear):
        each.write(limp())
    before = clear.read()
    for each in (body, clear):
        each.write(limp())
    middle = 0.5 * (before.qvel + clear.read().qvel)
    np.testing.assert_allclose(body.read().qvel, middle, atol=1e-12)


def test_noise_is_on_what_is_read_and_not_on_what_happens() -> None:
    noisy, clear = (DisturbedBody(still(1.0), Factors(noise=n)) for n in (2.0, None))
    angles, speeds = [], []
    for _ in range(150):
        noisy.write(limp())
        clear.write(limp())
        seen, true = noisy.read(), clear.read()
        assert noisy.read() is seen
        np.testing.assert_array_equal(noisy.data.qpos, clear.data.qpos)
        np.testing.assert_array_equal(seen.qpos[:3], true.qpos[:3])
        angles.append(seen.qpos[7:] - true.qpos[7:])
        speeds.append(seen.qvel[3:] - true.qvel[3:])
    # 5400 samples: the standard deviation is known to 1 %, five of which are allowed.
    assert np.std(angles) == pytest.approx(2.0 * np.radians(0.1), rel=0.05)
    assert np.std(speeds) == pytest.approx(2.0 * 0.05, rel=0.05)
    assert abs(np.mean(speeds)) < 5 * 0.1 / np.sqrt(np.size(speeds))


# -- Trials ------------------------------------------------------------------------------------


def trial(disturb: str, seconds: float = 0.4, *, controller: str = "pd") -> Trial:
    return Trial(still(seconds), controller, Disturbances.parse(disturb), seed=0)


def test_the_push_that_was_asked_for_is_no_help() -> None:
    outcome = trial("push=3").run(1)
    assert outcome.factors["push"] == 3.0
    assert outcome.root_force_max == 0.0


def test_any_other_force_on_the_root_shows(monkeypatch: pytest.MonkeyPatch) -> None:
    write = DisturbedBody.write

    def helped(self: DisturbedBody, command: Command) -> None:
        self.data.qfrc_applied[2] = 7.0
        write(self, command)

    monkeypatch.setattr(DisturbedBody, "write", helped)
    assert trial("push=3").run(1).root_force_max == pytest.approx(7.0)


def test_a_push_moves_her_by_its_impulse() -> None:
    """In the air nothing else moves her sideways: m v = J."""
    aloft = FIRST_POSE.copy()
    aloft[2] += 2.0
    motion = still(0.3, aloft)
    factors = Factors(impulse=5.0, push_at=0.05, push_direction=0.5)
    recording = perform(motion, PD(motion), DisturbedBody(motion, factors))
    com = np.asarray(recording.channels["com"])
    velocity = (com[-1] - com[-11]) / (10 * recording.period)
    mass = float(MODEL.body_mass.sum())
    wanted = 5.0 / mass * np.array([np.cos(0.5), np.sin(0.5)])
    np.testing.assert_allclose(velocity[:2], wanted, rtol=1e-3)


def test_a_trial_is_the_same_twice_and_differs_between_runs() -> None:
    several = trial("mass,friction,push=1")
    assert several.run(2) == several.run(2)
    assert several.run(2).factors != several.run(3).factors


def test_a_hard_push_fells_and_says_when() -> None:
    outcome = trial("push=60", 1.5).run(0)
    assert not outcome.completed
    assert outcome.fell_at is not None
    assert outcome.factors["push_at"] is not None
    assert outcome.fell_at >= outcome.factors["push_at"]
