"""From servos at rest to servos that hold where they stand, and back; each step read back.

What a servo was told counts when it says so itself: sync writes are never answered, and other
projects' emergency stops have reported success and done nothing (strands-labs/robots#1706).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from enpointe.errors import RigError
from enpointe.hardware.clock import Clock
from enpointe.hardware.control_table import Register
from enpointe.hardware.dynamixel.link import Link, PortLostError
from enpointe.hardware.rig_file import Rig, RigServo
from enpointe.hardware.units import FULL_PWM, WATCHDOG

__all__ = ["cut_torque", "hold", "prepare", "set_verified", "watch_bus"]

_TRIES = 3
_PAUSE = 0.005


def set_verified(link: Link, register: Register, values: Sequence[tuple[int, int]]) -> None:
    """Set a register of several servos and read it back.

    Raises:
        RigError: A servo does not say that it has the value, after three tries.
        PortLostError: The port is gone.
    """
    missing = list(values)
    for _ in range(_TRIES):
        link.sync_write(register, missing)
        missing = _unconfirmed(link, register, missing)
        if not missing:
            return
    servos = ", ".join(str(servo) for servo, _ in missing)
    raise RigError(
        f"{register.name} can't be set on servo {servos}; look at the cable, and reboot what has an"
        " alarm"
    )


def _unconfirmed(
    link: Link, register: Register, values: Sequence[tuple[int, int]]
) -> list[tuple[int, int]]:
    found = link.sync_read([servo for servo, _ in values], register.address, register.size)
    said = {servo: register.decode(data) for servo, (_, data) in found.items()}
    return [(servo, value) for servo, value in values if said.get(servo) != value]


def prepare(link: Link, rig: Rig, registers: Mapping[str, Register], period: float) -> None:
    """Set all that a servo forgets without power: gains, limits of drive, profile.

    Raises:
        RigError: A servo did not take it.
    """
    # A watchdog that has tripped locks the goals until it is switched off.
    set_verified(link, registers["Bus Watchdog"], [(servo.id, 0) for servo in rig.servos])
    rows = [(servo, _ram(servo, period)) for servo in rig.servos]
    for name in dict.fromkeys(name for _, values in rows for name in values):
        values = [(servo.id, row[name]) for servo, row in rows if name in row]
        set_verified(link, registers[name], values)


def _ram(servo: RigServo, period: float) -> dict[str, int]:
    initial = servo.sheet.initial
    usual = tuple(initial.get(f"Position {letter} Gain", 0) for letter in "PID")
    p, i, d = servo.gains if servo.gains is not None else usual
    values = {
        "Position P Gain": p,
        "Position I Gain": i,
        "Position D Gain": d,
        "Feedforward 2nd Gain": 0,
        "Feedforward 1st Gain": 0,
        "Profile Acceleration": 0,
        "Profile Velocity": max(round(period * 1e3), 1),
        "Goal PWM": int(initial.get("PWM Limit", FULL_PWM)),
    }
    if servo.current:
        values["Goal Current"] = servo.current_counts
    return values


def hold(link: Link, registers: Mapping[str, Register], goals: Sequence[tuple[int, int]]) -> None:
    """Torque on, each servo where it stands.

    Args:
        link: The bus.
        registers: `common` of the rig.
        goals: Pairs of ID and Goal Position.

    Raises:
        RigError: A servo did not take it.
    """
    # Firmware may forget goals when torque comes on, or may follow one from before: say it twice.
    link.sync_write(registers["Goal Position"], goals)
    set_verified(link, registers["Torque Enable"], [(servo, 1) for servo, _ in goals])
    set_verified(link, registers["Goal Position"], goals)


def watch_bus(
    link: Link, registers: Mapping[str, Register], ids: Sequence[int], seconds: float
) -> None:
    """Have the servos stop by themselves when they hear nothing for so long.

    Raises:
        RigError: A servo did not take it.
    """
    counts = min(max(round(seconds / WATCHDOG), 1), 127)
    set_verified(link, registers["Bus Watchdog"], [(servo, counts) for servo in ids])


def cut_torque(
    link: Link,
    registers: Mapping[str, Register],
    ids: Sequence[int],
    clock: Clock,
    within: float,
) -> tuple[int, ...]:
    """Have all servos let go, again and again until each has said that it has.

    Args:
        link: The bus.
        registers: `common` of the rig.
        ids: Those most likely to answer first.
        clock: For the time that it may take.
        within: s after which to give up.

    Returns:
        IDs of those that have not confirmed it.
    """
    torque = registers["Torque Enable"]
    end = clock.now() + within
    left = [(servo, 0) for servo in ids]
    while left:
        try:
            link.sync_write(torque, [(servo, 0) for servo in ids])
            left = _unconfirmed(link, torque, left)
        except PortLostError:
            break
        if not left or clock.now() >= end:
            break
        # Who is silent silences those after him: the next round begins with another.
        left = [*left[1:], left[0]]
        clock.sleep_until(clock.now() + _PAUSE)
    return tuple(servo for servo, _ in left)
