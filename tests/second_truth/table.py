"""The table of a campaign as text.

Interval: Wilson 1927, as in Brown, Cai, DasGupta 2001.
"""

import math

import counts


def wilson(k, n):
    """95 % interval of a share, in %."""
    if not n:
        return 0.0, 100.0
    z, p = 1.959964, k / n
    middle, half = p + z * z / (2 * n), z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return 100 * (middle - half) / (1 + z * z / n), 100 * (middle + half) / (1 + z * z / n)


def row(name, k, n):
    """One row of the table."""
    low, high = wilson(k, n)
    return f"{name:66s} {k:4d} of {n:4d}  {100 * k / n:5.1f} %  ({low:.0f} to {high:.0f})"


def rows(lines):
    """Rows of the counts and means of these lines."""
    texts, shares, means = counts.texts(), counts.shares(lines), counts.means(lines)
    return [row("  " + texts[name], *shares[name]) for name in texts if name in shares] + \
        [f"  {texts[name]:64s} {means[name][0]:.1f}, of {means[name][1]} cases" for name in texts if name in means]


def by(lines, title, key):
    """Rows of single causes by a property; what is said instead of the right name."""
    out = ["", f"single, first name right, by {title}:"]
    for value in sorted({key(line) for line in lines}):
        group = [line for line in lines if key(line) == value]
        others = sorted({line["names"][0] if line["names"] else "no name" for line in group if not counts.right(line)})
        out.append(row("  " + value, sum(map(counts.right, group)), len(group)) +
                   ("   else: " + ", ".join(others) if others else ""))
    return out


def table(lines):
    """The whole table as text; the pooled figures first."""
    done = [line for line in lines if "error" not in line]
    out = ["all cases", *rows(done), row("  errors of the programme", len(lines) - len(done), len(lines))]
    groups = sorted({counts.group(line) for line in done})
    for name in groups if len(groups) > 1 else []:
        out += ["", name, *rows([line for line in done if counts.group(line) == name])]
    single = [line for line in done if line["kind"] == "single" and counts.told(line)]
    if single:
        out += by(single, "cause", lambda line: line["hidden"][0])
        out += by(single, "friction law", lambda line: line["friction"])
        out += by(single, "machine",
                  lambda line: ("rotary" if line["rotary"] else "linear") + (", two bodies" if line["two"] else ""))
    nameless = [line for line in done if line["kind"] == "unknown"]
    if nameless:
        out += ["", "unknown, no name, by form:"]
    for form in sorted({line["unknown"][0] for line in nameless}):
        group = [line for line in nameless if line["unknown"][0] == form]
        names = sorted({name for line in group for name in line["names"]})
        out.append(row("  " + form, sum(not line["names"] for line in group), len(group)) +
                   ("   " + ", ".join(names) if names else ""))
    return "\n".join(out)
