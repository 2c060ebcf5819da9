#!/usr/bin/env python3
"""The examples of docs/formats.md go through the programmes in the order of the page, and its tables are complete.

usage: formats_test.py FOLDER-OF-PROGRAMMES
"""

import dataclasses
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import jsonschema

import commands

PAGE = commands.SOURCE / "docs/formats.md"
SCHEMAS = commands.SOURCE / "docs/schemas"


@dataclasses.dataclass
class Block:
    """A fenced block: its language, the line of its fence, the name of a file in the text before it, or none."""
    language: str
    line: int
    name: str | None
    text: str


def blocks(page):
    """The blocks of a page. A file's block follows a paragraph that ends with its name: `run.csv`:"""
    found, lines, start = [], page.splitlines(), None
    for number, line in enumerate(lines, 1):
        if not line.startswith("```"):
            continue
        if start is None:
            before = next((text for text in reversed(lines[:number - 1]) if text), "")
            name = re.search(r"`([\w./-]+)`:$", before)
            start = Block(line[3:].strip(), number, name[1] if name else None, "")
        else:
            start.text = "".join(text + "\n" for text in lines[start.line:number - 1])
            found.append(start)
            start = None
    return found


def table_below(page, head):
    """First column of the table whose heading row begins with `head`, without the quotes of code."""
    rows = page.partition(f"\n| {head} |")[2].partition("\n\n")[0].splitlines()[2:]
    return [row.split("|")[1].strip().strip("`") for row in rows]


def paths(schema, node, prefix=""):
    """Keys of a schema as the page writes them, without what is the same for many keys or differs between effects."""
    node = {**schema["$defs"].get(node.get("$ref", "").removeprefix("#/$defs/"), {}), **node}
    if node.get("type") == "array":
        yield from paths(schema, node["items"], prefix + "[]")
    for key, part in node.get("properties", {}).items():
        path = f"{prefix}.{key}".removeprefix(".")
        yield path
        in_one_row = path == "extended" or path.startswith(("mean_error_", "rows[]."))
        if not in_one_row:
            yield from paths(schema, part, path)


class Page(unittest.TestCase):
    """docs/formats.md."""

    programmes = None

    @classmethod
    def setUpClass(cls):
        cls.page = PAGE.read_text(encoding="utf-8")
        cls.blocks = blocks(cls.page)
        cls.schemas = {schema["title"]: schema for file in SCHEMAS.glob("*.json")
                       if (schema := json.loads(file.read_text(encoding="utf-8")))}

    def shell(self, text, folder):
        """Runs shell commands as a reader would, with the programmes on the path."""
        path = f"{self.programmes}{os.pathsep}{os.environ['PATH']}"
        return subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env={**os.environ, "PATH": path},
                              capture_output=True, text=True, check=False)

    def test_has_examples_that_the_programmes_read(self):
        self.assertGreater(len(self.blocks), 15)
        with tempfile.TemporaryDirectory() as name:
            folder, unread = pathlib.Path(name), {}
            for block in self.blocks:
                place = f"docs/formats.md:{block.line}"
                with self.subTest(place):
                    if block.language == "sh":
                        for line in block.text.splitlines():
                            done = self.shell(line, folder)
                            self.assertEqual(done.returncode, 0, f"{place}: {line}\n{done.stderr}")
                            unread = {file: at for file, at in unread.items() if file.split("/")[0] not in line.split()}
                    elif block.language == "python":
                        subprocess.run([sys.executable, "-c", block.text], cwd=folder, check=True)
                    elif block.language == "json":
                        document = json.loads(block.text)
                        jsonschema.Draft202012Validator(self.schemas[document["schema"]]).validate(document)
                    else:
                        self.assertIsNotNone(block.name, f"{place}: found no name of a file before the block")
                        (folder / block.name).parent.mkdir(exist_ok=True)
                        (folder / block.name).write_text(block.text, encoding="utf-8")
                        unread[block.name] = place
            self.assertEqual(unread, {}, "found files that no command below them reads")
            self.check_values(folder)

    def check_values(self, folder):
        """What the page says of its examples, seen in what the commands made of them."""
        rows = (folder / "recorded.csv").read_text(encoding="utf-8").splitlines()
        head, first = [line.split(",") for line in rows if not line.startswith("#")][:2]
        values = dict(zip(head, map(float, first)))
        self.assertAlmostEqual(values["X.x[m]"], 1.5e-3)
        self.assertAlmostEqual(values["X.i[A]"], -2.0 * 2.0 ** 0.5)
        again = self.shell("stiction convert again.mat again.csv && cmp again.csv from-mat.csv", folder)
        self.assertEqual(again.returncode, 0, again.stderr)
        # A store with one wrong digit is not used.
        store = folder / "store/parameters"
        store.write_text(store.read_text(encoding="utf-8").replace("gain 150", "gain 151"), encoding="utf-8")
        refused = self.shell("stictiond --machine emps --parameters store --hold 0.1 --unpaced", folder)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("the file is not used", refused.stderr)

    def test_lists_every_channel_of_a_log(self):
        header = (commands.SOURCE / "host/log/log.hpp").read_text(encoding="utf-8")
        channels = re.findall(r'^    \{"(\w+)", "([^"]+)", &AxisLog::', header, re.M)
        self.assertGreater(len(channels), 10)
        self.assertEqual(sorted(table_below(self.page, "column")), sorted(["t[s]", *(f"{a}[{b}]" for a, b in channels)]))

    def test_lists_every_schema_with_its_file(self):
        rows = re.findall(r"^\| \[`(stiction\.[\w-]+/\d+)`\]\((schemas/[\w-]+\.json)\) \|", self.page, re.M)
        self.assertEqual(sorted(name for name, _ in rows), sorted(self.schemas))
        for name, file in rows:
            self.assertEqual(json.loads((PAGE.parent / file).read_text(encoding="utf-8"))["title"], name)

    def test_lists_every_key_of_the_verdict(self):
        schema = self.schemas["stiction.verdict/1"]
        self.assertEqual(sorted(table_below(self.page, "key")), sorted(paths(schema, schema)))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    Page.programmes = pathlib.Path(sys.argv[1]).resolve()
    unittest.main(argv=sys.argv[:1])
