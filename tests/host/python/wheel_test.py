"""`pip install --no-build-isolation .` from a copy of the sources, without a network, over a finished build: the module
is installed with its stubs and machines, and works without the build.

usage: wheel_test.py ROOT BUILD     status 77: pip or setuptools is not there
"""

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

root, build = map(Path, sys.argv[1:])
if any(importlib.util.find_spec(name) is None for name in ("pip", "setuptools", "wheel")):
    print("pip, setuptools or wheel is not installed (Debian: python3-pip, python3-setuptools, python3-wheel)")
    sys.exit(77)
with tempfile.TemporaryDirectory(prefix="stiction-wheel-") as place:
    tree, target = Path(place) / "tree", Path(place) / "installed"
    for name in ("pyproject.toml", "setup.py", "CMakeLists.txt", "host/python/stiction", "firmware/machine/shipped"):
        source = root / name
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copytree(source, tree / name) if source.is_dir() else shutil.copy(source, tree / name)
    environment = {**os.environ, "STICTION_BUILD": str(build), "PIP_NO_INDEX": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    environment.pop("PYTHONPATH", None)
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps",
                    "--target", str(target), "."], cwd=tree, env=environment, check=True)
    shutil.rmtree(tree)
    machines = {path.stem for path in (root / "firmware/machine/shipped").glob("*.toml")}
    code = "import stiction; print(stiction.__file__); print(*stiction.shipped_machines())"
    printed = subprocess.run([sys.executable, "-B", "-c", code], cwd=place, check=True, capture_output=True, text=True,
                             env={**environment, "PYTHONPATH": str(target)}).stdout.splitlines()
    assert printed[0] == str(target / "stiction/__init__.py"), printed
    assert machines <= set(printed[1].split()), printed
    assert (target / "stiction/__init__.pyi").is_file() and (target / "stiction/py.typed").is_file()
print(f"{len(machines)} machines are found by the installed module")
