#!/usr/bin/env python3
"""Gives the results machinery claims and printed lines, and expects what it says of them."""

import contextlib
import io
import json
import pathlib
import tempfile
import unittest
from unittest import mock

import scipy.stats

import campaigns
import commands
import kept as store
import page
import results
from claims import ClaimError, Row, Section, read_claims

SOURCES = {"plain": {"command": "toolchain/test", "compared": True, "all": True},
           "proof": {"command": "build/release/bin/proof"}}
BASE = {"key": "error", "what": "largest error", "source": "plain", "figure": "circle: error", "unit": "um",
        "bound": "≤ 2 um", "test": "Circle.IsRound"}
WIDE = {"key": "faults", "what": "faults", "source": "plain", "figure": "* ticks to detection", "value": "{n}, {max1} ticks",
        "take": r"(\d+) ticks", "unit": "ticks", "bound": "all", "test": "Fault"}


def row(**changes):
    return Row({key: value for key, value in (BASE | changes).items() if value is not None}, SOURCES)


class Claims(unittest.TestCase):
    def test_without_bound_unit_or_command_are_refused_by_name(self):
        for key in ("bound", "unit", "what"):
            with self.assertRaisesRegex(ClaimError, f"'error': '{key}' is missing"):
                row(**{key: None})
        with self.assertRaisesRegex(ClaimError, "no 'command' and no 'test'"):
            row(test=None)

    def test_with_a_value_that_lacks_its_unit_or_an_unknown_key_or_source_are_refused(self):
        with self.assertRaisesRegex(ClaimError, "does not hold its unit"):
            row(value="{1} mm")
        with self.assertRaisesRegex(ClaimError, "unknown colour"):
            row(colour="red")
        with self.assertRaisesRegex(ClaimError, "unknown source 'moon'"):
            row(source="moon")
        with self.assertRaisesRegex(ClaimError, "1 limits for 2 numbers"):
            row(value="{1}, {2} um", limits=["<= 1"])

    def test_of_the_repository_are_complete(self):
        self.assertGreater(sum(len(section.rows) for section in read_claims()), 150)


class Lines(unittest.TestCase):
    def measure(self, rows, *lines, part=False):
        return results.measure(rows, lines, part)

    def test_give_a_row_its_numbers_and_what_no_row_takes_is_named(self):
        values, strange, without = self.measure([row()], "circle: error          1.54 um (bound 2 um)", "square: error  3 um")
        self.assertEqual(values, {"error": ["1.54"]})
        self.assertEqual(strange, ["square: error  3 um"])
        self.assertEqual(without, [])

    def test_belong_to_the_longest_name_that_they_begin_with(self):
        rows = [row(), row(key="late", figure="circle: error when late")]
        values, strange, _ = self.measure(rows, "circle: error  1 um", "circle: error when late  2 um")
        self.assertEqual((values, strange), ({"error": ["1"], "late": ["2"]}, []))

    def test_of_a_pattern_are_counted_and_the_largest_is_taken(self):
        values, strange, _ = self.measure([Row(WIDE, SOURCES)], "bus off   9 ticks to detection", "open   11 ticks to detection")
        self.assertEqual((values, strange), ({"faults": ["2", "11"]}, []))

    def test_that_are_missing_or_say_something_else_are_told(self):
        _, _, without = self.measure([row()])
        self.assertEqual(without, ["row 'error': nothing printed 'circle: error'"])
        _, _, without = self.measure([row(take=r"(\d+) of")], "circle: error  1.5 um")
        self.assertIn("is not in '1.5 um' of 'circle: error'", without[0])
        self.assertEqual(self.measure([row(), Row(WIDE, SOURCES)], "a  1 ticks to detection", part=True)[::2], ({}, []))


