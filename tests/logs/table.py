"""The table of the campaign: what is wanted of logs, from the rows of judge.py. Each figure has its n and, where it is
a rate, its exact 95 % interval (Clopper and Pearson)."""

import collections
import re

import numpy as np
from scipy.stats import beta

import faults
import judge

FIRST_SOUND = 200


def rate(k, n):
    """"47 of 50, 94.0 % (83.5 to 98.7)"."""
    if n == 0:
        return "0 of 0"
    low = beta.ppf(0.025, k, n - k + 1) if k else 0.0
    high = beta.ppf(0.975, k + 1, n - k) if k < n else 1.0
    return f"{k} of {n}, {100 * k / n:.1f} % ({100 * low:.1f} to {100 * high:.1f})"


def covered(parameter):
    low, high = parameter["ci95"]
    return low <= parameter["true"] <= high


def returned(parameter):
    return parameter["value"] is not None and parameter["ci95"] is not None


def each(rows):
    """(row, name, parameter) of every parameter of every row."""
    return [(row, name, p) for row in rows for name, p in row["parameters"].items()]


def coverage(rows):
    """Lines: pooled, by parameter, by machine, rate, increment and motion, and the cells outside of 90 to 98 %."""
    given = [(row, name, p) for row, name, p in each(rows) if returned(p)]
    wanted = [item for item in given if item[2]["identifiable"]]
    pooled = lambda items: rate(sum(covered(p) for _, _, p in items), len(items))
    lines = [("95 % intervals cover, identifiable and returned (90 to 98 %)", pooled(wanted)),
             ("95 % intervals cover, all that is returned", pooled(given))]
    whole = {"parameter": lambda row, name: name, "machine": lambda row, name: row["cell"][0],
             "rate, Hz": lambda row, name: row["cell"][1], "increment, m": lambda row, name: row["cell"][2],
             "motion": lambda row, name: row["kind"], "friction": lambda row, name: row["law"],
             "set-points": lambda row, name: row["set_points"]}
    for title, key in whole.items():
        groups = collections.defaultdict(list)
        for row, name, p in wanted:
            groups[key(row, name)].append((row, name, p))
        lines += [(f"  by {title}: {value}", pooled(items)) for value, items in sorted(groups.items())]
    return lines


def by_cell(rows):
    """Lines of machine x rate, columns of increments: k/n of intervals that cover, and parameters not returned."""
    groups = collections.defaultdict(lambda: [0, 0, 0])
    for row, _, p in each(rows):
        if p["identifiable"]:
            group = groups[tuple(row["cell"])]
            group[2] += not returned(p)
            if returned(p):
                group[0] += covered(p)
                group[1] += 1
    increments = sorted({cell[2] for cell in groups})
    head = "covered/returned (-not returned)"
    lines = [f"{head:34}" + "".join(f"{q * 1e6:>14g} um" for q in increments)]
    for machine, hertz in sorted({cell[:2] for cell in groups}):
        text = f"{machine:16} {hertz:>8} Hz      "
        for q in increments:
            k, n, lost = groups.get((machine, hertz, q), (0, 0, 0))
            text += f"{f'{k}/{n}' + (f' (-{lost})' if lost else ''):>17}"
        lines.append(text)
    return lines


def not_returned(rows):
    wanted = [(row, name, p) for row, name, p in each(rows) if p["identifiable"]]
    lost = [(row, name) for row, name, p in wanted if not returned(p)]
    reasons = collections.Counter()
    for row, name in lost:
        said = next((s for s in row["not_determined"] or [] if s.startswith(name)), None)
        refusal = f"exit {row['status']}: {kind_of(tail(row['message']))}"
        reasons[refusal if row["status"] else kind_of(said or "not returned without a word")] += 1
    lines = [("identifiable but not returned (none)", rate(len(lost), len(wanted)))]
    return lines + [(f"  {count} times", reason[:150]) for reason, count in reasons.most_common(6)]


def tail(message):
    """A message without the path in front of it."""
    return message.split(".csv:")[-1].split(".toml:")[-1]


