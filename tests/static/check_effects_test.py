#!/usr/bin/env python3
"""Plants violations in a temporary tree and expects check_effects.py to find each of them, and nothing else."""

import pathlib
import tempfile
import unittest

import check_effects

SOUND = {file: '#include "sim/effects/drag/drag.hpp"\n' for file in check_effects.BY_CLASS} | {
    "sim/effects/drag/drag.hpp": 'constexpr auto name = "drag";\n',
    "sim/effects/lift/descriptor.cpp": '.aliases = {{"drag", "a second speed"}},\n',
    "host/report/page.cpp": '// a page of "drag"\n',
}


def findings_in(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return check_effects.check(root)[1]


class CheckEffects(unittest.TestCase):
    def expect_finding(self, file, text, *words):
        findings = findings_in(SOUND | {file: text})
        self.assertEqual(len(findings), 1, findings)
        for word in (file, *words):
            self.assertIn(word, findings[0])

    def test_accepts_aliases_classes_with_a_reason_and_comments(self):
        self.assertEqual(findings_in(SOUND), [])

    def test_finds_a_name_as_text(self):
        self.expect_finding("host/report/page.cpp", 'if (name == "drag") return;\n', "drag as text")

    def test_finds_a_name_in_a_script_of_a_page(self):
        self.expect_finding("host/report/web/page.js", "if (name === 'drag') show();\n", "drag as text")

    def test_finds_a_name_in_the_law_of_another_effect(self):
        self.expect_finding("sim/effects/lift/lift.hpp", 'find_effect("drag")\n', "drag as text")

    def test_finds_a_class_without_a_reason(self):
        self.expect_finding("host/log/log.cpp", '#include "sim/effects/drag/drag.hpp"\n', "BY_CLASS")

    def test_finds_a_reason_without_a_class(self):
        self.expect_finding("host/diagnose/diagnose.cpp", "", "no effect any more")


if __name__ == "__main__":
    unittest.main()
