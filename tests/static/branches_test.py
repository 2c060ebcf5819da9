#!/usr/bin/env python3
"""Gives branches.py counts as llvm-cov exports them, and expects the branches that they mean."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "toolchain" / "suites"))
import branches  # noqa: E402

SOURCE = """template <class T>
int sign(T x) {
  if (x < 0) return -1;
  return 1;
}
bool operator==(const A&, const A&) = default;
"""
CONDITION = (3, 7, 3, 12)


class Branches(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / branches.ROOT / "number/sign.hpp"
        self.file.parent.mkdir(parents=True)
        self.file.write_text(SOURCE, encoding="utf-8")

    def instantiation(self, runs, true, false):
        return {"filenames": [str(self.file)], "count": runs,
                "regions": [[2, 15, 5, 2, runs, 0, 0, branches.CODE], [3, 14, 3, 23, true, 0, 0, branches.CODE]],
                "branches": [[*CONDITION, true, false, 0, 0, 4]]}

    def taken(self, *functions):
        found = branches.branches_of(functions, branches.Sources())
        return {(place.text, outcome): is_taken for (place, outcome), is_taken in found.items()}

    def test_counts_both_outcomes_of_a_condition(self):
        self.assertEqual(self.taken(self.instantiation(5, 5, 0)), {("x < 0", "true"): True, ("x < 0", "false"): False})

    def test_takes_a_template_once_over_its_instantiations(self):
        self.assertEqual(self.taken(self.instantiation(5, 5, 0), self.instantiation(2, 0, 2)),
                         {("x < 0", "true"): True, ("x < 0", "false"): True})

    def test_leaves_out_what_is_known_at_compile_time(self):
        self.assertEqual(self.taken(self.instantiation(5, 0, 0)), {})
        self.assertEqual(self.taken(self.instantiation(5, 0, 0), self.instantiation(0, 0, 0)), {})

    def test_keeps_what_only_one_instantiation_knows_at_compile_time(self):
        self.assertEqual(self.taken(self.instantiation(5, 0, 0), self.instantiation(2, 0, 2)),
                         {("x < 0", "true"): False, ("x < 0", "false"): True})

    def test_reports_a_function_that_never_runs(self):
        self.assertIn(("int sign(T x)", "never runs"), self.taken(self.instantiation(0, 0, 0)))

    def test_leaves_out_what_the_compiler_wrote(self):
        comparison = self.instantiation(1, 0, 0) | {"branches": [[6, 45, 6, 46, 1, 0, 0, 0, 4]]}
        self.assertEqual(self.taken(comparison), {})

    def judge(self, reasons, least=0.0):
        found = branches.branches_of([self.instantiation(5, 5, 0)], branches.Sources())
        return branches.judge(found, reasons, least)

    def test_asks_for_a_reason(self):
        lines, well = self.judge({})
        self.assertFalse(well)
        self.assertIn("number/sign.hpp:3: `x < 0` is never false: NO REASON", lines[0])

    def test_takes_a_reason(self):
        self.assertTrue(self.judge({("number/sign.hpp", "x < 0", "false"): "no such number"})[1])

    def test_refuses_a_reason_without_its_branch(self):
        self.assertFalse(self.judge({("number/sign.hpp", "x < 0", "false"): "no such number",
                                     ("number/sign.hpp", "x < 0", "true"): "out of date"})[1])

    def test_refuses_too_small_a_share(self):
        self.assertFalse(self.judge({("number/sign.hpp", "x < 0", "false"): "no such number"}, 95.0)[1])


if __name__ == "__main__":
    unittest.main()