class Tolerance(unittest.TestCase):
    def test_is_two_per_cent_or_the_last_digit_and_whole_numbers_are_exact(self):
        self.assertFalse(row().differs("1.54", "1.57"))
        self.assertTrue(row().differs("1.54", "1.58"))
        self.assertTrue(row().differs("1.54", "1.50"))
        self.assertFalse(row().differs("0.03", "0.04"))
        self.assertTrue(row().differs("0.03", "0.05"))
        self.assertTrue(row().differs("38", "39"))
        self.assertFalse(row().differs("2.3e-05", "2.4e-05"))

    def test_of_a_row_is_relative_absolute_or_none(self):
        self.assertFalse(row(tolerance="2 %").differs("1000", "1020"))
        self.assertTrue(row(tolerance="2 %").differs("1000", "979"))
        self.assertTrue(row(tolerance="0.1").differs("4.0", "4.2"))
        self.assertFalse(row(tolerance="none").differs("1", "1000"))
        self.assertTrue(row(tolerance="exact").differs("1.00", "1.01"))
        self.assertTrue(row().differs("all", "some"))


class Compared(unittest.TestCase):
    def compare(self, printed, old, part=False, rows=None):
        said = io.StringIO()
        rows = rows or [row()]
        with mock.patch.object(results, "lines_of", lambda *_: printed), \
             mock.patch.object(results, "rows_of", lambda _: rows), \
             mock.patch.object(results, "read_sources", lambda: SOURCES), \
             mock.patch.object(store, "read", lambda _: {"plain": {"rows": old}}), contextlib.redirect_stdout(said):
            return results.compare("plain", part), said.getvalue()

    def test_with_the_page_a_figure_that_is_the_same_passes(self):
        self.assertEqual(self.compare(["circle: error  1.54 um"], {"error": ["1.54"]})[0], 0)

    def test_a_better_figure_fails_as_a_worse_one_does_and_says_what_to_run(self):
        for value in ("1.40", "1.70"):
            status, said = self.compare([f"circle: error  {value} um"], {"error": ["1.54"]})
            self.assertEqual(status, 1)
            self.assertIn(f"largest error: {value} um, in docs/results.md 1.54 um", said)
            self.assertIn("`toolchain/test --results plain` writes it again", said)

    def test_a_figure_of_no_row_and_a_row_of_no_figure_fail(self):
        status, said = self.compare(["circle: error  1.54 um", "new: figure  1 um"], {"error": ["1.54"]})
        self.assertEqual(status, 1)
        self.assertIn("no row of tests/results/claims/ takes the figure: new: figure  1 um", said)
        self.assertEqual(self.compare([], {"error": ["1.54"]})[0], 1)
        self.assertEqual(self.compare([], {"error": ["1.54"]}, part=True)[0], 0)
        self.assertEqual(self.compare(["circle: error  1.54 um"], {})[0], 1)


class Page(unittest.TestCase):
    def table(self, section, kept, runs=()):
        return page.table_of(section, kept, runs, SOURCES)

    def test_shows_value_bound_and_command_and_marks_what_is_missed(self):
        section = Section({"title": "Circle", "row": [BASE | {"limits": ["<= 1"]}]}, SOURCES)
        lines = self.table(section, {"plain": {"commit": "abc", "date": "2026-01-01", "rows": {"error": ["1.54"]}}})
        self.assertEqual(lines[2], "| largest error | 1.54 um (**missed**) | ≤ 2 um | `toolchain/test -R Circle.IsRound` |")

    def test_shows_the_commit_of_what_is_not_compared(self):
        table = {k: v for k, v in BASE.items() if k != "test"} | {"source": "proof"}
        kept = {"proof": {"commit": "abc", "date": "2026-01-01", "rows": {"error": ["1.54"]}}}
        self.assertIn("abc, 2026-01-01", self.table(Section({"title": "Circle", "row": [table]}, SOURCES), kept)[2])

    def test_shows_cases_interval_commit_and_seeds_of_a_campaign(self):
        claim = {"key": "k", "what": "found", "campaign": "blind", "kind": "one10", "count": "right", "unit": "%",
                 "bound": "≥ 95 %", "limits": [">= 95"], "command": "toolchain/suites/blind 20 1 one10"}
        run = {"campaign": "blind", "kind": "one10", "seed": "1", "cases": 20, "commit": "abc", "date": "2026-01-01",
               "counts": {"right": [18, 20]}}
        line = self.table(Section({"title": "Blind", "row": [claim]}, SOURCES), {}, [run])[2]
        self.assertEqual(line, "| found | 90.0 % (**missed**) | ≥ 95 % | 18 of 20, 69.9 to 97.2 % | "
                               "abc, 2026-01-01, seed 1 | `toolchain/suites/blind 20 1 one10` |")

    def test_that_was_edited_by_hand_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            edited = pathlib.Path(folder) / "results.md"
            for text, status in ((page.render(), 0), (page.render() + "and better\n", 1)):
                edited.write_text(text, encoding="utf-8")
                said = io.StringIO()
                with mock.patch.object(results, "PAGE", edited), contextlib.redirect_stdout(said), \
                     mock.patch.object(commands, "Commands", lambda *_: mock.Mock(missing=lambda _: [])):
                    self.assertEqual(results.check(folder), status)
                self.assertEqual("is not what the kept data make" in said.getvalue(), bool(status))

    def test_writes_no_value_that_nothing_printed(self):
        with self.assertRaisesRegex(ValueError, "'error': nothing printed its value yet"):
            self.table(Section({"title": "Circle", "row": [BASE]}, SOURCES), {})


