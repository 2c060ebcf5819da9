#!/usr/bin/env python3
"""Checks the words: phrases that texts for users do not have (phrases.py), citations that lead nowhere (citations.py),
public functions whose comment leaves out a parameter (parameter_docs.py), tables that a bar breaks (tables.py). Prints
each finding, and the counts on stderr.

usage: check_words.py [ROOT] [phrases] [citations] [parameters] [tables]     default: all; status 1: findings
"""

import pathlib
import sys

import citations
import parameter_docs
import phrases
import tables

CHECKS = ("phrases", "citations", "parameters", "tables")
ROOMS = ("firmware", "hal", "host", "sim", "tests", "toolchain", "docs", "examples", "studies")

# Where each check looks: paths from the root, files or folders.
FOLDERS = {
    "phrases": ("firmware", "hal", "host", "sim", "docs", "README.md"),
    "citations": ROOMS + ("README.md",),
    "parameters": ("firmware", "hal", "host", "sim", "toolchain"),
    "tables": ROOMS + ("README.md",),
}
SUFFIXES = {
    "phrases": {".cpp", ".hpp", ".h", ".js", ".html", ".md"},
    "citations": {".cpp", ".hpp", ".h", ".c", ".js", ".md", ".toml", ".py", ".sh", ".cmake", ".txt", ""},
    "parameters": {".hpp"},
    "tables": {".md"},
}


def files(root):
    """Paths of all files of the rooms, from the root."""
    found = [path.relative_to(root) for room in ROOMS for path in sorted((root / room).rglob("*"))
             if path.is_file() and not {"node_modules", "__pycache__"} & set(path.parts)]
    return [path.as_posix() for path in found] + [path.name for path in sorted(root.iterdir()) if path.is_file()]


def inside(path, folders):
    return any(path == folder or path.startswith(folder + "/") for folder in folders)


def chosen(paths, check):
    return [path for path in paths
            if inside(path, FOLDERS[check]) and pathlib.PurePath(path).suffix in SUFFIXES[check]]


def read(root, path):
    try:
        return (root / path).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return ""


def check(root, checks=CHECKS):
    """{check: [finding]}."""
    paths = files(root)
    cited = citations.Citations(paths, read(root, citations.SOURCES_PAGE) if citations.SOURCES_PAGE in paths else "")
    judges = {"phrases": phrases.findings, "citations": cited.findings,
              "parameters": lambda path, text: parameter_docs.findings(text),
              "tables": lambda path, text: tables.findings(text)}
    return {name: [f"{path}:{line}: {message}" for path in chosen(paths, name)
                   for line, message in judges[name](path, read(root, path))] for name in checks}


def main():
    arguments = sys.argv[1:]
    checks = [name for name in arguments if name in CHECKS] or CHECKS
    roots = [name for name in arguments if name not in CHECKS]
    root = pathlib.Path(roots[0] if roots else pathlib.Path(__file__).parents[2]).resolve()
    found = check(root, checks)
    for findings in found.values():
        for finding in findings:
            print(finding)
    print(", ".join(f"{len(findings)} {name}" for name, findings in found.items()), file=sys.stderr)
    return 1 if any(found.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
