#!/usr/bin/env python3
"""Gives failed_tests.py results as ctest writes them, and expects the names and the ends of the outputs."""

import pathlib
import sys
import unittest
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "toolchain" / "suites"))
import failed_tests  # noqa: E402


def case(name, status, output=""):
    failure = f'<skipped message="{output}"/>' if status == "notrun" else ""
    return f'<testcase name="{name}" time="1.25" status="{status}">{failure}<system-out>{output}</system-out></testcase>'


def report(*cases, lines=60):
    return failed_tests.report(xml.etree.ElementTree.fromstring(f"<testsuite>{''.join(cases)}</testsuite>"), lines)


class FailedTests(unittest.TestCase):
    def test_says_nothing_when_all_passed(self):
        self.assertEqual(report(case("A.One", "run"), case("A.Two", "notrun", "SKIP_REGULAR_EXPRESSION_MATCHED")), [])

    def test_names_what_failed_and_shows_its_output(self):
        self.assertEqual(report(case("A.One", "run"), case("A.Two", "fail", "1 is not 2\n")),
                         ["FAILED A.Two after 1.2 s", "  1 is not 2", "1 of 2 tests failed: A.Two"])

    def test_counts_what_could_not_be_run(self):
        self.assertEqual(report(case("A.One", "notrun", "Fixture dependency failed"))[-1], "1 of 1 tests failed: A.One")

    def test_shows_the_end_of_a_long_output(self):
        lines = report(case("A.One", "fail", "\n".join(map(str, range(1000)))), lines=10)
        self.assertEqual(lines[1], "  (990 lines before these)")
        self.assertEqual(lines[2], "  990")
        self.assertEqual(len(lines), 13)

    def test_names_all_though_it_shows_only_as_many_as_fit(self):
        lines = report(*(case(f"A.{i}", "fail", "x") for i in range(100)), lines=80)
        self.assertLess(len(lines), 30)
        self.assertTrue(lines[-1].endswith("A.98, A.99"))


if __name__ == "__main__":
    unittest.main()
