#!/usr/bin/env python3
"""Checks that what a kernel of a batch is compiled with stays in that kernel: a function without its instruction set in
the name could be taken by the linker for a caller that runs on every processor.

usage: symbols_test.py NM OBJECT...      status 1: findings
"""

import re
import subprocess
import sys

SETS = {"sse2": "Sse2", "avx2": "Avx2", "avx512": "Avx512", "neon": "Neon"}
# Data, and what the compiler itself refers to, have no instructions.
HARMLESS = ("DW.ref.", "stiction::sim::detail::direction", "typeinfo", "vtable for", "guard variable")


def findings(nm, path):
    kernel = re.search(r"kernel_([a-z0-9]+)\.cpp", path)
    if kernel is None or kernel.group(1) not in SETS:
        return [f"{path}: found an object that is no kernel; expected kernel_SET.cpp"]
    tag = "stiction::machine::" + SETS[kernel.group(1)]
    found = []
    names = subprocess.run([nm, "-C", "--defined-only", path], check=True, capture_output=True, text=True).stdout
    weak = 0
    for line in names.splitlines():
        kind, name = line.split(maxsplit=2)[1:]
        if kind not in "WVu":
            continue
        weak += 1
        if tag not in name and not name.startswith(HARMLESS):
            found.append(f"{path}: found {name}; expected {tag} in the name of what is linked by name")
    if weak == 0:
        found.append(f"{path}: found no function of a template; expected the kernel's")
    return found


def main():
    found = [finding for path in sys.argv[2:] for finding in findings(sys.argv[1], path)]
    print("\n".join(found))
    return 1 if found or len(sys.argv) < 3 else 0


if __name__ == "__main__":
    sys.exit(main())
