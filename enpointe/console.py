"""What a person or a script sees: progress on a terminal, tables, or one JSON object."""

from __future__ import annotations

import json as jsonlib
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rich.console
from rich.console import RenderableType
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn
from rich.table import Table

from enpointe.preparing import Progress as Report

__all__ = ["Console", "rows"]


class Console:
    """Output of one command.

    Args:
        json: Print one JSON object on standard output and nothing else.
        quiet: Print nothing but errors.
    """

    def __init__(self, *, json: bool, quiet: bool) -> None:
        self._json = json
        self._quiet = quiet
        self._out = rich.console.Console(highlight=False, soft_wrap=True)

    @contextmanager
    def progress(self) -> Iterator[Report]:
        """A progress bar for each task on a terminal; silent in a pipe, with --json and with -q."""
        if self._json or self._quiet or not sys.stderr.isatty():
            yield lambda task, done, total: None
            return
        bars = Progress(
            TextColumn("{task.description:<12}"),
            BarColumn(),
            TextColumn("{task.percentage:3.0f} %"),
            TimeElapsedColumn(),
            console=rich.console.Console(stderr=True),
            transient=True,
        )
        tasks: dict[str, TaskID] = {}
        with bars:

            def show(task: str, done: float, total: float) -> None:
                if task not in tasks:
                    tasks[task] = bars.add_task(task, total=total)
                bars.update(tasks[task], completed=done, total=total)

            yield show

    def show(self, figures: Mapping[str, object], files: Mapping[str, Path], folder: Path) -> None:
        """The figures of a job and what it wrote."""
        if self._json:
            paths = {name: str(path) for name, path in files.items()}
            self.print_json({**figures, "files": paths})
        elif not self._quiet:
            self._out.print(_table(figures))
            report = files.get("report", folder)
            self._out.print(f"report: {report}")

    def warn(self, message: str | None) -> None:
        """A plain line on standard error, for what went another way than it should."""
        if message and not self._quiet:
            print(f"enpointe: {message}", file=sys.stderr)

    def list(self, names: Sequence[str]) -> None:
        """Names, one a line."""
        if self._json:
            self.print_json({"names": [*names]})
        elif not self._quiet:
            for name in names:
                self._out.print(name, markup=False)

    def print(self, what: RenderableType) -> None:
        """Anything rich can draw."""
        if not self._quiet:
            self._out.print(what)

    def print_json(self, value: object) -> None:
        """One JSON object; not-a-numbers and infinities become null, which JSON lacks."""
        print(jsonlib.dumps(_finite(value), allow_nan=False))


def _finite(value: object) -> object:
    if isinstance(value, float):
        return value if value == value and abs(value) != float("inf") else None
    if isinstance(value, Mapping):
        return {str(k): _finite(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(v) for v in value]
    return value


def _table(figures: Mapping[str, object]) -> Table:
    return rows(_flat(figures))


def rows(pairs: Iterable[tuple[str, str]]) -> Table:
    """A plain table of what is measured and its value."""
    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="dim")
    table.add_column()
    for name, value in pairs:
        table.add_row(name, value)
    return table


def _flat(figures: Mapping[str, object], prefix: str = "") -> Iterator[tuple[str, str]]:
    for name, value in figures.items():
        label = f"{prefix}{name}"
        if isinstance(value, Mapping):
            yield from _flat(value, f"{label}.")
        elif name == "poses" and isinstance(value, list):
            for entry in value:
                yield entry["name"], _verdict(entry)
            if len(value) == 1:
                yield from ((rule["rule"], _measured(rule)) for rule in value[0]["rules"])
        elif name == "failures" and isinstance(value, list):
            fallen = [str(entry["run"]) for entry in value]
            yield label, f"{len(fallen)}: runs {', '.join(fallen)}" if fallen else "none"
        elif name == "rules" and isinstance(value, list):
            kept = sum(rule["held_fraction"] == 1.0 for rule in value)
            yield label, f"{kept} of {len(value)} held throughout"
        elif isinstance(value, list):
            apart = "\n" if any(isinstance(entry, Mapping) for entry in value) else ", "
            yield label, apart.join(_said(entry) for entry in value) or "none"
        else:
            yield label, _said(value)


def _said(value: object) -> str:
    """A figure, or some that belong together, in a line."""
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_said(entry)}" for name, entry in value.items())
    if isinstance(value, float):
        return f"{value:.4g}"
    return "none" if value is None else str(value)


def _verdict(entry: Mapping[str, Any]) -> str:
    """What a solved pose keeps, what it breaks and by how much, and how she cheats."""
    rules = entry["rules"]
    broken = [rule for rule in rules if not rule["held"]]
    kept = f"{len(rules) - len(broken)} of {len(rules)}" if broken else f"all {len(rules)}"
    lines = [f"{kept} rules held ({entry['solve_ms']:.0f} ms)"]
    lines += [f"{rule['rule']}: {_measured(rule)}" for rule in broken]
    if entry["cheats"]:
        cheats = (f"{c['name']} {c['value']:.0f} {c['unit']}" for c in entry["cheats"])
        lines.append(f"cheats: {', '.join(cheats)}")
    return "\n".join(lines)


def _measured(rule: Mapping[str, Any]) -> str:
    verdict = "held" if rule["held"] else "broken"
    limit = f"at {'least' if rule['at_least'] else 'most'} {rule['bound']:g}"
    return f"{verdict}, {round(rule['value'], 1) + 0.0:.1f} {rule['unit']} ({limit})"
