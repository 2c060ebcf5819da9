#!/usr/bin/env python3
"""Every JSON that stiction prints or writes names a schema of docs/schemas and meets it; misspelt keys do not.

usage: schemas_test.py FOLDER-OF-PROGRAMMES [FOLDER-WITH-RESULTS]
"""

import copy
import json
import pathlib
import re
import shlex
import sys
import tempfile
import unittest

import jsonschema

import commands
import verdict_effects

sys.path.insert(0, str(commands.SOURCE / "tests/static"))
import phrases  # of what users read

SCHEMAS = commands.SOURCE / "docs/schemas"

# Suffixes of keys, the longest first, and the units as descriptions have them.
UNITS = {"_deg_per_s2": "°/s²", "_deg_per_s": "°/s", "_mm_per_s2": "mm/s²", "_N_m": "N m", "_N_m_per_A": "N m/A", "_N_m_per_V": "N m/V", "_N_s_per_m": "N s/m", "_A_s_per_m": "A s/m", "_V_s_per_m": "V s/m", "_m_per_s2": "m/s²", "_mm_per_min": "mm/min",
         "_rad_per_s2": "rad/s²", "_rad_per_s": "rad/s", "_m_per_min": "m/min", "_mm_per_s": "mm/s", "_m_per_s": "m/s", "_N_per_mm": "N/mm", "_N_per_m": "N/m",
         "_N_per_s": "N/s", "_N_per_A": "N/A", "_N_per_V": "N/V", "_N_per_N": "N/N", "_V_per_A": "V/A",
         "_percent": "%", "_revolutions": "revolutions", "_per_s": "1/s", "_deg": "deg", "_kg": "kg", "_Hz": "Hz",
         "_dB": "dB", "_um": "µm", "_mm": "mm", "_ms": "ms", "_m": "m", "_s": "s", "_N": "N", "_A": "A", "_V": "V"}


def unit_of(key):
    """The suffix of a key that is a unit, or none."""
    return next((suffix for suffix in UNITS if key.endswith(suffix)), None)


def objects(schema, path=""):
    """(path, node) of every part of a schema that describes an object or names its keys."""
    if isinstance(schema, dict):
        yield path, schema
        for key, part in schema.items():
            yield from objects(part, f"{path}/{key}")
    elif isinstance(schema, list):
        for index, part in enumerate(schema):
            yield from objects(part, f"{path}/{index}")


def keyed(document, place=()):
    """(place of the object, key) of every key; indices of lists count as part of the place."""
    if isinstance(document, dict):
        for key, part in document.items():
            yield place, key
            yield from keyed(part, (*place, key))
    elif isinstance(document, list):
        for index, part in enumerate(document):
            yield from keyed(part, (*place, index))


# Objects whose keys a user chose: the design keys of a sweep.
OWN_NAMES = {("stiction.sweep/1", "values")}


def renamed(document, place, key, new):
    """A copy whose object at `place` has `new` for `key`."""
    changed = copy.deepcopy(document)
    part = changed
    for step in place:
        part = part[step]
    part[new] = part.pop(key)
    return changed


