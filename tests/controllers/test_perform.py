"""The one loop drives any body, writes down all that happened, and stops at a fault."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from enpointe.controllers import Body, Command, Controller, Recording, State, perform
from enpointe.errors import FormatError, MotionError
from enpointe.motion import Event, Motion

from ..motion.dancing import solver, tiny_model

Array = NDArray[np.float64]


class Echo:
    """A body without physics: it is at once where it is told to be."""

    def __init__(self, period: float = 0.01, fault_at: int | None = None) -> None:
        self.period = period
        self.fault: str | None = None
        self.written: list[Command] = []
        self._fault_at = fault_at
        self._position = 0.0

    def read(self) -> State:
        qpos = np.array([0, 0, 1, 1, 0, 0, 0, self._position])
        time = len(self.written) * self.period
        ones = np.ones(1)
        return State(time, qpos, np.zeros(7), 2 * ones, 0.001 * ones, ones.astype(bool))

    def write(self, command: Command) -> None:
        self.written.append(command)
        self._position = float(command.position[0])
        if len(self.written) == self._fault_at:
            self.fault = "a servo's alarm"

    def observe(self) -> dict[str, NDArray[np.generic]]:
        return {"count": np.array(len(self.written)), "pair": np.array([self._position, 1.0])}


class Ramp:
    """A controller that asks for the time itself."""

    def __init__(self) -> None:
        self.began: list[float] = []
        self.asked: list[tuple[float, float]] = []

    def reset(self, state: State) -> None:
        self.began.append(state.time)

    def command(self, t: float, state: State) -> Command:
        self.asked.append((t, state.time))
        return Command(np.array([t]), *np.zeros((4, 1)))


def reference(seconds: float = 1.0) -> Motion:
    time = np.arange(round(seconds * 100) + 1) / 100
    qpos = np.tile([0, 0, 1, 1, 0, 0, 0, 0.0], (len(time), 1))
    qpos[:, 7] = time
    events = [Event(0.0, "key pose", "a", 0.0), Event(seconds, "key pose", "b", 1.0)]
    return Motion.from_qpos(tiny_model(), time, qpos, events=events, name="ramp")


def recorded(fault_at: int | None = None) -> Recording:
    return perform(reference(), Ramp(), Echo(fault_at=fault_at))


def test_bodies_and_controllers_are_known_by_what_they_do() -> None:
    assert isinstance(Echo(), Body)
    assert isinstance(Ramp(), Controller)
    assert not isinstance(Ramp(), Body)
    assert not isinstance(object(), Controller)


@pytest.mark.parametrize("period", [0.01, 0.004, 0.05])
def test_a_command_for_each_period(period: float) -> None:
    """The last one at the motion's end, so that a recording lasts as long as what was asked."""
    body, controller = Echo(period), Ramp()
    recording = perform(reference(), controller, body)
    assert len(body.written) == len(recording.time) == round(1.0 / period) + 1
    assert recording.time[-1] == pytest.approx(recording.reference.duration)
    assert controller.began == [0.0]
    np.testing.assert_allclose(controller.asked, np.stack([recording.time] * 2, axis=1), atol=1e-9)
    assert recording.period == pytest.approx(period)
    assert recording.fault is None


def test_a_sample_is_the_state_before_its_command() -> None:
    recording = recorded()
    np.testing.assert_allclose(recording.position[:, 0], recording.time, atol=1e-12)
    np.testing.assert_allclose(recording.qpos[1:, 7], recording.position[:-1, 0], atol=1e-12)
    assert recording.qpos[0, 7] == 0.0


def test_everything_is_written_down() -> None:
    recording, n = recorded(), 101
    assert recording.qpos.shape == (n, 8)
    assert recording.qvel.shape == (n, 7)
    for name in ("effort", "position", "torque", "age", "valid"):
        assert getattr(recording, name).shape == (n, 1)
    assert recording.effort.min() == 2.0
    assert recording.age.max() == 0.001
    assert recording.valid.all()
    np.testing.assert_array_equal(recording.channels["count"], np.arange(1, n + 1))
    assert recording.channels["pair"].shape == (n, 2)
    assert recording.wall_time > 0
    assert recording.realtime_factor > 0


@pytest.mark.parametrize("at", [2, 37, 101])
def test_it_stops_at_a_fault_and_keeps_what_was(at: int) -> None:
    body = Echo(fault_at=at)
    recording = perform(reference(), Ramp(), body)
    assert len(recording.time) == len(body.written) == at
    assert recording.fault == "a servo's alarm"
    assert recording.channels["count"][-1] == at


