"""What happened, at the body's own rate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError, MotionError
from enpointe.files import atomic_path
from enpointe.motion import Motion
from enpointe.motion.npz import load_arrays, motion_arrays, motion_from_arrays

__all__ = ["Recording"]

Array = NDArray[np.float64]
_FORMAT = "enpointe recording 1"


@dataclass(frozen=True)
class Recording:
    """A performance, sample by sample.

    Attributes:
        model: The body that danced.
        reference: What it was asked to dance.
        time: (N,), s.
        qpos: (N, nq).
        qvel: (N, nv).
        effort: (N, nu), torques given, N m.
        position: (N, nu), joint targets commanded, rad.
        torque: (N, nu), feed-forward commanded, N m.
        age: (N, nu), s since each joint was read.
        valid: (N, nu).
        channels: What else the body observed of itself, each (N, ...).
        fault: Why the performance stopped early, or None.
        wall_time: s that it took.
    """

    model: mujoco.MjModel = field(repr=False)
    reference: Motion = field(repr=False)
    time: Array
    qpos: Array
    qvel: Array
    effort: Array
    position: Array
    torque: Array
    age: Array
    valid: NDArray[np.bool_]
    channels: Mapping[str, NDArray[np.generic]]
    fault: str | None
    wall_time: float

    @property
    def period(self) -> float:
        """s between samples."""
        return float(self.time[1] - self.time[0]) if len(self.time) > 1 else 0.0

    @property
    def realtime_factor(self) -> float:
        """Danced seconds over wall seconds."""
        return float(self.time[-1]) / self.wall_time if self.wall_time > 0 else float("inf")

    def as_motion(self) -> Motion:
        """The performance as a motion of its own, to replay, compare or convert.

        Raises:
            MotionError: It ended before there were two samples.
        """
        if len(self.time) < 2:
            why = self.fault or "nothing was danced"
            raise MotionError(f"the performance ended at once: {why}")
        acceleration = np.gradient(self.qvel, self.time, axis=0)
        return Motion(
            self.model,
            self.time - self.time[0],
            self.qpos,
            self.qvel,
            acceleration,
            tuple(e for e in self.reference.events if e.time <= self.time[-1]),
            f"{self.reference.name}, performed",
        )

    def save(self, path: Path) -> None:
        """Write everything but the model to a compressed NPZ file, beside and renamed."""
        arrays: dict[str, NDArray[np.generic]] = {name: getattr(self, name) for name in _SAMPLED}
        arrays |= {_CHANNEL + name: array for name, array in self.channels.items()}
        arrays |= motion_arrays(self.reference, _REFERENCE)
        arrays |= {
            "fault": np.array(self.fault or ""),
            "wall_time": np.array(self.wall_time),
            "format": np.array(_FORMAT),
        }
        with atomic_path(path) as beside:
            np.savez_compressed(beside, allow_pickle=False, **arrays)

    @classmethod
    def load(cls, path: Path, model: mujoco.MjModel) -> Recording:
        """Read what `save` wrote, for the model that danced it.

        Raises:
            FormatError: Not such a file, or of another body.
        """
        data = load_arrays(path, _FORMAT)
        reference = motion_from_arrays(data, model, path, _REFERENCE)
        missing = [n for n in (*_SAMPLED, "fault", "wall_time") if n not in data]
        if missing:
            raise FormatError(f"{', '.join(missing)} is missing; the file is damaged", path)
        channels = {
            name.removeprefix(_CHANNEL): array
            for name, array in data.items()
            if name.startswith(_CHANNEL)
        }
        samples = len(data["time"]) if data["time"].ndim else 0
        widths = {"qpos": model.nq, "qvel": model.nv, "time": None}
        for name in _SAMPLED:
            width = widths.get(name, model.nu)
            shape = (samples,) if width is None else (samples, width)
            if data[name].shape != shape:
                raise FormatError(f"{name} must have shape {shape}, not {data[name].shape}", path)
        for name, array in channels.items():
            if array.shape[:1] != (samples,):
                raise FormatError(f"channel {name} must have {samples} samples", path)
        try:
            sampled = {n: data[n].astype(bool if n == "valid" else float) for n in _SAMPLED}
            wall_time = float(data["wall_time"])
        except (ValueError, TypeError) as error:
            raise FormatError(f"values that are no numbers ({error})", path) from None
        return cls(
            model=model,
            reference=reference,
            channels=channels,
            fault=str(data["fault"]) or None,
            wall_time=wall_time,
            **sampled,
        )


_SAMPLED = ("time", "qpos", "qvel", "effort", "position", "torque", "age", "valid")
_CHANNEL = "channel_"
_REFERENCE = "reference_"
