"""The dancer that the model tests share; compiled once."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from enpointe.models import Figure, KeyPoseSolver, dancer_model


@pytest.fixture(scope="session")
def model() -> mujoco.MjModel:
    return dancer_model()


@pytest.fixture(scope="session")
def solver(model: mujoco.MjModel) -> KeyPoseSolver:
    return KeyPoseSolver(model)


@pytest.fixture(scope="session")
def figure(solver: KeyPoseSolver) -> Figure:
    return solver.figure


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20051122)
