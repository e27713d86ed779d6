"""A table of every motion file in a folder: its format, how many are read, what is refused and why.

python docs/read_all.py ../shared/data
python docs/read_all.py ../shared/data --write    # into docs/formats.md
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from pathlib import Path

from enpointe.errors import FormatError
from enpointe.motion.formats import MarkerMotion, SkeletonMotion, formats, read
from enpointe.motion.formats.content import Content
from enpointe.motion.formats.registry import sniffed

PAGE = Path(__file__).parent / "formats.md"
BEGIN, END = "<!-- read_all.py -->", "<!-- end of read_all.py -->"
ENDINGS = {suffix for each in formats() for suffix in each.suffixes}


def table(folder: Path) -> list[str]:
    """A row a format and kind of file, then what was refused."""
    found: dict[str, list[Content]] = defaultdict(list)
    refused = []
    files = [path for path in sorted(folder.rglob("*")) if path.suffix.lower() in ENDINGS]
    for path in files:
        try:
            found[sniffed(path).name].append(read(path))
        except FormatError as error:
            place = f"line {error.line}" if error.byte is None else f"byte {error.byte}"
            refused.append(f"- `{path.relative_to(folder)}`, {place}: {error.message}")
    lines = [
        f"{len(files)} files: {len(files) - len(refused)} read, {len(refused)} refused.\n",
        "| format | files read | with warnings | frames | joints or markers |",
        "| --- | --- | --- | --- | --- |",
    ]
    for name, contents in sorted(found.items()):
        sizes = [_size(each) for each in contents]
        frames, parts = (_range([size[i] for size in sizes]) for i in (0, 1))
        warned = sum(bool(each.warnings) for each in contents)
        lines.append(f"| {name} | {len(contents)} | {warned} | {frames} | {parts} |")
    return [*lines, "", *refused] if refused else lines


def _size(content: Content) -> tuple[int, int]:
    motion = content.motion
    if isinstance(motion, SkeletonMotion):
        return motion.frames, len(motion.skeleton.joints)
    return (motion.frames, len(motion.names)) if isinstance(motion, MarkerMotion) else (0, 0)


def _range(values: list[int]) -> str:
    low, high = min(values), max(values)
    return str(low) if low == high else f"{low} to {high}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="into docs/formats.md")
    options = parser.parse_args()
    lines = table(options.folder)
    if not options.write:
        print("\n".join(lines))
        return
    before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    PAGE.write_text(f"{before}{BEGIN}\n" + "\n".join(lines) + f"\n{END}{after}", "utf-8")


if __name__ == "__main__":
    main()
