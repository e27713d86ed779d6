"""States, goals and holds that the tests of the whole-body controller share."""

from __future__ import annotations

from functools import cache
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers import State, WholeBody
from enpointe.controllers.wholebody.instant import Observer
from enpointe.models import KeyPoseSolver, dancer_model, pose_target
from enpointe.motion import Motion
from enpointe.motion.hold import hold
from enpointe.notation import parse_score

Array = NDArray[np.float64]
HEAD = "benesh 1\ntitle: Hold\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\nbeat 0:\n"
FIRST = "feet: first\narms: fifth en bas"
RETIRE = "left leg: straight\nright leg: retiré devant\narms: fifth en avant"
RETIRE_DEMI = RETIRE.replace("left leg: straight", "left leg: straight, demi-pointe")
ARABESQUE_DEMI = "pose: first arabesque on left\nleft leg: straight, demi-pointe"
DEVANT_POINTE = "left leg: straight, pointe\nright leg: raised devant 90\narms: à la seconde"


@cache
def solver(pointe_shoes: bool = False) -> KeyPoseSolver:
    return KeyPoseSolver(dancer_model(flesh=False, pointe_shoes=pointe_shoes))


MODEL = solver().model


@cache
def held(pose: str, seconds: float = 1.0) -> Motion:
    chosen = solver("pointe" in pose.replace("demi-pointe", ""))
    frame = parse_score(f"{HEAD}{pose}\n").resolved()[0]
    return hold(chosen.model, chosen.solve(pose_target(frame, chosen.figure)).qpos, seconds)


def shaken(pose: str, seed: int, angle: float = 0.01, speed: float = 0.2) -> tuple[Array, Array]:
    """A pose with all but the root's place moved, and a velocity."""
    rng = np.random.default_rng(seed)
    qpos = held(pose).qpos[0].copy()
    qpos[7:] += rng.normal(0.0, angle, MODEL.nu)
    low, high = MODEL.jnt_range[1:].T
    qpos[7:] = np.clip(qpos[7:], low, high)
    return qpos, rng.normal(0.0, speed, MODEL.nv)


def state(qpos: Array, qvel: Array) -> State:
    nothing = np.zeros(MODEL.nu)
    return State(0.0, qpos, qvel, nothing, nothing, np.ones(MODEL.nu, dtype=bool))


def moved(qpos: Array, qvel: Array, seconds: float) -> Array:
    after = qpos.copy()
    mujoco.mj_integratePos(MODEL, after, qvel, seconds)
    return after


def observed(qpos: Array, qvel: Array) -> Observer:
    observer = Observer(MODEL, 0.7)
    observer.place(qpos, qvel)
    return observer


def driver(pose: str, **options: Any) -> WholeBody:
    return WholeBody(held(pose), **options)
