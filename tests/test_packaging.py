"""The rooms are packed whole, and imports between them go one way."""

from __future__ import annotations

import ast
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

NOT_INSTALLED = {"tests", "benchmarks", "examples", "docs"}
BUILT = {"build", "dist", "out"}


@pytest.fixture(scope="module")
def pyproject(root_dir: Path) -> dict[str, Any]:
    return tomllib.loads((root_dir / "pyproject.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def layers(pyproject: dict[str, Any]) -> list[list[str]]:
    """The modules of each layer, the highest first, without the signs of import-linter."""
    contract = pyproject["tool"]["importlinter"]["contracts"][0]
    assert contract["type"] == "layers"
    assert contract["containers"] == ["enpointe"]
    return [[name.strip(" ()") for name in re.split("[:|]", line)] for line in contract["layers"]]


@pytest.fixture(scope="module")
def rooms(root_dir: Path) -> dict[str, Path]:
    """The top-level folders that hold Python, by the name they are imported as."""
    found = {}
    for folder in root_dir.iterdir():
        if folder.is_dir() and (folder / "__init__.py").is_file():
            if folder.name in NOT_INSTALLED | BUILT:
                continue
            name = "enpointe" if folder.name == "enpointe" else f"enpointe.{folder.name}"
            found[name] = folder
    return found


def packages_of(rooms: dict[str, Path]) -> dict[str, Path]:
    found = {}
    for name, room in rooms.items():
        for marker in room.rglob("__init__.py"):
            parts = marker.parent.relative_to(room).parts
            found[".".join([name, *parts])] = marker.parent
    return found


def test_every_room_is_mapped_to_its_folder(
    pyproject: dict[str, Any], rooms: dict[str, Path]
) -> None:
    mapped = pyproject["tool"]["setuptools"]["package-dir"]
    assert mapped == {name: folder.name for name, folder in rooms.items()}


def test_every_package_is_listed_and_every_listed_package_is_there(
    pyproject: dict[str, Any], rooms: dict[str, Path]
) -> None:
    assert set(pyproject["tool"]["setuptools"]["packages"]) == set(packages_of(rooms))


def test_every_folder_with_python_in_it_is_a_package(rooms: dict[str, Path]) -> None:
    homes = {file.parent for room in rooms.values() for file in room.rglob("*.py")}
    assert homes == set(packages_of(rooms).values())


def test_every_room_and_front_door_module_stands_in_a_layer(
    layers: list[list[str]], rooms: dict[str, Path]
) -> None:
    named = {name for layer in layers for name in layer}
    front = {
        entry.stem
        for entry in rooms["enpointe"].iterdir()
        if (entry.suffix == ".py" and entry.stem != "__init__") or (entry / "__init__.py").is_file()
    }
    assert {name.removeprefix("enpointe.") for name in rooms if name != "enpointe"} | front == named


def lint_imports(config: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """Runs import-linter on the package `enpointe` that can be imported from `folder`."""
    code = "from importlinter.cli import lint_imports_command; lint_imports_command()"
    return subprocess.run(
        [sys.executable, "-c", code, "--no-cache", "--config", str(config)],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
    )


def made_up_package(folder: Path, modules: Iterable[str], imports: dict[str, str]) -> None:
    """Writes a package `enpointe` of empty modules but for one import in some of them."""
    package = folder / "enpointe"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    for name in modules:
        line = f"import {imports[name]}\n" if name in imports else ""
        (package / name).mkdir()
        (package / name / "__init__.py").write_text(line)


def test_the_real_rooms_keep_the_contracts(root_dir: Path, tmp_path: Path) -> None:
    told = lint_imports(root_dir / "pyproject.toml", tmp_path)
    assert told.returncode == 0, told.stdout + told.stderr


def test_imports_downwards_are_kept(
    root_dir: Path, tmp_path: Path, layers: list[list[str]]
) -> None:
    modules = [name for layer in layers for name in layer]
    downwards = {upper[0]: f"enpointe.{lower[0]}" for upper, lower in pairwise(layers)}
    made_up_package(tmp_path, modules, downwards)
    told = lint_imports(root_dir / "pyproject.toml", tmp_path)
    assert told.returncode == 0, told.stdout + told.stderr


@pytest.mark.parametrize(
    ("module", "imported"),
    [
        ("notation", "enpointe.models"),
        ("models", "enpointe.motion"),
        ("motion", "enpointe.controllers"),
        ("controllers", "enpointe.sim"),
        ("sim", "enpointe.cli"),
        ("sim", "enpointe.hardware"),
        ("hardware", "enpointe.sim"),
        ("hardware", "mujoco"),
        ("errors", "enpointe.files"),
        ("notation", "mujoco"),
        ("notation", "casadi"),
    ],
)
def test_imports_upwards_and_engines_in_a_score_are_refused(
    root_dir: Path, tmp_path: Path, layers: list[list[str]], module: str, imported: str
) -> None:
    made_up_package(tmp_path, [name for layer in layers for name in layer], {module: imported})
    told = lint_imports(root_dir / "pyproject.toml", tmp_path)
    assert told.returncode == 1
    assert f"enpointe.{module} -> {imported}" in told.stdout
    assert "BROKEN" in told.stdout


def test_a_module_that_stands_in_no_layer_is_refused(
    root_dir: Path, tmp_path: Path, layers: list[list[str]]
) -> None:
    modules = [name for layer in layers for name in layer]
    made_up_package(tmp_path, [*modules, "newcomer"], {})
    told = lint_imports(root_dir / "pyproject.toml", tmp_path)
    assert told.returncode == 1
    assert "newcomer" in told.stdout


def imported_by(package: Path) -> set[str]:
    """The top-level names of everything that a package's files import."""
    names = set()
    for file in package.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"), str(file))):
            if isinstance(node, ast.Import):
                names |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                names.add(node.module.split(".")[0])
    return names - set(sys.stdlib_module_names) - {"enpointe"}


def test_everything_that_is_imported_is_declared(
    pyproject: dict[str, Any], rooms: dict[str, Path]
) -> None:
    project = pyproject["project"]
    declared = {
        re.split("[<>=]", requirement)[0]
        for requirement in [
            *project["dependencies"],
            *project["optional-dependencies"]["video"],
            *project["optional-dependencies"]["ros"],
        ]
    }
    imports = {
        "PIL": "pillow",
        "mcap_ros2": "mcap-ros2-support",
        "dynamixel_sdk": "dynamixel-sdk",
        "serial": "dynamixel-sdk",
    }
    imported = {name for room in rooms.values() for name in imported_by(room)}
    assert {imports.get(name, name) for name in imported} <= declared


@pytest.mark.parametrize("name", ["constraints.txt", "constraints-floors.txt"])
def test_every_dependency_is_pinned_and_no_address_is_in_the_pins(
    root_dir: Path, pyproject: dict[str, Any], name: str
) -> None:
    text = (root_dir / name).read_text(encoding="utf-8")
    assert "://" not in text
    assert "--index" not in text
    pins = dict(re.findall(r"^([\w.-]+)==([\w.+]+)", text, re.MULTILINE))
    wanted = dict(
        requirement.split(">=")
        for requirement in pyproject["project"]["dependencies"]
        + pyproject["project"]["optional-dependencies"]["video"]
    )
    assert wanted.keys() <= pins.keys()
    if name == "constraints-floors.txt":
        for requirement, floor in wanted.items():
            assert re.fullmatch(re.escape(floor) + r"(\.0)*", pins[requirement]), requirement
    else:
        without_hash = re.findall(r"^[\w.-]+==[^\\\n]*$", text, re.MULTILINE)
        assert without_hash == []


@pytest.mark.slow
def test_the_wheel_holds_the_rooms_their_data_and_nothing_else(
    root_dir: Path, tmp_path: Path, rooms: dict[str, Path]
) -> None:
    source = tmp_path / "source"
    source.mkdir()
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(root_dir / name, source)
    for room in rooms.values():
        shutil.copytree(room, source / room.name, ignore=shutil.ignore_patterns("__pycache__"))
    build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(tmp_path)]
    subprocess.run([*build, str(source)], check=True, capture_output=True, timeout=300)
    (wheel,) = tmp_path.glob("*.whl")
    packed = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    wanted = {
        (name.replace(".", "/") + "/" + file.relative_to(room).as_posix())
        for name, room in rooms.items()
        for file in room.rglob("*")
        if file.is_file() and "__pycache__" not in file.parts and file.suffix != ".md"
    }
    assert packed == wanted
    assert "enpointe/py.typed" in packed
