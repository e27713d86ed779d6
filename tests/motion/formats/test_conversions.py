"""Any skeleton in any format: each joint stands where it stood."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.errors import EnpointeError, FormatError, MotionError
from enpointe.motion.formats import (
    Joint,
    MarkerMotion,
    Skeleton,
    SkeletonMotion,
    Space,
    formats,
    read,
    write,
)
from enpointe.motion.formats.convert import angles_of, depth_first, flat, plain, upright

from .skeletons import made

ORDERS = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"]
SEEDS = st.integers(0, 2**32)


def places(motion: SkeletonMotion) -> dict[str, NDArray[np.float64]]:
    """Each joint's path in metres, z up."""
    world = motion.skeleton.space.points(motion.world()[0])
    return {name: world[:, index] for index, name in enumerate(motion.skeleton.names)}


def agree(one: SkeletonMotion, other: SkeletonMotion, scale: float = 1.0) -> None:
    """All joints at the same places, but for a unit that was guessed."""
    theirs = places(other)
    for name, path in places(one).items():
        assert np.allclose(theirs[name] * scale, path, rtol=0, atol=1e-9), name


@given(SEEDS)
def test_plain_joints_stand_where_they_stood(seed: int) -> None:
    """Whatever axes, rests, orders: in places, in bones' ends, at rest; and plain again is same."""
    motion = made(seed)
    other, _ = plain(motion)
    agree(motion, other)
    assert all(joint.plain for joint in other.skeleton.joints)
    again, lost = plain(other)
    assert again.skeleton == other.skeleton
    assert np.array_equal(again.values, other.values)
    assert lost == ()


@given(SEEDS)
def test_rest_stays_rest(seed: int) -> None:
    """With all values 0 a plain skeleton is the other's rest pose, in directions of y up."""
    motion = made(seed)
    still = SkeletonMotion(motion.skeleton, 30.0, np.zeros((1, motion.skeleton.width)))
    other, _ = plain(still)
    turning = [c.endswith("rotation") for joint in other.skeleton.joints for c in joint.channels]
    assert np.allclose(other.values[:, turning], 0, atol=1e-12)
    agree(still, other)


@given(SEEDS, st.sampled_from(ORDERS))
def test_flat_joints_stand_where_they_stood(seed: int, order: str) -> None:
    """With no hierarchy, and upright: places and rotations."""
    motion = made(seed)
    other = flat(motion, order)
    agree(motion, other)
    turns = Rotation.from_quat(motion.world()[1].reshape(-1, 4), scalar_first=True)
    others = Rotation.from_quat(other.world()[1].reshape(-1, 4), scalar_first=True)
    assert (turns * others.inv()).magnitude().max() < 1e-12
    standing, _ = upright(other)
    assert standing.skeleton.space.up == "y"
    agree(motion, standing)


@given(SEEDS)
def test_depth_first_is_the_same_movement(seed: int) -> None:
    """Only the order changes: each joint follows its parent or a descendant of it."""
    motion = made(seed)
    other = depth_first(motion)
    agree(motion, other)
    chain: list[int] = []
    for index, joint in enumerate(other.skeleton.joints):
        while chain and chain[-1] != joint.parent:
            chain.pop()
        assert (chain[-1] if chain else -1) == joint.parent
        chain.append(index)


@pytest.mark.parametrize("order", ORDERS)
def test_angles_hold_at_the_pole(order: str) -> None:
    """Middle angles up to a quarter turn and exactly there: the same rotation to rounding."""
    middles = np.pi / 2 - np.concatenate([[0.0], np.logspace(-15, 0, 60)])
    middles = np.concatenate([middles, -middles])
    sides = np.random.default_rng(0).uniform(-np.pi, np.pi, (2, len(middles)))
    turns = Rotation.from_euler(order, np.column_stack([sides[0], middles, sides[1]]))
    again = Rotation.from_euler(order, angles_of(turns, order))
    assert (again * turns.inv()).magnitude().max() < 1e-14


@pytest.mark.parametrize("suffix", [".bvh", ".htr", ".gtr", ".bva"])
@settings(max_examples=60)
@given(seed=SEEDS)
def test_through_a_file_each_joint_stands_where_it_stood(
    tmp_path_factory: pytest.TempPathFactory, suffix: str, seed: int
) -> None:
    """And what was read is written to the same numbers again."""
    path = tmp_path_factory.getbasetemp() / f"through{suffix}"
    motion = made(seed)
    write(motion, path)
    other = read(path).motion
    assert isinstance(other, SkeletonMotion)
    guessed = motion.skeleton.space.metres_per_unit / other.skeleton.space.metres_per_unit
    agree(motion, other, guessed if suffix == ".bvh" else 1.0)
    # A time of a frame, in any digits, is not the inverse of every rate: not of 59.94.
    assert other.rate == pytest.approx(motion.rate, rel=3e-16)
    assert other.start == (0 if suffix in (".bvh", ".bva") else motion.start)
    assert write(other, path) == () or suffix == ".bvh"
    again = read(path).motion
    assert isinstance(again, SkeletonMotion)
    assert np.array_equal(again.values, other.values)
    assert (again.skeleton, again.notes) == (other.skeleton, other.notes)


def test_what_falls_is_told(tmp_path: Path) -> None:
    """Limits, a frame's number, a note, a unit."""
    joint = Joint("a", -1, channels=("Xrotation",), limits=((-1.0, 1.0),))
    skeleton = Skeleton((joint, Joint("b", 0, (0.0, 7.0, 0.0))), Space(0.3))
    motion = SkeletonMotion(skeleton, 30.0, np.ones((2, 1)), start=5, notes={"dancer": "A"})
    lost = "\n".join(write(motion, tmp_path / "a.bvh"))
    for word in ("limits", "first frame, 5", "dancer", "unit of length"):
        assert word in lost


def test_orders_and_channels_that_fit() -> None:
    """A joint can't be turned about an axis for which it has no channel."""
    with pytest.raises(MotionError, match="can't turn"):
        Skeleton((Joint("a", -1, channels=("Xrotation",), order="ZX"),))
    with pytest.raises(MotionError, match="two joints"):
        Skeleton((Joint("a", -1), Joint("a", 0)))


def test_a_format_is_told_by_content(tmp_path: Path) -> None:
    """Files of each format under another's name are read as what they are."""
    for each in formats():
        if each.name not in ("BVH", "ASK", "BVA", "HTR", "GTR"):
            continue
        path = tmp_path / f"a{each.suffixes[0]}"
        write(made(4), path)
        named = read(path)
        other = path.with_suffix(".txt")
        path.rename(other)
        found = read(other)
        assert isinstance(found.motion, SkeletonMotion)
        assert isinstance(named.motion, SkeletonMotion)
        assert np.array_equal(found.motion.values, named.motion.values), each.name


@pytest.mark.parametrize("name", ["missing.bvh", "", "a\0b"])
def test_what_is_no_file_is_refused(tmp_path: Path, name: str) -> None:
    """One line, no other exception."""
    with pytest.raises(FormatError):
        read(tmp_path / name)


def test_a_format_that_does_not_fit_is_refused(tmp_path: Path) -> None:
    """Markers in a BVH file; an ending that none has."""
    markers = MarkerMotion(("a",), 30.0, np.zeros((2, 1, 3)))
    with pytest.raises(EnpointeError, match="BVH holds skeleton"):
        write(markers, tmp_path / "a.bvh")
    with pytest.raises(EnpointeError, match=r"ends in '\.xyz'"):
        write(made(1), tmp_path / "a.xyz")
