"""Everything that can go wrong on a bus, at random moments, while a small rig dances in memory.

Each run draws a fault (or two), when, on whom, for how long and how bad, from its own seed; the
controller asks for more than limits and speeds allow all the while. A witness on the emulated bus,
which knows nothing of the driver's judgement, checks

- that no Goal Position leaves a joint's limits, that no two goals are further apart than the
  joint's speed allows (and the register's one pulse), and that no Goal Current exceeds the file's;
- that 200 ms after the fault can no longer be danced away, every servo has let go, has been stopped
  by its own watchdog, or is without power;
- that the recording is whole up to there, and nothing but a line of text comes out.

    python benchmarks/faults.py --runs 500
    python benchmarks/faults.py --runs 1 --seed 137 --json
"""

from __future__ import annotations

import argparse
import json
import math
import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

import mujoco
import numpy as np
from _bus_witness import GRACE, LIMITS, Witness

from enpointe.controllers import Command, Recording, State, perform
from enpointe.errors import EnpointeError
from enpointe.hardware.dynamixel import Layout, Link, ServoRig, description_of
from enpointe.hardware.emulator import (
    EmulatedPort,
    Fault,
    FaultKind,
    FaultRun,
    VirtualClock,
    bus_of,
)
from enpointe.hardware.rig_file import Rig
from enpointe.motion import Motion

DANCE = 1.0
_MODELS = ("XM430-W350", "XC330-T288", "XM430-W210", "XL430-W250", "XM540-W270")


def small_rig(rng: np.random.Generator) -> Rig:
    """Three to five servos of several models and both modes."""
    rows = []
    for number in range(int(rng.integers(3, 6))):
        model = _MODELS[int(rng.integers(len(_MODELS)))]
        limited = model != "XL430-W250" and rng.random() < 0.5
        half = float(rng.uniform(20.0, 80.0))
        rows.append(
            {
                "id": 11 + 3 * number,
                "model": model,
                "joint": f"joint_{number}",
                "sign": int(rng.choice([-1, 1])),
                "offset": float(np.round(rng.uniform(-60.0, 60.0), 1)),
                "limits": (-half, half),
                "speed": float(rng.uniform(60.0, 170.0)),
                "current": 400.0 if limited else 0.0,
                "gains": (900, 0, 2000) if limited else None,
            }
        )
    fast = bool(rng.random() < 0.7)
    return Rig.model_validate(
        {"name": "small", "body": "puppet", "baud": 1_000_000, "rate": 100.0,
         "fast_read": fast, "servo": rows}
    )  # fmt: skip


def drawn_faults(rng: np.random.Generator, rig: Rig, kind: FaultKind) -> tuple[Fault, ...]:
    """One fault of a kind, and sometimes lost packets beside it."""
    at = float(rng.uniform(0.0, 1.9))
    forever = rng.random() < 0.5
    duration = math.inf if forever else float(np.exp(rng.uniform(np.log(0.02), np.log(0.6))))
    everybody = rng.random() < 0.4
    ids = () if everybody else (int(rng.choice(rig.ids)),)
    packets = kind in (FaultKind.DROP, FaultKind.CORRUPT, FaultKind.DELAY, FaultKind.STUFFING)
    share = float(rng.choice([0.01, 0.1, 0.5, 1.0])) if packets else 1.0
    instructions = kind in (FaultKind.DROP, FaultKind.CORRUPT) and bool(rng.random() < 0.3)
    amounts = {
        FaultKind.DELAY: float(rng.uniform(0.001, 0.05)),
        FaultKind.BROWN_OUT: float(rng.uniform(2.0, 11.0)),
        FaultKind.OVERHEAT: float(rng.uniform(60.0, 110.0)),
    }
    fault = Fault(kind, ids, (at, at), (duration, duration), share, amounts.get(kind), instructions)
    if rng.random() < 0.3:
        return fault, Fault(FaultKind.DROP, probability=0.01)
    return (fault,)


@cache
def body(joints: int) -> mujoco.MjModel:
    """Hinges and nothing else, for the recording's sake."""
    spec = mujoco.MjSpec()
    for number in range(joints):
        arm = spec.worldbody.add_body(name=f"arm_{number}")
        arm.add_joint(name=f"joint_{number}", type=mujoco.mjtJoint.mjJNT_HINGE)
        arm.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.01, 0, 0])
        motor = spec.add_actuator(name=f"joint_{number}", target=f"joint_{number}")
        motor.trntype = mujoco.mjtTrn.mjTRN_JOINT
    return spec.compile()


class Greedy:
    """Asks for swings beyond limits and speeds, and now and then for what is no number.

    Args:
        rng: Draws the swings.
        joints: How many.
        nonsense: When it asks for it, s; infinite for never.
    """

    def __init__(self, rng: np.random.Generator, joints: int, nonsense: float) -> None:
        self._size = rng.uniform(0.1, 2.5, joints)
        self._pace = rng.uniform(1.0, 12.0, joints)
        self._nonsense = nonsense

    def reset(self, state: State) -> None:
        pass

    def command(self, t: float, state: State) -> Command:
        position = self._size * np.sin(self._pace * t)
        if t >= self._nonsense:
            position[0] = math.nan
        none = np.zeros(len(position))
        return Command(position, none, none, none, none)


@dataclass(frozen=True)
class Outcome:
    """One run.

    Attributes:
        seed: Of all that was drawn.
        kind: Of the fault.
        ending: How the driver says that the servos were left; "refused" if it did not begin.
        reason: The line it gave.
        completed: Whether it danced to the end.
        lost: Whether the fault could no longer be danced away.
        wrong: What must not be, in words.
    """

    seed: int
    kind: str
    ending: str
    reason: str
    completed: bool
    lost: bool
    wrong: tuple[str, ...]


