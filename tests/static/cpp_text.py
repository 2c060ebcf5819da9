"""Reads C++ and JavaScript as text: tokens, string literals and comments with their lines. No compiler, no preprocessor.

A Passage is a piece of text whose characters know the lines of the file that they came from.
"""

import bisect
import re

TOKEN = re.compile(
    r"(?P<comment>//(?:\\\n|[^\n])*|/\*.*?\*/)"
    r'|(?P<raw>\b(?:u8|[uUL])?R"(?P<mark>[^(\s"]*)\((?P<raw_text>.*?)\)(?P=mark)")'
    r'|(?P<literal>"(?P<text>(?:\\.|[^"\\\n])*)")'
    r"|(?P<number>\.?\d(?:'?[\w.]|[eEpP][+-])*)"
    r"|(?P<character>'(?:\\.|[^'\\\n])+')"
    r"|(?P<directive>^[ \t]*\#(?:\\\n|[^\n])*)"
    r"|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<symbol>::|->|\.\.\.|&&|\|\||[^\s\w])", re.S | re.M)
KINDS = ("comment", "raw", "literal", "number", "character", "directive", "word", "symbol")

# The quotes of JavaScript, and what may precede a comment: an address in a string is none.
SCRIPT = re.compile(r"(?P<comment>//[^\n]*|/\*.*?\*/)|'(?P<single>(?:\\.|[^'\\\n])*)'|\"(?P<double>(?:\\.|[^\"\\\n])*)\""
                    r"|`(?P<template>(?:\\.|[^`\\])*)`", re.S)
ESCAPES = {"n": " ", "t": " ", '"': '"', "\\": "\\", "'": "'"}


class Passage:
    def __init__(self):
        self.text = ""
        self.starts, self.lines = [], []  # the text from each start on is of this line

    def add(self, line, text):
        self.starts.append(len(self.text))
        self.lines.append(line)
        self.text += text

    def line(self, position):
        return self.lines[bisect.bisect_right(self.starts, position) - 1]


def tokens(text):
    """Yields (kind, text, line, value); `value`: a literal's text without its quotes, else the text itself."""
    line, seen = 1, 0
    for match in TOKEN.finditer(text):
        kind = match.lastgroup if match.lastgroup in KINDS else next(k for k in KINDS if match[k] is not None)
        line += text.count("\n", seen, match.start())
        seen = match.start()
        value = match["raw_text"] if kind == "raw" else match["text"] if kind == "literal" else match[0]
        yield ("literal" if kind == "raw" else kind, match[0], line, value)


def unescaped(text):
    return re.sub(r"\\(.)", lambda match: ESCAPES.get(match[1], match[1]), text, flags=re.S)


def literals(text):
    """Yields a Passage for each string literal; adjacent ones, which the compiler joins, are one."""
    passage = None
    for kind, _, line, value in tokens(text):
        if kind == "literal":
            passage = passage or Passage()
            for number, part in enumerate(unescaped(value).split("\n")):
                passage.add(line + number, (" " if number else "") + part)
        elif kind != "comment" and passage:
            yield passage
            passage = None
    if passage:
        yield passage


def script_literals(text):
    """The same for JavaScript. What ${...} computes is a part of the text, as its own literals are texts too."""
    for match in SCRIPT.finditer(text):
        if match["comment"] is None:
            passage, line = Passage(), text.count("\n", 0, match.start()) + 1
            value = next(value for value in (match["single"], match["double"], match["template"]) if value is not None)
            for number, part in enumerate(unescaped(value).split("\n")):
                passage.add(line + number, (" " if number else "") + part)
            yield passage


def comments(text, script=False):
    """Yields a Passage for each comment; line comments one below the other are one."""
    if script:
        found = ((text.count("\n", 0, match.start()) + 1, match["comment"])
                 for match in SCRIPT.finditer(text) if match["comment"] is not None)
    else:
        found = ((line, value) for kind, _, line, value in tokens(text) if kind == "comment")
    yield from joined(found, lambda part: part.strip("/* \t"))


def hash_comments(text):
    """The same for files in which a comment begins with #: TOML, Python, shell, CMake."""
    found = ((number, line.strip()) for number, line in enumerate(text.splitlines(), 1) if line.strip().startswith("#"))
    yield from joined(found, lambda part: part.lstrip("#! \t"))


def joined(found, bare):
    passage, last = None, None
    for line, comment in found:
        if passage and line != last + 1:
            yield passage
            passage = None
        passage = passage or Passage()
        for number, part in enumerate(comment.split("\n")):
            passage.add(line + number, (" " if passage.text else "") + bare(part))
            last = line + number
    if passage:
        yield passage
