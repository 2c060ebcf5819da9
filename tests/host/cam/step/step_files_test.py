#!/usr/bin/env python3
"""The files of `stiction cam step` by other people's code: drawings through ezdxf against a profile that is cut here, by
discs against rays, and tables with their checksums.

usage: step_files_test.py STICTION PROJECT      status 77: ezdxf is not installed (Debian: python3-ezdxf)
"""

import functools
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import zlib

import numpy as np

try:
    import ezdxf
    import ezdxf.path
except ImportError:
    print("step_files_test: ezdxf is missing, so no drawing is read back; install python3-ezdxf")
    sys.exit(77)

CHORD = 1e-3  # mm, that is asked for
A, B, C, ROLLERS = 105.0, 52.0, 13.0, 4
LAYERS = {"CAM_1", "CAM_2", "PITCH_1", "PITCH_2", "ROLLERS_1", "ROLLERS_2", "ZERO_PIN", "NOTES"}


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


def arc_points(arc):
    """Points of an arc or a line of a drawing, from its start; ezdxf's own paths make cubic curves of arcs."""
    if arc.dxftype() == "LINE":
        return [complex(*arc.dxf.start.vec2), complex(*arc.dxf.end.vec2)]
    begin, end = arc.dxf.start_angle, arc.dxf.end_angle
    angles = np.radians(begin + (end - begin) % 360 * np.linspace(0, 1, 17))
    return complex(*arc.dxf.center.vec2) + arc.dxf.radius * np.exp(1j * angles)


def outline(drawing, layer):
    """The curves of a layer, each as points."""
    curves = []
    for entity in drawing.modelspace().query(f'*[layer=="{layer}"]'):
        if entity.dxftype() == "POLYLINE":
            assert entity.is_closed
            curves += [np.array(arc_points(arc)) for arc in entity.virtual_entities()]
            continue
        path = ezdxf.path.make_path(entity)
        curves.append(np.array([p.x + 1j * p.y for p in path.flattening(2e-5, segments=16)]))
    return curves


def check_drawing(file, version):
    drawing = ezdxf.readfile(file)
    assert drawing.dxfversion == version, drawing.dxfversion
    assert not drawing.audit().errors
    found = {entity.dxf.layer for entity in drawing.modelspace()}
    assert found == LAYERS, found
    worst = 0.0
    for row in (1, 2):
        curves = outline(drawing, f"CAM_{row}")
        ends = [p for curve in curves for p in (curve[0], curve[-1])]
        for p in ends:
            others = [q for q in ends if q is not p]
            assert min(abs(p - q) for q in others) < 1e-6, "an outline that does not close"
        points = np.concatenate(curves)
        peak = corner(row)
        # A prime stride, so that not all of them are nodes of the curves.
        for point in points[(np.arange(50) * 7919) % len(points)]:
            angle = np.angle(point)
            if abs(np.angle(np.exp(1j * (angle - peak)))) < np.radians(0.2):
                continue
            # The distance along the ray is more than the one to the profile.
            off = abs(abs(point) - radius(row, angle))
            slope = (radius(row, angle + 1e-4) - radius(row, angle - 1e-4)) / 2e-4 / abs(point)
            worst = max(worst, off / np.hypot(1.0, slope))
    assert worst <= CHORD, f"{file.name}: {worst} mm from the profile; expected at most {CHORD} mm"
    return worst


def check_checksum(file):
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    stated = [re.search(r"CRC-32 of the other lines: ([0-9a-f]{8})", line) for line in lines]
    stated = {match.group(1) for match in stated if match}
    others = "".join(line for line in lines if "CRC-32" not in line).encode()
    assert stated == {f"{zlib.crc32(others):08x}"}, file.name
    return stated.pop()


def main():
    stiction, project = sys.argv[1], pathlib.Path(sys.argv[2])
    text = project.read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "quarter_turn.toml").write_bytes((project.parent / "quarter_turn.toml").read_bytes())
        # Without relief, which the discs know nothing of.
        (folder / "bare.toml").write_text(re.sub(r"\[relief\](\n[^\[]+)", "", text), encoding="utf-8")
        (folder / "step.toml").write_text(text, encoding="utf-8")
        for name, options in (("bare", []), ("step", ["--columns", "angle, x, y, wheel_radius", "--separator", ";",
                                                        "--decimal", ","])):
            done = subprocess.run([stiction, "cam", "step", f"{name}.toml", "--out", name, *options], cwd=folder,
                                  capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            result = json.loads((folder / name / "result.json").read_text(encoding="utf-8"))
            assert len(result["files"]) == 6
            for made in result["files"]:
                assert check_checksum(folder / name / made["name"]) == made["crc32"]
        (folder / "odd.toml").write_text(text.replace("rollers = 4", "rollers = 6"), encoding="utf-8")
        done = subprocess.run([stiction, "cam", "step", "odd.toml", "--out", "odd"], cwd=folder, capture_output=True, text=True)
        assert done.returncode == 2 and "odd.toml: found a stroke of 90" in done.stderr, done.stderr
        assert not (folder / "odd").exists()
        worst = [check_drawing(folder / "bare" / "cams_r12.dxf", "AC1009"),
                 check_drawing(folder / "bare" / "cams_r2000.dxf", "AC1015")]
        rows = [line for line in (folder / "step/cam_1.csv").read_text(encoding="utf-8").splitlines()
                if not line.startswith("#")]
        assert rows[0] == "angle deg;x mm;y mm;wheel_radius mm", rows[0]
        assert len(rows) == 3601
        angle, x, y, wheel = (float(cell.replace(",", ".")) for cell in rows[1].split(";"))
        assert angle == 0.0 and abs(np.hypot(x, y) - radius(1, 0.0)) < 1e-5
        assert abs(wheel - np.hypot(x, y) - 12.0) < 1e-5  # the dwell is a circle
        limits = [line.split(";") for line in (folder / "step/inspection_2.csv").read_text(encoding="utf-8").splitlines()
                  if not line.startswith("#")][1:]
        assert all(float(low.replace(",", ".")) < float(mid.replace(",", ".")) < float(high.replace(",", "."))
                   for _, mid, low, high, _ in limits)
        print("distance of the drawings from the profile:", ", ".join(f"{1e3 * w:.3f} um" for w in worst))


main()
