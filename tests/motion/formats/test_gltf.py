"""Motions as glTF: nodes stand where MuJoCo's bodies do, and every accessor lies in its bytes."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from enpointe.errors import FormatError
from enpointe.models import dancer_model
from enpointe.motion import Motion
from enpointe.motion.formats.gltf import write_gltf

TO_GLTF = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
SIZES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
TYPES = {5126: "<f4", 5125: "<u4"}
SHAPES = """<mujoco><worldbody><geom type="plane" size="1 1 1"/>
  <body name="all" pos="0 0 1"><freejoint/>
    <geom type="capsule" size=".1 .3" rgba="1 0 0 1"/><geom type="box" size=".1 .2 .3" pos="1 0 0"/>
    <geom type="sphere" size=".2" pos="2 0 0"/><geom type="ellipsoid" size=".1 .2 .3" pos="3 0 0"/>
    <geom type="cylinder" size=".1 .3" pos="4 0 0" euler="90 0 0" rgba="0 1 0 .5"/>
    <geom name="hidden" size="9" group="3"/></body></worldbody></mujoco>"""


@pytest.fixture(scope="module")
def dance() -> Motion:
    model = dancer_model()
    rng = np.random.default_rng(2)
    qpos = np.tile(model.qpos0, (40, 1))
    qpos[:, 7:] += np.cumsum(rng.normal(0, 0.05, (40, model.nq - 7)), axis=0)
    qpos[:, :3] += np.cumsum(rng.normal(0, 0.02, (40, 3)), axis=0)
    turn = np.linspace(0, 4 * np.pi, 40)
    qpos[:, 3], qpos[:, 6] = np.cos(turn / 2), np.sin(turn / 2)
    return Motion.from_qpos(model, np.arange(40) / 30, qpos, name="dance")


def opened(path: Path) -> tuple[dict[str, Any], bytes]:
    raw = path.read_bytes()
    if path.suffix == ".gltf":
        scene = json.loads(raw)
        return scene, base64.b64decode(scene["buffers"][0]["uri"].split(",")[1])
    magic, version, whole, length = struct.unpack_from("<4sIII", raw)
    assert (magic, version, whole) == (b"glTF", 2, len(raw))
    return json.loads(raw[20 : 20 + length]), raw[28 + length :]


def values(scene: dict[str, Any], data: bytes, index: int) -> Any:
    """An accessor's numbers, once its place is known to lie in the bytes."""
    accessor = scene["accessors"][index]
    view = scene["bufferViews"][accessor["bufferView"]]
    size = SIZES[accessor["type"]]
    assert view["byteOffset"] % 4 == 0
    assert accessor["count"] * size * 4 == view["byteLength"]
    assert view["byteOffset"] + view["byteLength"] <= scene["buffers"][0]["byteLength"] <= len(data)
    kind = TYPES[accessor["componentType"]]
    found = np.frombuffer(data, kind, accessor["count"] * size, view["byteOffset"])
    table = found.reshape(accessor["count"], size)
    for bound, measured in (("min", table.min(axis=0)), ("max", table.max(axis=0))):
        if bound in accessor:
            np.testing.assert_array_equal(np.float32(accessor[bound]), measured)
    return table


@pytest.mark.parametrize("ending", [".glb", ".gltf"])
def test_nodes_stand_where_the_bodies_do(dance: Motion, tmp_path: Path, ending: str) -> None:
    """Within 1e-5 m at ten frames, y up and z forward."""
    path = tmp_path / f"dance{ending}"
    write_gltf(dance, path)
    scene, data = opened(path)
    (animation,) = scene["animations"]
    tracks: dict[tuple[int, str], Any] = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        np.testing.assert_allclose(
            values(scene, data, sampler["input"])[:, 0], dance.time, atol=1e-6
        )
        target = channel["target"]["node"], channel["target"]["path"]
        tracks[target] = values(scene, data, sampler["output"])
    bodies = mujoco.MjData(dance.model)
    for frame in np.linspace(0, len(dance.time) - 1, 10).astype(int):
        bodies.qpos[:] = dance.qpos[frame]
        mujoco.mj_kinematics(dance.model, bodies)
        places = stood(scene, tracks, frame)
        for body in range(dance.model.nbody):
            assert scene["nodes"][body]["name"] == dance.model.body(body).name
            np.testing.assert_allclose(places[body], TO_GLTF @ bodies.xpos[body], atol=1e-5)


