#!/usr/bin/env python3
"""The rules of the campaign's table: what is missing is never a success."""

import sys
import unittest

import judge
import table


def row(**changes):
    parameter = {"true": 100.0, "bound": 1.0, "identifiable": True, "value": 101.0, "ci95": [99.0, 103.0]}
    made = {"name": "r", "cell": ["emps.X", 100, 1e-6], "kind": "circle", "fault": "none", "law": "coulomb", "status": 0,
            "set_points": True, "message": "", "not_determined": [], "questions": None, "seed": [1, 0, 100, 1000, 0, 0],
            "held_out_force_ratio": judge.NOT_OFFERED, "cutoff_scan": judge.NOT_OFFERED,
            "parameters": {"mass_kg": dict(parameter)}}
    made["parameters"]["mass_kg"] |= changes.pop("mass", {})
    return made | changes


def text_of(lines, title):
    return next(text for name, text in lines if name.startswith(title))


class Table(unittest.TestCase):
    def test_refused_record_is_not_returned(self):
        refused = row(status=2, message="a.csv:3: found a step", mass={"value": None, "ci95": None})
        lines = table.whole({"sound": [row(), refused]})
        self.assertTrue(text_of(lines, "identifiable but not returned").startswith("1 of 2"))
        self.assertTrue(text_of(lines, "95 % intervals cover, identifiable").startswith("1 of 1"))

    def test_value_without_an_interval_is_not_returned(self):
        lines = table.whole({"sound": [row(mass={"ci95": None})]})
        self.assertTrue(text_of(lines, "identifiable but not returned").startswith("1 of 1"))

    def test_missing_keys_are_not_offered(self):
        lines = table.whole({"sound": [row(inspect={"questions": judge.NOT_OFFERED})], "faulty": [row(fault="rms")]})
        for title in ("false questions on sound records, inspect", "error of mass at the chosen cut-off", "held-out force",
                      "  rms asked, inspect"):
            self.assertIn("not offered", text_of(lines, title))

    def test_refused_faulty_record_has_not_been_asked(self):
        asked = row(fault="sign", questions=["sign"], inspect={"questions": ["sign"]})
        refused = row(fault="sign", status=2, questions=None, inspect={"questions": None})
        lines = table.whole({"sound": [], "faulty": [asked, refused]})
        self.assertTrue(text_of(lines, "  sign asked, identify").startswith("1 of 2"))

    def test_negative_mass_is_counted_as_nonsense(self):
        lines = table.whole({"sound": [row(mass={"value": -3.0})]})
        self.assertTrue(text_of(lines, "negative mass").startswith("1 of 1"))

    def test_chosen_cutoff_is_judged_against_the_best_common_one(self):
        scan = [{"cutoff_Hz": 10, "mass_kg": 104.0}, {"cutoff_Hz": 20, "mass_kg": 100.5}]
        lines = table.whole({"sound": [row(cutoff_scan=scan)]})
        self.assertTrue(text_of(lines, "error of mass at the chosen cut-off").startswith("2.00 "))

    def test_bias_is_that_of_the_coarsest_encoder_that_identifies(self):
        fine, coarse = row(mass={"value": 101.0}), row(mass={"value": 110.0}, cell=["emps.X", 100, 1e-5])
        beyond = row(mass={"value": 150.0, "identifiable": False}, cell=["emps.X", 100, 1e-4])
        lines = table.whole({"sound": [fine, coarse, beyond]})
        self.assertIn("+10.00 %", text_of(lines, "  emps.X 100 Hz, 10 um"))

    def test_question_in_an_axis_of_inspect_is_found(self):
        self.assertEqual(judge.questions_in({"axes": [{"questions": [{"about": "length"}]}]}), ["length"])
        self.assertEqual(judge.questions_in({"axes": [{"questions": []}]}), [])
        self.assertIsNone(judge.questions_in({"axes": [{}]}))


if __name__ == "__main__":
    sys.exit(unittest.main())
