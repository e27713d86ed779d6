"""Coverage-guided fuzzing of the readers of motion files, where atheris is installed.

    pip install atheris
    python benchmarks/fuzz.py BVH --seconds 120
    python benchmarks/fuzz.py C3D --seconds 600 --corpus corpus

One reader a run: libFuzzer owns the process. It starts from the small files of mutants.py, follows
the branches of this package, and stops at the first file that is neither read nor refused with a
place in one line, takes more than ten seconds, or more than a gigabyte; that file is left here.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import atheris

with atheris.instrument_imports(include=["enpointe.motion.formats", "enpointe.motion.gesture"]):
    import enpointe.motion.formats.registry  # noqa: F401

from mutants import SECONDS, judged, originals


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("reader")
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--corpus", type=Path, help="folder in which interesting files are kept")
    options = parser.parse_args()
    warnings.simplefilter("error")
    with TemporaryDirectory() as name:
        folder = Path(name)
        suffix, reader, raws = originals(folder)[options.reader]
        corpus = options.corpus or folder / "corpus"
        corpus.mkdir(parents=True, exist_ok=True)
        for number, raw in enumerate(raws):
            (corpus / f"whole-{number}").write_bytes(raw)
        path = folder / f"small{suffix}"

        def one(data: bytes) -> None:
            path.write_bytes(data)
            outcome, reason = judged(reader, path, len(data))
            if outcome == "failed":
                raise AssertionError(reason)

        limits = [f"-timeout={SECONDS:.0f}", "-rss_limit_mb=1024", "-max_len=16384"]
        ends = [f"-max_total_time={options.seconds}", "-print_final_stats=1"]
        atheris.Setup([sys.argv[0], *limits, *ends, str(corpus)], one)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
