"""Forces under the feet against Newton and Euler, and the pressure against a force plate."""

from __future__ import annotations

import copy
from functools import cache

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from enpointe.controllers import WholeBody
from enpointe.motion import Motion
from enpointe.sim.balance import LOADED, centre_of_pressure, zero_moment_point
from enpointe.sim.body import SimulatedBody
from enpointe.sim.contacts import ContactReader

from ..controllers.wholebody_cases import ARABESQUE_DEMI, FIRST, RETIRE, held

Array = NDArray[np.float64]
Step = tuple[Array, Array, Array, Array, Array, Array]
TINY = 1e-6
POSES = (FIRST, RETIRE, ARABESQUE_DEMI)


def swaying(pose: str, seconds: float = 0.6) -> Motion:
    """A pose whose arms and trunk swing about, so that the floor has something to do."""
    still = held(pose, seconds)
    model = still.model
    time = np.arange(round(seconds * 250) + 1) / 250
    qpos = np.tile(still.qpos[0], (len(time), 1))
    for name, size in (("left_shoulder_raise", 0.3), ("waist_tilt", 0.06), ("waist_turn", 0.2)):
        swing = size * np.sin(2 * np.pi * 1.5 * time) ** 2
        qpos[:, model.joint(name).qposadr[0]] += swing
    return Motion.from_qpos(model, time, qpos)


@cache
def steps(pose: str) -> tuple[SimulatedBody, list[Step]]:
    """Of each physics step: CoM, c'', L', sole points, sole forces, wrench about the origin.

    c'' and L' come from the velocities before and after the step in the configuration that it was
    solved in, and from how momentum changes there at constant velocity; the wrench from the
    contacts' own places and forces.
    """
    motion = swaying(pose)
    body, controller = SimulatedBody.at_start_of(motion, period=0.001), WholeBody(motion)
    model, data = body.model, body.data
    probe, reader = mujoco.MjData(model), ContactReader(model)
    controller.reset(body.read())
    rows = []
    for k in range(round(motion.duration / 0.001)):
        state = body.read()
        body.write(controller.command(0.001 * k, state))
        change = _momenta(probe, state.qpos, data.qvel) - _momenta(probe, state.qpos, state.qvel)
        ahead, behind = state.qpos.copy(), state.qpos.copy()
        mujoco.mj_integratePos(model, ahead, state.qvel, TINY)
        mujoco.mj_integratePos(model, behind, state.qvel, -TINY)
        drift = _momenta(probe, ahead, state.qvel) - _momenta(probe, behind, state.qvel)
        rate = change / model.opt.timestep + drift / (2 * TINY)
        _momenta(probe, state.qpos, state.qvel)
        reader.read(data)
        seen = reader.observed()
        rows.append(
            (
                np.array(probe.subtree_com[0]),
                rate[0],
                rate[1],
                np.asarray(seen["sole_point"], dtype=float),
                np.asarray(seen["sole_force"], dtype=float),
                _plate(model, data),
            )
        )
    assert body.fault is None
    return body, rows


def _momenta(probe: mujoco.MjData, qpos: Array, qvel: Array) -> Array:
    """Velocity of the centre of mass and angular momentum about it, (2, 3)."""
    model = probe.model
    probe.qpos[:], probe.qvel[:] = qpos, qvel
    mujoco.mj_fwdPosition(model, probe)
    mujoco.mj_fwdVelocity(model, probe)
    mujoco.mj_subtreeVel(model, probe)
    return np.array([probe.subtree_linvel[0], probe.subtree_angmom[0]])


def _plate(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """What a force plate in the floor reads: force and moment about the origin, (6,)."""
    wrench, total = np.zeros(6), np.zeros(6)
    for i in range(data.ncon):
        mujoco.mj_contactForce(model, data, i, wrench)
        frame = data.contact.frame[i].reshape(3, 3)
        force = frame.T @ wrench[:3]
        place = np.array([*data.contact.pos[i, :2], 0.0])
        total += np.concatenate([force, np.cross(place, force)])
    return total


def loaded(rows: list[Step]) -> list[Step]:
    """All but the first step, in which a sole may not have come down yet."""
    assert all(row[4][:, 2].sum() > LOADED for row in rows[1:])
    return rows[1:]


@pytest.mark.parametrize("pose", POSES)
def test_the_floor_gives_mass_times_acceleration_less_gravity(pose: str) -> None:
    body, rows = steps(pose)
    mass = body.model.body_mass.sum()
    sums = np.array([row[4].sum(axis=0) for row in rows])
    expected = np.array([mass * (row[1] + [0, 0, 9.81]) for row in rows])
    np.testing.assert_allclose(sums, expected, atol=0.05)
    assert np.ptp(expected[:, 2]) > 5.0


@pytest.mark.parametrize("pose", POSES)
def test_the_pressure_is_where_a_force_plate_has_it(pose: str) -> None:
    """CoP = (-M_y, M_x) / F_z of the plate's wrench."""
    _, rows = steps(pose)
    for _, _, _, points, forces, plate in loaded(rows):
        expected = np.array([-plate[4], plate[3]]) / plate[2]
        assert np.linalg.norm(centre_of_pressure(points, forces) - expected) < 1e-3


@pytest.mark.parametrize("pose", POSES)
def test_the_movement_alone_tells_where_the_pressure_is(pose: str) -> None:
    body, rows = steps(pose)
    mass = float(body.model.body_mass.sum())
    apart, travelled = [], []
    for com, acceleration, rate, points, forces, _ in loaded(rows):
        pressure = centre_of_pressure(points, forces)
        point = zero_moment_point(com, acceleration, rate, mass, 9.81)
        apart.append(np.linalg.norm(point - pressure))
        travelled.append(pressure)
    assert max(apart) < 1e-3
    assert np.ptp(np.array(travelled), axis=0).max() > 5e-3


@pytest.mark.parametrize("cone", [mujoco.mjtCone.mjCONE_ELLIPTIC, mujoco.mjtCone.mjCONE_PYRAMIDAL])
def test_forces_are_those_that_mujoco_tells(cone: mujoco.mjtCone) -> None:
    still = held(FIRST, 0.1)
    model = copy.copy(still.model)
    model.opt.cone = cone
    data, reader = mujoco.MjData(model), ContactReader(model)
    data.qpos[:] = still.qpos[0]
    for _ in range(20):
        mujoco.mj_step(model, data)
    reader.read(data)
    forces, wrench = np.zeros((len(reader.soles), 3)), np.zeros(6)
    for i in range(data.ncon):
        mujoco.mj_contactForce(model, data, i, wrench)
        first, second = data.contact.geom[i].tolist()
        sole, sign = (second, 1.0) if second in reader.soles else (first, -1.0)
        if sole in reader.soles:
            on_sole = sign * wrench[:3] @ data.contact.frame[i].reshape(3, 3)
            forces[reader.soles.tolist().index(sole)] += on_sole
    assert forces[:, 2].sum() > 100.0
    np.testing.assert_allclose(
        np.asarray(reader.observed()["sole_force"], dtype=float), forces, atol=1e-12
    )
