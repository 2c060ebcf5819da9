#!/usr/bin/env python3
"""Follows README.md and the pages of docs/ literally: each in a copy of the working tree of its own, its files written
and its commands run in one shell, in the page's order. What a block says that it prints must be printed.

usage: run_pages.py ROOT BUILD [--only PAGE] [--recipes FOLDER]
  BUILD     the folder of a finished build, whose programmes the commands find as build/release
  --recipes for docs/extending.md: bin/ and share/ with the page's recipes built in, their tests in bin/tests/

Commands that build or test the whole tree do nothing here, and the run says so: CI runs them as such.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import check_pages
import pages

WITH_RECIPES = "docs/extending.md"
# Pages that a different test follows, because their examples are more than commands.
OTHERS = {"docs/formats.md": "tests/schemas/formats_test.py", "docs/python.md": "tests/host/python/page_test.py"}
BUILT = """#!/bin/sh
echo "run_pages: $0 $*: the programmes are built already"
"""
TESTED = """#!/bin/bash
# Tests that a page chooses by name are run, where its recipes have them.
if [ "$1" = -R ] && compgen -G 'build/release/bin/tests/*' >/dev/null; then
  ran=
  for test in build/release/bin/tests/*; do
    "$test" --gtest_list_tests --gtest_filter="*$2*" | grep -q '^  ' || continue
    "$test" --gtest_filter="*$2*" || exit 1
    ran=1
  done
  [ -n "$ran" ] || { echo "test: found no test '$2'" >&2; exit 1; }
  exit
fi
echo "run_pages: $0 $*: the tests are run by CI as such"
"""
# The end of a command in the output of the shell: its line and its status.
END = "@@run_pages"


def working_copy(root, target):
    """What git tracks or would, or all but builds where there is no git."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "-coz", "--exclude-standard"], capture_output=True)
    if listed.returncode == 0:
        names = [name for name in listed.stdout.decode().split("\0") if name]
        for name in names:
            source = pathlib.Path(root) / name
            if not source.is_file() or name.startswith("shared/"):
                continue
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target / name)
    else:
        def left(folder, names):
            return {"build", ".git", "shared"} & set(names) if folder == str(root) else {"node_modules"} & set(names)
        shutil.copytree(root, target, dirs_exist_ok=True, ignore=left)


def prepared(root, build, recipes, target):
    """`recipes`: the folder whose programmes and machines are in the place of those of the build, or none."""
    working_copy(root, target)
    release = target / "build/release"
    release.mkdir(parents=True, exist_ok=True)
    for folder in [recipes] if recipes else []:
        for name in ("bin", "share"):
            (release / name).symlink_to((pathlib.Path(folder) / name).resolve())
    for entry in pathlib.Path(build).resolve().iterdir():
        if not (release / entry.name).is_symlink():
            (release / entry.name).symlink_to(entry)
    shutil.copy2(target / "toolchain/test", target / "toolchain/test.original")
    for name, text in (("setup", BUILT), ("build", BUILT), ("test", TESTED)):
        path = target / "toolchain" / name
        path.write_text(text)
        path.chmod(0o755)


def commands_of(block):
    """(line, text): a command with its continued lines and here-documents."""
    pending, first, end = [], 0, ""
    for number, line in enumerate(block.lines, block.line + 1):
        if not pending and (not line.strip() or line.lstrip().startswith("#")):
            continue
        first = first if pending else number
        pending.append(line)
        if end:
            if line.strip() != end:
                continue
        elif match := re.search(r"<<-?\s*'?(\w+)'?", line):
            end = match[1]
            continue
        elif line.rstrip().endswith("\\"):
            continue
        yield first, "\n".join(pending)
        pending, end = [], ""
    if pending:
        yield first, "\n".join(pending)


class Shell:
    """One bash for all commands of a page, so that a folder entered and a variable set last."""

    def __init__(self, folder):
        environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.process = subprocess.Popen(["bash", "--noprofile", "--norc"], cwd=folder, env=environment, text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def run(self, command):
        """(status, output)."""
        # A command that reads its input must not read the next commands.
        self.process.stdin.write(f"{{ {command}\n}} </dev/null\nstatus_of_page=$?; echo; echo {END} $status_of_page\n")
        self.process.stdin.flush()
        output = []
        for line in self.process.stdout:
            if line.startswith(END):
                return int(line.split()[1]), "".join(output)
            output.append(line)
        return self.process.wait(), "".join(output)

    def close(self):
        self.process.communicate()


def words(line):
    return " ".join(line.split())


def missing_lines(block, output):
    """Lines of a block that the output does not have in this order; "..." is anything."""
    printed = [words(line) for line in output.splitlines()]
    at = 0
    for line in block.lines:
        if line.strip() in ("", "..."):
            continue
        wanted = re.compile(".*".join(re.escape(part.strip()) for part in words(line).split("...")))
        found = next((k for k in range(at, len(printed)) if wanted.fullmatch(printed[k])), None)
        if found is None:
            yield line
        else:
            at = found + 1


def missing_programmes(command, folder):
    """Of a command that is not run: its programme, where it has a path, and options of the script of the suites."""
    words_of = command.split("  #")[0].split()
    programme = words_of[0]
    if "/" in programme and not (pathlib.Path(folder) / programme).exists():
        yield programme
    if programme.endswith("toolchain/test"):
        known = (pathlib.Path(folder) / "toolchain/test.original").read_text()
        yield from (word for word in words_of[1:] if word.startswith("--") and not re.search(rf"{word}\b", known))


def follow(page, folder, report):
    """Yields findings of a page in its copy of the tree. `report`: counts what was run and what was not."""
    shell, output = Shell(folder), None
    try:
        for block in page.blocks:
            if block.creates or block.changes:
                try:
                    pages.write_file(block, folder)
                except pages.PageError as error:
                    yield str(error)
                continue
            if block.language == "sh":
                reasons = [mark for mark in block.marks if mark != "refused"]
                commands = list(commands_of(block))
                if reasons:
                    for line, text in commands:
                        report["left"].append(f"{page.name}:{line}: {check_pages.MARKS['sh'][reasons[0]]}: {text}")
                        for missing in missing_programmes(text, folder):
                            yield f"{page.name}:{line}: there is no {missing}"
                    output = None
                    continue
                output = ""
                for line, text in commands:
                    begin = time.monotonic()
                    status, printed = shell.run(text)
                    output += printed
                    report["run"] += 1
                    report["times"].append((time.monotonic() - begin, f"{page.name}:{line}", text.splitlines()[0]))
                    report["said"] += [said for said in printed.splitlines() if said.startswith("run_pages: ")]
                    if status not in ((1, 2) if "refused" in block.marks else (0,)):
                        tail = "\n    ".join(printed.splitlines()[-15:])
                        yield f"{page.name}:{line}: `{text}` ended with {status}\n    {tail}"
                        if shell.process.poll() is not None:
                            return
            elif "printed" in block.marks:
                if output is None:
                    yield f"{block.place}: no command was run whose output this is"
                    continue
                for line in missing_lines(block, output):
                    yield f"{block.place}: not printed: {line}"
                    report["output"][block.place] = output
    finally:
        shell.close()


def planned(folder):
    """Yields a finding if the tree that a reader has now cannot be configured, or a source of it is missing: all that a
    build would do, but for the compiler."""
    for command in (["cmake", "-G", "Ninja", "-S", folder, "-B", f"{folder}/planned", "-DSTICTION_TESTS=ON"],
                    ["cmake", "--build", f"{folder}/planned", "--", "-n"]):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            tail = "\n    ".join((done.stdout + done.stderr).splitlines()[-15:])
            yield f"{WITH_RECIPES}: the tree with all recipes cannot be built: {' '.join(command[:2])}\n    {tail}"
            return


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root")
    parser.add_argument("build")
    parser.add_argument("--only", action="append", default=[], metavar="PAGE")
    parser.add_argument("--recipes", metavar="FOLDER")
    parser.add_argument("--show", action="store_true", help="print the output of commands whose text differs")
    arguments = parser.parse_args()
    root = pathlib.Path(arguments.root).resolve()
    names = ["README.md"] + sorted(path.relative_to(root).as_posix() for path in (root / "docs").glob("*.md"))
    every_page = [pages.read_page(root, name) for name in names]
    found = [] if arguments.only else list(check_pages.findings(root, every_page))
    report = {"run": 0, "left": [], "said": [], "times": [], "output": {}}
    for page in every_page:
        if arguments.only and page.name not in arguments.only:
            continue
        recipes = arguments.recipes if page.name == WITH_RECIPES else None
        if page.name == WITH_RECIPES and not recipes:
            report["left"].append(f"{page.name}: needs its recipes built")
            continue
        if (root / OTHERS.get(page.name, "none")).is_file():
            report["said"].append(f"run_pages: {page.name}: {OTHERS[page.name]} follows it")
            continue
        if not any(block.language == "sh" for block in page.blocks):
            continue
        with tempfile.TemporaryDirectory(prefix="stiction-pages-") as folder:
            prepared(root, arguments.build, recipes, pathlib.Path(folder))
            found += follow(page, folder, report)
            if recipes:
                found += planned(folder)
    print(f"{report['run']} commands run, {len(report['left'])} not:")
    for each in report["left"]:
        print(f"  not run: {each}")
    for each in dict.fromkeys(report["said"]):
        print(f"  replaced: {each.removeprefix('run_pages: ')}")
    for seconds, place, text in sorted(report["times"], reverse=True)[:8]:
        print(f"  {seconds:5.1f} s  {place}: {text}")
    if arguments.show:
        for place, output in report["output"].items():
            print(f"--- printed before {place}\n{output}")
    for each in found:
        print(each)
    print(f"{len(found)} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
