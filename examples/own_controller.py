"""A controller of your own: the shipped PD with softer arms, then stiffer ones.

A controller is any class with `reset` and `command`. It never sees the body, only its state, so the
same one drives a simulated dancer today and servos when there are any.
"""

from dataclasses import replace

import numpy as np

import enpointe
from enpointe.controllers import PD, Command, State, perform
from enpointe.motion import Motion
from enpointe.sim.body import SimulatedBody
from enpointe.sim.measures import measure


class Arms:
    """PD whose arms are some times as stiff; damping follows by the root."""

    def __init__(self, motion: Motion, times: float) -> None:
        names = [motion.model.actuator(i).name for i in range(motion.model.nu)]
        arm = [any(part in n for part in ("shoulder", "elbow", "forearm")) for n in names]
        self._times = np.where(arm, times, 1.0)
        self._pd = PD(motion)

    def reset(self, state: State) -> None:
        self._pd.reset(state)

    def command(self, t: float, state: State) -> Command:
        asked = self._pd.command(t, state)
        stiffness, damping = asked.stiffness * self._times, asked.damping * self._times**0.5
        return replace(asked, stiffness=stiffness, damping=damping)


motion = enpointe.perform("first-port-de-bras", effort="angry", controller="kinematic").motion
for times in (0.1, 1.0, 3.0):
    recording = perform(motion, Arms(motion, times), SimulatedBody.at_start_of(motion))
    figures = measure(recording)
    print(f"arms {times:g} times as stiff: {figures.tracking_rms_deg:.3f} degrees behind")
