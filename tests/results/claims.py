"""The table of claims: what docs/results.md says, where its figure comes from and how far it may be off.

tests/results/claims/*.toml: a file a section, in the order of their names.

  title, text, after      the section's heading, what stands above its table and below it (Markdown)
  [[row]]
  key         one word, the name of its values in kept.toml
  what        the claim, without its value
  source      a name in sources.toml; or
  campaign    a name in campaigns.toml, with `kind` and `count` (k of n) or `mean` (a mean over the cases)
  figure      the name that is printed before the value, or several; with `*`, any text: a pattern for whole lines, and the
              row takes all of them
  take        regular expression whose groups are the numbers; without it the first number
  value       the text of the value: {1} is the first number, {max1} and {min1} the largest and least of all lines, {n}
              the lines. Without it "{1} UNIT".
  unit        of the value; what has none counts something, which is its unit
  bound       what is wanted, as text; "none: REASON" where nothing is
  limits      one text a number of the value, as "<= 2" or "" for none: a number beyond it is marked as missed
  tolerance   how far a new figure may be off: "2 %", "0.1" (the same unit), "exact" or "none". Without it whole numbers
              are exact and others within 2 % or one unit of their last digit.
  command     prints the figure; without it the source's, or `toolchain/test -R TEST`
  test        the test (or several) that prints it, as ctest names it
"""

import fnmatch
import pathlib
import re
import tomllib

FOLDER = pathlib.Path(__file__).parent
NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
HELD = ("source", "campaign")
KEYS = {"key", "what", "source", "campaign", "kind", "count", "mean", "figure", "take", "value", "unit", "bound",
        "limits", "tolerance", "command", "test"}


class ClaimError(Exception):
    """A row that cannot be used; the message names it."""


def as_list(value):
    return value if isinstance(value, list) else [value]


