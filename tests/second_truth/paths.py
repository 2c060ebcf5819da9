"""Makes the oracle of tests/axes (compiler, control law, encoders, units) importable, as its own scripts do, and gives
the compiler a folder of its own for each state of the sources: it keeps a function until the function's own file
changes, although others that it calls may have. SECOND_TRUTH_CACHE names the folder above it [that of temporary files].
"""

import hashlib
import os
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
AXES = HERE.parent / "axes"
sys.path[:0] = [str(HERE), str(AXES)]

_STATE = hashlib.sha256()
for _name in ("laws.py", "plant.py", "residuals.py", "fast.py"):
    _STATE.update((HERE / _name).read_bytes())
for _name in ("controllers.py", "encoders.py", "jit.py"):
    _STATE.update((AXES / _name).read_bytes())
os.environ["NUMBA_CACHE_DIR"] = os.path.join(
    os.environ.get("SECOND_TRUTH_CACHE", tempfile.gettempdir()),
    f"second-truth-{os.getuid()}-{_STATE.hexdigest()[:12]}")
