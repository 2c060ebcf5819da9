"""Phrases that texts for users do not have, and what to say instead.

Texts for users are the string literals of the product, the pages' HTML and scripts, the pages of docs/ and README.md.
Whoever adds a row gives the plain word for it.
"""

import re

import cpp_text

# (pattern, instead)
EVERYWHERE = [
    (r"\btak(?:es?|ing) (?:\S+ ){0,8}away\b", "explains, removes, reduces"),
    (r"\bbeside\b", "next to, together with, in addition to, given"),
    (r"\bto judge on\b", "for validation"),
    (r"\bjudged? (?:on|against)\b|\bheld against\b", "validated on, compared with"),
    (r"\bits maker\b", "nominal"),
    (r"\bbelongs? into\b", "belongs in"),
    (r"\b(?:no|some)body\b", "unknown; name who or what: a client, a user"),
    (r"\bst(?:ands?|ood)\b(?! for\b)", "is; is at standstill; is written"),
    (r"(?<!\bone )(?<!\bafter )(?<!\beach )\banother\b", "a different one; one more"),
    (r"\b(?:beside|beyond|less|minus|times|of|than|upon|above|below) what\b", "a noun: the measured force, the residual"),
    (r"\bwhat (?:stays|remains?|remained|happens|happened|repeats|grows|lags|drifts)\b", "a noun: the residual, the remainder"),
    (r"\bwhat (?:is|was|has been|were) (?:left|hidden|written|measured|learned|missing|exchanged|given|open|commanded)\b",
     "a noun: the residual, the hidden effect, the files"),
    (r"\b\w+(?:'s|s'|’s) (?:\w+ )?\w+(?:'s|s'|’s) (?=\w)", "of: no possessive of a possessive"),
    (r"\banew\b", "again"),
    (r"\bin the mean\b", "on average"),
    (r"\bstretch(?:es)?\b", "segment"),
    (r"\bleaves? over\b|\bleft over\b", "the residual"),
    (r"\bswing(?:s|ing)?\b|\bswung\b", "oscillation, oscillates"),
    (r"\bhunts?\b|\bhunting\b", "limit cycle"),
    (r"'s doing\b", "is caused by"),
    (r"\bway (?:since|before sliding|is free|of (?:at|the))\b|\balong the way\b|\b(?:measured|recorded) way\b",
     "displacement, path"),
    (r"\bbears?\b|\bborne\b", "tolerates; concerns"),
    (r"\bspeaks? (?:of|against)\b", "mentions; prevents"),
    (r"\bto and fro\b", "back and forth"),
]
# In comments as well.
COMMENTS = [
    (r"\bnobody's\b", "unknown, without an owner"),
    (r"\bto judge on\b", "for validation"),
    (r"\bwhat its maker\b", "the nominal"),
    (r"\bbelongs? into\b", "belongs in"),
    (r"\btak(?:es?|ing) (?:\S+ ){0,8}away,? beside\b", "explains"),
]
# Where a page shows the text as it is written; files that are read keep their ASCII units.
PAGES = [
    (r"(?<=[\d}] )\+-|(?<=[\d}])\+-|\+-(?=[\d{])", "±"),
    (r"(?<=[\d}] )u[ms]\b|(?<=[\d}])u[ms]\b|, u[ms]\b", "µm, µs"),
]
COMPILED = {kind: [(re.compile(pattern, re.I), instead) for pattern, instead in rows]
            for kind, rows in (("everywhere", EVERYWHERE), ("pages", EVERYWHERE + PAGES), ("comments", COMMENTS))}

CODE_BLOCK = re.compile(r"^(```|~~~)")
INLINE_CODE = re.compile(r"`[^`]*`")
TAG = re.compile(r"<[^>]*>|\{\{\w+\}\}")


def passages(name, text):
    """The texts for users in a file of that name: (kind, Passage)."""
    if name.endswith((".cpp", ".hpp", ".h")):
        yield from (("everywhere", passage) for passage in cpp_text.literals(text))
        yield from (("comments", passage) for passage in cpp_text.comments(text))
    elif name.endswith(".js"):
        yield from (("pages", passage) for passage in cpp_text.script_literals(text))
        yield from (("comments", passage) for passage in cpp_text.comments(text, script=True))
    elif name.endswith(".html"):
        yield "pages", of_lines(TAG.sub(lambda tag: " " + "\n" * tag[0].count("\n"), text).split("\n"))
    elif name.endswith(".md"):
        yield "pages", of_lines(prose(text))


def of_lines(lines):
    passage = cpp_text.Passage()
    for number, line in enumerate(lines, 1):
        passage.add(number, line + " ")
    return passage


def prose(text):
    """The lines of a page, empty where they are code; words in `backticks` are names, not language."""
    inside = False
    for line in text.split("\n"):
        if CODE_BLOCK.match(line.strip()):
            inside = not inside
            line = ""
        yield "" if inside else INLINE_CODE.sub("`…`", line)


def findings(name, text):
    """Yields (line, message) for a file."""
    for kind, passage in passages(name, text):
        for pattern, instead in COMPILED[kind]:
            for match in pattern.finditer(passage.text):
                yield passage.line(match.start()), f'"{match[0]}": say instead: {instead}'
