#!/usr/bin/env python3
"""The fuzzer of the command line on shell scripts in the programme's place: what it draws and what it finds."""

import argparse
import pathlib
import random
import stat
import tempfile
import unittest

import command_files
import command_line_fuzz
import help_grammar

HELP = """a command
Usage: stiction simulate circle [OPTIONS] [logs...]

Positionals:
  logs LOG ... Excludes: --reference
                              logs of one axis
  OUT TEXT REQUIRED           the log to write

Options:
  -h,--help                   Print this help message and exit
  --machine MACHINE REQUIRED  shipped machine by name, or a machine file
  --set KEY=VALUE ...         another value for a key
  --compensation KIND:{off,pulse}
                              friction compensation
  --feed "NUMBER UNIT"=16 m/min
                              feed along the path
  --signal TEXT:{multisine,stepped-sine}=multisine Excludes: --from
                              multisine: all frequencies at once
  --json                      print the result as JSON
  --out DIR                   write the result into this folder
"""


class Grammar(unittest.TestCase):
    def test_has_every_argument_with_what_its_help_says(self):
        command = help_grammar.command_of(("simulate", "circle"), HELP)
        found = {argument.name: argument for argument in command.arguments}
        self.assertEqual(list(found), ["logs", "OUT", "--machine", "--set", "--compensation", "--feed", "--signal",
                                       "--json", "--out"])
        self.assertTrue(found["logs"].many and not found["logs"].required)
        self.assertEqual(found["logs"].takes, "LOG")
        self.assertTrue(found["OUT"].required)
        self.assertTrue(found["--machine"].required)
        self.assertEqual(found["--set"].takes, "KEY=VALUE")
        self.assertTrue(found["--set"].many)
        self.assertEqual(found["--compensation"].choices, ("off", "pulse"))
        self.assertEqual(found["--feed"].takes, "NUMBER UNIT")
        self.assertEqual(found["--signal"].choices, ("multisine", "stepped-sine"))
        self.assertEqual(found["--json"].takes, "")

    def test_finds_the_commands_below_a_command(self):
        text = "x\nUsage: x\n\nOptions:\n  -h,--help    y\n\nSubcommands:\n  circle    a circle\n  l-shape   a path\n"
        self.assertEqual(help_grammar.commands_below(text), ["circle", "l-shape"])


