#!/usr/bin/env python3
"""Plants errors in pages and expects check_pages.py and run_pages.py to find each of them, and nothing else."""

import pathlib
import tempfile
import unittest

import check_pages
import pages
import run_pages

README = """# Product

Run `stiction inspect a.csv`, see [the drive](docs/drive.md#real-time).

```sh
cd docs
name=drive
```

`my.toml`:

```toml
a = 1
```

```sh
stiction() { echo "$@"; }
cat ../my.toml "$name.md"
cd ..
stiction inspect a.csv \\
  | tr a-z A-Z
```

```text printed
# Drive
INSPECT ...CSV
```
"""
DRIVE = "# Drive\n\n## Real time\n\nOne line.\nA second.\n"


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "docs").mkdir()
        (self.root / "docs/drive.md").write_text(DRIVE)

    def findings(self, readme):
        page = pages.Page("README.md", readme)
        (self.root / "README.md").write_text(readme)
        report = {"run": 0, "left": [], "said": [], "times": [], "output": {}}
        found = list(check_pages.findings(self.root, [page, pages.read_page(self.root, "docs/drive.md")]))
        found += run_pages.follow(page, self.root, report)
        return found, report

    def expect(self, readme, *words):
        found, _ = self.findings(readme)
        self.assertEqual(len(found), 1, found)
        for word in words:
            self.assertIn(word, found[0])

    def test_follows_a_sound_page(self):
        found, report = self.findings(README)
        self.assertEqual(found, [])
        self.assertEqual(report["run"], 6)

    def test_finds_a_command_that_fails(self):
        self.expect(README.replace("name=drive", "name=drive; false"), "README.md:7", "ended with 1")

    def test_finds_a_shell_that_ends(self):
        self.expect(README + "\n```sh\nexit 3\n```\n", "exit 3", "ended with 3")

    def test_finds_a_refused_command_that_succeeds(self):
        self.expect(README + "\n```sh refused\ntrue\n```\n", "ended with 0")
        self.assertEqual(self.findings(README + "\n```sh refused\n(exit 2)\n```\n")[0], [])
        self.expect(README + "\n```sh refused\nno-such-programme\n```\n", "ended with 127")

    def test_finds_a_line_that_is_not_printed(self):
        self.expect(README.replace("# Drive\nINSPECT", "# Driver\nINSPECT"), "not printed: # Driver")
        self.expect(README.replace("INSPECT ...CSV", "A.CSV INSPECT"), "not printed: A.CSV")

    def test_wants_printed_lines_in_their_order(self):
        self.expect(README.replace("# Drive\nINSPECT ...CSV", "INSPECT ...CSV\n# Drive"), "not printed: # Drive")

    def test_leaves_marked_commands_alone_and_says_so(self):
        found, report = self.findings(README + "\n```sh needs-bus\nfalse\n```\n")
        self.assertEqual((found, len(report["left"])), ([], 1))

    def test_finds_a_marked_command_whose_programme_is_not_there(self):
        self.expect(README + "\n```sh needs-root\n./toolchain/none --now\n```\n", "there is no ./toolchain/none")

    def test_finds_unknown_marks_and_languages(self):
        self.expect(README + "\n```sh needs-luck\ntrue\n```\n".replace("true", "#"), "unknown mark 'needs-luck'")
        self.expect(README + "\n```\ntrue\n```\n", "a block of ''")

    def test_finds_links_and_anchors_that_lead_nowhere(self):
        self.expect(README.replace("drive.md#real", "none.md#real"), "leads nowhere")
        self.expect(README.replace("#real-time", "#unreal-time"), "no heading #unreal-time")

    def test_finds_a_command_of_the_readme_that_is_in_no_block(self):
        self.expect(README.replace("`stiction inspect", "`stiction convert"), "in no block")

    def test_changes_a_file_where_its_context_is(self):
        change = "\nIn `docs/drive.md`, a line:\n\n```diff\n One line.\n+Between.\n@@\n-A second.\n+The last.\n```\n"
        self.assertEqual(self.findings(README + change)[0], [])
        text = DRIVE.replace("A second.", "Between.\nThe last.")
        self.assertEqual((self.root / "docs/drive.md").read_text(), text)
        self.assertEqual(self.findings(README + change)[0], [], "what is there already is not added again")
        self.assertEqual((self.root / "docs/drive.md").read_text(), text)

    def test_finds_a_change_that_has_no_place(self):
        change = "\nIn `docs/drive.md`, a line:\n\n```diff\n No line.\n+Between.\n```\n"
        self.expect(README + change, "0 places for the change")

    def test_keeps_the_folder_and_continued_lines_and_here_documents(self):
        text = "```sh\ncat <<END > out.txt\nfirst\n\nsecond\nEND\nwc -l \\\n  out.txt\n```\n\n```text printed\n3 out.txt\n```\n"
        self.assertEqual(self.findings(README + "\n" + text)[0], [])

    def test_makes_anchors_as_github_does(self):
        self.assertEqual(pages.anchor("5. Friction `compensation`, µm [x](y.md)"), "5-friction-compensation-µm-x")


if __name__ == "__main__":
    unittest.main()
