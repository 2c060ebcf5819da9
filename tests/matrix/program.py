"""The programme `stiction` as a user runs it: one command in a folder, what it said, how it ended."""

import dataclasses
import json
import os
import pathlib
import re
import resource
import shlex
import signal
import subprocess
import time

# The longest command takes a minute of a core. Its own time counts: a busy machine may take long.
PATIENCE = 300  # s of processor time
PATIENCE_WAITING = 3600.0  # s, for a command that waits for something that does not come


@dataclasses.dataclass
class Outcome:
    """How a command ended: its exit code, below zero for a signal, None where it waited too long."""
    command: list
    code: int | None
    out: str
    error: str
    seconds: float

    def typed(self):
        return shlex.join(str(part) for part in self.command)

    def broke(self):
        """What no input may cause, in one word or two; None where the command ended by itself."""
        if self.code is None or self.code == -signal.SIGXCPU:
            return "no end"
        if self.code < 0:
            return signal.Signals(-self.code).name
        if "terminate called" in self.error:
            return "uncaught exception"
        return None

    def sentence(self):
        """The message of a refusal, None where it is not one line that says what was found and what is expected."""
        lines = [line for line in self.error.splitlines() if line.strip()]
        if len(lines) != 1 or self.out.strip():
            return None
        return lines[0] if re.search(r"\b(expected|needs?)\b", lines[0]) else None

    def json(self):
        return json.loads(self.out)


def limit_time(seconds):
    """In the command's process."""
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))


class Program:
    """The programme at `path`, with the machines that ship beside it."""

    def __init__(self, path):
        self.path = pathlib.Path(path).resolve()
        self.machines_folder = self.path.parents[1] / "share/stiction/machines"
        self.experiments = self.subcommands("simulate")
        self.options = {name: self.options_of("simulate", name) for name in self.experiments}

    def run(self, *arguments, folder=None, patience=PATIENCE, waiting=PATIENCE_WAITING):
        command = [self.path, *map(str, arguments)]
        begin = time.monotonic()
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, errors="replace",
                                   start_new_session=True, preexec_fn=lambda: limit_time(patience))
        try:
            out, error = process.communicate(timeout=waiting)
            code = process.returncode
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)  # with what it has started
            out, error = process.communicate()
            code = None
        return Outcome(["stiction", *map(str, arguments)], code, out, error, time.monotonic() - begin)

    def subcommands(self, *command):
        """Names of the commands below `command`, from its help."""
        text = self.run(*command, "--help").out
        _, _, list_of_them = text.partition("Subcommands:")
        return re.findall(r"^  ([a-z][a-z-]*)(?=\s)", list_of_them, re.MULTILINE)

    def options_of(self, *command):
        """The long options of a command, from its help."""
        return set(re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", self.run(*command, "--help").out, re.MULTILINE))

    def machines(self):
        """Names of the machines that ship."""
        listed = self.run("machine").out.split()
        return listed or sorted(file.stem for file in self.machines_folder.glob("*.toml"))