class Files(unittest.TestCase):
    def test_change_whatever_they_hold_and_repeat_with_the_seed(self):
        with tempfile.TemporaryDirectory() as folder:
            place, out = pathlib.Path(folder) / "a.csv", pathlib.Path(folder) / "b.csv"
            for data in (b"", b"\0\xff", b"t[s],x[m]\n0,1\n1,2\n", b"\xf0\x28 1.5 kg"):
                place.write_bytes(data)
                seen = set()
                for seed in range(60):
                    command_files.changed(random.Random(seed), place, out)
                    seen.add(out.read_bytes())
                    again = out.read_bytes()
                    command_files.changed(random.Random(seed), place, out)
                    self.assertEqual(out.read_bytes(), again)
                if len(data) > 2:
                    self.assertGreater(len(seen), 20)

    def test_name_the_keys_of_a_machine_file(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder) / "m.toml"
            place.write_text('[axis.X]\nmass = "9 kg" # so\n  [axis.X.friction]\n  use = "lugre"\n')
            self.assertEqual(command_files.keys_of([place]),
                             [("axis.X.friction.use", '"lugre"'), ("axis.X.mass", '"9 kg"')])


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in ("bin", "share/stiction/machines", "work", "findings"):
            (self.root / name).mkdir(parents=True)
        (self.root / "share/stiction/machines/m.toml").write_text('[axis.X]\nmass = "9 kg"\n')

    def findings(self, script, runs=1):
        """What the fuzzer finds of a programme that does `script` instead of what it was asked for."""
        place = self.root / "bin/stiction"
        (self.root / "help").write_text(HELP)
        place.write_text(f"#!/bin/sh\ncase $* in *--help) exec cat {self.root}/help;; esac\n{script}\n")
        place.chmod(place.stat().st_mode | stat.S_IXUSR)
        options = argparse.Namespace(program=place, seed=1, patience=1, corpora=self.root,
                                     findings=self.root / "findings")
        fuzzer = command_line_fuzz.Fuzzer(options, pathlib.Path(tempfile.mkdtemp(dir=self.root / "work")))
        return [fuzzer.run(number) for number in range(runs)]

    def test_that_die_or_throw_are_findings_with_their_files(self):
        self.assertEqual(self.findings("kill -SEGV $$")[0].finding, "SIGSEGV")
        self.assertEqual(self.findings("echo 'terminate called after' >&2; exit 1")[0].finding, "uncaught exception")
        self.assertEqual(self.findings("exit 99")[0].finding, "a sanitizer's report")
        self.assertEqual(self.findings("exit 3")[0].finding, "exit 3")
        self.assertTrue((self.root / "findings/command_line-1-0/command").exists())

    def test_that_fail_without_a_word_are_findings(self):
        self.assertEqual(self.findings("exit 2")[0].finding, "exit 2 without a message")
        self.assertEqual(self.findings("echo 'found a; expected b' >&2; exit 2")[0].finding, "")
        self.assertEqual(self.findings("echo no >&2; exit 2")[0].finding,
                         "refused without what was found and what was expected")
        self.assertEqual(self.findings("echo no >&2; exit 1")[0].finding, "")

    def test_that_do_not_end_are_ended_and_told(self):
        run = self.findings("while :; do :; done")[0]
        self.assertEqual((run.finding, run.note), ("", "no end in its time"))

    def test_that_refuse_and_write_are_findings(self):
        writes = 'for word; do case $word in out*) echo >"$word";; esac; done; echo no >&2; exit 2'
        self.assertIn("refused, and something is written", {run.finding for run in self.findings(writes, runs=60)})

    def test_owe_json_where_it_was_asked_for(self):
        self.assertIn("no JSON on standard output", {run.finding for run in self.findings("echo no", runs=60)})
        self.assertEqual({run.finding for run in self.findings("echo '{}'", runs=60) if not run.meant}, {""})

    def test_owe_the_right_spelling_of_a_misspelt_option(self):
        runs = [run for run in self.findings("echo 'found a; expected b' >&2; exit 2", runs=80) if run.meant]
        self.assertTrue(runs)
        self.assertEqual({run.finding for run in runs}, {"a misspelt option without its right spelling"})
        tells = "echo \"found; expected; did you mean '--machine'? did you mean '--signal'? did you mean '--feed'? did " \
                "you mean '--json'? did you mean '--set'? did you mean '--compensation'?\" >&2; exit 2"
        self.assertEqual({run.finding for run in self.findings(tells, runs=80) if run.meant}, {""})

    def test_that_change_foreign_files_or_leave_temporary_ones_are_findings(self):
        spoils = 'for word; do case $word in used*) echo >"$word/thesis.txt";; esac; done; exit 0'
        self.assertIn("a foreign file is changed", {run.finding for run in self.findings(spoils, runs=60)})
        removes = 'for word; do case $word in used*) rm "$word/thesis.txt";; esac; done; exit 0'
        self.assertIn("a foreign file is gone", {run.finding for run in self.findings(removes, runs=60)})
        self.assertEqual(self.findings("touch .a.partial-1")[0].finding, "a temporary file is left")

    def test_follow_from_seed_and_number(self):
        lines = [[run.line for run in self.findings("exit 0", runs=20)] for _ in range(2)]
        names = [[[part.rsplit("/", 1)[-1] for part in line] for line in each] for each in lines]
        self.assertEqual(*names)
        self.assertGreater(len({tuple(line) for line in names[0]}), 15)


if __name__ == "__main__":
    unittest.main()