class Row:
    """One claim."""

    def __init__(self, table, sources):
        self.key = table.get("key", "?")
        unknown = set(table) - KEYS
        if unknown:
            raise ClaimError(f"row '{self.key}': unknown {', '.join(sorted(unknown))}")
        for key in ("key", "what", "unit", "bound"):
            if not str(table.get(key, "")).strip():
                raise ClaimError(f"row '{self.key}': '{key}' is missing")
        if sum(key in table for key in HELD) != 1:
            raise ClaimError(f"row '{self.key}': wants either 'source' or 'campaign'")
        self.what, self.unit, self.bound = table["what"], table["unit"], table["bound"]
        self.source, self.campaign = table.get("source"), table.get("campaign")
        self.kind, self.count, self.mean = table.get("kind", ""), table.get("count"), table.get("mean")
        if self.source and self.source not in sources:
            raise ClaimError(f"row '{self.key}': unknown source '{self.source}'")
        if self.campaign and bool(self.count) == bool(self.mean):
            raise ClaimError(f"row '{self.key}': wants either 'count' or 'mean'")
        self.figures = as_list(table.get("figure", []))
        if self.source and not self.figures:
            raise ClaimError(f"row '{self.key}': 'figure' is missing")
        self.take = re.compile(table.get("take", f"({NUMBER})"))
        self.value = table.get("value", "{1} " + self.unit)
        if self.unit not in self.value:
            raise ClaimError(f"row '{self.key}': its value does not hold its unit, {self.unit}")
        self.fields = re.findall(r"\{(\w+)\}", self.value)
        self.limits = table.get("limits", [])
        if self.limits and len(self.limits) != (len(self.fields) if self.source else 1):
            raise ClaimError(f"row '{self.key}': {len(self.limits)} limits for {len(self.fields)} numbers")
        self.tolerance = str(table.get("tolerance", ""))
        self.tests = as_list(table.get("test", []))
        self.command = table.get("command") or (
            f"toolchain/test -R '{'|'.join(self.tests)}'" if len(self.tests) > 1 or "*" in "".join(self.tests)
            else f"toolchain/test -R {self.tests[0]}" if self.tests
            else sources[self.source]["command"] if self.source and self.source != "plain" else "")
        if not self.command:
            raise ClaimError(f"row '{self.key}': no 'command' and no 'test' prints it")

    def matches(self, line):
        """The text behind the name when `line` is one of this row's figures."""
        for figure in self.figures:
            if "*" in figure:
                if fnmatch.fnmatchcase(line, figure):
                    return figure, line
            elif line.startswith(figure) and line[len(figure):len(figure) + 1] in (" ", ":"):
                return figure, line[len(figure):].lstrip(": ").strip()
        return None

    def numbers(self, texts):
        """The numbers of the row, as they are printed, from [(figure, text)]; ClaimError when they are not there."""
        groups = []
        for figure, text in texts:
            found = self.take.search(text)
            if not found:
                raise ClaimError(f"row '{self.key}': '{self.take.pattern}' is not in '{text}' of '{figure}'")
            groups.append(list(found.groups()))
        wild = any("*" in figure for figure in self.figures)
        if not wild:
            in_order = [g for figure in self.figures for (f, _), each in zip(texts, groups) if f == figure for g in each]
            missing = [figure for figure in self.figures if figure not in [f for f, _ in texts]]
            if missing:
                raise ClaimError(f"row '{self.key}': nothing printed '{missing[0]}'")
        values = []
        for field in self.fields:
            if field == "n":
                values.append(str(len(groups)))
            elif wild:
                choose = {"max": max, "min": min}.get(field[:3])
                column = int(field[3:]) - 1
                if not choose:
                    raise ClaimError(f"row '{self.key}': {{{field}}} of many lines is not one number")
                values.append(choose((g[column] for g in groups), key=float))
            else:
                if int(field) > len(in_order):
                    raise ClaimError(f"row '{self.key}': {{{field}}} of {len(in_order)} numbers")
                values.append(in_order[int(field) - 1])
        return values

    def text(self, values):
        """The value with its unit, from the numbers that are kept."""
        rest = list(values)
        text = re.sub(r"\{\w+\}", lambda _: rest.pop(0), self.value)
        missed = [limit for value, limit in zip(values, self.limits) if limit and not within(float(value), limit)]
        return text + (" (**missed**)" if missed else "")

    def differs(self, kept, new):
        """Whether a new number is further from the kept one than the row allows."""
        if self.tolerance == "none" or kept == new:
            return False
        if self.tolerance == "exact" or not re.fullmatch(NUMBER, kept) or not re.fullmatch(NUMBER, new):
            return True
        a, b = float(kept), float(new)
        if self.tolerance.endswith("%"):
            return abs(b - a) > abs(a) * float(self.tolerance[:-1]) / 100.0 * (1 + 1e-12)
        if self.tolerance:
            return abs(b - a) > float(self.tolerance) * (1 + 1e-12)
        if re.fullmatch(r"[-+]?\d+", kept) and re.fullmatch(r"[-+]?\d+", new):
            return True
        return abs(b - a) > max(0.02 * abs(a), last_digit(kept)) * (1 + 1e-9)


def last_digit(text):
    """One unit of the last digit of a printed number."""
    mantissa, _, exponent = text.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals)


def within(value, limit):
    relation, bound = limit.split()
    return {"<=": value <= float(bound), ">=": value >= float(bound), "<": value < float(bound),
            "=": value == float(bound)}[relation]


class Section:
    """A heading with its table."""

    def __init__(self, table, sources):
        self.title = table["title"]
        self.text, self.after = table.get("text", "").strip(), table.get("after", "").strip()
        self.rows = [Row(row, sources) for row in table.get("row", [])]


def read_sources(folder=FOLDER):
    return tomllib.loads((folder / "sources.toml").read_text(encoding="utf-8"))


def read_claims(folder=FOLDER):
    """The sections in the order of their files; ClaimError for a row that lacks something or a key in use twice."""
    sources = read_sources(folder)
    sections = []
    for file in sorted((folder / "claims").glob("*.toml")):
        try:
            sections.append(Section(tomllib.loads(file.read_text(encoding="utf-8")), sources))
        except (ClaimError, tomllib.TOMLDecodeError, re.error) as error:
            raise ClaimError(f"{file.name}: {error}") from error
    keys = [row.key for section in sections for row in section.rows]
    twice = {key for key in keys if keys.count(key) > 1}
    if twice:
        raise ClaimError(f"in use twice: {', '.join(sorted(twice))}")
    return sections