def kind_of(reason):
    """A reason with its numbers taken out, so that like ones are counted together."""
    return re.sub(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", "#", reason)


def nonsense(rows):
    given = [p for _, name, p in each(rows) if returned(p) and name != "constant_force_N"]
    return [("negative mass or friction as a result (none)", rate(sum(p["value"] <= 0 for p in given), len(given)))]


def mass_bias(rows):
    """Mean relative error of mass in the coarsest encoder's cell of machine and rate where every record identifies it."""
    cells = collections.defaultdict(list)
    for row in rows:
        cells[tuple(row["cell"])].append(row["parameters"]["mass_kg"])
    biases = []
    for machine, hertz in sorted({cell[:2] for cell in cells}):
        sure = [q for m, r, q in cells if (m, r) == (machine, hertz) and all(p["identifiable"] for p in cells[m, r, q])]
        if not sure:
            continue
        group = cells[machine, hertz, max(sure)]
        errors = [p["value"] / p["true"] - 1 for p in group if returned(p)]
        biases.append((machine, hertz, max(sure), errors, len(group)))
    lines = []
    with_value = [b for b in biases if b[3]]
    small = sum(abs(np.mean(b[3])) <= 0.03 for b in with_value)
    lines.append(("bias of mass at the coarsest encoder that identifies it, within 3 % (all)", rate(small, len(biases))))
    for machine, hertz, q, errors, n in biases:
        text = f"{100 * np.mean(errors):+.2f} % (n {len(errors)} of {n})" if errors else f"not returned in {n}"
        lines.append((f"  {machine} {hertz} Hz, {q * 1e6:g} um", text))
    return lines


def at(scan, cutoff):
    """Mass at a cut-off, linear over its logarithm; None outside of the scan."""
    points = sorted((p["cutoff_Hz"], p["mass_kg"]) for p in scan if p.get("mass_kg") is not None)
    if not points or not points[0][0] <= cutoff <= points[-1][0]:
        return None
    return float(np.interp(np.log(cutoff), np.log([p[0] for p in points]), [p[1] for p in points]))


def cutoff_ratios(groups):
    """(rms relative error of mass as returned over that of the best single cut-off of the scan, records) of groups."""
    ratios = []
    for group in groups:
        truth = [row["parameters"]["mass_kg"] for row in group]
        chosen = np.sqrt(np.mean([(p["value"] / p["true"] - 1) ** 2 for p in truth]))
        best = np.inf
        for cutoff in sorted({point["cutoff_Hz"] for row in group for point in row["cutoff_scan"]}):
            masses = [at(row["cutoff_scan"], cutoff) for row in group]
            if None not in masses:
                best = min(best, np.sqrt(np.mean([(m / p["true"] - 1) ** 2 for m, p in zip(masses, truth)])))
        if np.isfinite(best) and best > 0:
            ratios.append((chosen / best, len(group)))
    return ratios


def chosen_cutoff(rows):
    """The ratio in each cell, and of the records of a rate and encoder, and of a rate, together: the best of twelve
    cut-offs of one record is the luckiest of twelve errors, which no choice that does not know the truth comes near."""
    scans = [row for row in rows if isinstance(row["cutoff_scan"], list) and returned(row["parameters"]["mass_kg"])]
    title = "error of mass at the chosen cut-off over the best of the scan, median of cells (1.2)"
    if not scans:
        offered = any(row["cutoff_scan"] not in (None, judge.NOT_OFFERED) for row in rows)
        return [(title, "no scan with a mass" if offered else judge.NOT_OFFERED)]
    lines = []
    for name, of_cell in ((title, lambda cell: cell), ("error of mass at the chosen cut-off, records of each rate and encoder", lambda cell: cell[1:]),
                          ("error of mass at the chosen cut-off, records of each rate alone", lambda cell: cell[1])):
        groups = collections.defaultdict(list)
        for row in scans:
            groups[of_cell(tuple(row["cell"]))].append(row)
        ratios = cutoff_ratios(groups.values())
        if not ratios:
            return [(title, "no cell has a scan with common cut-offs")]
        values = [r for r, _ in ratios]
        lines.append((name, f"{np.median(values):.2f} ({len(values)} groups, at least {min(n for _, n in ratios)} "
                            f"records each), within 1.2: {rate(sum(v <= 1.2 for v in values), len(values))}"))
    return lines


def held_out(rows):
    values = [row["held_out_force_ratio"] for row in rows if isinstance(row["held_out_force_ratio"], (int, float))]
    title = "held-out force rms over least squares of mass, viscous, Coulomb, offset (every record 1.01)"
    if not values:
        return [(title, judge.NOT_OFFERED)]
    return [(title, f"largest {max(values):.3f}, within 1.01: {rate(sum(v <= 1.01 for v in values), len(values))}")]


def said(row, where):
    """What one row asked: list, or None when its output has no such key or the programme refused."""
    told = row.get("inspect", {}).get("questions") if where == "inspect" else row["questions"]
    return told if isinstance(told, list) else None


def questions(sound, faulty):
    """False questions on sound records, questions asked on faulty ones, by each of the two commands."""
    lines = []
    for where in ("inspect", "identify"):
        told = [said(row, where) for row in sound if "inspect" in row][:FIRST_SOUND]
        offered = [t for t in told if t is not None]
        lines.append((f"false questions on sound records, {where} (2 %)",
                      rate(sum(bool(t) for t in offered), len(offered)) if offered else judge.NOT_OFFERED))
        for fault, about in faults.QUESTIONS.items():
            group = [row for row in faulty if row["fault"] == fault]
            asked = [said(row, where) for row in group]
            answers = [row.get("inspect", {}) if where == "inspect" else row for row in group]
            refused = sum(answer.get("status", 0) != 0 for answer in answers)
            if not any(a is not None for a in asked):
                word = f"all {refused} refused" if group and refused == len(group) else judge.NOT_OFFERED
                lines.append((f"  {fault} asked, {where} (all)", f"{word}; n {len(group)}"))
                continue
            right = [a is not None and about in a for a in asked]
            sure = [r for r, row in zip(right, group) if row["parameters"]["mass_kg"]["bound"] <= 0.03 * row["parameters"]["mass_kg"]["true"]]
            lines.append((f"  {fault} asked, {where} (all)",
                          f"{rate(sum(right), len(right))}; where mass is known to 3 %: "
                          f"{rate(sum(sure), len(sure))}; refused {refused}"))
    return lines


def whole(results):
    """All lines (title, text) of the table, the cells last."""
    sound = results["sound"]
    lines = [("sound records", f"{len(sound)}, of which refused {sum(row['status'] != 0 for row in sound)}")]
    lines += coverage(sound) + not_returned(sound) + nonsense(sound) + mass_bias(sound) + chosen_cutoff(sound)
    lines += held_out(sound) + questions(sound, results.get("faulty", []))
    for part, title in (("one_direction", "logs of one direction each, joined"), ("saturated", "a saturated stretch"),
                        ("gap", "two gaps"), ("inject", "a known test signal")):
        rows = results.get(part, [])
        if rows:
            wanted = [p for _, _, p in each(rows) if p["identifiable"]]
            given = [p for p in wanted if returned(p)]
            lines.append((f"{title}: identifiable and returned", rate(len(given), len(wanted))))
            lines.append(("  of these 95 % intervals cover", rate(sum(map(covered, given)), len(given))))
    lines += loops(results.get("loops", []))
    return lines


def loops(pairs):
    """Closed-loop position error of records with a test signal over that of the same without it."""
    if not pairs:
        return []
    ratios = [p["with"] / p["without"] for p in pairs if p["with"] and p["without"]]
    title = "closed loop with test signals over one without any, position rms (1.2)"
    text = f"median {np.median(ratios):.2f}, largest {max(ratios):.2f}, within 1.2: " if ratios else ""
    lines = [(title, text + rate(sum(r <= 1.2 for r in ratios), len(pairs)))]
    refused = [p["message"] for p in pairs if p["message"]]
    if refused:
        lines.append(("  refused", f"{len(refused)} of {len(pairs)}; {tail(refused[0])[:140]}"))
    return lines
