"""Tables of Markdown whose rows do not have as many cells as their head: a bar that is not escaped shifts the row."""

import re

BAR = re.compile(r"(?<!\\)\|")
RULE = re.compile(r"\s*\|?\s*:?-+:?\s*(\|\s*:?-+:?\s*)*\|?\s*$")


def cells(line):
    return len(BAR.findall(line.strip().strip("|"))) + 1


def findings(text):
    """Yields (line, message)."""
    wanted, fenced, before = None, False, ""
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced, wanted = not fenced, None
        elif not fenced and wanted is None and "|" in before and "|" in line and RULE.match(line):
            wanted = cells(before)
            if cells(line) != wanted:
                yield number, f"the rule of the table has {cells(line)} cells, its head {wanted}"
        elif wanted is not None and "|" not in line:
            wanted = None
        elif wanted is not None and cells(line) != wanted:
            yield number, f"the row has {cells(line)} cells, the head of its table {wanted}; a bar in a cell is \\|"
        before = line
