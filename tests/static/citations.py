"""Finds citations that lead nowhere: a link, a path or a file's name that is not in the repository, a document named
without a reference, a publication that docs/sources.md does not list.

Citations are looked for in comments, in pages (.md) and, of documents, in string literals as well.
"""

import re
import unicodedata

import cpp_text

SOURCES_PAGE = "docs/sources.md"
ROOMS = "firmware|hal|host|sim|tests|toolchain|docs|examples"
LINK = re.compile(r"\]\(([^)\s]+)\)")
PATH = re.compile(rf"(?<![\w/.<$}}-])(?:{ROOMS})/[\w./*{{}}<>-]+")
FILE = re.compile(r"(?<![\w/.*>-])(?:[\w-]+/)*[\w-]+\.(?:hpp|cpp|md|py)\b(?!/)")
PLACEHOLDER = re.compile(r"[*{}<>]|(?:^|/)[A-Z]{2,}(?:[/_.]|$)")
# A block of a page that is a file (tests/docs/pages.py): its name in a line of its own.
GIVEN = re.compile(r"^(?:[-*] |\d+\. )?`([\w./-]+)`:$", re.M)
NO_PLACEHOLDER = re.compile(r"(?:^|/)(?:README\.md|CMakeLists\.txt)$")
DOCUMENT = re.compile(r"\b(?:plant|cam|drive|plan|diagnosis|friction|hil|sources'?) stud(?:y|ies)\b|\b[Tt]he study\b"
                      r"|\bstudy's\b|\b[Cc]ontract\b|\.\./shared\b")
NAME = r"[A-ZÀ-Ž][\w'’-]+"
PUBLICATION = re.compile(rf"({NAME}(?:(?:,? (?:and|&) |, | )(?:den |de )?{NAME})*(?:,? et al\.?)?),? \(?((?:18|19|20)\d\d)\b(?!-)")
NO_AUTHOR = {"January", "February", "March", "April", "May", "June", "July", "August", "September", "October",
             "November", "December", "Debian", "Since", "In", "Of", "VDI", "ISO", "RFC", "IEC", "From", "At", "Until"}


def plain(text):
    return "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))


def names_of(authors):
    """Last words of the names: 'Hess and Soom' is ('Hess', 'Soom')."""
    parts = re.split(r",? and |,? & |, ", plain(authors).replace("'s", "").replace("’s", ""))
    return tuple(part.split()[-1] for part in parts if part and not part.startswith("et al"))


def listed_sources(page):
    """{(names, year)} of the keys in the first column of the tables."""
    keys = set()
    for line in page.splitlines():
        match = re.match(r"\| (.+?) ((?:18|19|20)\d\d) \|", line)
        if match:
            keys.add((names_of(match[1]), match[2]))
    return keys


def is_listed(names, year, keys):
    return any(year == key_year and (names[-len(key):] == key or key[-len(names):] == names or names[0] == key[0])
               for key, key_year in keys)


def passages(name, text):
    """(kind, Passage): "comment", "literal" or "page"."""
    if name.endswith(".md"):
        passage = cpp_text.Passage()
        for number, line in enumerate(text.split("\n"), 1):
            passage.add(number, line + " ")
        yield "page", passage
    elif name.endswith((".cpp", ".hpp", ".h", ".c")):
        yield from (("comment", passage) for passage in cpp_text.comments(text))
        yield from (("literal", passage) for passage in cpp_text.literals(text))
    elif name.endswith(".js"):
        yield from (("comment", passage) for passage in cpp_text.comments(text, script=True))
        yield from (("literal", passage) for passage in cpp_text.script_literals(text))
    else:
        yield from (("comment", passage) for passage in cpp_text.hash_comments(text))


class Citations:
    def __init__(self, paths, sources_page):
        """`paths`: of all files, from the root; `sources_page`: the text of docs/sources.md."""
        self.files = set(paths)
        self.folders = {"/".join(path.split("/")[:k]) for path in paths for k in range(1, path.count("/") + 1)}
        self.tails = {"/".join(path.split("/")[k:]) for path in paths for k in range(path.count("/") + 1)}
        self.stems = {path.rsplit(".", 1)[0] for path in paths}  # a header and its source may be named without ending
        self.sources = listed_sources(sources_page)

    def exists(self, path):
        path = path.rstrip("/")
        return path in self.files or path in self.folders or path in self.stems

    def findings(self, name, text):
        """Yields (line, message) for a file."""
        given = set(GIVEN.findall(text)) if name.endswith(".md") else set()
        given |= {path.rsplit("/", 1)[k] for path in given if "/" in path for k in (0, 1)}
        for kind, passage in passages(name, text):
            if kind == "page":
                yield from self.links(name, passage)
            if kind != "literal":
                yield from self.names(passage, given)
                yield from self.publications(name, passage)
            for match in DOCUMENT.finditer(passage.text):
                yield passage.line(match.start()), f'"{match[0]}" names a document without a reference'

    def links(self, name, passage):
        folder = name.rsplit("/", 1)[0] + "/" if "/" in name else ""
        for match in LINK.finditer(passage.text):
            target = match[1].split("#")[0]
            if not target or re.match(r"[a-z]+:", target):
                continue
            parts = []
            for part in (folder + target).split("/"):
                parts = parts[:-1] if part == ".." else parts + [part] if part not in ("", ".") else parts
            if not self.exists("/".join(parts)):
                yield passage.line(match.start()), f"the link {match[1]} leads nowhere"

    def names(self, passage, given):
        """`given`: files, and their folders, that the page itself has as blocks."""
        for pattern, known in ((PATH, self.exists), (FILE, self.tails.__contains__)):
            for match in pattern.finditer(passage.text):
                path = match[0].rstrip(".:-")
                if pattern is FILE and PATH.match(path):
                    continue
                if (not PLACEHOLDER.search(path) or NO_PLACEHOLDER.search(path)) and not known(path) \
                        and path.rstrip("/") not in given:
                    yield passage.line(match.start()), f"there is no {path}"

    def publications(self, name, passage):
        if name == SOURCES_PAGE:
            return
        for match in PUBLICATION.finditer(passage.text):
            names = names_of(match[1])
            if names and names[-1] not in NO_AUTHOR and not is_listed(names, match[2], self.sources):
                yield passage.line(match.start()), f"{SOURCES_PAGE} does not list {match[1]} {match[2]}"
