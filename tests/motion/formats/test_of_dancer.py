"""The dancer's motion as a skeleton's: each body stays where MuJoCo has it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from enpointe.errors import MotionError
from enpointe.motion.formats import SkeletonMotion, read, write
from enpointe.motion.formats.of_dancer import even_rate, skeleton_of_motion

from .movements import body_places, writhing


@pytest.mark.parametrize("suffix", [".bvh", ".htr", ".gtr", ".bva", ".amc"])
def test_bodies_stand_where_they_stood(tmp_path: Path, suffix: str) -> None:
    """Through a file of each kind, to a millionth of a millimetre."""
    motion = writhing()
    skeleton, lost = skeleton_of_motion(motion)
    assert "1 events" in " ".join(lost)
    write(skeleton, tmp_path / f"writhing{suffix}")
    found = read(tmp_path / f"writhing{suffix}").motion
    assert isinstance(found, SkeletonMotion)
    places = found.skeleton.space.points(found.world()[0])
    names = list(found.skeleton.names)
    for body, expected in enumerate(np.moveaxis(body_places(motion), 1, 0), start=1):
        name = motion.model.body(body).name
        # ASF calls what moves freely its root, and says nothing of the unit but in inches.
        column = names.index("root" if suffix == ".amc" and name == "pelvis" else name)
        assert np.allclose(places[:, column], expected, rtol=0, atol=1e-9), name


def test_every_joint_has_three_angles_that_go_on() -> None:
    """One order for all, no jump over half a turn, an end to each last bone."""
    skeleton, _ = skeleton_of_motion(writhing())
    joints = skeleton.skeleton.joints
    assert {joint.product for joint in joints} == {"ZXY"}
    assert sum(len(joint.channels) == 6 for joint in joints) == 1
    turning = [c.endswith("rotation") for joint in joints for c in joint.channels]
    steps = np.abs(np.diff(skeleton.values[:, turning], axis=0))
    assert steps.max() < 180
    assert np.ptp(skeleton.values[:, turning], axis=0).max() > 200
    parents = {joint.parent for joint in joints}
    for index, joint in enumerate(joints):
        assert len(joint.ends) == (index not in parents)
        assert all(0.05 < np.linalg.norm(end) < 0.4 for end in joint.ends)


def test_uneven_samples_need_a_rate() -> None:
    """Steps that differ are no rate; those that only rounding tells apart are."""
    motion = writhing(frames=5)
    assert even_rate(motion) == 100.0
    late = motion.time.copy()
    late[2] += 1e-3
    uneven = replace(motion, time=late)
    assert even_rate(uneven) is None
    with pytest.raises(MotionError, match="give a rate"):
        skeleton_of_motion(uneven)