class Schemas(unittest.TestCase):
    """The files by themselves."""

    @classmethod
    def setUpClass(cls):
        cls.files = {file: json.loads(file.read_text(encoding="utf-8")) for file in sorted(SCHEMAS.glob("*.json"))}

    def test_are_valid_and_named_as_their_files(self):
        self.assertTrue(self.files)
        for file, schema in self.files.items():
            with self.subTest(file.name):
                jsonschema.Draft202012Validator.check_schema(schema)
                name, version = file.stem.rsplit("-", 1)
                self.assertEqual(schema["title"], f"stiction.{name}/{version}")
                self.assertEqual(schema["properties"]["schema"]["const"], schema["title"])
                self.assertIn("schema", schema["required"])

    def test_leave_no_object_open(self):
        for file, schema in self.files.items():
            for path, node in objects(schema):
                if {"properties", "patternProperties"} & set(node) and not path.endswith("/if") and not (
                        re.search(r"/(oneOf/\d+|then)$", path) or path.endswith("properties")):
                    with self.subTest(f"{file.name}{path}"):
                        self.assertIs(node.get("additionalProperties"), False)

    def test_describe_every_key_with_its_unit(self):
        for file, schema in self.files.items():
            for path, node in objects(schema):
                if re.search(r"/(if|then|oneOf/\d+)(/|$)", path):
                    continue  # they only choose between what is described elsewhere
                keys = {**node.get("properties", {}), **node.get("patternProperties", {})}
                for key, part in keys.items() if isinstance(keys, dict) else ():
                    with self.subTest(f"{file.name}{path}: {key}"):
                        self.assertTrue(part.get("description"), "found no description; expected one")
                        if (unit := unit_of(key.rstrip("$"))) is not None:
                            self.assertRegex(f"{part['description']}; {node.get('description', '')}",
                                             rf"\bin {re.escape(UNITS[unit])}(?![\w/]| s/m)")

    def test_describe_in_the_words_of_the_project(self):
        for file, schema in self.files.items():
            page = "\n\n".join(node["description"] for _, node in objects(schema)
                               if isinstance(node.get("description"), str))
            with self.subTest(file.name):
                self.assertEqual([message for _, message in phrases.findings("schema.md", page)], [])

    def test_say_the_same_where_they_share_a_name(self):
        known = {}
        for file, schema in self.files.items():
            for name, part in schema.get("$defs", {}).items():
                if name == "figures":
                    continue
                with self.subTest(f"{file.name}: {name}"):
                    self.assertEqual(known.setdefault(name, part), part)

    def test_have_the_effects_of_the_vocabulary(self):
        file, page = SCHEMAS / "verdict-1.json", commands.SOURCE / "docs/effects.md"
        wanted = verdict_effects.with_effects(self.files[file], page.read_text(encoding="utf-8"))
        self.assertGreater(len(wanted["$defs"]["effect"]["enum"]), 20)
        if wanted != self.files[file]:
            place = Outputs.programmes.parent / file.name
            place.write_text(verdict_effects.formatted(wanted) + "\n", encoding="utf-8")
            self.fail(f"{file}: found other effects than in docs/effects.md; the file as it must be is {place}")

    def test_are_laid_out_alike(self):
        for file, schema in self.files.items():
            with self.subTest(file.name):
                self.assertEqual(file.read_text(encoding="utf-8"), verdict_effects.formatted(schema) + "\n")


class Outputs(unittest.TestCase):
    """What the commands print and write."""

    programmes, made = None, None

    @classmethod
    def setUpClass(cls):
        cls.programme = cls.programmes / "stiction"
        cls.schemas = {}
        for file in SCHEMAS.glob("*.json"):
            schema = json.loads(file.read_text(encoding="utf-8"))
            cls.schemas[schema["title"]] = jsonschema.Draft202012Validator(schema)
        with tempfile.TemporaryDirectory() as folder:
            cls.documents = commands.documents(cls.programme, pathlib.Path(folder), cls.made)

    def test_meet_their_schemas(self):
        for maker, document in self.documents:
            with self.subTest(maker):
                self.assertIn(document.get("schema"), self.schemas)
                errors = self.schemas[document["schema"]].iter_errors(document)
                self.assertEqual([f"{error.json_path}: {error.message}" for error in errors], [])

    def test_meet_every_schema(self):
        self.assertEqual(set(self.schemas) - {document.get("schema") for _, document in self.documents}, set())

    def test_come_from_every_command_that_has_json(self):
        lines = [shlex.split(line) for line in (*commands.COMMANDS, *commands.LONG)]
        with tempfile.TemporaryDirectory() as folder:
            found = list(commands.subcommands(self.programme, folder))
        self.assertIn(("simulate", "circle"), found)
        for path in found:
            with self.subTest(" ".join(path)):
                self.assertTrue(any(tuple(line[:len(path)]) == path and "--json" in line for line in lines),
                                "found a command with --json that no line of commands.py runs; expected one")

    def test_hold_finite_numbers_only(self):
        for maker, document in self.documents:
            for place, key in keyed(document):
                part = document
                for step in (*place, key):
                    part = part[step]
                if isinstance(part, float):
                    self.assertTrue(abs(part) < float("inf"), f"{maker}: {place} {key}")

    def test_are_refused_with_a_misspelt_key_or_without_its_unit(self):
        seen, changed = set(), 0
        for maker, document in self.documents:
            schema = document.get("schema")
            if schema not in self.schemas:
                continue  # named by the test above
            for place, key in keyed(document):
                kind = (schema, *(step for step in place if isinstance(step, str)), key)
                if kind in seen or (schema, place[-1] if place else None) in OWN_NAMES:
                    continue
                seen.add(kind)
                wrong = ["x" + key] + ([key.removesuffix(unit)] if (unit := unit_of(key)) else [])
                for new in wrong:
                    changed += 1
                    with self.subTest(f"{maker}: {'.'.join(kind)} as {new}"):
                        self.assertFalse(self.schemas[schema].is_valid(renamed(document, place, key, new)))
        self.assertGreater(changed, 500)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    Outputs.programmes = pathlib.Path(sys.argv[1]).resolve()
    Outputs.made = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None
    unittest.main(argv=sys.argv[:1])
