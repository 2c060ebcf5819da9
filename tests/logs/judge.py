"""Runs the programme on a record and keeps what it said beside what is true."""

import json
import subprocess
import time

NOT_OFFERED = "not offered"  # a key that the programme's output does not have: never counted as success


def call(program, *arguments):
    """Status, parsed JSON or None, the first line on standard error, seconds."""
    begin = time.monotonic()
    try:
        done = subprocess.run([program, *arguments, "--json"], capture_output=True, text=True, timeout=300)
    except subprocess.TimeoutExpired:
        return 124, None, "no answer within 300 s", 300.0
    told = None
    if done.returncode == 0:
        try:
            told = json.loads(done.stdout)
        except json.JSONDecodeError as error:
            return 125, None, f"standard output is no JSON: {error}", time.monotonic() - begin
    return done.returncode, told, done.stderr.strip().partition("\n")[0], time.monotonic() - begin


def questions_in(told):
    """What the output asks about, as a list of "amperes", "length", "sign", "shift"; None when it has no such key."""
    if told is None:
        return None
    places = [told] + [axis for axis in told.get("axes", []) if isinstance(axis, dict)]
    lists = [place["questions"] for place in places if "questions" in place]
    return sorted({q["about"] for questions in lists for q in questions}) if lists else None


def identify(program, facts, logs=None, extra=()):
    """The row of a record (facts: as truth.write() returns them), by `stiction identify`."""
    paths = logs or [facts["log"]]
    status, told, message, seconds = call(program, "identify", *paths, "--machine", facts["machine"], *extra)
    row = {key: facts[key] for key in ("name", "cell", "kind", "fault", "law", "set_points", "seed")}
    row |= {"file_mass": facts["file"]["mass"], "status": status, "message": message, "seconds": round(seconds, 3)}
    told = told or {}
    found = told.get("parameters", {})
    row["parameters"] = {}
    for name, truth in facts["parameters"].items():
        said = found.get(name) or {}
        interval = said.get("ci95")
        interval = interval if interval and None not in interval else None
        row["parameters"][name] = truth | {"value": said.get("value"), "ci95": interval}
    row["not_determined"] = told.get("not_determined")
    row["questions"] = questions_in(told) if told else None
    row["held_out_force_ratio"] = told.get("held_out_force_ratio", NOT_OFFERED) if told else None
    row["cutoff_scan"] = told.get("cutoff_scan", NOT_OFFERED) if told else None
    return row


def inspect(program, facts):
    """Status, message and questions of `stiction inspect`."""
    status, told, message, seconds = call(program, "inspect", facts["log"], "--machine", facts["machine"])
    asked = questions_in(told)
    return {"status": status, "message": message, "seconds": round(seconds, 3),
            "questions": NOT_OFFERED if told is not None and asked is None else asked}


def closed_loop_error(program, facts):
    """Position difference rms in um between log and closed-loop simulation, by `stiction compare`; or the refusal."""
    status, told, message, _ = call(program, "compare", facts["log"], "--machine", facts["machine"], "--signals", "double")
    try:
        return told["machines"][0]["rows"][0]["position_difference_rms_um"], ""
    except (TypeError, KeyError, IndexError):
        return None, f"status {status}: {message}"
