"""Whether a command of docs/results.md exists: its programme, its options, the tests that it names."""

import json
import re
import shlex
import subprocess


class Commands:
    def __init__(self, root, build):
        self.root, self.build = root, build
        self.usage = (root / "toolchain/test").read_text(encoding="utf-8").split("set -euo pipefail")[0]
        self.tests, self.partly = self.listed_tests()

    def listed_tests(self):
        """The names of all tests, and whether some programme of theirs is not built."""
        shown = subprocess.run(["ctest", "--test-dir", str(self.build), "--show-only=json-v1"], check=True,
                               capture_output=True, text=True).stdout
        names = [test["name"] for test in json.loads(shown)["tests"]]
        return names, any(name.endswith("_NOT_BUILT") for name in names)

    def in_sources(self, pattern):
        """Whether a test of a programme that is not built has this name in the sources."""
        suite, _, name = pattern.strip("^$").replace("\\", "").partition(".")
        suite = suite.rpartition("/")[2]
        wanted = re.compile(rf"TEST(_[FP])?\(\s*{re.escape(suite)},\s*{re.escape(name.partition('/')[0])}")
        return any(wanted.search(file.read_text(encoding="utf-8"))
                   for file in (self.root / "tests").rglob("*.cpp"))

    def missing(self, command):
        """What a command names that is not there, as sentences."""
        words = shlex.split(command)
        programme = words[0]
        if programme.startswith("build/release/bin/"):
            name = programme.rpartition("/")[2]
            targets = (self.build / "build.ninja").read_text(encoding="utf-8")
            return [] if f"build bin/{name}:" in targets else [f"the programme {name} is not in the build tree"]
        if not (self.root / programme).is_file():
            return [f"{programme} does not exist"]
        if programme != "toolchain/test":
            return []
        findings = [f"toolchain/test has no option {word}" for word in words[1:]
                    if word.startswith("-") and not re.search(rf"(^#\s+|; |\[){re.escape(word)}\b", self.usage, re.M)]
        if "-R" in words:
            for pattern in words[words.index("-R") + 1].split("|"):
                if not any(re.search(pattern, name) for name in self.tests) and not (
                        self.partly and self.in_sources(pattern)):
                    findings.append(f"no test has the name {pattern}")
        return findings
