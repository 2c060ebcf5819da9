"""The grammar of a programme's command line, read from the help of each of its commands."""

import dataclasses
import re
import subprocess


@dataclasses.dataclass(frozen=True)
class Argument:
    """An option, or a positional argument, whose name has no dashes."""
    name: str
    takes: str = ""  # what the help calls its value: FILE, KEY=VALUE; empty: a flag
    choices: tuple = ()
    required: bool = False
    many: bool = False


@dataclasses.dataclass(frozen=True)
class Command:
    """A command that runs by itself."""
    words: tuple  # ("simulate", "circle")
    arguments: tuple


def section(text, title):
    found = re.search(rf"^{title}:\n((?:  .*\n|\n)*)", text, re.MULTILINE)
    return found[1] if found else ""


def entries(text):
    """The left column of each entry; what it says of it, and lines that go on, begin further to the right."""
    for line in text.splitlines():
        if found := re.match(r"  (\S.*?)(?:\s{2,}|$)", line):
            yield found[1]


def argument_of(entry):
    """From an entry such as `-h,--help`, `--set KEY=VALUE ...`, `--feed "NUMBER UNIT"=16 m/min`, `logs LOG ...`."""
    entry, _, _ = entry.partition(" Excludes:")
    name, _, rest = entry.partition(" ")
    name = name.split(",")[-1]
    required = " REQUIRED" in f" {rest}"
    rest = rest.replace("REQUIRED", "").strip()
    many = rest.endswith("...")
    rest = rest.removesuffix("...").strip()
    choices = ()
    if found := re.search(r"\{([^}]*)\}", rest):
        choices = tuple(found[1].split(","))
    takes = re.split(r":\{|=(?=[^=]*$)", rest)[0] if not rest.startswith("KEY=VALUE") else "KEY=VALUE"
    return Argument(name, takes.strip('"'), choices, required, many)


def commands_below(text):
    return [entry.split()[0] for entry in entries(section(text, "Subcommands"))]


def command_of(words, text):
    """A command from its help."""
    arguments = [argument_of(entry) for entry in entries(section(text, "Options"))]
    positional = [argument_of(entry) for entry in entries(section(text, "Positionals"))]
    # A flag has nothing behind its name; a positional argument always has a value.
    positional = [dataclasses.replace(each, takes=each.takes or "TEXT") for each in positional]
    return Command(words, tuple(argument for argument in positional + arguments if argument.name != "--help"))


def read(program, *words):
    """All commands of the programme that have none below them."""
    text = subprocess.run([program, *words, "--help"], check=True, capture_output=True, text=True).stdout
    below = commands_below(text)
    own = command_of(words, text)
    if not below:
        return [own]
    inner = [command for word in below for command in read(program, *words, word)]
    # A command that also works without those below it has options of its own; the programme has --version alone.
    return ([own] if words and own.arguments else []) + inner
