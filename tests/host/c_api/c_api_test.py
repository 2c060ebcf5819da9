"""Compiles the program in C as its user does, runs it, and compares what it wrote with what the command prints.

usage: c_api_test.py COMPILER HEADER_FOLDER LIBRARY_FOLDER PROGRAM.c STICTION
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

compiler, headers, libraries, program, stiction = sys.argv[1:]
with tempfile.TemporaryDirectory(prefix="stiction-c-") as folder:
    binary = str(Path(folder) / "program")
    subprocess.run([compiler, "-std=c11", "-Wall", "-Wextra", "-pedantic", "-Werror", "-I", headers, program, "-o", binary,
                    "-L", libraries, f"-Wl,-rpath,{libraries}", "-lstiction", "-lm"], check=True)
    subprocess.run([binary, folder], check=True, cwd=folder)
    printed = subprocess.run([stiction, "diagnose", str(Path(folder) / "circle.csv"), "--machine", "mcfv5050ln", "--set",
                              "axis.X.mass=240 kg", "--axis", "X", "--json"], check=True, capture_output=True, text=True)
    found = (Path(folder) / "verdict.json").read_text()
    if json.loads(found) != json.loads(printed.stdout):
        sys.exit("the verdict of the C API is not that of the command")
    # What C++ is in the library must not be seen by a program that has an other of it.
    symbols = subprocess.run(["nm", "-D", "--defined-only", str(Path(libraries) / "libstiction.so")], check=True,
                             capture_output=True, text=True).stdout.split("\n")
    seen = [line.split()[-1] for line in symbols if line]
    if not seen or not all(name.startswith("stiction_") for name in seen):
        sys.exit(f"found symbols {[name for name in seen if not name.startswith('stiction_')][:5]}; "
                 "expected stiction_* alone")
    declared = {line.split("(")[0].split()[-1].lstrip("*") for line in (Path(headers) / "stiction.h").read_text().splitlines()
                if "(" in line and " stiction_" in line.split("(")[0] and not line.startswith((" ", "typedef"))}
    if declared != set(seen):
        sys.exit(f"the header and the library differ in {sorted(declared ^ set(seen))}")
print(f"{len(seen)} functions of the C API, the verdict equal to the command's")
