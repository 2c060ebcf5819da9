"""The cams of examples/cams/step_cam.toml without relief, cut by discs against rays and apart from the programme, and what is
common to the tests of files for a shop.
"""

import functools
import re
import subprocess
import zlib

import numpy as np

A, B, C, ROLLERS = 105.0, 52.0, 13.0, 4


def modified_sine(x):
    """The unit law (Norton's handbook)."""
    x = np.clip(x, 0.0, 1.0)
    pi = np.pi
    first = pi * x - np.sin(4 * pi * x) / 4
    middle = 2 + pi * x - 9 / 4 * np.sin(pi / 3 + 4 * pi * x / 3)
    last = 4 + pi * x - np.sin(4 * pi * x) / 4
    return np.where(x < 1 / 8, first, np.where(x < 7 / 8, middle, last)) / (pi + 4)


@functools.lru_cache
def centres(row):
    """Those of each roller over a turn, where it is near the cam."""
    psi = np.linspace(0, 2 * np.pi, 9001)
    way = np.pi / 2 * modified_sine((psi - np.pi / 2) / np.pi)
    arms = [np.pi / 8 * (1 if row == 1 else -1) + roller * np.pi / 2 - way for roller in range(ROLLERS)]
    return [np.exp(1j * psi) * (A - B * np.exp(-1j * v)) for v in arms]


def radius(row, angle):
    """What all discs of a turn leave of the ray at `angle`, rad, in mm."""
    least = np.inf
    for centre in centres(row):
        turned = centre * np.exp(-1j * angle)
        inside = C * C - turned.imag**2
        entry = np.where((inside > 0) & (turned.real > 0), turned.real - np.sqrt(np.maximum(inside, 0)), np.inf)
        k = int(np.argmin(entry))
        best = entry[k]
        if 0 < k < len(entry) - 1 and np.isfinite(entry[k - 1]) and np.isfinite(entry[k + 1]):
            bend = entry[k - 1] - 2 * best + entry[k + 1]
            if bend > 0:
                best -= (entry[k + 1] - entry[k - 1]) ** 2 / (8 * bend)
        least = min(least, best)
    return least


@functools.lru_cache
def corner(row):
    """The angle of the corner of that cam, where the radius is the largest."""
    angles = np.radians(np.linspace(205, 220, 151)) * (1 if row == 1 else -1)
    return angles[int(np.argmax([radius(row, a) for a in angles]))]


def off_profile(row, points):
    """The largest distance of points (complex, mm) from that cam, but beside its corner, in mm."""
    worst, peak = 0.0, corner(row)
    for point in points:
        angle = np.angle(point)
        if abs(np.angle(np.exp(1j * (angle - peak)))) < np.radians(0.2):
            continue
        # The distance along the ray is more than the one to the profile.
        off = abs(abs(point) - radius(row, angle))
        slope = (radius(row, angle + 1e-4) - radius(row, angle - 1e-4)) / 2e-4 / abs(point)
        worst = max(worst, off / np.hypot(1.0, slope))
    return worst


def stated_checksum(file):
    """That of a file, after it was compared with the CRC-32 of its other lines."""
    lines = file.read_bytes().splitlines(keepends=True)
    stated = {match.group(1).decode() for match in (
        re.search(rb"CRC-32 of the other lines: ([0-9a-f]{8})", line) for line in lines) if match}
    others = b"".join(line for line in lines if b"CRC-32" not in line)
    assert stated == {f"{zlib.crc32(others):08x}"}, file.name
    return stated.pop()


def make(stiction, project, folder, name, bare=False, options=()):
    """Writes the files of the project into the folder NAME of `folder`; without relief, which discs know nothing of, when
    it is to be bare."""
    text = project.read_text(encoding="utf-8")
    if bare:
        text = re.sub(r"\[relief\](\n[^\[]+)", "", text)
    (folder / "quarter_turn.toml").write_bytes((project.parent / "quarter_turn.toml").read_bytes())
    (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    done = subprocess.run([stiction, "cam", "step", f"{name}.toml", "--out", name, *options], cwd=folder,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder / name
