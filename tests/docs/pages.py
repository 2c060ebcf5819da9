"""Pages of Markdown as a reader follows them: fenced blocks, files that a block gives or changes, headings and links.

A fence is opened by its language and marks: ```sh needs-root. A block is a file where the line before it is nothing but
the file's name in code and a colon, `my.toml`:, and changes a file where that line begins with "In" and names it: a diff
without line numbers, whose context must occur once.
"""

import dataclasses
import pathlib
import re

FENCE = re.compile(r"^(```+)([^`]*)$")
HEADING = re.compile(r"^(#+) +(.*?) *#*$")
NEW_FILE = re.compile(r"^(?:[-*] |\d+\. )?`([\w./-]+)`:$")
CHANGED_FILE = re.compile(r"^(?:[-*] |\d+\. )?In `([\w./-]+)`.*:$")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


class PageError(Exception):
    """What is wrong with a page, with its place."""


@dataclasses.dataclass
class Block:
    page: str
    line: int  # of the fence
    language: str
    marks: list
    lines: list
    section: str  # the anchor of the heading above
    creates: str = ""  # the file that it is
    changes: str = ""  # the file that it changes

    @property
    def text(self):
        return "\n".join(self.lines) + "\n"

    @property
    def place(self):
        return f"{self.page}:{self.line}"


def anchor(heading):
    """As GitHub makes it of a heading's text."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


class Page:
    def __init__(self, name, text):
        self.name, self.blocks, self.anchors, self.prose = name, [], set(), []
        before, block, fence = "", None, ""
        section = ""
        for number, line in enumerate(text.splitlines(), 1):
            match = FENCE.match(line.strip())
            if block is not None:
                if match and match[1] == fence and not match[2]:
                    self.blocks.append(block)
                    block, before = None, ""
                else:
                    block.lines.append(line)
            elif match:
                fence, words = match[1], match[2].split()
                block = Block(name, number, words[0] if words else "", words[1:], [], section)
                if new := NEW_FILE.match(before):
                    block.creates = new[1]
                elif changed := CHANGED_FILE.match(before):
                    block.changes = changed[1]
            else:
                if heading := HEADING.match(line):
                    section = anchor(heading[2])
                    self.anchors.add(section)
                if line.strip():
                    before = line.strip()
                self.prose.append((number, line))
        if block is not None:
            raise PageError(f"{name}:{block.line}: the block has no end")

    def links(self):
        """(line, target) of each link."""
        for number, line in self.prose:
            for match in LINK.finditer(line):
                yield number, match[1]

    def code_spans(self):
        """(line, text) of each piece of code within the prose."""
        for number, line in self.prose:
            for match in re.finditer(r"`([^`]+)`", line):
                yield number, match[1]


def read_page(root, name):
    return Page(name, (pathlib.Path(root) / name).read_text(encoding="utf-8"))


def places(lines, part):
    return [k for k in range(len(lines) - len(part) + 1) if lines[k:k + len(part)] == part]


def changed(text, block):
    """`text` with the changes of a diff block, each hunk of which must fit in exactly one place, or be there already, as
    in the tree of a reader who has followed the page."""
    lines = text.split("\n")
    hunks = [[]]
    for line in block.lines:
        if line.startswith("@@"):
            hunks.append([])
        else:
            hunks[-1].append(line)
    for hunk in filter(None, hunks):
        old = [line[1:] for line in hunk if line[:1] != "+"]
        new = [line[1:] for line in hunk if line[:1] != "-"]
        if len(places(lines, new)) == 1:
            continue
        found = places(lines, old)
        if len(found) != 1 or not old:
            raise PageError(f"{block.place}: {block.changes} has {len(found)} places for the change, expected one: {old}")
        lines[found[0]:found[0] + len(old)] = new
    return "\n".join(lines)


def write_text(path, text):
    """What has not changed keeps its time, so that nothing is compiled again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.is_file() and path.read_text(encoding="utf-8") == text:
        return
    path.unlink(missing_ok=True)
    path.write_text(text, encoding="utf-8")


def write_file(block, root):
    """Writes the file of a block below `root`, or changes it there; returns its name."""
    name = block.creates or block.changes
    path = pathlib.Path(root) / name
    if ".." in pathlib.PurePath(name).parts or name.startswith("/"):
        raise PageError(f"{block.place}: {name} is outside of the repository")
    if block.changes and block.language != "diff":
        raise PageError(f"{block.place}: a change of {name} is a diff")
    if block.changes and not path.is_file():
        raise PageError(f"{block.place}: there is no {name} to change")
    write_text(path, block.text if block.creates else changed(path.read_text(encoding="utf-8"), block))
    return name
