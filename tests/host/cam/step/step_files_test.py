#!/usr/bin/env python3
"""The files of `stiction cam step` by other people's code: drawings through ezdxf against a profile that is cut here, by
discs against rays, and tables with their checksums.

usage: step_files_test.py STICTION PROJECT      status 77: ezdxf is not installed (Debian: python3-ezdxf)
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

try:
    import ezdxf
    import ezdxf.path
except ImportError:
    print("step_files_test: ezdxf is missing, so no drawing is read back; install python3-ezdxf")
    sys.exit(77)

from ray_profile import make, off_profile, radius, stated_checksum

CHORD = 1e-3  # mm, that is asked for
LAYERS = {"CAM_1", "CAM_2", "PITCH_1", "PITCH_2", "ROLLERS_1", "ROLLERS_2", "ZERO_PIN", "NOTES"}


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
        # A prime stride, so that not all of them are nodes of the curves.
        worst = max(worst, off_profile(row, points[(np.arange(50) * 7919) % len(points)]))
    assert worst <= CHORD, f"{file.name}: {worst} mm from the profile; expected at most {CHORD} mm"
    return worst


def main():
    stiction, project = sys.argv[1], pathlib.Path(sys.argv[2])
    text = project.read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, options in (("bare", []), ("step", ["--columns", "angle, x, y, wheel_radius", "--separator", ";",
                                                        "--decimal", ","])):
            made = make(stiction, project, folder, name, name == "bare", options)
            result = json.loads((made / "result.json").read_text(encoding="utf-8"))
            assert len(result["files"]) == 6
            for each in result["files"]:
                assert stated_checksum(made / each["name"]) == each["crc32"]
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
