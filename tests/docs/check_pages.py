"""What can be seen of the pages without running them: languages and marks of blocks, links and their anchors, commands
of the README that no block has. Yields findings, each a line of text."""

import pathlib
import re

import pages

LANGUAGES = {"sh", "text", "toml", "python", "c", "cpp", "cmake", "json", "csv", "diff", "markdown", "js"}
# Why a block of commands is not run, or how it is.
MARKS = {
    "sh": {
        "needs-root": "changes the system",
        "needs-bus": "needs a CAN bus, a fieldbus or a PLC",
        "needs-hours": "takes too long for a test",
        "refused": "run; every command must be refused",
    },
    "text": {"printed": "lines that the commands above must print"},
}
COMMAND = re.compile(r"^(?:\./toolchain/\S+|toolchain/\S+|stiction|stictiond|stiction-plant|cmake|export|sudo) +\S")
PLACEHOLDER = re.compile(r" [A-Z]{2,}\b")


def blocks(page):
    for block in page.blocks:
        if block.language not in LANGUAGES:
            yield f"{block.place}: a block of '{block.language}'; expected one of {', '.join(sorted(LANGUAGES))}"
        for mark in block.marks:
            if mark not in MARKS.get(block.language, {}):
                known = ", ".join(MARKS.get(block.language, {})) or "none"
                yield f"{block.place}: unknown mark '{mark}'; a block of {block.language} may have {known}"


def links(page, root, others):
    """`others`: {name: Page} of all pages."""
    folder = pathlib.PurePosixPath(page.name).parent
    for line, target in page.links():
        if re.match(r"[a-z]+:", target):
            continue
        path, _, wanted = target.partition("#")
        name = page.name
        if path:
            parts = []
            for part in (folder / path).parts:
                parts = parts[:-1] if part == ".." else parts + [part]
            name = "/".join(parts)
            if not (pathlib.Path(root) / name).exists():
                yield f"{page.name}:{line}: the link {target} leads nowhere"
                continue
        if wanted:
            if name not in others:
                others[name] = pages.read_page(root, name)
            if wanted not in others[name].anchors:
                yield f"{page.name}:{line}: {name} has no heading #{wanted}"


def commands(readme, every_page):
    """A command line within the README's sentences is also in a block somewhere, where it is run."""
    known = [line.split("  #")[0].strip() for page in every_page for block in page.blocks if block.language == "sh"
             for line in block.lines]
    for line, text in readme.code_spans():
        given = PLACEHOLDER.split(text)[0].strip()  # up to the first word that a reader replaces
        if COMMAND.match(text) and not any(command.startswith(given) for command in known):
            yield f"{readme.name}:{line}: `{text}` is in no block of commands"


def findings(root, every_page):
    others = {page.name: page for page in every_page}
    for page in every_page:
        yield from blocks(page)
        yield from links(page, root, others)
        if page.name == "README.md":
            yield from commands(page, every_page)
