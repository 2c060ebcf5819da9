#!/usr/bin/env python3
"""Plants violations in a temporary tree and expects check_words.py to find each of them, and nothing else."""

import pathlib
import tempfile
import unittest

import check_words

SOURCES = "| key | source |\n| --- | --- |\n| Hess, Soom 1990 | D. P. Hess, A. Soom, *Friction*. |\n| Astrom, Hagglund 2006 | *PID*. |\n"
SOUND = {
    "docs/sources.md": SOURCES,
    "docs/drive.md": "# Drive\n\nSee [sources](sources.md) and `host/log/log.hpp`.\n\n```\nstands beside another\n```\n",
    "host/log/log.hpp": "#pragma once\n// As in docs/drive.md and log.hpp (Hess and Soom 1990).\nint sum(int a, int b);\n",
    "host/cli/main.cpp": '#include <cstdio>\nint main() { std::puts("The residual force is explained."); }\n',
    "host/report/web/page.js": "// Of docs/drive.md (Åström, Hägglund 2006).\nconst words = 'the standard error';\n",
    "firmware/machine/shipped/table.toml": "# Of Hess, Soom 1990.\nname = 'table'\n",
}


def findings_in(files, *checks):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return [finding for found in check_words.check(root, checks or check_words.CHECKS).values() for finding in found]


class Words(unittest.TestCase):
    def expect(self, check, file, text, *words, line=1):
        findings = findings_in(SOUND | {file: text}, check)
        self.assertEqual(len(findings), 1, findings)
        for word in (f"{file}:{line}: ", *words):
            self.assertIn(word, findings[0])

    def expect_none(self, check, file, text):
        self.assertEqual(findings_in(SOUND | {file: text}, check), [])

    def test_finds_a_bar_that_breaks_a_table(self):
        head = "| fault | when |\n| --- | --- |\n"
        self.expect("tables", "docs/drive.md", head + "| over-speed | |v| above 1 |\n", "4 cells", line=3)
        self.expect("tables", "docs/drive.md", "| fault | when |\n| --- |\n", "rule", line=2)
        self.expect_none("tables", "docs/drive.md", head + "| over-speed | \\|v\\| above 1 |\n\nA text | with bars.\n")

    def test_accepts_a_sound_tree(self):
        self.assertEqual(findings_in(SOUND), [])


class Phrases(Words):
    def test_finds_a_phrase_that_goes_over_several_literals(self):
        self.expect("phrases", "host/cli/a.cpp", 'auto a = f("It takes 3 %\\n"  // why\n  "away.");\n', "takes 3 % away", "explains")

    def test_says_the_line_of_the_literal_with_the_phrase(self):
        self.expect("phrases", "host/cli/a.cpp", 'auto a =\n  "The first, "\n  "another one.";\n', '"another"', line=3)

    def test_reads_raw_literals(self):
        self.expect("phrases", "hal/a.hpp", 'const char* a = R"(one\nstands here)";\n', '"stands"', line=2)

    def test_finds_the_worst_in_comments_too(self):
        self.expect("phrases", "host/cli/a.cpp", "// Records to\n// judge on.\nint a;\n", "to judge on")

    def test_leaves_other_comments_and_code_alone(self):
        self.expect_none("phrases", "host/cli/a.cpp", '// It stands beside another.\nint stands = another(beside, \'"\');\n')

    def test_leaves_include_lines_alone(self):
        self.expect_none("phrases", "host/cli/a.cpp", '#include "hal/beside/another.hpp"\n')

    def test_finds_phrases_on_pages(self):
        self.expect("phrases", "README.md", "# A\n\nOne and\nanother.\n", '"another"', line=4)
        self.expect("phrases", "host/report/web/a.html", "<p class=\"beside\">What stays\n  unexplained</p>\n", "What stays")
        self.expect("phrases", "host/report/web/a.js", "const a = `${n} stands ${'x'}`;  // stands\n", '"stands"')

    def test_leaves_names_and_commands_on_pages_alone(self):
        self.expect_none("phrases", "README.md", "The key `beside`.\n\n```\nstands\n```\n")

    def test_finds_ascii_signs_on_pages_only(self):
        self.expect("phrases", "docs/a.md", "It is 3 +- 1 mm.\n", "±")
        self.expect("phrases", "docs/a.md", "It is 3 um.\n", "µm")
        self.expect("phrases", "docs/a.md", "It is 3 us.\n", "µs")
        self.expect_none("phrases", "host/cli/a.cpp", 'auto a = "{:.2f} +- {:.2f} um";\n')

    def test_finds_possessives_of_possessives(self):
        self.expect("phrases", "host/cli/a.cpp", 'auto a = "the machine\'s file\'s mass";\n', "machine's file's")
        self.expect_none("phrases", "host/cli/a.cpp", 'auto a = "the machine\'s mass and the file\'s";\n')

    def test_leaves_words_that_only_look_alike_alone(self):
        self.expect_none("phrases", "host/cli/a.cpp", 'auto a = "one after another at standstill; k_s stands for stiffness; bearing";\n')


