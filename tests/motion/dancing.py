"""Scores solved, moved and danced once a process, for all the tests that look at the same dance."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cache

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers import PD, Command, Recording, perform
from enpointe.models import KeyPoseSolver, dancer_model
from enpointe.motion import (
    PRESETS,
    Choreography,
    Interpolation,
    Motion,
    interpolate,
    solve_key_poses,
)
from enpointe.notation import load_score, parse_score, shipped_scores
from enpointe.sim.body import SimulatedBody
from enpointe.sim.measures import Measures, measure

SCORES = shipped_scores()
PORTS_DE_BRAS = ("first-port-de-bras", "third-port-de-bras", "fourth-port-de-bras")
"""On both feet throughout: what PD dances under gravity. The others leave the floor or stand on one
leg, where it falls; they move kinematically."""
EFFORTS = tuple(PRESETS)

TINY = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <body name="trunk" pos="0 0 1">
      <freejoint name="root"/>
      <geom type="sphere" size="0.1" mass="1" contype="0" conaffinity="0"/>
      <body name="arm">
        <joint name="hinge" type="hinge" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.02" mass="0.2" contype="0"
              conaffinity="0"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="hinge" forcerange="-9 9" forcelimited="true"/></actuator>
</mujoco>
"""


@cache
def tiny_model() -> mujoco.MjModel:
    """A free ball with one arm: the smallest body that has all that a motion has."""
    return mujoco.MjModel.from_xml_string(TINY)


@cache
def solver() -> KeyPoseSolver:
    return KeyPoseSolver(dancer_model(flesh=False))


def written_score(*beats: str, tempo: float = 60.0) -> str:
    """A score of one line a beat; several signs of a beat are separated by semicolons."""
    text = f"benesh 1\ntitle: Test\nmethod: Cecchetti\nmetre: 4/4\ntempo: {tempo:g}\n"
    for beat, signs in enumerate(beats):
        lines = "".join(f"  {sign.strip()}\n" for sign in signs.split(";"))
        text += f"\nbeat {beat}:\n{lines}"
    return text


@cache
def solved(text: str) -> Choreography:
    """A score's own text, or the name of a shipped one, solved at its own tempo."""
    score = load_score(text) if text in SCORES else parse_score(text)
    return solve_key_poses(score, solver())


def timed(chosen: Choreography, tempo: float) -> Choreography:
    """At another tempo; where nothing jumps, the poses stay what they are."""
    score = chosen.score
    stations = []
    for station in chosen.stations:
        assert station.frame is not None
        assert station.flight is None
        beat = score.frames[station.frame].beat
        stations.append(replace(station, time=score.seconds(beat, tempo)))
    return replace(chosen, stations=tuple(stations), tempo=tempo)


@cache
def choreography(score: str, preset: str) -> Choreography:
    return timed(solved(score), PRESETS[preset].tempo)


@cache
def motion(score: str, preset: str, kind: str = "expressive") -> Motion:
    return interpolate(choreography(score, preset), PRESETS[preset].effort, Interpolation(kind))


@dataclass
class Watch:
    """What an onlooker of every physics step saw; all of it should stay zero or empty."""

    applied: float = 0.0
    pulled: float = 0.0
    root_actuation: float = 0.0
    over_limit: float = 0.0
    strangers: set[tuple[str, str]] = field(default_factory=set)
    steps: int = 0


class WatchedBody(SimulatedBody):
    """The simulated body with an onlooker at its own data."""

    watch: Watch

    def write(self, command: Command) -> None:
        super().write(command)
        data, watch = self.data, self.watch
        limit = self.model.actuator_forcerange[:, 1]
        excess = float(np.max(np.abs(data.actuator_force) - limit))
        watch.over_limit = max(watch.over_limit, excess)
        watch.root_actuation = max(
            watch.root_actuation, float(np.abs(data.qfrc_actuator[:6]).max())
        )
        for pair in data.contact.geom:
            first, second = sorted(self.model.geom(int(g)).name for g in pair)
            names = {first, second}
            sole = (names - {"floor"}).pop()
            if "floor" not in names or sole.rsplit("_", 1)[1] not in ("inner", "outer"):
                watch.strangers.add((first, second))


@contextmanager
def watched_steps(watch: Watch) -> Iterator[None]:
    """Sees the forces that anybody applies at every single step, through MuJoCo's own callback."""

    def look(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        watch.steps += 1
        watch.applied = max(watch.applied, float(np.abs(data.qfrc_applied).max()))
        watch.pulled = max(watch.pulled, float(np.abs(data.xfrc_applied).max()))

    mujoco.set_mjcb_control(look)
    try:
        yield
    finally:
        mujoco.set_mjcb_control(None)


@dataclass(frozen=True)
class Danced:
    motion: Motion
    recording: Recording
    measures: Measures
    watch: Watch


@cache
def danced(score: str, preset: str) -> Danced:
    """A port de bras danced by PD under gravity, with an onlooker."""
    reference = motion(score, preset)
    body = WatchedBody.at_start_of(reference)
    assert isinstance(body, WatchedBody)
    body.watch = Watch()
    with watched_steps(body.watch):
        recording = perform(reference, PD(reference), body)
    return Danced(reference, recording, measure(recording), body.watch)


def sites(model: mujoco.MjModel, qpos: NDArray[np.float64], *names: str) -> NDArray[np.float64]:
    """Places of sites in the torso's frame along a trajectory, (T, len(names), 3), m."""
    data = mujoco.MjData(model)
    out = np.empty((len(qpos), len(names), 3))
    for i, pose in enumerate(qpos):
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        rotation = data.body("torso").xmat.reshape(3, 3)
        for j, name in enumerate(names):
            out[i, j] = rotation.T @ (data.site(name).xpos - data.body("torso").xpos)
    return out
