"""What a sweep of many short circles takes: processor and wall seconds by threads, and its memory.

usage: many_rows.py STICTION [ROWS]      default: 100000 rows on all cores, a tenth of them on one and on two threads
Two threads are compared with one in turns, so that what others do on the machine in between falls on both.
"""

import pathlib
import resource
import subprocess
import sys
import tempfile
import time

SPEC = """schema = "stiction.sweep-spec/1"
name = "many circles"
command = "simulate circle"
machine = "emps"
figures = ["peak_error"]
[option]
friction = "coulomb_viscous"
feed = "2 m/min"
[set]
"axis.X.mass" = {{ distribution = "uniform", from = 0.9, to = 1.1, relative = true }}
[sample]
number = {}
"""
TURNS = 3


def swept(program, folder, rows, threads):
    """Wall and processor seconds of a sweep of so many rows."""
    spec = folder / f"{rows}.toml"
    spec.write_text(SPEC.format(rows))
    out = folder / f"{rows}-{threads}-{time.monotonic_ns()}"
    before, begins = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    command = [program, "sweep", spec, "--out", out, "--yes"] + (["--threads", str(threads)] if threads else [])
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.monotonic() - begins, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    rows = int(sys.argv[2]) if len(sys.argv) > 2 else 100000
    with tempfile.TemporaryDirectory(prefix="stiction-rows-") as name:
        folder = pathlib.Path(name)
        walls = {1: [], 2: []}
        for _ in range(TURNS):
            for threads in walls:
                walls[threads].append(swept(program, folder, rows // 10, threads)[0])
        ratios = sorted(one / two for one, two in zip(walls[1], walls[2]))
        print(f"{rows // 10} circles, one thread {sorted(walls[1])[TURNS // 2]:.1f} s, two {sorted(walls[2])[TURNS // 2]:.1f} s: "
              f"{ratios[TURNS // 2]:.2f} times as fast ({ratios[0]:.2f} to {ratios[-1]:.2f} in {TURNS} turns)")
        wall, processor = swept(program, folder, rows, None)
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        print(f"{rows} circles: {wall:.0f} s, {1e3 * processor / rows:.2f} ms of a processor each, "
              f"{peak:.0f} MiB of memory at most")


if __name__ == "__main__":
    main()
