#!/usr/bin/env python3
"""Writes the files that a section of a page gives or changes into a folder, and prints their names.

usage: extract.py ROOT PAGE SECTION FOLDER      SECTION: the anchor of its heading, as in a link
"""

import pathlib
import sys

import pages


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    root, name, section, folder = sys.argv[1:]
    page = pages.read_page(root, name)
    if section not in page.anchors:
        sys.exit(f"{name}: found no heading #{section}; expected one of {', '.join(sorted(page.anchors))}")
    blocks = [block for block in page.blocks if block.section == section and (block.creates or block.changes)]
    if not blocks:
        sys.exit(f"{name}#{section}: found no block that is a file")
    texts = {}
    for block in blocks:
        name = block.creates or block.changes
        if block.changes and name not in texts:
            texts[name] = (pathlib.Path(root) / name).read_text(encoding="utf-8")
        texts[name] = block.text if block.creates else pages.changed(texts[name], block)
    for each, text in texts.items():
        pages.write_text(pathlib.Path(folder) / each, text)
    print(";".join(texts), end="")


if __name__ == "__main__":
    try:
        main()
    except (pages.PageError, OSError) as error:
        sys.exit(f"extract.py: {error}")
