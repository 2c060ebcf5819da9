"""What was measured, kept between runs: kept.toml (figures of sources) and campaigns.toml (cases counted by campaigns).

kept.toml, a table a source: `commit` and `date` of its newest run, and the numbers of every row as they were printed.
campaigns.toml, a table a run: campaign, kind, seed, cases, commit of its engine, date; `counts` as [k, n], `means` as
[mean, cases]. Runs of one commit are pooled; a row shows the commit of its newest run.
"""

import json
import math
import tomllib

from claims import FOLDER

HEAD = {
    "kept.toml": "# The newest run of every source. Written by `toolchain/test --results`; not edited by hand.\n",
    "campaigns.toml": "# Runs of campaigns. Written by `toolchain/suites/blind` and `second_truth`, not by hand.\n",
}


def read(name, folder=FOLDER):
    file = folder / name
    return tomllib.loads(file.read_text(encoding="utf-8")) if file.exists() else {}


def plain(value):
    """A value of TOML: JSON's text, lists and numbers are also TOML's."""
    return json.dumps(value, ensure_ascii=False)


def write_kept(kept, folder=FOLDER):
    lines = [HEAD["kept.toml"]]
    for source in sorted(kept):
        lines.append(f"[{source}]")
        lines += [f"{key} = {plain(kept[source][key])}" for key in ("commit", "date")]
        lines.append(f"[{source}.rows]")
        lines += [f"{key} = {plain(values)}" for key, values in sorted(kept[source]["rows"].items())]
        lines.append("")
    (folder / "kept.toml").write_text("\n".join(lines), encoding="utf-8")


def order(run):
    return run["campaign"], run["kind"], str(run["seed"]), run["date"]


def write_campaigns(runs, folder=FOLDER):
    lines = [HEAD["campaigns.toml"]]
    for run in sorted(runs, key=order):
        lines.append("[[run]]")
        lines += [f"{key} = {plain(run[key])}" for key in ("campaign", "kind", "seed", "cases", "commit", "date")]
        for table in ("counts", "means"):
            if run.get(table):
                lines.append(f"[run.{table}]")
                lines += [f"{key} = {plain(pair)}" for key, pair in sorted(run[table].items())]
        lines.append("")
    (folder / "campaigns.toml").write_text("\n".join(lines), encoding="utf-8")


def add_run(runs, new):
    """`runs` with `new`, and a sentence. The runs of an engine before are dropped, as its row shows the newest only; but
    a run of fewer than half of their cases does not take the place of theirs."""
    same = [r for r in runs if (r["campaign"], r["kind"]) == (new["campaign"], new["kind"])]
    what = f"{new['campaign']} {new['kind']}, seed {new['seed']}, {new['cases']} cases".replace(" ,", ",")
    before = [r for r in same if r["commit"] != new["commit"]]
    of_engine = [r for r in same if r["commit"] == new["commit"] and str(r["seed"]) != str(new["seed"])]
    cases = new["cases"] + sum(r["cases"] for r in of_engine)
    if before and 2 * cases < sum(r["cases"] for r in before):
        old = f"{sum(r['cases'] for r in before)} of {before[0]['commit']}"
        return runs, f"{what}: not kept, {cases} cases in place of {old}"
    return [r for r in runs if r not in same] + of_engine + [new], f"{what}: kept, commit {new['commit']}"


def pooled(runs, row):
    """The newest engine's runs of a row's campaign and kind together: {seeds, commit, date, k, n} or {.., mean, n};
    None when there is none."""
    table = "counts" if row.count else "means"
    entry = row.count or row.mean
    of_row = [r for r in runs if r["campaign"] == row.campaign and r["kind"] == row.kind and entry in r.get(table, {})]
    if not of_row:
        return None
    newest = max(of_row, key=lambda r: r["date"])
    engine = [r for r in of_row if r["commit"] == newest["commit"]]
    pairs = [r[table][entry] for r in engine]
    n = sum(pair[1] for pair in pairs)
    found = {"seeds": ", ".join(str(r["seed"]) for r in sorted(engine, key=order)), "commit": newest["commit"],
             "date": newest["date"], "n": n}
    if row.count:
        found["k"] = sum(pair[0] for pair in pairs)
    else:
        found["mean"] = sum(pair[0] * pair[1] for pair in pairs) / n
    return found


def wilson(k, n, z=1.959964):
    """The 95 % interval of a share by Wilson's score, in %."""
    share = k / n
    middle = (share + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(share * (1 - share) / n + z * z / (4 * n * n))
    return 100 * max(0.0, middle - half), 100 * min(1.0, middle + half)
