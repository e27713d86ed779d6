"""Reading contacts off a simulation: forces and places of the soles, and whatever else touched."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.controllers.plant import Plant

__all__ = ["ContactReader"]


class ContactReader:
    """Contact forces of the last step.

    MuJoCo's contact list and its forces belong together only right after `mj_step`; read then.

    Args:
        model: With a floor plane and sole spheres.

    Attributes:
        soles: Sole geoms, (S,).
        lies: Whether anything but a sole rested on the floor in the last step.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self.soles = Plant(model).sole_geoms
        self._radius = np.array(model.geom_size[self.soles, 0])
        self._row = {int(geom): i for i, geom in enumerate(self.soles)}
        self._floors = set(np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE).tolist())
        self._force = np.zeros((len(self.soles), 3))
        self._point = np.zeros((len(self.soles), 3))
        self._depth = np.zeros(len(self.soles))
        self._others = 0
        self._other_force = 0.0
        self.lies = False
        self._three_rows = _THREE if _forces_stand_alone(model) else None
        self._seen = b""
        self._sort([])

    def read(self, data: mujoco.MjData) -> None:
        """Take the contacts of `data`, right after a step."""
        self._force[:] = 0.0
        self._depth[:] = 0.0
        self._point[:] = data.geom_xpos.take(self.soles, axis=0)
        self._point[:, 2] -= self._radius
        self._others, self._other_force = 0, 0.0
        self.lies = False
        # The contacts' fields as whole arrays: one by one they cost more than the physics.
        contacts = data.contact
        given = self._given(data, contacts.efc_address)
        # The axes of a contact's frame are its rows; the first points from first to second geom.
        forces = (given[:, None] @ contacts.frame.reshape(-1, 3, 3))[:, 0]
        geoms = contacts.geom
        if geoms.tobytes() != self._seen:
            self._seen = geoms.tobytes()
            self._sort(geoms.tolist())
        for i in self._elsewhere:
            first, second = self._pairs[i]
            self._meet(first, second, given[i])
        if len(self._bearing):
            np.matmul(self._onto, forces, out=self._force)
            self._depth[self._rows] = np.maximum(-contacts.dist.take(self._bearing), 0.0)

    def _given(self, data: mujoco.MjData, rows: NDArray[np.int32]) -> NDArray[np.float64]:
        """Forces in the contacts' own frames, (C, 3); `rows` is where each one's begin."""
        if self._three_rows is not None and (rows >= 0).all():
            return np.asarray(data.efc_force.take(rows[:, None] + self._three_rows))
        wrenches = np.zeros((len(rows), 6))
        for i, wrench in enumerate(wrenches):
            mujoco.mj_contactForce(self._model, data, i, wrench)
        return wrenches[:, :3]

    def _sort(self, pairs: list[list[int]]) -> None:
        """Tell soles on the floor from the rest; from step to step the pairs hardly change."""
        rows = [self._sole_row(first, second) for first, second in pairs]
        bearing = [i for i, row in enumerate(rows) if row is not None]
        self._pairs = pairs
        self._elsewhere = [i for i, row in enumerate(rows) if row is None]
        self._bearing = np.array(bearing, dtype=np.int64)
        self._rows = np.array([row for row in rows if row is not None], dtype=np.int64)
        self._onto = np.zeros((len(self.soles), len(pairs)))
        signs = [1.0 if pairs[i][0] in self._floors else -1.0 for i in bearing]
        self._onto[self._rows, bearing] = signs

    def _meet(self, first: int, second: int, force: NDArray[np.float64]) -> None:
        """Note a contact that is no sole on the floor."""
        bears = bool(force[0] > 0.0)
        self._others += int(bears)
        self.lies = self.lies or (bears and (first in self._floors or second in self._floors))
        self._other_force = max(self._other_force, float(np.linalg.norm(force)))

    def observed(self) -> dict[str, NDArray[np.generic]]:
        """Channels of one sample.

        Returns:
            sole_force (S, 3) N on each sole; sole_point (S, 3) m, its lowest point; sole_depth (S,)
            m into the floor; other_contacts, how many contacts bore force that were no sole on the
            floor; other_force, the largest of them, N.
        """
        return {
            "sole_force": self._force.copy(),
            "sole_point": self._point.copy(),
            "sole_depth": self._depth.copy(),
            "other_contacts": np.array(self._others),
            "other_force": np.array(self._other_force),
        }

    def _sole_row(self, first: int, second: int) -> int | None:
        if first in self._floors:
            return self._row.get(second)
        if second in self._floors:
            return self._row.get(first)
        return None


_THREE = np.arange(3)


def _forces_stand_alone(model: mujoco.MjModel) -> bool:
    """Whether the solver's rows of a contact are its force: elliptic cones without torsion.

    With pyramids they are edges of the pyramid, which `mj_contactForce` adds up.
    """
    elliptic = model.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
    touching = (model.geom_contype | model.geom_conaffinity) != 0
    return bool(elliptic and model.npair == 0 and (model.geom_condim[touching] == 3).all())