class _Looking(VirtualClock):
    """A virtual clock that lets the witness look whenever 2 ms have passed."""

    def __init__(self) -> None:
        super().__init__()
        self.witness: Witness | None = None

    def sleep_until(self, moment: float) -> None:
        while self.witness is not None and moment - self.now() > 0.002:
            self._step(self.now() + 0.002)
        self._step(moment)

    def _step(self, moment: float) -> None:
        super().sleep_until(moment)
        if self.witness is not None:
            self.witness.bus.run_until(self.now())
            self.witness.look(self.now())


def run(seed: int, kinds: Sequence[FaultKind] = tuple(FaultKind)) -> Outcome:
    """One seeded run."""
    rng = np.random.default_rng(seed)
    kind = kinds[seed % len(kinds)]
    rig = small_rig(rng)
    faults = FaultRun(drawn_faults(rng, rig, kind), rng)
    nonsense = float(rng.uniform(0.0, DANCE)) if rng.random() < 0.1 else math.inf
    controller = Greedy(rng, len(rig.servos), nonsense)
    clock = _Looking()
    bus = bus_of(description_of(rig), faults=faults)
    witness = clock.witness = Witness(rig, bus, faults)
    port = EmulatedPort(bus, clock)
    wrong: list[str] = []
    recording: Recording | None = None
    ending, reason, completed = "refused", "", False
    rig_body: ServoRig | None = None
    try:
        port.setBaudRate(rig.baud)
        layout = Layout.bare(rig)
        with ServoRig(rig, Link(port), layout, clock, limits=LIMITS) as rig_body:
            rig_body.start(np.zeros(len(rig.servos)))
            recording = perform(_reference(len(rig.servos)), controller, rig_body)
            rig_body.finish()
        ending, reason = rig_body.statistics.ending.value, recording.fault or ""
        completed = recording.fault is None
    except (EnpointeError, OSError) as error:
        reason = str(error)
        if "\n" in reason or not reason:
            wrong.append(f"a message that is no line: {reason!r}")
    except Exception:
        wrong.append(traceback.format_exc())
    if rig_body is not None and rig_body.statistics.ending.value == "running":
        wrong.append("left running")
    _outlive(clock, witness)
    wrong += witness.violations[:3]
    if witness.at_grace:
        wrong.append(
            f"driven {GRACE} s after the loss at {witness.lost_at:.3f}: {witness.at_grace}"
        )
    if left := witness.driven(clock.now()):
        wrong.append(f"driven at the end: {left}")
    if recording is not None:
        wrong += _holes(recording, rig)
    lost = witness.lost_at < math.inf
    return Outcome(seed, kind.value, ending, reason, completed, lost, tuple(wrong))


def _reference(joints: int) -> Motion:
    model = body(joints)
    return Motion.from_qpos(model, [0.0, DANCE], np.zeros((2, model.nq)), name="swings")


def _outlive(clock: _Looking, witness: Witness) -> None:
    """What happens when the host has gone."""
    clock.sleep_until(clock.now() + 2.0 * GRACE)


def _holes(recording: Recording, rig: Rig) -> list[str]:
    """What is missing in a recording."""
    found = []
    steps = np.diff(recording.time)
    if not len(recording.time):
        return ["an empty recording"]
    if np.any(steps <= 0.0) or np.any(steps > 0.2):
        found.append(f"gaps in the recording: {steps.min():.3f} to {steps.max():.3f} s")
    for name in ("qpos", "qvel", "effort", "position", "age"):
        values = getattr(recording, name)
        if name != "position" and not np.all(np.isfinite(values)):
            found.append(f"{name} has what is no number")
    if recording.age[recording.valid].max(initial=0.0) > 2.0 * rig.period:
        found.append("a valid sample that is old")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.npz"
        recording.save(path)
        again = Recording.load(path, recording.model)
        if not np.array_equal(again.qpos, recording.qpos) or again.fault != recording.fault:
            found.append("the file does not hold what was recorded")
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--seed", type=int, default=0, help="of the first run")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    begin = time.perf_counter()
    outcomes = []
    for seed in range(options.seed, options.seed + options.runs):
        outcomes.append(run(seed))
        if outcomes[-1].wrong:
            print(f"seed {seed}: {outcomes[-1]}", file=sys.stderr)
        if sys.stderr.isatty():
            print(f"\r{len(outcomes)} of {options.runs}", end="", file=sys.stderr)
    if options.json:
        print(json.dumps([asdict(outcome) for outcome in outcomes]))
    else:
        _print(outcomes, time.perf_counter() - begin)
    return int(any(outcome.wrong for outcome in outcomes))


def _print(outcomes: Sequence[Outcome], seconds: float) -> None:
    print("| fault | runs | danced to the end | unrecoverable | endings | wrong |")
    print("| --- | --- | --- | --- | --- | --- |")
    for kind in [*FaultKind, None]:
        chosen = [o for o in outcomes if kind is None or o.kind == kind.value]
        if not chosen:
            continue
        endings = Counter(outcome.ending for outcome in chosen)
        words = ", ".join(f"{count} {name}" for name, count in sorted(endings.items()))
        completed, lost = sum(o.completed for o in chosen), sum(o.lost for o in chosen)
        wrong = sum(bool(o.wrong) for o in chosen)
        name = "all" if kind is None else kind.value
        print(f"| {name} | {len(chosen)} | {completed} | {lost} | {words} | {wrong} |")
    print(f"\n{len(outcomes)} runs in {seconds:.0f} s")


if __name__ == "__main__":
    sys.exit(main())
