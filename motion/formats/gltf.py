"""Motions as glTF 2.0: the dancer with her shapes, animated, for Blender, browsers and engines.

A node a body with a rotation at every sample, and a translation where it moves in its parent. One
node above all turns our z up and x forward into glTF's y up and z forward (Khronos Group, glTF 2.0
Specification, §3.4). Numbers are 32-bit floats.
"""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import FormatError
from enpointe.files import write_bytes
from enpointe.motion.formats.bodies import relative
from enpointe.motion.formats.shapes import Surface, surfaces
from enpointe.motion.motion import Motion

__all__ = ["write_gltf"]

Array = NDArray[np.float64]
_FLOAT, _UNSIGNED = 5126, 5125
_VERTICES, _INDICES = 34962, 34963
_UPRIGHT = [-0.5, -0.5, -0.5, 0.5]
_MAGIC, _JSON, _BIN = 0x46546C67, 0x4E4F534A, 0x004E4942
_STILL = 1e-7


def write_gltf(motion: Motion, path: Path) -> tuple[str, ...]:
    """Write the animated body; binary where `path` ends in .glb, one JSON file where in .gltf.

    Returns:
        What glTF can't hold.

    Raises:
        FormatError: An ending that is neither.
    """
    binary = path.suffix.lower() == ".glb"
    if not binary and path.suffix.lower() != ".gltf":
        raise FormatError("a glTF file ends in .glb or .gltf", path)
    scene = _Scene(motion)
    write_bytes(path, scene.glb() if binary else scene.gltf())
    return ("velocities and accelerations", *(["events"] if motion.events else []))


class _Scene:
    """The JSON and the bytes of a glTF file as they grow."""

    def __init__(self, motion: Motion) -> None:
        self._data = bytearray()
        self._json: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "enpointe"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [],
            "materials": [],
            "meshes": [],
            "accessors": [],
            "bufferViews": [],
        }
        self._colours: dict[tuple[float, float, float, float], int] = {}
        self._add_bodies(motion.model)
        self._animate(motion)
        for name in ("materials", "meshes"):
            if not self._json[name]:
                del self._json[name]

    def glb(self) -> bytes:
        """The binary form: a header and two chunks."""
        self._json["buffers"] = [{"byteLength": len(self._data)}]
        text = json.dumps(self._json, separators=(",", ":")).encode()
        text = text.ljust(-(-len(text) // 4) * 4)
        data = bytes(self._data).ljust(-(-len(self._data) // 4) * 4, b"\0")
        whole = 12 + 8 + len(text) + 8 + len(data)
        return b"".join(
            [
                struct.pack("<III", _MAGIC, 2, whole),
                struct.pack("<II", len(text), _JSON),
                text,
                struct.pack("<II", len(data), _BIN),
                data,
            ]
        )

    def gltf(self) -> bytes:
        """The JSON form, its bytes within as base64."""
        uri = "data:application/octet-stream;base64," + base64.b64encode(self._data).decode()
        self._json["buffers"] = [{"byteLength": len(self._data), "uri": uri}]
        return json.dumps(self._json, indent=1).encode()

    def _add_bodies(self, model: mujoco.MjModel) -> None:
        """Nodes in the order of the bodies; the world is the node that stands upright."""
        nodes = self._json["nodes"]
        for body in range(model.nbody):
            node: dict[str, Any] = {"name": model.body(body).name or f"body {body}"}
            if body == 0:
                node["rotation"] = _UPRIGHT
            else:
                x, y, z = (float(value) for value in model.body_pos[body])
                node["translation"] = [x, y, z]
                node["rotation"] = np.roll(model.body_quat[body], -1).tolist()
                parent = nodes[int(model.body_parentid[body])]
                parent.setdefault("children", []).append(body)
            parts = surfaces(model, body)
            if parts:
                node["mesh"] = len(self._json["meshes"])
                self._json["meshes"].append(
                    {"name": node["name"], "primitives": [self._primitive(part) for part in parts]}
                )
            nodes.append(node)

    def _primitive(self, part: Surface) -> dict[str, Any]:
        points = part.points.astype("<f4")
        return {
            "attributes": {
                "POSITION": self._accessor(points, "VEC3", _VERTICES, bounds=True),
                "NORMAL": self._accessor(_unit(part.normals), "VEC3", _VERTICES),
            },
            "indices": self._accessor(part.triangles.astype("<u4").ravel(), "SCALAR", _INDICES),
            "material": self._material(part.colour),
        }

    def _material(self, colour: tuple[float, float, float, float]) -> int:
        if colour not in self._colours:
            self._colours[colour] = len(self._colours)
            linear = [_linear(value) for value in colour[:3]]
            material: dict[str, Any] = {
                "pbrMetallicRoughness": {
                    "baseColorFactor": [*linear, colour[3]],
                    "metallicFactor": 0.0,
                    "roughnessFactor": 0.8,
                }
            }
            if colour[3] < 1:
                material["alphaMode"] = "BLEND"
            self._json["materials"].append(material)
        return self._colours[colour]

    def _animate(self, motion: Motion) -> None:
        times = self._accessor(motion.time.astype("<f4"), "SCALAR", bounds=True)
        translations, rotations = relative(motion)
        samplers: list[dict[str, Any]] = []
        channels: list[dict[str, Any]] = []
        for body in range(1, motion.model.nbody):
            tracks = {"translation": translations[:, body], "rotation": rotations[:, body]}
            for target, track in tracks.items():
                if np.abs(track - track[0]).max() <= _STILL:
                    self._json["nodes"][body][target] = track[0].tolist()
                    continue
                values = track if target == "translation" else _unit(track)
                kind = "VEC3" if target == "translation" else "VEC4"
                output = self._accessor(values.astype("<f4"), kind)
                channels.append(
                    {"sampler": len(samplers), "target": {"node": body, "path": target}}
                )
                samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})
        if channels:
            animation = {"name": motion.name, "samplers": samplers, "channels": channels}
            self._json["animations"] = [animation]

    def _accessor(
        self, values: NDArray[Any], kind: str, target: int | None = None, *, bounds: bool = False
    ) -> int:
        view: dict[str, Any] = {
            "buffer": 0,
            "byteOffset": len(self._data),
            "byteLength": values.nbytes,
        }
        if target is not None:
            view["target"] = target
        self._data += np.ascontiguousarray(values).tobytes()
        self._json["bufferViews"].append(view)
        accessor: dict[str, Any] = {
            "bufferView": len(self._json["bufferViews"]) - 1,
            "componentType": _UNSIGNED if values.dtype.kind == "u" else _FLOAT,
            "count": len(values),
            "type": kind,
        }
        if bounds:
            flat = values.reshape(len(values), -1)
            accessor["min"] = flat.min(axis=0).astype(float).tolist()
            accessor["max"] = flat.max(axis=0).astype(float).tolist()
        self._json["accessors"].append(accessor)
        return len(self._json["accessors"]) - 1


def _unit(vectors: Array) -> NDArray[np.float32]:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: NDArray[np.float32] = (vectors / lengths).astype("<f4")
    return unit


def _linear(value: float) -> float:
    """A colour as screens have it to a linear one (IEC 61966-2-1)."""
    return value / 12.92 if value <= 0.04045 else float(((value + 0.055) / 1.055) ** 2.4)
