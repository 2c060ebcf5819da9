#!/usr/bin/python3
"""The table of docs/cam.md that compares the classic with the electronic cam: is it what the programme says?

usage: classic_cam_table.py --stiction PROGRAMME [--write] PAGE
  Each row of the table in PAGE is run anew by its first four cells; --write puts what comes out into the page.
"""

import argparse
import difflib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

COLUMNS = ["speed", "stroke", "inertia of the load", "shaft", "M_D", "classic: M_H, power", "electronic: motor, power",
           "reserve", "highest speed", "residual"]
HEAD = "| " + " | ".join(COLUMNS) + " |"
MACHINE = "servo-joint"
# A shaft's damping hardly moves its own frequency.
DAMPING_RATIO = "0.01"


def motion(stroke):
    """A rise and a return of 120 degrees each, 60 degrees of rest behind each."""
    rest = '[[cam.dial.segment]]\nlength = "60 deg"\n'
    move = '[[cam.dial.segment]]\nlength = "120 deg"\nstroke = "{} deg"\nlaw = "modified sine"\n'
    return ('schema = "stiction.cam/1"\n[cam.dial]\ncycle = "360 deg"\n' + move.format(stroke) + rest +
            move.format(-stroke) + rest)


def run(programme, *arguments):
    """The JSON of a command; a broken limit is no error here."""
    ran = subprocess.run([programme, "cam", *arguments, "--json"], capture_output=True, text=True, check=False)
    if not ran.stdout:
        raise SystemExit(f"{' '.join(arguments)}: found {ran.stderr.strip()}; expected JSON")
    return json.loads(ran.stdout)


def figures(programme, folder, cells):
    """The cells of a row behind its first four."""
    speed, stroke, inertia, shaft = cells
    file = folder / "dial.toml"
    file.write_text(motion(int(stroke.rstrip("°"))), encoding="utf-8")
    machine = ["--machine", MACHINE, "--speed", speed, "--set", f"axis.J.inertia={inertia.replace('²', '^2')}"]
    if shaft != "stiff":
        stiffness = float(re.fullmatch(r"([\d.]+) kN m/rad", shaft).group(1))
        machine += ["--set", f"axis.J.transmission.stiffness={1e3 * stiffness:g} N m/rad",
                    "--set", f"axis.J.transmission.damping_ratio={DAMPING_RATIO}"]
    found = run(programme, "design", str(file), *machine)["results"]
    limits = run(programme, "check", str(file), *machine)["cams"][0]["at_speed"]["limits"]
    first = min((x for x in limits if x["highest_speed"]), key=lambda x: x["highest_speed"])
    rpm = first["highest_speed"] * 60 / 6.283185307179586
    residual = found.get("residual_deg")
    return [f"{found['output_N_m']:.3g} N m",
            f"{found['classic_cam_N_m']:.3g} N m, {found['classic_cam_power_W']:.3g} W",
            f"{found['motor_N_m']:.3g} N m, {found['motor_power_W']:.3g} W",
            f"{found['motor_reserve_percent']:.1f} %", f"{rpm:.1f} rpm ({first['limit']})",
            "–" if residual is None else f"{1e3 * residual:.2f} m°"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("--stiction", required=True)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("page", type=pathlib.Path)
    options = parser.parse_args()
    lines = options.page.read_text(encoding="utf-8").split("\n")
    if HEAD not in lines:
        raise SystemExit(f"{options.page}: found no line {HEAD!r}; expected the table below it")
    made = list(lines)
    row = lines.index(HEAD) + 2
    with tempfile.TemporaryDirectory() as folder:
        while lines[row].startswith("|"):
            cells = [cell.strip() for cell in lines[row].strip("|").split("|")][:4]
            made[row] = "| " + " | ".join(cells + figures(options.stiction, pathlib.Path(folder), cells)) + " |"
            row += 1
    if options.write:
        options.page.write_text("\n".join(made), encoding="utf-8")
        return 0
    for line in difflib.unified_diff(lines, made, str(options.page), "what the programme says", lineterm="", n=0):
        print(line)
    return int(lines != made)


if __name__ == "__main__":
    sys.exit(main())