class Campaigns(unittest.TestCase):
    LOG = ("one at 10 %: the first name is right (exact aliases count)         67 of 69    97.1 % (wanted at least 95 %)\n"
           "  some name is wrong                                                0 of 69     0.0 % \n"
           "held-out gain, one effect, share 10 %                             86.3 % of the oracle's in the mean "
           "(wanted at least 80 %), reached in 50 of 60\n"
           "95 % intervals that cover the true value                          104 of 108   96.3 % (wanted 90 to 98 %)\n")

    def read(self, seed="7", commit="new", dirty=""):
        return campaigns.read_log(seed, self.LOG, lambda *words: dirty if words[0] == "status" else commit)

    def test_are_read_as_counts_and_means(self):
        run, = self.read()
        self.assertEqual((run["kind"], run["cases"], run["commit"]), ("one10", 69, "new"))
        self.assertEqual(run["counts"]["first_right"], [67, 69])
        self.assertEqual(run["counts"]["some_wrong"], [0, 69])
        self.assertEqual(run["means"], {"gain": [86.3, 69], "intervals": [96.3, 69]})

    def test_of_an_engine_without_a_commit_are_not_kept(self):
        with self.assertRaisesRegex(campaigns.NotKept, "changes without a commit"):
            self.read(dirty=" M host/diagnose/diagnose.cpp")

    def test_of_one_engine_are_pooled_and_drop_those_of_the_one_before(self):
        runs = []
        for seed, commit in (("1", "old"), ("2", "new"), ("3", "new")):
            runs, _ = store.add_run(runs, self.read(seed, commit)[0])
        claim = Row({"key": "k", "what": "w", "campaign": "blind", "kind": "one10", "count": "first_right", "unit": "%",
                     "bound": "≥ 95 %", "command": "c"}, SOURCES)
        found = store.pooled(runs, claim)
        self.assertEqual((found["k"], found["n"], found["seeds"], found["commit"]), (134, 138, "2, 3", "new"))

    def test_of_few_cases_do_not_take_the_place_of_many(self):
        runs, _ = store.add_run([], self.read("1", "old")[0])
        few = self.read("2", "new")[0] | {"cases": 5}
        kept, said = store.add_run(runs, few)
        self.assertEqual(kept, runs)
        self.assertIn("not kept, 5 cases in place of 69 of old", said)

    def test_intervals_are_wilsons(self):
        for k, n in ((81, 263), (0, 20), (69, 69)):
            truth = scipy.stats.binomtest(k, n).proportion_ci(method="wilson")
            low, high = store.wilson(k, n)
            self.assertAlmostEqual(low, 100 * truth.low, 4)
            self.assertAlmostEqual(high, 100 * truth.high, 4)


