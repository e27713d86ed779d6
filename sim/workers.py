"""Runs of a trial on processes of this machine, or on a Dask cluster.

A run's outcome depends on the trial and its number alone, so that it does not matter who dances it.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from importlib import import_module
from itertools import islice
from typing import Any

from enpointe.errors import EnpointeError
from enpointe.sim.fingerprint import code_digest
from enpointe.sim.trial import Outcome, Trial

__all__ = ["on_cluster", "on_processes"]

ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Linear algebra of this size is slower on several threads, and the processes are the threads."""
CONNECTING = 10.0
"""s that a scheduler is given to answer."""

_trial: Trial | None = None


def on_processes(
    trial: Trial, runs: Iterable[int], processes: int
) -> Generator[Outcome, None, None]:
    """Dance on processes of this machine; outcomes as they come.

    Each process is a fresh interpreter, of one thread of linear algebra, even where there is but
    one: who dances alone dances as in company. When the iterator is closed, or interrupted, the
    processes are ended at once.

    Raises:
        EnpointeError: A process died.
    """
    waiting = iter(runs)
    strangers = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(
        processes, multiprocessing.get_context("spawn"), initializer=_begin, initargs=(trial,)
    )
    try:
        with _one_thread():
            # As many as there are processes, and one each in hand.
            with _deaf():
                dancing = {pool.submit(_dance, run) for run in islice(waiting, 2 * processes)}
            yield from _finished(pool, dancing, waiting)
    except BrokenProcessPool:
        raise EnpointeError(
            "a process that danced has died (too little memory?); what was finished is kept: run"
            " the same again, with fewer processes"
        ) from None
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        for process in set(multiprocessing.active_children()) - strangers:
            process.terminate()
            process.join()


def _finished(
    pool: ProcessPoolExecutor, dancing: set[Future[Outcome]], waiting: Iterator[int]
) -> Iterator[Outcome]:
    while dancing:
        done, dancing = wait(dancing, return_when=FIRST_COMPLETED)
        dancing |= {pool.submit(_dance, run) for run in islice(waiting, len(done))}
        for future in done:
            yield future.result()


def on_cluster(trial: Trial, runs: Iterable[int], address: str) -> Generator[Outcome, None, None]:
    """Dance on the workers of a Dask scheduler, where enpointe must be installed too.

    Args:
        trial: Sent to every worker once.
        runs: Their numbers.
        address: Of the scheduler, such as tcp://host:8786.

    Raises:
        EnpointeError: Dask is not installed, nobody answers, or the workers can't dance.
    """
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        raise EnpointeError(
            "a cluster needs Dask: pip install 'enpointe[cluster]', or leave out --cluster"
        ) from None
    try:
        client = distributed.Client(address, timeout=CONNECTING, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise EnpointeError(f"no Dask scheduler answers at {address}: {reason}") from None
    with client:
        if not client.nthreads():
            raise EnpointeError(f"the Dask scheduler at {address} has no workers; start some")
        with _cluster_faults(address):
            if set(client.run(code_digest).values()) != {code_digest()}:
                raise EnpointeError(
                    f"the workers of {address} have another enpointe, MuJoCo or numpy than this"
                    " machine; install the same everywhere"
                )
            sent = client.scatter(trial, broadcast=True)
        futures = client.map(_dance_sent, list(runs), trial=sent, pure=False)
        try:
            for future in distributed.as_completed(futures, loop=client.loop):
                with _cluster_faults(address):
                    outcome: Outcome = future.result()
                yield outcome
        finally:
            client.cancel(futures)


@contextmanager
def _cluster_faults(address: str) -> Iterator[None]:
    """What goes wrong at a worker comes as any exception."""
    try:
        yield
    except EnpointeError:
        raise
    except Exception as error:
        reason = " ".join(str(error).split())
        raise EnpointeError(
            f"a worker of {address} failed, {type(error).__name__}: {reason}; all workers need the"
            " same enpointe as this machine"
        ) from error


def _begin(trial: Trial) -> None:
    global _trial
    # Whoever stops the sweep ends this process; it has nothing to say about it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    _trial = trial


def _end_with_parent() -> None:
    """Nobody is left behind when the sweep itself is killed."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _dance(run: int) -> Outcome:
    assert _trial is not None
    return _trial.run(run)


def _dance_sent(run: int, trial: Trial) -> Outcome:
    return trial.run(run)


@contextmanager
def _one_thread() -> Iterator[None]:
    """What a process started meanwhile finds in its environment."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def _deaf() -> Iterator[None]:
    """Processes started meanwhile ignore the keyboard from their first moment."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
