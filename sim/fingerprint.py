"""Which enpointe this is: a digest of the code on which a simulated dance depends."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

import mujoco
import numpy as np

from enpointe import controllers, models, motion, notation, sim

__all__ = ["code_digest"]


@cache
def code_digest() -> str:
    """Sixteen hexadecimal digits that differ where the code or its engines do."""
    digest = hashlib.sha256(f"mujoco {mujoco.__version__}, numpy {np.__version__}".encode())
    for room in (notation, models, motion, controllers, sim):
        for folder in room.__path__:
            for file in sorted(Path(folder).rglob("*.py")):
                digest.update(file.relative_to(folder).as_posix().encode())
                digest.update(file.read_bytes())
    return digest.hexdigest()[:16]