class RunsOfTheSecondTruth(unittest.TestCase):
    """Lines of results as tests/second_truth/scoring.py writes them."""

    @staticmethod
    def line(seed, **facts):
        findings = [{"effect": "mass_mismatch", "parameters": {"mass_kg": 11.0}, "standard_errors": {"mass_kg": 0.2},
                     "probability": 1.0, "confused_with": [], "holdout_gain": {}}]
        return {"key": f"single {seed} 0.1 with set-points", "kind": "single", "seed": seed, "share": 0.1,
                "hidden": ["mass_mismatch"], "unknown": [], "names": ["mass_mismatch"], "confused": [],
                "probability": 1.0, "cannot_tell": False, "first_right": True, "confused_right": False, "found": 1,
                "false": [], "tolerated": [], "exact": True, "parameters": {"mass_mismatch": {"mass": 11.3}},
                "held_out_force": [4.0, 3.0], "findings": findings, "baseline": {"force_rms_N": 2.0},
                "extended": {"force_rms_N": 1.8}} | facts

    def read(self, *lines):
        return campaigns.read_lines("abc", "2026-01-01", "\n".join(map(json.dumps, lines)))

    def test_are_kept_by_kind(self):
        wrong = {"names": ["stribeck"], "first_right": False, "exact": False}
        runs = self.read(self.line(7), self.line(8, **wrong), self.line(9, share=0.02), self.line(10, error="none"))
        self.assertEqual([run["kind"] for run in runs], ["single10", "single2"])
        self.assertEqual(runs[0]["counts"]["first_right"], [1, 2])
        self.assertEqual(runs[0]["counts"]["first_wrong"], [1, 2])
        self.assertEqual((runs[0]["seed"], runs[0]["cases"], runs[0]["commit"]), (7, 2, "abc"))

    def test_have_the_gain_as_a_share_of_the_oracles(self):
        # 1 - 1.8^2 / 2^2 of 1 - 3 / 4.
        self.assertEqual(self.read(self.line(7))[0]["means"]["gain"], [76.0, 1])

    def test_have_an_interval_where_truth_and_verdict_have_the_same_number(self):
        off = {"parameters": {"mass_mismatch": {"mass": 11.5}}}
        self.assertEqual(self.read(self.line(7), self.line(8, **off))[0]["counts"]["intervals"], [1, 2])

    def test_of_what_an_observer_cannot_tell_count_apart(self):
        counted = self.read(self.line(7, cannot_tell=True, names=[], findings=[], first_right=False))[0]["counts"]
        self.assertEqual(counted["apart_silent"], [1, 1])
        self.assertNotIn("first_right", counted)

    def test_are_of_an_engine_without_changes(self):
        with self.assertRaisesRegex(campaigns.NotKept, "changes without a commit"):
            campaigns.engine_commit(lambda *words: " M host/diagnose/diagnose.cpp")


class CommandsThere(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = pathlib.Path(folder.name)
        (root / "toolchain").mkdir()
        (root / "tests").mkdir()
        (root / "toolchain/test").write_text("# usage: [-R REGEX]\n#   --count   x; --seed S\nset -euo pipefail\n--hidden")
        (root / "build.ninja").write_text("build bin/stiction: link\n")
        with mock.patch.object(commands.Commands, "listed_tests", lambda _: (["Circle.IsRound", "A/B.c/0"], False)):
            self.there = commands.Commands(root, root)

    def test_that_exist_are_found_and_others_named(self):
        for command in ("toolchain/test", "toolchain/test --count", "toolchain/test --seed 3",
                        "toolchain/test -R Circle.IsRound", "toolchain/test -R 'Circle.IsRound|A/B'",
                        "build/release/bin/stiction --help"):
            self.assertEqual(self.there.missing(command), [], command)
        for command, said in (("toolchain/test --hidden", "no option --hidden"), ("toolchain/gone", "does not exist"),
                              ("toolchain/test -R Circle.IsSquare", "no test has the name Circle.IsSquare"),
                              ("build/release/bin/gone 1", "programme gone is not in the build tree")):
            self.assertIn(said, self.there.missing(command)[0])


if __name__ == "__main__":
    unittest.main()
