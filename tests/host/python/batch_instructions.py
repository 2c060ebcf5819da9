"""Instructions of a batch from Python against those of the same loop in C++, counted by valgrind.

usage: batch_instructions.py FOLDER BATCH_LOOP     FOLDER: has the package; BATCH_LOOP: tests/benchmark/batch_loop.cpp

Each runs two lengths, and the difference is counted, so that what a start costs is not. Both must give the same sum of
positions, to the bit. Status 1: Python has less than 90 % of the speed of C++.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

SHORT, LONG = 400, 1600  # ticks
LEAST = 0.9

FROM_PYTHON = """
import sys
sys.path.insert(0, sys.argv[1])
import numpy as np
import stiction
ticks = int(sys.argv[2])
machines = [stiction.machine("mcfv5050ln", set=f"axis.X.mass={200 + 10 * k} kg") for k in range(8)]
rate, amplitude = 30.0, 1e-3
phase = rate * np.arange(ticks) * machines[0].period
found = stiction.batch([(machines[k % 8], "X") for k in range(64)], amplitude * np.sin(phase),
                       amplitude * rate * np.cos(phase), -amplitude * rate * rate * np.sin(phase))
print(f"{sum(found['x'][-1].tolist()):.17g}")
"""


def instructions(*command):
    """Of the command, and what it printed."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["valgrind", "--tool=cachegrind", "--cache-sim=no",
                               f"--cachegrind-out-file={Path(folder) / 'out'}", *command],
                              capture_output=True, text=True, check=True)
    return int(re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)[1].replace(",", "")), done.stdout


def of_a_tick(*command):
    (few, _), (many, printed) = (instructions(*command, str(ticks)) for ticks in (SHORT, LONG))
    return (many - few) / (LONG - SHORT), printed


def main():
    folder, loop = sys.argv[1:3]
    cpp, of_cpp = of_a_tick(loop)
    python, of_python = of_a_tick("/usr/bin/python3", "-c", FROM_PYTHON, folder)
    print(f"C++     {cpp:10.0f} instructions a tick of 64 axes")
    print(f"Python  {python:10.0f} instructions a tick of 64 axes")
    print(f"Python has {100 * cpp / python:.1f} % of the speed of C++")
    if float(of_cpp) != float(of_python):
        sys.exit(f"found {of_python.strip()} from Python; expected {of_cpp.strip()}, as from C++")
    sys.exit(cpp / python < LEAST)


main()
