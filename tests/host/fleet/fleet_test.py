#!/usr/bin/env python3
"""A small fleet as its users run it: a growing friction that is found, a broken record, results that are kept, and what
is refused.

usage: fleet_test.py STICTION SCHEMA
"""

import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import jsonschema
import numpy

STICTION, SCHEMA = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "fleet"))

import fleet_records  # noqa: E402

MONTHS = 6


class Fleet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = pathlib.Path(tempfile.mkdtemp(prefix="stiction-fleet-"))
        # Four axes, the second with a friction that grows by 8 % a month from the fourth month on.
        fleet_records.write_fleet(STICTION, cls.made, 4, MONTHS, 5, drifting=1, begin=3, drift=0.08, missing=0.0)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.made, True)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="stiction-fleet-"))
        self.addCleanup(shutil.rmtree, self.folder, True)

    def fleet(self, listed, *more, out="out"):
        return subprocess.run([STICTION, "fleet", listed, "--out", self.folder / out, *more], capture_output=True,
                              text=True, check=False, cwd=self.folder)

    def rows(self):
        with open(self.made / "fleet.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        return [rows[0], *([*row[:3], str(self.made / row[3])] for row in rows[1:])]

    def listed(self, rows, name="fleet.csv"):
        with open(self.folder / name, "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(rows)
        return name

    def refusal(self, rows):
        done = self.fleet(self.listed(rows), "--no-diagnosis", out="refused")
        self.assertEqual(done.returncode, 2, done.stdout)
        return done.stderr

    def test_finds_the_growing_friction_and_keeps_what_it_has_judged(self):
        rows = self.rows()
        first = self.fleet(self.listed(rows[:-3]), "--no-diagnosis", "--threads", "1")
        self.assertEqual((first.returncode, first.stderr), (0, ""))
        state = self.folder / "out" / ".fleet" / "records.jsonl"
        self.assertEqual(len(state.read_text().splitlines()), 4 * MONTHS - 3)
        # As a kill leaves it: half of a line.
        with open(state, "a", encoding="utf-8") as file:
            file.write('{"values": [')
        broken = [["axis 03", "emps", "2030-01-01", "missing.csv"], ["axis 04", "emps", "2030-02-01", "still.csv"]]
        still = "t[s],X.x[m],X.u[V]\n" + "".join(f"{k / 1000},0,0.1\n" for k in range(4000))
        (self.folder / "still.csv").write_text(still, encoding="utf-8")
        done = self.fleet(self.listed(rows + broken), "--no-diagnosis", "--threads", "2", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        summary = json.loads(done.stdout)
        jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(summary)
        keys = [json.loads(line)["key"] for line in state.read_text().splitlines() if line.startswith('{"values":[')]
        self.assertEqual(len(keys), len(set(keys)))  # none twice
        self.assertEqual(len(keys), 4 * MONTHS + 1)  # a log that is not there is looked for each time
        self.assertEqual([each["log"] for each in summary["broken"]], ["missing.csv", "still.csv"])
        self.assertTrue(all(each["message"] for each in summary["broken"]))
        worst = summary["axes"][0]
        self.assertEqual((worst["axis"], worst["alarmed"]), ("axis 02", True))
        coulomb = {each["parameter"]: each for each in worst["parameters"]}["coulomb"]
        self.assertEqual(coulomb["alarm"]["direction"], "up")
        self.assertIn(coulomb["alarm"]["date"], [fleet_records.date_of(k) for k in (3, 4, 5)])
        self.assertGreater(coulomb["per_month_low"], 0.0)
        # The same results in one go, from the other number of threads.
        again = self.fleet(self.listed(rows + broken), "--no-diagnosis", "--threads", "1", "--json", out="again")
        self.assertEqual(again.stdout, done.stdout)
        for name in ("fleet.csv", "fleet.npz", "fleet.json"):
            self.assertEqual((self.folder / "out" / name).read_bytes(), (self.folder / "again" / name).read_bytes())
        page = (self.folder / "out" / "report.html").read_text(encoding="utf-8")
        self.assertIn("Fleet: 4 axes", page)
        with numpy.load(self.folder / "out" / "fleet.npz", allow_pickle=False) as table:
            self.assertEqual(len(table["value"]), 4 * (4 * MONTHS) + 2)
            mass = table["value"][(table["axis"] == "axis 01") & (table["parameter"] == "mass")]
            self.assertEqual(len(mass), MONTHS)
            truth = fleet_records.Truth(5, 0)
            self.assertLess(abs(mass.mean() / truth.mass - 1.0), 0.01)

    def test_lists_logs_of_other_machines_as_broken(self):
        rows = self.rows()[:3]
        text = pathlib.Path(rows[1][3]).read_text(encoding="utf-8")
        (self.folder / "other.csv").write_text("# machine: mcfv5050ln\n" + text, encoding="utf-8")
        heavy = text.splitlines()
        # Three times the motor's signal is three times the mass.
        moved = [heavy[0]] + [",".join([*line.split(",")[:-1], repr(3.0 * float(line.split(",")[-1]))])
                              for line in heavy[1:]]
        (self.folder / "heavy.csv").write_text("\n".join(moved) + "\n", encoding="utf-8")
        rows += [["axis 01", "emps", "2030-01-01", "other.csv"], ["axis 01", "emps", "2030-02-01", "heavy.csv"]]
        done = self.fleet(self.listed(rows), "--json", "--no-diagnosis")
        self.assertEqual(done.returncode, 0, done.stderr)
        messages = [each["message"] for each in json.loads(done.stdout)["broken"]]
        self.assertEqual(len(messages), 2)
        self.assertIn("other.csv: found a log of the machine mcfv5050ln; expected one of emps", messages[0])
        self.assertIn("is it a log of a different machine?", messages[1])

    def test_judges_logs_of_the_simulations_of_linear_and_rotary_machines(self):
        rows = [["axis", "machine", "date", "log", "machine_axis"]]
        for machine, axis in (("mcfv5050ln", "X"), ("servo-joint", "J")):
            made = subprocess.run([STICTION, "simulate", "commissioning", "--machine", machine, "--axis", axis, "--out",
                                   self.folder / machine], capture_output=True, text=True, check=False)
            self.assertEqual(made.returncode, 0, made.stderr)
            rows.append([machine, machine, "2026-01-01", f"{machine}/speeds.csv", axis])
            rows.append([machine, machine, "2026-02-01", f"{machine}/other-speeds.csv", axis])
        done = self.fleet(self.listed(rows), "--json", "--no-diagnosis")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["broken"], [])
        table = (self.folder / "out" / "fleet.csv").read_text(encoding="utf-8")
        for unit in ("mass,kg,", "mass,kg m^2,", "coulomb,N,", "coulomb,N m,"):
            self.assertEqual(table.count(unit), 2, unit)

    def test_refuses_lists_that_are_wrong(self):
        head = ["axis", "machine", "date", "log"]
        self.assertIn("no such machine", self.refusal([head, ["a", "nothing", "2026-01-01", "a.csv"]]))
        self.assertIn("second record of axis a on 2026-01-01",
                      self.refusal([head, ["a", "emps", "2026-01-01", "a.csv"], ["a", "emps", "2026-01-01", "b.csv"]]))
        self.assertIn("machine_axis 'Q' of a; expected an axis of emps: X",
                      self.refusal([head + ["machine_axis"], ["a", "emps", "2026-01-01", "a.csv", "Q"]]))
        self.assertIn("found no machine_axis of a, and mcfv5050ln has 2 axes",
                      self.refusal([head, ["a", "mcfv5050ln", "2026-01-01", "a.csv"]]))
        (self.folder / "full").mkdir()
        (self.folder / "full" / "mine.txt").write_text("mine", encoding="utf-8")
        done = self.fleet(self.listed([head, ["a", "emps", "2026-01-01", "a.csv"]]), out="full")
        self.assertIn("found files that are no results of a fleet", done.stderr)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(self.fleet("fleet.csv", "--false-alarms", "2").returncode, 2)
        self.assertEqual(self.fleet("fleet.csv", "--full", "--no-diagnosis").returncode, 2)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    unittest.main(argv=sys.argv[:1])
