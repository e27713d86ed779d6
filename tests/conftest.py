"""What every test shares: one BLAS thread a process, hypothesis profiles, the real data."""

from __future__ import annotations

import os

# Before numpy is imported anywhere: two workers with a thread pool each only slow one another.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

ROOT = Path(__file__).resolve().parents[1]

settings.register_profile("dev", deadline=None, print_blob=True)
settings.register_profile(
    "ci",
    deadline=None,
    derandomize=True,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci" if os.environ.get("CI") else "dev"))


@pytest.fixture(scope="session")
def root_dir() -> Path:
    """The project's root; skips where the tests run without the checkout around them."""
    if not (ROOT / "pyproject.toml").is_file():
        pytest.skip("not in a checkout")
    return ROOT


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Real motion, marker and music files, kept beside the checkout and never in it."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("no shared/data beside the checkout")
    return folder
