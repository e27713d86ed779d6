"""A dancer's movement on bodies of servos: what stands keeps standing, and limbs point alike."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from enpointe.models import pose_target
from enpointe.models.dancer import dancer_model
from enpointe.models.puppet import op3_model, puppet_model
from enpointe.models.soles import sole_geoms
from enpointe.motion import Motion
from enpointe.motion.contact_schedule import trace_soles
from enpointe.motion.footprints import Sole, footings
from enpointe.motion.puppeteering import Puppeteered, puppeteer
from enpointe.motion.retargeting.body import Body
from enpointe.posing import vocabulary_score

from .dancing import solved, solver

BODIES = {"puppet": puppet_model, "op3": op3_model}


def position(name: str) -> np.ndarray:
    """The dancer in a position of the vocabulary."""
    score = vocabulary_score(name)
    assert score is not None
    keys = solver()
    return keys.solve(pose_target(score.resolved()[0], keys.figure)).qpos


def waving() -> Motion:
    """The dancer stands, raises both arms and bends forward a little."""
    model = dancer_model(flesh=False)
    time = np.arange(0.0, 0.8, 0.01)
    qpos = np.tile(model.key("standing").qpos, (len(time), 1))
    share = 0.5 - 0.5 * np.cos(np.pi * time / time[-1])
    for name, most in (("shoulder_raise", 1.2), ("elbow_bend", 0.7)):
        for side in ("left", "right"):
            qpos[:, model.joint(f"{side}_{name}").qposadr[0]] = 0.2 + share * most
    qpos[:, model.joint("waist_bend").qposadr[0]] = 0.2 * share
    return Motion.from_qpos(model, time, qpos)


@pytest.fixture(scope="module", params=sorted(BODIES))
def made(request: pytest.FixtureRequest) -> Puppeteered:
    return puppeteer(waving(), BODIES[request.param]())


def test_feet_stand_where_they_stood(made: Puppeteered) -> None:
    points = trace_soles(made.motion, sole_geoms(made.motion.model))
    bearing = made.contacts.bears.all(axis=0)
    assert bearing.sum() >= 8
    assert np.abs(points[:, bearing, 2]).max() < 5e-4
    assert np.ptp(points[:, bearing, :2], axis=0).max() < 1e-3


def test_joints_keep_their_ranges(made: Puppeteered) -> None:
    model = made.motion.model
    joints = model.actuator_trnid[:, 0]
    angles = made.motion.qpos[:, model.jnt_qposadr[joints]]
    assert np.all(angles >= model.jnt_range[joints, 0] - 1e-6)
    assert np.all(angles <= model.jnt_range[joints, 1] + 1e-6)


def test_the_weight_is_over_the_feet(made: Puppeteered) -> None:
    """At the end, arms and trunk forward, the centre of mass is within the bearing soles."""
    model = made.motion.model
    data = mujoco.MjData(model)
    data.qpos[:] = made.motion.qpos[-1]
    mujoco.mj_forward(model, data)
    points = made.contacts.points[-1][made.contacts.bears[-1]]
    com = data.subtree_com[0]
    for axis in (0, 1):
        assert points[:, axis].min() + 0.003 < com[axis] < points[:, axis].max() - 0.003
    assert made.weight is not None
    assert made.weight.outside.max() < 1e-4


def test_arms_point_as_the_dancers(made: Puppeteered) -> None:
    source, body = waving(), Body(made.motion.model)
    dancer = Body(source.model)
    ends = []
    for who, motion in ((dancer, source), (body, made.motion)):
        data = mujoco.MjData(motion.model)
        data.qpos[:] = motion.qpos[-1]
        mujoco.mj_forward(motion.model, data)
        start, end, length = who.segments["left_upper_arm"]
        ends.append((data.site_xpos[end] - data.site_xpos[start]) / length)
    assert ends[0] @ ends[1] > 0.95


@pytest.mark.parametrize("name", sorted(BODIES))
def test_a_heel_rises_as_far_as_there_is_a_sole_to_stand_on(name: str) -> None:
    """Of a dancer on high demi-pointe: the puppet on her second sole, OP3 flat, on one mark."""
    body = Body(BODIES[name]())
    count = 40
    pitch = np.concatenate([np.zeros(10), np.linspace(0, 1.0, 20), np.full(10, 1.0)])
    c, s, o, e = np.cos(pitch), np.sin(pitch), np.zeros(count), np.ones(count)
    foot = np.array([[c, o, s], [o, e, o], [-s, o, c]]).transpose(2, 0, 1)
    flat = np.tile(np.eye(3), (count, 1, 1))
    feet = {
        side: (np.tile([0.1, y, 0.0], (count, 1)), flat, foot, np.tile([0.0, y, 0.1], (count, 1)))
        for side, y in (("left", 0.1), ("right", -0.1))
    }
    standing = {side: np.ones(count, dtype=bool) for side in feet}
    found = footings(feet, standing, body, 0.33, 100.0)["left"]
    sole = Sole.of(body, "left")
    assert sole.rise == pytest.approx(np.pi / 4 if name == "puppet" else 0.0, abs=1e-3)
    risen = -np.arcsin(found.turn[-1][2, 0])
    assert risen == pytest.approx(sole.rise, abs=1e-6)
    edge = found.ankle + found.turn @ sole.edge
    np.testing.assert_allclose(edge, np.tile(edge[0], (count, 1)), atol=1e-9)


def test_feet_in_one_place_are_set_beside_each_other() -> None:
    body = Body(puppet_model())
    flat = np.tile(np.eye(3), (5, 1, 1))
    feet = {
        side: (np.zeros((5, 3)), flat, flat, np.tile([0.0, y, 0.0], (5, 1)))
        for side, y in (("left", 0.01), ("right", -0.01))
    }
    standing = {side: np.ones(5, dtype=bool) for side in feet}
    found = footings(feet, standing, body, 0.33, 100.0)
    apart = found["left"].ankle[0] - found["right"].ankle[0]
    assert abs(apart[1]) >= 0.048
    assert abs(apart[0]) < 1e-9


def fifth() -> Motion:
    """The dancer stands in fifth, closer than bodies of servos can."""
    qpos = solved("third-port-de-bras").key_poses[0].qpos
    time = np.arange(0.0, 0.4, 0.01)
    return Motion.from_qpos(dancer_model(flesh=False), time, np.tile(qpos, (len(time), 1)))


@pytest.mark.parametrize("name", sorted(BODIES))
def test_legs_too_thick_for_a_position_stand_wider(name: str) -> None:
    """No limb in another at any moment, and it is told by how much the position was opened."""
    made = puppeteer(fifth(), BODIES[name]())
    model = made.motion.model
    data = mujoco.MjData(model)
    plane = int(mujoco.mjtGeom.mjGEOM_PLANE)
    for qpos in made.motion.qpos[::5]:
        data.qpos[:] = qpos
        mujoco.mj_forward(model, data)
        limbs = (model.geom_type[data.contact.geom] != plane).all(axis=1)
        assert data.contact.dist[limbs].min(initial=0.0) > -5e-4
    assert made.opened > 0.002
    points = trace_soles(made.motion, sole_geoms(model))
    assert np.ptp(points[:, made.contacts.bears.all(axis=0), :2], axis=0).max() < 1e-3


def test_weight_planned_for_slower_tempi_stays_over_the_feet(made: Puppeteered) -> None:
    """The centre of mass itself, which is the zero-moment point of a dance that takes for ever."""
    assert made.weight is not None
    for k, time in enumerate(made.weight.time):
        points = made.contacts.points[made.contacts.index(float(time))]
        bearing = points[made.contacts.at(float(time)), :2]
        assert np.all(bearing.min(axis=0) < made.weight.com[k, :2])
        assert np.all(bearing.max(axis=0) > made.weight.com[k, :2])


@pytest.mark.parametrize("name", sorted(BODIES))
def test_feet_go_apart_as_the_dancers_lie(name: str) -> None:
    """In first to the sides, legs uncrossed, and in fifth one before the other."""
    body = Body(BODIES[name]())
    for pose, across in (("feet first", True), ("feet fifth", False)):
        qpos = position(pose)
        time = np.arange(0.0, 0.1, 0.01)
        held = Motion.from_qpos(dancer_model(flesh=False), time, np.tile(qpos, (len(time), 1)))
        made = puppeteer(held, body.model, balanced=False)
        data = mujoco.MjData(body.model)
        data.qpos[:] = made.motion.qpos[-1]
        mujoco.mj_forward(body.model, data)
        apart = data.site("left_ankle").xpos - data.site("right_ankle").xpos
        assert (apart[1] > abs(apart[0])) == across
