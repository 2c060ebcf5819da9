#!/usr/bin/env python3
"""Identifies joints from logs of their independent truth, with their own encoders, and compares with what they are.

usage: identify_truth.py PROGRAMME
  A line a quantity; status 1 where one is further off than its bound.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import cases
from write_truth import write

# Case: key to true value and largest error as a share of it. Inertias are reduced to the joint (equations.md, 1).
JOINTS = {
    "pendulum_pd_voltage": {
        "inertia_kg_m2": (0.02 + 3.3e-6 * 50**2, 0.02),
        "gravity_moment_N_m": (1.9 - 0.6, 0.01),
        "viscous_N_m_s_per_rad": (0.02, 0.15),
        "coulomb_N_m": (0.08, 0.15),
    },
    "servo_joint_p_voltage": {
        "inertia_kg_m2": (2.4e-3 + 4e-8 * 345**2, 0.02),
        "gravity_moment_N_m": (0.48, 0.01),
        "viscous_N_m_s_per_rad": (0.011, 0.15),
        "coulomb_N_m": (0.036, 0.15),
    },
}


def errors(programme, name, folder):
    """Rows of key, value, relative error and its bound for a case."""
    table, file = write(name, folder)
    command = [programme, "identify", table, "--machine", file, "--json"]
    found = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["parameters"]
    for key, (true, most) in JOINTS[name].items():
        value = found[key]["value"] if key in found else float("nan")
        yield key, value, abs(value / true - 1), most


def main():
    sound = True
    with tempfile.TemporaryDirectory() as folder:
        for name in JOINTS:
            assert name in cases.CASES
            for key, value, error, most in errors(sys.argv[1], name, pathlib.Path(folder)):
                print(f"{name}: {key} {value:.5g}, {100 * error:.2g} % off (bound {100 * most:g} %)")
                sound = sound and error <= most
    return 0 if sound else 1


if __name__ == "__main__":
    sys.exit(main())
