"""What is found feasible, danced on the emulated bus: motors that never want more than there is."""

from __future__ import annotations

import numpy as np
import pytest

from enpointe.hardware import datasheet
from enpointe.hardware.demand import Demand
from enpointe.hardware.emulator import Load
from enpointe.hardware.feasibility import assess
from enpointe.hardware.limits import JointLimit
from enpointe.hardware.units import CENTRE, PULSE

from .rigs import Rig

XM430 = datasheet("XM430-W350")
WEIGHT, INERTIA = 1.2, XM430.armature + 0.03
LIMIT = JointLimit("hip", XM430, -3.0, 3.0)
EACH = 0.01


def kick(seconds: float) -> Demand:
    """A weight on a rod lifted to 100 degrees and let down, beginning and ending at rest."""
    time = np.linspace(0.0, seconds, 301)
    w = 2.0 * np.pi / seconds
    high = np.radians(100.0) / 2.0
    angle, speed = high * (1.0 - np.cos(w * time)), high * w * np.sin(w * time)
    rise = high * w**2 * np.cos(w * time)
    arrays = (angle, speed, rise, WEIGHT * np.sin(angle), INERTIA * rise)
    return Demand(("hip",), time, *(array[:, None] for array in arrays))


def danced(demand: Demand) -> tuple[float, float]:
    """Share of the time at which the motor has all the supply, and the greatest error, rad."""
    rig = Rig(
        settings={"Drive Mode": 4},
        loads=[Load(INERTIA, XM430.friction, WEIGHT, hanging=0.0)],
    )
    rig.set("Torque Enable", 1)
    rig.set("Profile Velocity", round(1e3 * EACH))
    motor, full, ticks, worst = rig.servos[0].motor, 0, 0, 0.0
    start = rig.clock.now()
    while (t := rig.clock.now() - start) < float(demand.time[-1]):
        wanted = float(np.interp(t, demand.time, demand.position[:, 0]))
        rig.set("Goal Position", round(CENTRE + wanted / PULSE))
        while rig.clock.now() - start < t + EACH:
            rig.wait(1e-3)
            ticks += 1
            full += abs(motor.duty) > 0.999
        worst = max(worst, abs(wanted - float(rig.bus.plant.position()[0])))
    return full / ticks, worst


@pytest.mark.parametrize("seconds", [0.7, 1.0])
def test_motors_are_spent_as_written_and_not_in_the_time_that_is_enough(seconds: float) -> None:
    written = kick(seconds)
    found = assess(written, [LIMIT])
    assert found.time_scale is not None
    assert found.time_scale > 1.05
    spent, error = danced(written)
    assert spent > 0.02
    enough, less = danced(written.scaled(found.time_scale))
    assert enough == 0.0
    assert less < error
