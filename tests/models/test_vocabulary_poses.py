"""Every position of the vocabulary, danced by the perfect and the real dancer, on both sides."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from enpointe.notation import names

from .checking import check_certified, check_in_mujoco, too_deep
from .posing import (
    DANCERS,
    STYLES,
    mirrored_qpos,
    same_pose,
    score_called,
    solved,
    solver_of,
    targets_of,
)

NAMES = names()


@pytest.mark.parametrize("other_side", [False, True], ids=["right", "left"])
@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("name", NAMES)
def test_every_position_is_certified_and_keeps_its_limbs_apart(
    name: str, style: str, other_side: bool, model: mujoco.MjModel
) -> None:
    found = solved(name, style=STYLES[style], other_side=other_side)
    assert found.held, str(found.certificate)
    assert found.certificate.legal
    check_in_mujoco(model, found)
    assert too_deep(model, found.qpos) == {}


@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("name", NAMES)
def test_the_other_side_is_the_mirror_image(name: str, style: str, model: mujoco.MjModel) -> None:
    found, image = (
        solved(name, style=STYLES[style], other_side=other_side) for other_side in (False, True)
    )
    assert same_pose(image.qpos, mirrored_qpos(model, found.qpos), atol=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("dancer", [dancer for dancer in DANCERS if dancer != "default"])
@pytest.mark.parametrize("name", NAMES)
def test_other_dancers_take_every_position(name: str, dancer: str) -> None:
    """A name gives way to the body that it is danced by; a sign that somebody wrote does not."""
    found = solved(name, dancer=dancer)
    check_certified(found, score_called(name).resolved()[0], dancer)
    check_in_mujoco(solver_of(dancer).model, found)


@pytest.mark.parametrize("name", NAMES)
def test_a_real_dancer_stays_near_the_perfect_one(name: str) -> None:
    """She lends her pelvis to a leg but holds head, body and arms where the score has them."""
    perfect, real = (solved(name, style=style) for style in STYLES.values())
    model = solver_of("default").model
    for joint in range(1, model.njnt):
        part = model.joint(joint).name
        if part.startswith("neck"):
            here = model.jnt_qposadr[joint]
            assert np.degrees(abs(perfect.qpos[here] - real.qpos[here])) < 1
    certificates = [{r.rule: r for r in pose.certificate.results} for pose in (perfect, real)]
    for certificate in certificates:
        held = certificate.get("body as written") or certificate["body lent to the leg"]
        assert held.value <= (20 if name.endswith(" 120") else 6)
    assert targets_of(name)[0].real is False
    assert targets_of(name, style=STYLES["real"])[0].real is True
