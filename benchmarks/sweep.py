"""The same sweep on one process, two processes and a local Dask cluster: alike, and how fast.

Runs a second are of the running alone: the score is solved once before, and the clock starts with
the processes. The tables are compared byte by byte.

    python benchmarks/sweep.py
    python benchmarks/sweep.py --score adage-developpe --runs 40 --json
"""

from __future__ import annotations

import os

# Before numpy: the processes are the threads.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import enpointe
from enpointe.sweeping import Sweep

WORKERS = 2


@contextmanager
def local_cluster() -> Iterator[str | None]:
    """Address of a scheduler with `WORKERS` workers here; None without Dask."""
    try:
        from distributed import LocalCluster
    except ImportError:
        yield None
        return
    cluster = LocalCluster(  # type: ignore[no-untyped-call]
        n_workers=WORKERS, threads_per_worker=1, dashboard_address=":0"
    )
    with cluster:
        yield cluster.scheduler_address


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--score", default="third-port-de-bras")
    parser.add_argument("--controller", choices=("wholebody", "pd"), default="wholebody")
    parser.add_argument("--runs", type=int, default=8)
    parser.add_argument("--disturb", default=None)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    with TemporaryDirectory() as folder, local_cluster() as address:

        def swept(name: str, processes: int, cluster: str | None) -> Sweep:
            # All dance the same solved movement, which a first sweep of no length left behind.
            out = Path(folder) / name
            shutil.copytree(Path(folder) / "solved", out)
            (out / "runs.jsonl").unlink()
            return enpointe.sweep(
                options.score,
                runs=options.runs,
                controller=options.controller,
                disturb=options.disturb,
                processes=processes,
                cluster=cluster,
                out=out,
            )

        enpointe.sweep(
            options.score,
            runs=1,
            controller=options.controller,
            disturb=options.disturb,
            out=Path(folder) / "solved",
        )
        sweeps = {"1 process": swept("one", 1, None), "2 processes": swept("two", WORKERS, None)}
        if address is not None:
            sweeps[f"Dask, {WORKERS} workers here"] = swept("dask", WORKERS, address)
    _report(sweeps, options)


def _report(sweeps: dict[str, Sweep], options: argparse.Namespace) -> None:
    first = next(iter(sweeps.values()))
    alike = {name: sweep.table() == first.table() for name, sweep in sweeps.items()}
    if options.json:
        rows = {
            name: {"runs_per_second": sweep.runs_per_second, "identical": alike[name]}
            for name, sweep in sweeps.items()
        }
        print(json.dumps({**vars(options), "completed": first.completed_fraction, "ways": rows}))
    else:
        print(
            f"{options.score}, {options.controller}, {options.runs} runs of {first.duration:.1f} s,"
            f" {100 * first.completed_fraction:.0f} % completed"
        )
        for name, sweep in sweeps.items():
            table = "the same table" if alike[name] else "ANOTHER TABLE"
            print(f"{name:<22} {sweep.runs_per_second or 0.0:7.3f} runs/s  {table}")
    if not all(alike.values()):
        raise SystemExit(1)


if __name__ == "__main__":
    main()
