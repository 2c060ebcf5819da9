#!/usr/bin/env python3
"""Writes a CSV of 200 MB (an axis that moves to and fro at 16 kHz) and measures `stiction inspect` on it: resident
memory, time, and whether progress is shown on a terminal.

usage: large_csv.py FOLDER [--program PROGRAM] [--megabytes 200]
"""

import argparse
import os
import pathlib
import pty
import subprocess
import sys
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
LARGEST = 1 << 30  # bytes of resident memory


def write(path, megabytes):
    """A log of 16 kHz: a sine of 1 Hz with quantised position and noisy current, until the file is large enough."""
    rng, rate, first = np.random.default_rng(1), 16000, 0
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("t[s],x_set[m],x[m],i[A]\n")
        while file.tell() < megabytes * 1_000_000:
            t = (first + np.arange(100_000)) / rate
            x = 0.1 * np.sin(2 * np.pi * t)
            a, v = -((2 * np.pi) ** 2) * x, 2 * np.pi * 0.1 * np.cos(2 * np.pi * t)
            i = (225 * a + 500 * v + 90 * np.sign(v)) / 94 + 0.02 * rng.standard_normal(len(t))
            rows = np.column_stack([t, x, np.round(x, 8), i])
            np.savetxt(file, rows, fmt=("%.7f", "%.9f", "%.8f", "%.4f"), delimiter=",")
            first += len(t)
    return first


def run(command):
    """Status, seconds, largest resident memory in bytes, and what a terminal showed on standard error."""
    screen, line = pty.openpty()
    begin = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=line, close_fds=True)
    os.close(line)
    shown = b""
    while True:
        try:
            part = os.read(screen, 4096)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        shown += part
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    os.close(screen)
    return process.returncode, time.monotonic() - begin, usage.ru_maxrss * 1024, shown.decode(errors="replace")


def measure(program, folder, megabytes=200):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "large.csv"
    try:
        samples = write(path, megabytes)
        size = path.stat().st_size
        status, seconds, memory, shown = run([str(program), "inspect", str(path), "--machine", "mcfv5050ln", "--axis", "X"])
    finally:
        path.unlink(missing_ok=True)
    return {"bytes": size, "samples": samples, "status": status, "seconds": round(seconds, 1), "resident_bytes": memory,
            "progress": sum("%" in part for part in shown.replace("\n", "\r").split("\r")), "message": shown[-200:]}


def lines(found):
    """Rows of the campaign's table."""
    if not found:
        return []
    verdict = "" if found["status"] == 0 else f"; exit {found['status']}: {found['message'].strip()}"
    return [("CSV of 200 MB, resident memory of inspect (1024 MiB)",
             f"{found['resident_bytes'] / 2**20:.0f} MiB, {found['seconds']} s, {found['bytes'] / 1e6:.0f} MB, "
             f"{found['samples']} samples, progress drawn {found['progress']} times{verdict}")]


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("folder")
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/stiction"))
    parser.add_argument("--megabytes", type=float, default=200)
    options = parser.parse_args()
    found = measure(options.program, options.folder, options.megabytes)
    for title, text in lines(found):
        print(f"{title:60} {text}")
    sys.exit(0 if found["status"] == 0 and found["resident_bytes"] <= LARGEST and found["progress"] else 1)


if __name__ == "__main__":
    main()
