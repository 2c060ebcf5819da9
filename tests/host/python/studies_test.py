"""The studies at a small size: they run as their users run them, and show what they say.

usage: studies_test.py STUDIES FOLDER     FOLDER: has the package
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

STUDIES, FOLDER = Path(sys.argv[1]), sys.argv[2]


def run(study, *arguments):
    """The table of a study, of which the picture is SVG with a curve for each column."""
    with tempfile.TemporaryDirectory(prefix="stiction-study-") as folder:
        subprocess.run([sys.executable, "-B", STUDIES / f"{study}.py", folder, *arguments], check=True,
                       capture_output=True, env={**os.environ, "PYTHONPATH": FOLDER})
        table = (Path(folder) / f"{study}.txt").read_text(encoding="utf-8")
        picture = xml.etree.ElementTree.parse(Path(folder) / f"{study}.svg")
        return table, len(picture.findall(".//{http://www.w3.org/2000/svg}polyline"))


class Studies(unittest.TestCase):
    def test_quadrant_error_grows_with_static_friction(self):
        table, curves = run("stribeck", "--ratios", "1,3", "--feeds", "3.2 m/min")
        rows = [list(map(float, line.split())) for line in table.splitlines() if re.match(r"\s*\d", line)]
        self.assertEqual([ratio for ratio, _ in rows], [1.0, 3.0])
        self.assertGreater(rows[1][1], 1.02 * rows[0][1])
        self.assertEqual(curves, 1)

    def test_parameters_of_a_simulated_record_come_back(self):
        table, curves = run("emps", "--shares", "0.5,1")
        lines = table.splitlines()
        found = [float(cell) for cell in re.sub(r"\[.*?\]", "", lines[-2]).split()[1:]]
        source = [float(cell) for cell in lines[-1].split()[1:]]
        self.assertEqual(len(found), 3)
        self.assertEqual(curves, 3)
        self.assertLess(abs(found[0] / source[0] - 1.0), 0.05)  # the mass

    def test_fleet_finds_the_axis_whose_friction_grows(self):
        table, curves = run("fleet", "--axes", "3", "--months", "6", "--growth", "0.1")
        alarms = {line[:6]: line for line in table.splitlines() if line.startswith("axis ")}
        self.assertEqual(curves, 3)
        self.assertRegex(alarms["axis 2"], r"coulomb up on 2024-0[3456]-01")
        for quiet in ("axis 1", "axis 3"):
            self.assertTrue(alarms[quiet].endswith("none"), table)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
