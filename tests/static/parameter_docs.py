"""Finds public functions with more than two parameters whose comment leaves one of them out.

Public is what a header declares outside of anonymous and detail namespaces and of private and protected parts of a
class. The comment is the one above the declaration, or above the group of declarations without a blank line that it is
in, and what is written inside of it; for a constructor the comment of its class as well. A parameter is documented
where the comment holds its name as a word; one without a name, where it holds the last word of its type.
"""

import dataclasses
import re

import cpp_text

LEAST = 3  # parameters from which on each must be documented
NO_FUNCTION = {"using", "static_assert", "typedef", "concept"}
NO_NAME = {"if", "alignas", "decltype", "requires", "noexcept", "explicit", "sizeof", "while", "for", "switch"}
ACCESS = ("public", "private", "protected")


@dataclasses.dataclass
class Token:
    text: str
    line: int
    kind: str


@dataclasses.dataclass
class Scope:
    reachable: bool  # from outside of the header
    open: bool = True  # the part that is being read is public
    name: str = ""  # of a class
    line: int = 0

    def public(self):
        return self.reachable and self.open


# ---- statements: lists of tokens ----

def after(tokens, at):
    """Index behind the bracket that closes the one at `at`; angles count only where `at` is one, outside of others."""
    angles = tokens[at].text == "<"
    opening, closing = ("<", ">") if angles else ("([{", ")]}")
    depth = 0
    while at < len(tokens):
        text = tokens[at].text
        if angles and text in "([{":
            at = after(tokens, at)
            continue
        depth += (text in opening) - (text in closing)
        at += 1
        if depth == 0:
            break
    return at


def opens_template(tokens, at):
    return tokens[at].text == "<" and at > 0 and tokens[at - 1].kind == "word" and tokens[at - 1].text != "operator"


def of_operator(tokens, at):
    return any(token.text == "operator" for token in tokens[max(0, at - 3):at])


def behind_requirement(tokens, at):
    """Index behind a requires-clause whose expression begins at `at`: (...), or concepts joined by && and ||."""
    while at < len(tokens):
        if tokens[at].text == "(":
            at = after(tokens, at)
        else:
            at += 1
            while at < len(tokens) and tokens[at].text in ("::", "<"):
                at = at + 2 if tokens[at].text == "::" else after(tokens, at)
        if at >= len(tokens) or tokens[at].text not in ("&&", "||"):
            break
        at += 1
    return at


def bare(statement):
    """The statement without template parameters, requirements and attributes before it."""
    at = 0
    while at + 1 < len(statement):
        text, following = statement[at].text, statement[at + 1].text
        if text == "template" and following == "<":
            at = after(statement, at + 1)
        elif text == "[" and following == "[":
            at = after(statement, at)
        elif text == "requires":
            at = behind_requirement(statement, at + 1)
        else:
            break
    return statement[at:]


def signature(statement):
    """(name, tokens of the parameters, index behind them) of a function's declaration, or None."""
    statement = bare(statement)
    if not statement or statement[0].text in NO_FUNCTION:
        return None
    at = 0
    while at < len(statement):
        text = statement[at].text
        if text == "(":
            end = after(statement, at)
            before = statement[at - 1] if at else None
            if before and (before.kind == "word" or of_operator(statement, at)) and before.text not in NO_NAME:
                return before.text, statement[at + 1:end - 1], statement[end:]
            at = end
        elif text in "[{" or opens_template(statement, at):
            at = after(statement, at)
        elif text == "=" and not of_operator(statement, at):
            return None
        else:
            at += 1
    return None


def parameters(tokens):
    """Names of the parameters; of one that has none, because it is not used, the last word of its type."""
    parts, at = [[]], 0
    while at < len(tokens):
        if tokens[at].text in "([{" or opens_template(tokens, at):
            end = after(tokens, at)
            parts[-1] += tokens[at:end]
            at = end
            continue
        if tokens[at].text == ",":
            parts.append([])
        else:
            parts[-1].append(tokens[at])
        at += 1
    return [parameter_name(part) for part in parts if part]


def parameter_name(part):
    texts = [token.text for token in part]
    if "=" in texts:
        part = part[:texts.index("=")]
    while part and part[-1].text == "]":
        part = part[:max(i for i, token in enumerate(part) if token.text == "[")]
    if part and part[-1].text == ")":  # T (&name)[N]
        part = part[:-1]
    return next((token.text for token in reversed(part) if token.kind == "word" and token.text != "const"), "void")


