"""Captured movement on the dancer."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from enpointe.motion.formats import MarkerMotion, SkeletonMotion, Space, read
from enpointe.motion.retargeting import Retargeted, retarget
from enpointe.motion.retargeting.holding import runs

from .conftest import RATE, as_skeleton, step_sideways

TAKES = [f"05_{n}" for n in ("01", "02", "03", "04", "06", "08", "09")]
TAKES += [f"05_{n}" for n in ("11", "12", "14", "16", "18", "20")]
LIMBS = ("thigh", "shank", "upper_arm", "forearm")


def slip(made: Retargeted) -> float:
    """Farthest that the ball of a standing foot goes from where it came to stand, m."""
    names = [made.motion.model.geom(int(g)).name for g in made.contacts.soles]
    farthest = 0.0
    for side in ("left", "right"):
        ball = [i for i, name in enumerate(names) if name.startswith(f"{side}_ball")]
        stands = made.standing[side] & made.contacts.bears[:, ball].all(axis=1)
        places = made.contacts.points[:, ball, :2].mean(axis=1)
        for run in runs(stands):
            away = np.linalg.norm(places[run] - places[run][0], axis=1)
            farthest = max(farthest, float(away.max()))
    return farthest


def heights(made: Retargeted) -> tuple[float, float]:
    """The lowest sole at any time, and the highest of those that bear, m."""
    points = made.contacts.points[:, :, 2]
    return float(points.min()), float(points[made.contacts.bears].max())


def limbs_off(made: Retargeted, quantile: str) -> float:
    """The worst limb's residual, degrees."""
    return max(
        float(getattr(residual, quantile))
        for name, residual in made.residuals.items()
        if name.endswith(LIMBS)
    )


@pytest.mark.parametrize("scale", [1.0, 1.2])
def test_her_own_movement_comes_back(model: mujoco.MjModel, scale: float) -> None:
    motion = step_sideways(model)
    made = retarget(as_skeleton(motion, scale=scale), model)
    assert made.scale == pytest.approx(1 / scale, abs=1e-6)
    limbs = [
        model.joint(f"{side}_{name}").qposadr[0]
        for side in ("left", "right")
        for name in ("hip_raise", "hip_cross", "knee_bend", "shoulder_raise", "elbow_bend")
    ]
    off = np.abs(made.motion.qpos[:, limbs] - motion.qpos[:, limbs])
    assert np.degrees(np.median(off)) < 1.0
    assert limbs_off(made, "median") < 1.0
    # While a foot leaves, the floor holds it to 8 mm of height, as it does a badly captured one.
    assert limbs_off(made, "p95") < 4.0
    assert made.residuals["pelvis"].median < 0.5


def test_feet_neither_slide_nor_sink_nor_float(model: mujoco.MjModel) -> None:
    made = retarget(as_skeleton(step_sideways(model), scale=1.15), model)
    assert slip(made) < 1e-3
    low, high = heights(made)
    assert low > -1e-3
    assert high < 1e-3
    assert made.contacts.bears.any(axis=1).all()


def test_joints_keep_to_their_ranges(model: mujoco.MjModel) -> None:
    made = retarget(as_skeleton(step_sideways(model)), model)
    low, high = model.jnt_range[1:].T
    assert np.all(made.motion.qpos[:, 7:] >= low - 0.01)
    assert np.all(made.motion.qpos[:, 7:] <= high + 0.01)


@pytest.mark.parametrize("turned", [90.0, -135.0])
def test_whichever_way_she_faces(model: mujoco.MjModel, turned: float) -> None:
    motion = step_sideways(model)
    quat = np.array([np.cos(np.radians(turned) / 2), 0, 0, np.sin(np.radians(turned) / 2)])
    motion.qpos[:, 3:7] = quat
    made = retarget(as_skeleton(motion), model)
    aligned = np.abs(made.motion.qpos[:, 3:7] @ quat)
    assert np.degrees(2 * np.arccos(np.median(aligned))) < 0.5
    assert np.degrees(2 * np.arccos(aligned.min())) < 4.0


def test_the_floor_may_be_anywhere(model: mujoco.MjModel) -> None:
    captured = as_skeleton(step_sideways(model, 1.0))
    captured.values[:, 1] += 37.0  # cm
    assert heights(retarget(captured, model))[1] < 1e-3


def test_a_marker_set_comes_back(model: mujoco.MjModel) -> None:
    motion = step_sideways(model)
    sites = {"LANK": "left_ankle", "RANK": "right_ankle", "LKNE": "left_knee", "RKNE": "right_knee"}
    sites |= {"LTOE": "left_ball", "RTOE": "right_ball", "LHEE": "left_heel", "RHEE": "right_heel"}
    sites |= {"LELB": "left_elbow", "RELB": "right_elbow"}
    sites |= {"LWRA": "left_wrist", "RWRA": "right_wrist"}
    # Where markers are that no site marks: body, and place in its upright frame, m.
    skin = {
        "LASI": ("pelvis", (0.09, 0.115, 0.09)),
        "RASI": ("pelvis", (0.09, -0.115, 0.09)),
        "LPSI": ("pelvis", (-0.09, 0.04, 0.128)),
        "RPSI": ("pelvis", (-0.09, -0.04, 0.128)),
        "CLAV": ("torso", (0.08, 0, 0.33)),
        "C7": ("torso", (-0.08, 0, 0.33)),
        "STRN": ("torso", (0.08, 0, 0.15)),
        "T10": ("torso", (-0.08, 0, 0.15)),
        "LSHO": ("left_upper_arm", (0, 0, 0)),
        "RSHO": ("right_upper_arm", (0, 0, 0)),
    }
    data = mujoco.MjData(model)
    rows = []
    for qpos in motion.qpos:
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        own = [np.array(data.site(site).xpos) for site in sites.values()]
        turn = {
            name: np.array(data.body(body).xmat).reshape(3, 3) for name, (body, _) in skin.items()
        }
        own += [data.body(body).xpos + turn[name] @ place for name, (body, place) in skin.items()]
        rows.append(own)
    positions = 1000.0 * np.array(rows)
    positions[30:34, 0] = np.nan
    captured = MarkerMotion((*sites, *skin), RATE, positions, Space(1e-3, up="z"))
    made = retarget(captured, model)
    assert slip(made) < 1e-3
    # Markers on the outer side are led inwards by breadths that sites do not have.
    assert limbs_off(made, "median") < 6.0
    assert made.residuals["pelvis"].median < 3.0


@pytest.mark.slow
@pytest.mark.parametrize("take", TAKES)
def test_a_dancer_was_captured(take: str, model: mujoco.MjModel, data_dir: Path) -> None:
    path = data_dir / "cmu_05" / f"{take}.amc"
    if not path.exists():
        pytest.skip("no data here")
    captured = read(path).motion
    assert isinstance(captured, SkeletonMotion)
    coarse = replace(captured, values=captured.values[::3], rate=captured.rate / 3)
    made = retarget(coarse, model)
    assert slip(made) < 0.005
    low, high = heights(made)
    assert low > -0.005
    assert high < 0.005
    assert made.motion.time[1] == pytest.approx(3 / 120)
    medians = [r.median for name, r in made.residuals.items() if name.endswith(LIMBS)]
    assert np.mean(medians) < 4.0