def test_progress_is_told_from_the_start_to_the_end() -> None:
    told: list[tuple[float, float]] = []
    perform(reference(5.0), Ramp(), Echo(), progress=lambda *a: told.append(a))
    assert told[0] == (0.0, 5.0)
    assert told[-1] == (5.0, 5.0)
    assert [t for t, _ in told] == sorted(t for t, _ in told)
    assert len(told) > 3


def test_a_recording_is_a_motion_too() -> None:
    danced = recorded().as_motion()
    assert danced.name == "ramp, performed"
    assert [e.name for e in danced.events] == ["a", "b"]
    assert danced.duration == pytest.approx(reference().duration)
    np.testing.assert_allclose(danced.qpos[1:, 7], danced.time[:-1], atol=1e-12)
    np.testing.assert_allclose(danced.qacc, 0, atol=1e-12)


def test_a_fault_at_once_is_a_recording_but_no_motion() -> None:
    recording = recorded(fault_at=1)
    assert len(recording.time) == 1
    assert recording.fault == "a servo's alarm"
    with pytest.raises(MotionError, match="ended at once: a servo's alarm"):
        recording.as_motion()


FIELDS = ("time", "qpos", "qvel", "effort", "position", "torque", "age", "valid")


def test_nothing_is_lost_on_disk(tmp_path: Path) -> None:
    for recording in (recorded(), recorded(fault_at=40)):
        recording.save(tmp_path / "r.npz")
        again = Recording.load(tmp_path / "r.npz", tiny_model())
        for name in FIELDS:
            array = getattr(recording, name)
            np.testing.assert_array_equal(getattr(again, name), array)
            assert getattr(again, name).dtype == array.dtype
        assert set(again.channels) == set(recording.channels)
        for name, array in recording.channels.items():
            np.testing.assert_array_equal(again.channels[name], array)
        assert (again.fault, again.wall_time) == (recording.fault, recording.wall_time)
        np.testing.assert_array_equal(again.reference.qpos, recording.reference.qpos)
        assert again.reference.events == recording.reference.events


def test_a_damaged_file_is_refused_or_the_same(tmp_path: Path) -> None:
    path, recording = tmp_path / "r.npz", recorded()
    recording.save(path)
    data, rng = path.read_bytes(), np.random.default_rng(5)
    refused = 0
    for i in range(120):
        hurt = bytearray(data)
        if i % 2:
            hurt = hurt[: int(rng.integers(len(data)))]
        else:
            hurt[int(rng.integers(len(data)))] ^= int(rng.integers(1, 256))
        path.write_bytes(bytes(hurt))
        try:
            again = Recording.load(path, tiny_model())
        except FormatError as error:
            refused += 1
            named = str(path) in str(error)
        else:
            named = all(np.array_equal(getattr(again, n), getattr(recording, n)) for n in FIELDS)
            # What a flipped letter renames is a channel, and never a silent change of numbers.
            known = [array.tobytes() for array in recording.channels.values()]
            assert all(array.tobytes() in known for array in again.channels.values())
        assert named
    assert refused > 80


@pytest.mark.parametrize("name", [*FIELDS, "fault", "wall_time", "reference_qpos"])
def test_a_missing_part_is_named(tmp_path: Path, name: str) -> None:
    path = tmp_path / "r.npz"
    recorded().save(path)
    with np.load(path) as stored:
        arrays = {n: stored[n] for n in stored.files if n != name}
    np.savez(path, **arrays)
    with pytest.raises(FormatError, match=name):
        Recording.load(path, tiny_model())


@pytest.mark.parametrize(
    ("name", "value"),
    [("qpos", np.zeros((3, 8))), ("effort", np.zeros((101, 9))), ("wall_time", np.array("soon"))],
)
def test_parts_that_do_not_fit_are_refused(tmp_path: Path, name: str, value: Array) -> None:
    path = tmp_path / "r.npz"
    recorded().save(path)
    with np.load(path) as stored:
        arrays = {n: stored[n] for n in stored.files} | {name: value}
    np.savez(path, **arrays)
    with pytest.raises(FormatError):
        Recording.load(path, tiny_model())


def test_another_body_and_another_format_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "r.npz"
    recorded().save(path)
    with pytest.raises(FormatError, match=r"a body with coordinates \(101, 8\), not 43"):
        Recording.load(path, solver().model)
    np.savez(path, format=np.array("enpointe motion 1"))
    with pytest.raises(FormatError, match="expected 'enpointe recording 1'"):
        Recording.load(path, tiny_model())


def test_a_saved_recording_replaces_the_last_one_whole(tmp_path: Path) -> None:
    path = tmp_path / "r.npz"
    recorded(fault_at=3).save(path)
    replace(recorded(), fault="fell").save(path)
    assert Recording.load(path, tiny_model()).fault == "fell"
    assert [p.name for p in tmp_path.iterdir()] == ["r.npz"]
