#!/usr/bin/env python3
"""Man pages of the package: each command has one, it says what --help says, and mandoc finds nothing wrong.

usage: man_pages_test.py STICTION      the programme; status 1: a test failed"""

import functools
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]
PACKAGE = ROOT / "toolchain/package"
PROGRAM = ""


@functools.cache
def said(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def commands():
    return said(PACKAGE / "man_page", "--commands", PROGRAM).split()


def page(command=None):
    template = PACKAGE / "man" / ("stiction-command.1.in" if command else "stiction.1.in")
    return said(PACKAGE / "man_page", template, PROGRAM, "0.1.0", "November 23, 2026", *([command] if command else []))


class ManPages(unittest.TestCase):
    def test_every_command_of_the_help_has_a_page(self):
        for command in ("simulate", "compare", "machine", "identify", "diagnose", "tune-friction", "sweep", "convert", "inspect",
                        "completion"):
            self.assertIn(command, commands())

    def test_every_option_is_on_its_page(self):
        for command in commands():
            text = page(command).replace("\\-", "-")
            for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", said(PROGRAM, command, "--help"), re.MULTILINE):
                self.assertIn(option, text, command)

    def test_experiments_are_sections_with_their_options(self):
        text = page("simulate").replace("\\-", "-")
        for experiment in ("circle", "impact", "frequency-response", "replay"):
            self.assertIn(f".Ss stiction simulate {experiment}\n", text)
        self.assertIn("--lowest", text)

    def test_no_mark_of_a_template_is_left(self):
        for text in [page()] + [page(command) for command in commands()]:
            self.assertEqual(re.findall(r"@[A-Z]+@", text), [])

    @unittest.skipUnless(shutil.which("mandoc"), "mandoc is not installed")
    def test_mandoc_finds_nothing_to_warn_of(self):
        with tempfile.TemporaryDirectory() as folder:
            for command in [None] + commands():
                file = pathlib.Path(folder) / f"{command}.1"
                file.write_text(page(command), encoding="utf-8")
                checked = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", file], capture_output=True, text=True,
                                         check=False)
                self.assertEqual((checked.returncode, checked.stdout), (0, ""), command)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop()
    unittest.main()
