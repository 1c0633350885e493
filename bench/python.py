"""What Python adds to a call, and how soon Ctrl-C stops one: ./batten python bench/python.py"""

import os
import signal
import threading
import time

import numpy as np

import batten
from array_loop import loop_step


def sheet(side: int) -> batten.Mesh:
    u, v = np.meshgrid(np.arange(side + 1.0), np.arange(side + 1.0))
    points = np.stack([u, v, np.sin(u) * np.cos(v)], axis=-1).reshape(-1, 3)
    first = ((side + 1) * np.arange(side)[:, None] + np.arange(side)).reshape(-1)
    return batten.Mesh(points, np.stack([first, first + 1, first + side + 2, first + side + 1], axis=1))


def best(body, count: int = 2000) -> float:
    """Seconds of the fastest of many calls."""
    times = []
    for _ in range(count):
        start = time.perf_counter()
        body()
        times.append(time.perf_counter() - start)
    return min(times)


tiny = sheet(1)
surface = batten.LimitSurface(tiny)
tessellator = batten.Tessellator(tiny, 1)
motion = batten.Interpolator(tiny)
face, uv = np.zeros(1, dtype=np.int32), np.full((1, 2), 0.5)
print("calls on a single quad, microseconds, the C++ work included:")
for name, body in {
    "LimitSurface.points": lambda: surface.points(face, uv),
    "Tessellator": lambda: tessellator(tiny.points),
    "limit_positions": lambda: batten.limit_positions(tiny),
    "Interpolator.solve": lambda: motion.solve(tiny.points),
}.items():
    print(f"  {name:22} {1e6 * best(body):6.1f}")

large = sheet(1000)
start = time.perf_counter()
assert np.shares_memory(batten.Mesh(large.points, large.faces).points, large.points)
positions = batten.limit_positions(large)
print(f"1 M vertices: limit positions in {time.perf_counter() - start:.3f} s, then {best(lambda: batten.limit_positions(large), 5):.3f} s")

triangles = batten.triangulate(sheet(300))
refined = batten.subdivide(triangles, scheme="loop")
points, _ = loop_step(triangles.points, np.asarray(triangles.faces).reshape(-1, 3))
assert np.allclose(np.sort(points, axis=0), np.sort(refined.points, axis=0), atol=1e-12)
ours = best(lambda: batten.subdivide(triangles, scheme="loop"), 5)
arrays = best(lambda: loop_step(triangles.points, np.asarray(triangles.faces).reshape(-1, 3)), 3)
print(f"one Loop step of {len(triangles.faces):,} triangles: {1e3 * ours:.0f} ms; by NumPy's array operations {1e3 * arrays:.0f} ms, {arrays / ours:.0f} times as long")

sent = [0.0]


def interrupt() -> None:
    time.sleep(0.5)
    sent[0] = time.perf_counter()
    os.kill(os.getpid(), signal.SIGINT)


waits = []
for _ in range(5):
    thread = threading.Thread(target=interrupt)
    thread.start()
    try:
        while True:
            batten.interpolate(sheet(250), fair=True)
    except KeyboardInterrupt:
        waits.append(time.perf_counter() - sent[0])
    thread.join()
print(f"Ctrl-C stops a fair surface of 63,000 points after at most {max(waits):.2f} s")
