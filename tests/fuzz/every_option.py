#!/usr/bin/env python3
"""Gives every option of every command a word and a negative number, one at a time, and nothing else.

What is refused says what was found and what was expected. The fuzzer of the command line draws some hundred lines, so a
new option can go unseen for weeks; here each has its turn."""

import argparse
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile

import help_grammar

VALUES = ["*", "-1"]


def findings(program, command, argument, folder):
    """The lines of one option that are refused in other words."""
    for value in VALUES:
        line = [*command.words, f"{argument.name}={value}"]
        try:
            run = subprocess.run([program, *line], cwd=folder, capture_output=True, text=True, timeout=20, check=False,
                                 stdin=subprocess.DEVNULL, errors="replace")
        except subprocess.TimeoutExpired:
            continue  # It was taken, and what it asks for takes long, or serves until it is ended.
        if run.returncode == 2 and not ("found" in run.stderr and "expected" in run.stderr):
            yield f"{' '.join(line)}: {run.stderr.strip()}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    program = parser.parse_args().program.resolve()
    commands = help_grammar.read(program)
    options = [(command, each) for command in commands for each in command.arguments
               if each.takes and each.name.startswith("--")]
    with tempfile.TemporaryDirectory() as folder, \
            concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        found = [line for lines in pool.map(lambda each: list(findings(program, *each, folder)), options) for line in lines]
    for line in found:
        print(f"refused without what was found and what was expected: {line}")
    print(f"{len(options)} options of {len(commands)} commands, {len(VALUES)} values each; {len(found)} findings")
    return 1 if found or not options else 0


if __name__ == "__main__":
    sys.exit(main())