def stood(scene: dict[str, Any], tracks: dict[tuple[int, str], Any], frame: int) -> dict[int, Any]:
    """Every node's place in the world at a frame."""
    nodes = scene["nodes"]
    frames = {0: (np.zeros(3), Rotation.from_quat(nodes[0]["rotation"]))}
    for index, node in enumerate(nodes):
        place, turn = frames[index]
        for child in node.get("children", []):
            at, way = (
                tracks[child, path][frame] if (child, path) in tracks else nodes[child][path]
                for path in ("translation", "rotation")
            )
            frames[child] = place + turn.apply(at), turn * Rotation.from_quat(way)
    return {index: place for index, (place, _) in frames.items()}


def test_quaternions_take_the_short_way(dance: Motion, tmp_path: Path) -> None:
    """Two whole turns on the spot: neighbours stay on one side of the sphere."""
    write_gltf(dance, tmp_path / "dance.glb")
    scene, data = opened(tmp_path / "dance.glb")
    animation = scene["animations"][0]
    for channel in animation["channels"]:
        if channel["target"]["path"] == "rotation":
            turn = values(scene, data, animation["samplers"][channel["sampler"]]["output"])
            assert ((turn[1:] * turn[:-1]).sum(axis=1) > 0).all()
            np.testing.assert_allclose(np.linalg.norm(turn, axis=1), 1.0, atol=1e-6)


def test_every_shape_is_closed_and_faces_outwards(tmp_path: Path) -> None:
    """The volume that the triangles enclose is the shapes' own, within the facets' cut corners."""
    model = mujoco.MjModel.from_xml_string(SHAPES)
    motion = Motion.from_qpos(model, [0.0, 1.0], np.tile(model.qpos0, (2, 1)))
    write_gltf(motion, tmp_path / "shapes.glb")
    scene, data = opened(tmp_path / "shapes.glb")
    ball = 4 / 3 * np.pi
    whole = {
        (1.0, 0.0): np.pi * 0.01 * 0.6 + ball * 0.001,
        (0.0, 1.0): np.pi * 0.01 * 0.6,
        (0.5, 0.5): 8 * 0.006 + ball * 0.008 + ball * 0.006,
    }
    primitives = [p for mesh in scene["meshes"] for p in mesh["primitives"]]
    assert len(primitives) == 3
    for primitive in primitives:
        points = values(scene, data, primitive["attributes"]["POSITION"]).astype(float)
        normals = values(scene, data, primitive["attributes"]["NORMAL"]).astype(float)
        corners = values(scene, data, primitive["indices"]).reshape(-1, 3)
        a, b, c = (points[corners[:, i]] for i in range(3))
        volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
        colour = scene["materials"][primitive["material"]]["pbrMetallicRoughness"]
        red, green = (round(v, 2) for v in colour["baseColorFactor"][:2])
        expected = whole[(0.5, 0.5) if 0 < red < 1 else (red, green)]
        assert 0.94 * expected < volume <= expected * (1 + 1e-6)
        outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), normals[corners[:, 0]])
        assert (outward > -1e-9).all()


def test_trimesh_reads_the_dancer(dance: Motion, tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    write_gltf(dance, tmp_path / "dance.glb")
    scene = trimesh.load(tmp_path / "dance.glb")
    low, high = scene.bounds
    assert 1.5 < high[1] - low[1] < 1.9
    assert {dance.model.body(i).name for i in range(1, dance.model.nbody)} <= set(scene.graph.nodes)


def test_another_ending_is_refused(dance: Motion, tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="glb"):
        write_gltf(dance, tmp_path / "dance.fbx")