class Citations(Words):
    def test_finds_a_link_that_leads_nowhere(self):
        self.expect("citations", "docs/a.md", "[a](sources.md#x), [b](https://a.org/b.md)\n[c](../host/none.md)\n", "../host/none.md", line=2)

    def test_finds_a_path_that_does_not_exist(self):
        self.expect("citations", "host/log/a.hpp", "// As\n// in host/log/b.hpp.\n", "host/log/b.hpp", line=2)
        self.expect("citations", "firmware/machine/shipped/a.toml", "x = 1\n# See docs/plan.\n", "docs/plan", line=2)

    def test_finds_the_name_of_a_file_that_does_not_exist(self):
        self.expect("citations", "host/log/a.hpp", "// Units: contracts.md, 2.\n", "contracts.md")

    def test_accepts_files_that_the_page_itself_has_as_blocks(self):
        page = "# A\n\n`hal/new/new.hpp`:\n\n```cpp\n```\n\nSee `hal/new/`, `new.hpp`.\n"
        self.expect_none("citations", "docs/a.md", page)
        self.expect("citations", "docs/a.md", page + "And `hal/old/old.hpp`.\n", "hal/old/old.hpp", line=9)

    def test_accepts_folders_tails_of_paths_and_placeholders(self):
        self.expect_none("citations", "host/log/a.hpp", "// host/log, log/log.hpp, host/log/log, sim/effects/NAME/law.hpp, host/*.hpp.\n")

    def test_finds_a_document_without_reference(self):
        self.expect("citations", "host/log/a.cpp", 'auto a = "plant study, 10";\n', "plant study")
        self.expect("citations", "host/log/a.hpp", "// The contract's name.\n", "contract")

    def test_finds_a_publication_that_is_not_listed(self):
        self.expect("citations", "host/log/a.hpp", "// A fit (Golub,\n// Pereyra 1973).\n", "Golub, Pereyra 1973")
        self.expect("citations", "host/log/a.hpp", "// As Hess and Soom 1991 have it.\n", "1991")

    def test_finds_one_that_another_year_has(self):
        self.expect("citations", "docs/a.md", "Soom (2006) says so.\n", "Soom 2006")

    def test_accepts_years_without_authors(self):
        self.expect_none("citations", "docs/a.md", "Since 2004, in March 2005; Debian 12, 1999 samples.\n")


class Parameters(Words):
    def expect_missing(self, text, *names, line=1):
        self.expect("parameters", "host/log/a.hpp", text, *names, line=line)

    def expect_documented(self, text):
        self.expect_none("parameters", "host/log/a.hpp", text)

    def test_finds_a_parameter_that_the_comment_leaves_out(self):
        self.expect_missing("// From `first` (s), `last` (s).\nvoid f(double first, double last, int count = g(1, 2));\n", "f()", "count", line=2)

    def test_wants_whole_words(self):
        self.expect_missing("// The firstborn of lasting counts.\nint f(int first, int last, int counts);\n", "first, last", line=2)

    def test_accepts_two_parameters_without_a_word(self):
        self.expect_documented("void f(std::map<int, int> a, std::function<void(int, int, int)> b);\n")

    def test_counts_parameters_of_templates_and_references_right(self):
        self.expect_missing("template <class T, int N = (1 < 2)>\n  requires std::is_same_v<T, int>\n"
                            "auto f(const std::vector<std::pair<int, T>>& pairs, T (&out)[N], int k) -> std::array<T, 3> {\n  return {};\n}\n",
                            "pairs, out, k")

    def test_accepts_the_comment_of_a_group_and_comments_inside(self):
        self.expect_documented("// Of `a`, `b`, `c`.\nvoid f(int a, int b, int c);\nvoid g(int a, int b,\n       int d,  // d: the last\n       int c);\n")

    def test_does_not_take_the_comment_above_an_empty_line(self):
        self.expect_missing("// Of a, b, c.\nvoid f(int a, int b, int c);\n\nvoid g(int a, int b, int c);\n", "g()", line=4)

    def test_passes_over_what_is_not_public(self):
        self.expect_documented("namespace detail {\nvoid f(int a, int b, int c);\n}\nnamespace {\nvoid f(int a, int b, int c);\n}\n"
                               "class A {\n  void f(int a, int b, int c);\n public:\n  struct B { int x; };\n private:\n"
                               "  struct C {\n    void f(int a, int b, int c);\n  };\n  int a_ = f(1, 2, 3);\n};\n"
                               "inline int g() {\n  const auto h = [](int a, int b, int c) { return a; };\n  return h(1, 2, 3);\n}\n")

    def test_looks_into_public_parts_of_classes(self):
        self.expect_missing("namespace a::b {\nclass A {\n public:\n  // Over `a`.\n  A(int a, int b, int c) : a_{a}, b_(b) { f(); }\n\n  int a_;\n};\n}\n",
                            "A()", "b, c", line=5)

    def test_accepts_the_comment_of_the_class_for_its_constructor(self):
        self.expect_documented("// With a, b and c.\nclass A {\n public:\n  A(int a, int b, int c);\n};\n")

    def test_reads_operators_concepts_and_initialisers(self):
        self.expect_missing("template <class T>\nconcept C = requires(T a, T b, T c) {\n  { a.f(b, c, a) } -> std::same_as<int>;\n};\n"
                            "inline constexpr int x{f(1, 2, 3)};\nbool operator<(const A& a, const A& b);\n"
                            "void g(int a, int b, int c) noexcept;\n", "g()", line=7)

    def test_wants_the_type_of_a_parameter_without_a_name(self):
        self.expect_missing("// a, b\nvoid f(int a, int b, const std::string&);\n", "string", line=2)
        self.expect_documented("// a, b; the Config is not used\nvoid f(int a, int b, const Config& = {});\n")

    def test_passes_over_sources(self):
        self.expect_none("parameters", "host/log/a.cpp", "void f(int a, int b, int c) {}\n")


if __name__ == "__main__":
    unittest.main()
