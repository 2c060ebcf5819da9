"""The example for Octave and its errors, where Octave is installed (status 77: it is not).

usage: octave_test.py EXAMPLE_FOLDER HEADER_FOLDER LIBRARY_FOLDER STICTION
"""

import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

examples, headers, libraries, stiction = sys.argv[1:]
if not shutil.which("mkoctfile") or not shutil.which("octave-cli"):
    print("octave is not installed: toolchain/setup octave")
    sys.exit(77)
with tempfile.TemporaryDirectory(prefix="stiction-octave-") as folder:
    for name in ("stiction_run_mex.c", "circle.m"):
        shutil.copy(Path(examples) / name, folder)
    subprocess.run(["mkoctfile", "--mex", "stiction_run_mex.c", f"-I{headers}", f"-L{libraries}", "-lstiction",
                    f"-Wl,-rpath,{libraries}"], cwd=folder, check=True)
    found = subprocess.run(["octave-cli", "--no-gui", "circle.m"], cwd=folder, check=True, capture_output=True,
                           text=True).stdout
    # Octave ends with the text of the library, or with that of the function's own checks.
    for call, words in (
            ('stiction_run_mex("simulate circle", "mcfv5050ln", {"fed=16 m/min"})', "did you mean 'feed'?"),
            ('stiction_run_mex("simulate circle", "mcfv5050l")', 'did you mean "mcfv5050ln"?'),
            ('stiction_run_mex("diagnose", "mcfv5050ln", {"axis=X"}, {"nowhere.csv"})', "nowhere.csv"),
            ('stiction_run_mex("diagnose")', "found 1 arguments; expected command, machine, options, logs"),
            ('stiction_run_mex("simulate circle", 3)', "machine: expected a text"),
            ('stiction_run_mex("simulate circle", "mcfv5050ln", "feed=16 m/min")', "options: expected a cell array"),
            ('stiction_run_mex("simulate circle", "mcfv5050ln", {3})', "options: expected texts alone")):
        refused = subprocess.run(["octave-cli", "--no-gui", "--eval", call], cwd=folder, capture_output=True, text=True)
        if refused.returncode == 0 or words not in refused.stderr:
            sys.exit(f"{call}: found {refused.returncode}, {refused.stderr!r}; expected an error with {words!r}")
    printed = json.loads(subprocess.run([stiction, "simulate", "circle", "--machine", "mcfv5050ln", "--friction", "lugre",
                                         "--feed", "16 m/min", "--json"], check=True, capture_output=True,
                                        text=True).stdout)
    peak = printed["rows"][0]["peak_error_um"]
    if f"peak error of X: {peak:.2f} um" not in found or not re.search(r"following error of X: \d+\.\d+ um", found):
        sys.exit(f"found {found!r}; expected the peak error of the command, {peak:.2f} um")
print(found.strip())
