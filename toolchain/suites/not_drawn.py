"""Prints the regular expression of the tests in tests/drawn.txt whose group a commit does not draw, for ctest -E.

usage: ctest -N ... | not_drawn.py tests/drawn.txt COMMIT
COMMIT: its hexadecimal name. Status 1 for an expression that no test of the list matches, which would draw nothing.
"""

import re
import sys

GROUPS = 4


def main():
    path, commit = sys.argv[1:]
    names = re.findall(r"^ *Test +#\d+: (.*)$", sys.stdin.read(), re.MULTILINE)
    drawn = int(commit[-8:-4], 16) % GROUPS
    left_out, unmatched = [], []
    with open(path, encoding="utf-8") as file:
        rows = [line.split(maxsplit=1) for line in file if line.strip() and not line.startswith("#")]
    for group, expression in rows:
        expression = expression.strip()
        if not any(re.search(expression, name) for name in names):
            unmatched.append(expression)
        if int(group) != drawn:
            left_out.append(expression)
    for expression in unmatched:
        print(f"{path}: no test matches {expression}", file=sys.stderr)
    print("|".join(left_out))
    return 1 if unmatched else 0


if __name__ == "__main__":
    sys.exit(main())
