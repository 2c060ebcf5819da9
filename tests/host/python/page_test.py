"""Runs every example of docs/python.md, in the page's order, in an empty folder.

usage: page_test.py PAGE FOLDER     FOLDER: has the package
"""

import os
import re
import sys
import tempfile

page, folder = sys.argv[1:3]
sys.path.insert(0, folder)
text = open(page, encoding="utf-8").read()
names = {}
blocks = list(re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S))
with tempfile.TemporaryDirectory(prefix="stiction-page-") as place:
    os.chdir(place)
    for block in blocks:
        line = text.count("\n", 0, block.start()) + 1
        exec(compile("\n" * line + block[1], page, "exec"), names)
    os.chdir("/")
import numpy as np  # noqa: E402

# What the page says of its own results.
assert len(blocks) > 6, f"found {len(blocks)} examples"
assert len(names["replayed"].logs[0]["X.x"]) == len(names["log"]["X.x"]) and names["loops"]["results"]
assert np.max(np.abs(names["rough"].logs[0]["X.x"] - names["smooth"].logs[0]["X.x"])) > 1e-7
assert len(names["found"].logs) == 1 and len(names["found"]["rows"]) == 2
assert names["heavy"].axes["X"]["mass"] == 300.0
assert names["many"]["e"].shape == (100, 4) and not names["many"]["fault"].any()
assert np.max(np.abs(names["own"]["v"] - names["twin"]["v"])) <= 1e-12 < np.max(np.abs(names["twin"]["v"]))
print(f"{len(blocks)} examples of {page} were run")
