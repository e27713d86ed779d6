"""Another rate: what stood on a frame stays, what is between two is between them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial.transform import Rotation

from enpointe.errors import MotionError
from enpointe.motion import Motion
from enpointe.motion.formats import Joint, MarkerMotion, Skeleton, SkeletonMotion
from enpointe.motion.formats.resampling import resampled
from enpointe.motion.formats.winding import nearest_angles, unwound

from .making import marker_motion
from .movements import writhing
from .skeletons import made

ANGLES = hnp.arrays(float, (6, 3), elements=st.floats(-7, 7))
ORDERS = st.sampled_from(["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"])


def turns(angles: np.ndarray, order: str) -> Rotation:
    return Rotation.from_euler(order, angles)


@given(ANGLES, ANGLES, ORDERS)
def test_nearest_angles_turn_alike(angles: np.ndarray, others: np.ndarray, order: str) -> None:
    """The same rotations, no farther away than those that were given."""
    found = nearest_angles(angles, others)
    assert (turns(found, order) * turns(angles, order).inv()).magnitude().max() < 1e-12
    far, before = (np.abs(each - others).sum(axis=1) for each in (found, angles))
    assert (far <= before + 1e-12).all()


def test_unwound_angles_do_not_jump() -> None:
    """Two turns about one axis while another passes its pole come out as they went in."""
    straight = np.linspace([0, -1, 0], [4 * np.pi, 1, 1], 200)
    folded = np.remainder(straight + np.pi, 2 * np.pi) - np.pi
    assert np.allclose(unwound(folded), straight, rtol=0, atol=1e-12)


@given(st.integers(0, 2**32), st.sampled_from([2, 3, 5]))
def test_frames_between_leave_the_others_as_they_are(seed: int, times: int) -> None:
    """So many times as many frames, and back: the same numbers, to the bit."""
    motion = made(seed)
    more = resampled(motion, motion.rate * times)
    assert isinstance(more, SkeletonMotion)
    assert more.frames == times * (motion.frames - 1) + 1
    assert np.array_equal(more.values[::times], motion.values)
    again = resampled(more, motion.rate)
    assert isinstance(again, SkeletonMotion)
    assert np.array_equal(again.values, motion.values)


@given(st.integers(0, 2**32))
def test_rotations_go_half_way(seed: int) -> None:
    """In the middle between two frames a joint of three axes has half of its turn behind it."""
    rng = np.random.default_rng(seed)
    joint = Joint("a", -1, channels=("Yrotation", "Zrotation", "Xrotation"), order="ZXY")
    angles = rng.uniform(-180, 180, (2, 3))
    motion = resampled(SkeletonMotion(Skeleton((joint,)), 30.0, angles), 60.0)
    assert isinstance(motion, SkeletonMotion)
    first, middle, last = Rotation.from_quat(motion.world()[1][:, 0], scalar_first=True)
    assert (first.inv() * middle).magnitude() == pytest.approx(
        (first.inv() * last).magnitude() / 2, abs=1e-9
    )
    assert (first.inv() * middle * (middle.inv() * last).inv()).magnitude() < 1e-9


def test_one_angle_goes_the_short_way() -> None:
    """From 170 to -170 degrees over 180."""
    hinge = SkeletonMotion(
        Skeleton((Joint("a", -1, channels=("Xrotation",)),)), 1.0, np.array([[170.0], [-170.0]])
    )
    found = resampled(hinge, 2.0)
    assert isinstance(found, SkeletonMotion)
    assert found.values[:, 0] == pytest.approx([170, 180, -170])


def test_a_marker_is_missing_between_where_it_is_missing() -> None:
    """Its own frames keep what they have; residuals go with it, cameras with the nearest frame."""
    motion = marker_motion(gaps=True, rich=True)
    quaternions = np.tile([1.0, 0, 0, 0], (*motion.seen.shape, 1))
    quaternions[~motion.seen] = np.nan
    more = resampled(replace(motion, orientations=quaternions), 2 * motion.rate)
    assert isinstance(more, MarkerMotion)
    assert np.array_equal(more.positions[::2], motion.positions, equal_nan=True)
    both = motion.seen[:-1] & motion.seen[1:]
    assert np.array_equal(more.seen[1::2], both)
    assert more.orientations is not None
    assert np.array_equal(np.isfinite(more.orientations).all(axis=2), more.seen)
    middle = (motion.positions[:-1] + motion.positions[1:]) / 2
    assert np.allclose(more.positions[1::2], middle, equal_nan=True)


def test_the_dancers_motion() -> None:
    """As many samples as fit, those of the same moments the same."""
    motion = writhing(frames=12)
    found = resampled(motion, 50.0)
    assert isinstance(found, Motion)
    assert np.allclose(found.qpos, motion.qpos[::2], rtol=0, atol=1e-12)
    assert found.events == motion.events


@pytest.mark.parametrize("rate", [0.0, -1.0, np.nan, np.inf, 1e12])
def test_no_rate(rate: float) -> None:
    for motion in (made(1), marker_motion(), writhing(frames=3)):
        with pytest.raises(MotionError):
            resampled(motion, rate)
