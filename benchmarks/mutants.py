"""Spoiled motion files, many of them: what each reader makes of a file that something happened to.

Small files of every format are written, a few accidents happen to each (bytes, words, lines and
counts changed, pieces cut, doubled, or taken from another file), and the file is read: whole, or
refused by one line that says where. Anything else is a failure: another exception, more than ten
seconds, more memory than four times the file and what a reader needs for any file. Failing files
are kept. The same seed makes the same files.

    python benchmarks/mutants.py --mutants 20000
    python benchmarks/mutants.py --mutants 1000000 --seed 7 --keep failing --json
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
import random
import resource
import signal
import struct
import time
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType

import numpy as np

from enpointe.errors import EnpointeError, FormatError
from enpointe.models import dancer_model
from enpointe.motion import Motion
from enpointe.motion.formats import (
    Analog,
    Joint,
    Label,
    MarkerMotion,
    Skeleton,
    SkeletonMotion,
    Space,
    formats,
    read,
)
from enpointe.motion.formats.mjcf import read_keyframes, write_keyframes
from enpointe.motion.formats.mnm import read_names
from enpointe.motion.npz import load_motion, save_motion

SECONDS, TIMES, ROOM = 10.0, 4, 32_000_000
"""A reader's limits: of time, of memory in sizes of the file, and bytes beside these, which any
file takes and an allocator keeps."""

DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
REAL = (
    "bvh_various/131_01.bvh",
    "cmu_05/05.asf",
    "trc/Gait.trc",
    "trc_opensim/exampleFormat.trc",
    "csm/ThomasFechten.csm",
    "c3d_org/sample02/DEC_INT.C3D",
    "c3d_org/sample02/sgi_real.c3d",
)
SHORT = 12_000

Reader = Callable[[Path], object]
SCRAPS = (
    *b"nan inf -inf 1e999 1e-999 -0 0x10 1_0 .5 5. + - . e 99999999999999999999 -1 65535".split(),
    *b"{ } ( ) [ ] [x] : = # ; < <<<<<<< ======= \" ' , \t \n \r \r\n".split(b" "),
    *b"HIERARCHY|MOTION|ROOT a|JOINT b|End Site|OFFSET 0 0 0|Frames:|begin|end|DROPOUT".split(b"|"),
    *("é".encode(), "\u0663".encode(), b"\xff", b"\x00", b"\x1a", b"\xc2\xa0", b"", b" ", b"1,5"),
    b"[" * 60,
    b"1 " * 60,
)
COUNTS = (0, 1, 2, 3, 7, 8, 9, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)


@dataclass
class Tally:
    """What became of the mutants of one reader."""

    read: int = 0
    refused: int = 0
    failed: int = 0
    slowest: float = 0.0
    reasons: Counter[str] = field(default_factory=Counter)


class TooLongError(BaseException):
    """Beside `Exception`, so that no reader takes it for an error of the file."""


def movements() -> tuple[SkeletonMotion, SkeletonMotion, MarkerMotion, MarkerMotion]:
    """A chain, body animation parameters, plain markers, and markers with all that there is."""
    dice = np.random.default_rng(3)
    six = tuple(f"{a}position" for a in "XYZ") + tuple(f"{a}rotation" for a in "ZXY")
    end = ((0.0, 9.0, 1.0),)
    joints = (
        Joint("hips", -1, channels=six),
        Joint("chest", 0, (0.0, 12.0, 0.0), six[3:]),
        Joint("head", 1, (0.0, 20.0, 1.0), six[3:], ends=end),
        Joint("knee", 0, (5.0, -9.0, 0.0), ("Xrotation",), ends=end),
    )
    chain = SkeletonMotion(Skeleton(joints, Space(0.01)), 30.0, dice.normal(0, 40, (4, 13)))
    bap = (
        Joint("HumanoidRoot", -1, channels=("Xposition", "Yrotation")),
        Joint("l_hip", 0, channels=("Xrotation", "Zrotation")),
    )
    parameters = SkeletonMotion(Skeleton(bap, Space(0.001, "y", 1.0)), 25.0, np.ones((3, 4)))
    points = dice.normal(0, 300, (5, 3, 3)).astype(np.float32).astype(float)
    plain = MarkerMotion(("C7", "LHEE", "head top"), 100.0, points, Space(0.001, "z"))
    points = points.copy()
    points[1, 1] = points[3, :2] = np.nan
    seen = np.isfinite(points).all(axis=2)
    rich = MarkerMotion(
        plain.names,
        100.0,
        points,
        plain.space,
        start=11,
        residuals=np.where(seen, np.float32(0.5), np.float32(np.nan)),
        cameras=np.where(seen, 5, 0).astype(np.uint8),
        analog=Analog(("Fz",), ("N",), 200.0, np.ones((10, 1), np.float32)),
        labels=(Label(0.02, "Foot Strike", "anna", "Left"),),
        notes={"SUBJECTS:NAMES": '["anna"]'},
    )
    return chain, parameters, plain, rich


def originals(folder: Path) -> dict[str, tuple[str, Reader, list[bytes]]]:
    """By reader: the ending of its files, itself, and whole files of it."""
    model = dancer_model()
    found: dict[str, tuple[str, Reader, list[bytes]]] = {}
    for each in formats():
        raws = []
        path = folder / f"small{each.suffixes[0]}"
        for movement in movements():
            if each.write is not None:
                try:
                    each.write(movement, path)
                except EnpointeError:
                    continue
                raws.append(path.read_bytes())
        found[each.name] = each.suffixes[0], each.read, raws
    # The skeleton that the movements of AMC files are read with has been written beside them.
    suffix, reader, raws = found["ASF"]
    found["ASF"] = suffix, reader, [*raws, (folder / "small.asf").read_bytes()]
    for name in REAL:
        path = DATA / name
        for suffix, _, raws in found.values():
            if path.is_file() and path.suffix.lower() == suffix:
                raws.append(path.read_bytes()[:SHORT])
    names = b"hips\tPelvis\nchest = Spine\nhead top\tHEAD\n"
    found["MNM"] = ".mnm", read_names, [names]
    still = Motion.from_qpos(model, np.arange(3) / 30, np.tile(model.qpos0, (3, 1)))
    write_keyframes(still, folder / "small.xml")
    save_motion(still, folder / "small.npz")
    for name, suffix, own in (
        ("keyframes", ".xml", read_keyframes),
        ("NPZ", ".npz", load_motion),
    ):
        raw = (folder / f"small{suffix}").read_bytes()
        found[name] = suffix, partial(own, model=model), [raw]
    return found


def mutant(raws: list[bytes], dice: random.Random) -> bytes:
    """One to four accidents to one of these files."""
    raw = dice.choice(raws)
    for _ in range(dice.choice((1, 1, 2, 3, 4))):
        raw = dice.choice(ACCIDENTS)(raw, raws, dice)
    return raw


def _byte(raw: bytes, raws: list[bytes], dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] + bytes([dice.randrange(256)]) + raw[at + 1 :]


def _count(raw: bytes, raws: list[bytes], dice: random.Random) -> bytes:
    form, size = dice.choice(((">I", 4), ("<I", 4), ("<H", 2), (">H", 2)))
    at = dice.randint(0, min(len(raw), dice.choice((24, 600, 1 << 20))))
    count = dice.choice(COUNTS) & (0xFFFFFFFF if size == 4 else 0xFFFF)
    return raw[:at] + struct.pack(form, count) + raw[at + size :]


def _splice(raw: bytes, raws: list[bytes], dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] + dice.choice(SCRAPS) + raw[at + dice.choice((0, 0, 1, 2, 8, 60)) :]


def _cut(raw: bytes, raws: list[bytes], dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] if dice.random() < 0.5 else raw[:at] + raw[at + dice.choice((1, 4, 80, 512)) :]


def _double(raw: bytes, raws: list[bytes], dice: random.Random) -> bytes:
    at = dice.randint(0, len(raw))
    return raw[:at] + raw[at : at + dice.choice((1, 4, 100, 512))] + raw[at:]


def _cross(raw: bytes, raws: list[bytes], dice: random.Random) -> bytes:
    other = dice.choice(raws)
    at = dice.randint(0, min(len(raw), len(other)))
    return raw[:at] + other[at:]


def _lines(raw: bytes, raws: list[bytes], dice: random.Random) -> bytes:
    lines = raw.split(b"\n")
    one, other = dice.randrange(len(lines)), dice.randrange(len(lines))
    match dice.randrange(4):
        case 0:
            del lines[min(one, other) : max(one, other)]
        case 1:
            lines.insert(other, lines[one])
        case 2:
            lines[one], lines[other] = lines[other], lines[one]
        case _:
            lines[one] = b"\t".join(lines[one].split()[: dice.randint(0, 9)])
    return b"\n".join(lines)


def _word(raw: bytes, raws: list[bytes], dice: random.Random) -> bytes:
    """A word of some line, of the first ones most, is a scrap, another word or ten times itself."""
    lines = raw.split(b"\n")
    place = dice.randrange(min(len(lines), dice.choice((6, 30, 1 << 20))))
    words = lines[place].split()
    if not words:
        return raw
    which = dice.randrange(len(words))
    others = lines[dice.randrange(len(lines))].split() or [b""]
    words[which] = dice.choice((dice.choice(SCRAPS), words[which] + b"0", dice.choice(others)))
    lines[place] = dice.choice((b" ", b"\t")).join(words)
    return b"\n".join(lines)


ACCIDENTS = (_byte, _byte, _count, _splice, _splice, _cut, _double, _cross, _lines, _word, _word)


def judged(reader: Reader, path: Path, size: int) -> tuple[str, str]:
    """ "read", "refused" or "failed", and in what way a failure."""
    # A damaged archive has no line or byte to point at; its reader names the part.
    placed = path.suffix == ".npz"
    before = _peak()
    signal.setitimer(signal.ITIMER_REAL, SECONDS)
    try:
        reader(path)
        outcome = "read", ""
    except FormatError as error:
        outcome = "refused", ""
        if "\n" in str(error) or not (placed or error.line or error.byte is not None):
            outcome = "failed", f"no place or no line: {error}"
    except TooLongError:
        outcome = "failed", f"longer than {SECONDS} s"
    except BaseException as error:
        outcome = "failed", f"{type(error).__name__}: {error}"
        if isinstance(error, KeyboardInterrupt):
            raise
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
    if _peak() - before > TIMES * size + ROOM:
        return "failed", f"{(_peak() - before) / 1e6:.0f} MB for {size} bytes"
    return outcome


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _ring(signum: int, frame: FrameType | None) -> None:
    raise TooLongError


def run(count: int, seed: int, names: list[str], keep: Path | None) -> dict[str, Tally]:
    """As many mutants of each reader as of any other, `count` in all."""
    signal.signal(signal.SIGALRM, _ring)
    warnings.simplefilter("error")
    tallies: dict[str, Tally] = {}
    with TemporaryDirectory(dir="/dev/shm" if Path("/dev/shm").is_dir() else None) as name:
        folder = Path(name)
        found = originals(folder)
        chosen = {key: found[key] for key in names or found}
        for key, (suffix, reader, raws) in chosen.items():
            tally = tallies[key] = Tally()
            dice = random.Random(f"{seed} {key}")
            path = folder / f"small{suffix}"
            whole = path.read_bytes() if path.is_file() else None
            for number in range(count // len(chosen)):
                raw = mutant(raws, dice)
                path.write_bytes(raw)
                # One in eight goes the way of a user, who does not say which format it is.
                sniffed = number % 8 == 0 and key not in ("MNM", "keyframes", "NPZ")
                started = time.perf_counter()
                outcome, reason = judged(read if sniffed else reader, path, len(raw))
                tally.slowest = max(tally.slowest, time.perf_counter() - started)
                setattr(tally, outcome, getattr(tally, outcome) + 1)
                if reason:
                    tally.reasons[reason[:100]] += 1
                    if keep is not None:
                        keep.mkdir(parents=True, exist_ok=True)
                        kept = f"{key.replace(' ', '-')}-{seed}-{number}{suffix}"
                        (keep / kept).write_bytes(raw)
            if whole is not None:
                path.write_bytes(whole)
    return tallies


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mutants", type=int, default=20_000, help="of all readers together")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", action="append", default=[], metavar="READER")
    parser.add_argument("--keep", type=Path, help="folder for files that fail")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    tallies = run(options.mutants, options.seed, options.only, options.keep)
    if options.json:
        print(json.dumps({name: vars(tally) for name, tally in tallies.items()}))
        return
    print("| reader | read | refused | failed | slowest, ms |\n| --- | --- | --- | --- | --- |")
    for name, tally in tallies.items():
        print(
            f"| {name} | {tally.read} | {tally.refused} | {tally.failed}"
            f" | {1000 * tally.slowest:.0f} |"
        )
    for name, tally in tallies.items():
        for reason, times in tally.reasons.most_common(5):
            print(f"{name}: {times} x {reason}")


if __name__ == "__main__":
    main()