# ---- headers ----

class Header:
    def __init__(self, text):
        self.lines = text.split("\n")
        self.tokens, self.comments = [], {}  # by line
        for kind, word, line, _ in cpp_text.tokens(text):
            if kind == "comment":
                for number, part in enumerate(word.split("\n")):
                    self.comments[line + number] = self.comments.get(line + number, "") + " " + part
            elif kind != "directive":
                self.tokens.append(Token(word, line, kind))

    def functions(self):
        """Yields (statement, last line, scope) of each declaration that may be a function's."""
        scopes, statement, at = [Scope(True)], [], 0
        while at < len(self.tokens):
            token = self.tokens[at]
            if token.text in "([":
                end = after(self.tokens, at)
                statement += self.tokens[at:end]
                at = end
                continue
            at += 1
            if token.text == "{":
                opened = scope_of(statement)
                if opened:
                    opened.reachable = opened.reachable and scopes[-1].public()
                    scopes.append(opened)
                    statement = []
                    continue
                end = after(self.tokens, at - 1)
                if has_body(statement):
                    yield statement, token.line, scopes[-1]
                    statement = []
                else:
                    statement += self.tokens[at - 1:end]
                at = end
            elif token.text == "}":
                del scopes[max(1, len(scopes) - 1):]
                statement = []
            elif token.text == ";":
                yield statement, token.line, scopes[-1]
                statement = []
            elif token.text == ":" and len(statement) == 1 and statement[0].text in ACCESS:
                scopes[-1].open = statement[0].text == "public"
                statement = []
            else:
                statement.append(token)

    def undocumented(self):
        """Yields (line, function, names of the parameters that the comment leaves out)."""
        for statement, last, scope in self.functions():
            found = signature(statement)
            if found is None or not scope.public():
                continue
            name, inside, _ = found
            names = parameters(inside)
            if len(names) < LEAST:
                continue
            line = statement[0].line
            comment = self.comment(line, last)
            if name == scope.name:
                comment += self.comment(scope.line, scope.line)
            missing = [each for each in names if not re.search(rf"\b{each}\b", comment)]
            if missing:
                yield line, name, missing

    def comment(self, first, last):
        """What is written in the lines of a declaration, and above it or its group."""
        inside = [self.comments.get(line, "") for line in range(first, last + 1)]
        line = first - 1
        while not self.is_comment(line) and self.declares(line):
            line -= 1
        above = []
        while self.is_comment(line):
            above.append(self.comments[line])
            line -= 1
        return " ".join(above + inside)

    def is_comment(self, line):
        return line > 0 and line in self.comments and self.lines[line - 1].strip().startswith(("//", "/*", "*"))

    def declares(self, line):
        """Whether the line may belong to another declaration of the same group."""
        text = self.lines[line - 1].split("//")[0].strip() if line > 0 else ""
        return bool(text) and not text.endswith(("{", ":"))


def scope_of(statement):
    """The scope that a brace behind the statement opens; None where it opens none."""
    tokens = bare(statement)
    words = [token.text for token in tokens]
    if not words or words[0] == "extern":
        return Scope(bool(words))
    if "namespace" in words[:2]:
        name = words[words.index("namespace") + 1:]
        return Scope(bool(name) and not any(word.endswith("detail") for word in name))
    if words[0] in ("class", "struct", "union"):
        name = next((token.text for token in tokens[1:] if token.kind == "word" and token.text not in NO_NAME), "")
        return Scope(True, words[0] != "class", name, statement[0].line)
    return Scope(False) if words[0] == "enum" else None


def has_body(statement):
    """Whether a brace behind the statement opens a function's body, and not an initialiser or a requirement."""
    found = signature(statement)
    if found is None or statement[-1].text in ("=", "return"):
        return False
    initialises_members = any(token.text == ":" for token in found[2])
    return not (initialises_members and statement[-1].kind == "word" and statement[-1].text != "noexcept")


def findings(text):
    """Yields (line, message) for a header."""
    for line, name, missing in Header(text).undocumented():
        yield line, f"the comment of {name}() says nothing of {', '.join(missing)}"
