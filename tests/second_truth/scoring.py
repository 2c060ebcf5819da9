"""What a verdict is worth against a truth: one line of results a case.

Cases in which an ideal observer has odds under 20 are marked, and counted apart (counts.py).
"""

import math

LEAST_NATS = math.log(20.0)
SAID = 0.10  # probability from which a name in confused_with counts as said
NO_CAUSE = {"force_map", "unexplained"}  # say of themselves that they name no cause
KEPT = ("effect", "parameters", "standard_errors", "probability", "confused_with", "holdout_gain")  # of each finding


def names_of(verdict):
    """Names of the findings in their order, without those that name no cause."""
    return [f["effect"] for f in verdict.get("findings", []) if f["effect"] not in NO_CAUSE]


def judge(truth, verdict):
    """One line of results: what was hidden, what was said, and which of the counts it belongs to."""
    hidden, names = truth["hidden"], names_of(verdict)
    findings = [f for f in verdict.get("findings", []) if f["effect"] not in NO_CAUSE]
    meant = {h: {h, *truth["accept"].get(h, [])} for h in hidden}
    right = lambda name: any(name in group for group in meant.values())
    confused = findings[0].get("confused_with", []) if findings else []
    line = {
        "kind": truth["kind"], "seed": truth["seed"], "share": truth["share"], "hidden": hidden,
        "unknown": truth["unknown"], "shape": truth["shape"], "friction": truth["machine"]["friction"],
        "rotary": truth["machine"]["rotary"],
        "two": truth["machine"]["shaft"] > 0, "nats": truth["oracle_nats"], "alias_nats": truth["oracle_alias_nats"],
        "names": names, "status": verdict.get("status"), "confused": [c["effect"] for c in confused],
        "probability": findings[0].get("probability") if findings else None,
        "force_map": any(f["effect"] == "force_map" for f in verdict.get("findings", [])),
        "cannot_tell": truth["oracle_nats"] is not None and truth["oracle_nats"] < LEAST_NATS,
        "first_right": bool(names) and right(names[0]),
        "confused_right": bool(names) and not right(names[0]) and any(
            right(c["effect"]) and c.get("probability", 0.0) >= SAID for c in confused),
        "found": sum(any(n in group for n in names) for group in meant.values()),
        "false": [n for n in names if not right(n) and n not in truth["tolerated"]],
        "tolerated": [n for n in names if n in truth["tolerated"]],
        "parameters": truth["parameters"], "held_out_force": truth.get("held_out_force"),
        "findings": [{key: f.get(key) for key in KEPT} for f in findings],
        "baseline": verdict.get("baseline"), "extended": verdict.get("extended")}
    line["exact"] = line["found"] == len(hidden) and not line["false"]
    return line
