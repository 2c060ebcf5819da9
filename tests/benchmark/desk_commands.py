"""Processor seconds and instructions of what people wait for at the desk.

usage: desk_commands.py STICTION [--seconds-only]

Runs `tune-friction` of two shipped machines and `diagnose --reference circle`, and prints a line of each: processor
time of user and system, which depends on what else the processor does, and instructions counted by callgrind, which
takes some fifty times as long.
"""
import os
import re
import subprocess
import sys
import tempfile

COMMANDS = [
    ["tune-friction", "--machine", "mcfv5050ln"],
    ["tune-friction", "--machine", "screw-motor-encoder"],
    ["diagnose", "--reference", "circle", "--machine", "mcfv5050ln"],
]


def seconds(command):
    """User and system time (s) of a command that must succeed."""
    before = os.times()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = os.times()
    return after.children_user - before.children_user, after.children_system - before.children_system


def instructions(command):
    """Instructions of a command, counted by callgrind; its processor is one without AVX-512."""
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", *command],
                             check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    found = re.search(r"Collected : (\d+)", run.stderr)
    if not found:
        sys.exit(f"callgrind: found no count in its output; expected a line 'Collected : N':\n{run.stderr}")
    return int(found.group(1))


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--seconds-only"]):
        sys.exit(__doc__)
    for arguments in COMMANDS:
        command = [sys.argv[1], *arguments]
        user, system = seconds(command)
        line = f"stiction {' '.join(arguments)}: {user + system:.1f} s of a processor ({system:.1f} s in the system)"
        if len(sys.argv) == 2:
            line += f", {instructions(command) / 1e9:.1f} thousand million instructions"
        print(line, flush=True)


if __name__ == "__main__":
    main()
