"""Threads, progress and Ctrl-C."""

from __future__ import annotations

import os
import signal
import threading
import time

import numpy as np
import pytest

import batten
from conftest import grid


def test_progress_rises_to_one_and_may_stop_the_call() -> None:
    mesh = grid(300, 300)
    seen: list[float] = []
    batten.interpolate(mesh, progress=seen.append)
    assert seen and seen == sorted(seen) and seen[-1] == 1.0

    class Enough(Exception):
        pass

    def stop(done: float) -> None:
        raise Enough(f"at {done}")

    with pytest.raises(Enough):
        batten.interpolate(mesh, fair=True, progress=stop)
    with pytest.raises(batten.Error) as caught:
        batten.interpolate(mesh, fair=True, progress=lambda done: False)
    assert caught.value.code == "cancelled"
    assert batten.interpolate(mesh).report.converged  # everything is usable


def test_control_c_stops_a_call() -> None:
    mesh = grid(250, 250)
    sent: list[float] = []
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have told the process to ignore it

    def interrupt() -> None:
        time.sleep(0.3)
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            batten.interpolate(mesh, fair=True)
    thread.join()
    assert sent  # and the call is over; bench/python.py measures how soon
    assert batten.interpolate(mesh).report.converged


def test_eight_threads_run_at_once() -> None:
    """Python's lock is free: all eight calls have begun before one of them ends."""
    mesh = grid(60, 60)
    solver = batten.Interpolator(mesh)
    expected = solver.solve(mesh.points).control
    begun = threading.Barrier(8, timeout=60)
    results: list[np.ndarray] = []

    def work() -> None:
        waited = False

        def meet(done: float) -> None:
            nonlocal waited
            if not waited:
                waited = True
                begun.wait()

        batten.interpolate(mesh, fair=True, progress=meet)
        results.append(solver.solve(mesh.points).control)

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 8
    for control in results:
        assert np.array_equal(control, expected)


def test_a_bar_is_drawn(capsys: pytest.CaptureFixture[str]) -> None:
    batten.interpolate(grid(100, 100), progress=True)
    drawn = capsys.readouterr().err
    assert "100 %" in drawn or "100%" in drawn
