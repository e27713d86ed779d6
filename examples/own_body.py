"""A body of your own: one that gets each command 10 ms late.

A body is any class with `read`, `write`, `observe`, a `period` and a `fault`. This one wraps the
simulated dancer; one of servos would write to a bus instead.
"""

from collections import deque

import enpointe
from enpointe.controllers import PD, Command, perform
from enpointe.motion import Motion
from enpointe.sim.body import SimulatedBody
from enpointe.sim.measures import measure


class LateBody(SimulatedBody):
    """Obeys the command that it was given some periods ago; at first, the first one."""

    _late = 0
    _given: deque[Command]

    @classmethod
    def by(cls, periods: int, motion: Motion) -> "LateBody":
        body = cls.at_start_of(motion)
        body._late, body._given = periods, deque()
        return body

    def write(self, command: Command) -> None:
        self._given.append(command)
        super().write(self._given.popleft() if len(self._given) > self._late else self._given[0])


motion = enpointe.perform("first-port-de-bras", effort="angry", controller="kinematic").motion
for periods in (0, 5, 25):
    recording = perform(motion, PD(motion), LateBody.by(periods, motion))
    figures = measure(recording)
    late = 1000 * periods * recording.period
    print(f"{late:.0f} ms late: {figures.tracking_rms_deg:.3f} degrees behind, {recording.fault}")
