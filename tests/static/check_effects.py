#!/usr/bin/env python3
"""Checks that an effect is known outside of its folder by nobody but those who treat it specially, and by its class.

usage: check_effects.py [ROOT]      status 1: findings

An effect is a folder of sim/effects. Its name in quotes belongs into that folder, and into the list of aliases of
another one. Its header is included elsewhere only by the files of BY_CLASS, each with its reason.
"""

import pathlib
import re
import sys

# File: what it does with these effects that it does with no other.
BY_CLASS = {
    "sim/plant/acting_effects.hpp": "what acts between motor and carriage, and on what is measured, has its own place "
                                    "in a step of the plant",
    "host/simulate/replay_sampler.cpp": "the current of a record comes late",
    "host/simulate/late_current.hpp": "the current of a record comes late",
    "host/simulate/late_set_points.hpp": "a slave has the set-points of its master late",
    "host/tune/lap_errors.cpp": "laps of a late slave have no batch",
    "host/diagnose/reference/reference_circles.cpp": "axes that act on each other are simulated together",
    "host/diagnose/record/command_replay.cpp": "the same",
    "sim/plant/transmission_error.hpp": "it adds to the errors of the machine file's transmission",
    "sim/effects/backlash/descriptor.cpp": "the plant has two masses, for a gap or for an elastic mode",
    "sim/effects/backlash/regressor.cpp": "the same",
    "sim/effects/structural_resonance/regressor.cpp": "the same",
    "host/diagnose/behind_master.cpp": "a late slave is simulated as late before its force is searched",
    "host/identify/identified_machine.cpp": "an identification writes friction that rises with a weight as it",
    "host/identify/refinement.cpp": "the fit has the constant force of the file as a parameter",
    "host/diagnose/diagnose.cpp": "a record's delay is taken out before the drive's commands are judged; a smooth "
                                      "force without a name extends the machine as a table",
    "host/diagnose/judge/finding_evidence.cpp": "a smooth force without a name extends the machine as a table",
    "host/diagnose/verdict/verdict.hpp": "a table of the machine file names no cause",
    "host/diagnose/judge/closed_loop.cpp": "the other axis must be simulated where it acts on this one",
    "host/diagnose/record/inverse_dynamics.cpp": "the force that bends an elastic mode of the machine file is expected",
    "host/diagnose/reference/reference_charts.cpp": "rows of two numbers tell sliding friction and the contact, nothing else",
    "host/diagnose/reference/reference_diagnosis.cpp": "the same",
    "host/diagnose/reference/reference_extension.cpp": "the same",
    "host/diagnose/reference/reference_words.cpp": "the same",
    "host/diagnose/reference/sliding_law.cpp": "the same",
}
# Text that is not the name of an effect.
OTHER_MEANINGS = {("firmware/machine/file/feed_drive_parameters.hpp", "constant_force"): "a key of the feed drive's cutting force",
                  ("firmware/machine/file/parameters.hpp", "backlash"): "a key of the transmission",
                  ("firmware/machine/file/axis_rules.cpp", "backlash"): "a key of the transmission",
                  ("host/requests/identify_options.cpp", "constant_force"): "a parameter of the fit",
                  ("host/fleet/record_estimate.cpp", "constant_force"): "a parameter of the fit"}

TOPS = ("firmware", "hal", "sim", "host")
SOURCES = {".cpp", ".hpp", ".js", ".html"}
COMMENT = re.compile(r"//.*")


def sources(root):
    for top in TOPS:
        for file in sorted((root / top).rglob("*")):
            if file.suffix in SOURCES and "node_modules" not in file.parts:
                yield file.relative_to(root)


def check(root):
    names = sorted(folder.name for folder in (root / "sim/effects").iterdir() if folder.is_dir())
    quoted = re.compile(r"""["'](%s)["']""" % "|".join(map(re.escape, names)))
    included = re.compile(r'#\s*include\s*"sim/effects/(%s)/' % "|".join(map(re.escape, names)))
    findings, used = [], set()
    for file in sources(root):
        own = file.parts[2] if file.as_posix().startswith("sim/effects/") and len(file.parts) > 3 else None
        for number, line in enumerate((root / file).read_text(encoding="utf-8").splitlines(), 1):
            place = f"{file.as_posix()}:{number}"
            include = included.search(line)
            if include and include[1] != own:
                used.add(file.as_posix())
                if file.as_posix() not in BY_CLASS:
                    findings.append(f"{place}: knows the effect {include[1]}; add the file to BY_CLASS with its reason")
            for match in quoted.finditer(COMMENT.sub("", line)):
                alias = own is not None and file.name == "descriptor.cpp"
                if match[1] != own and not alias and (file.as_posix(), match[1]) not in OTHER_MEANINGS:
                    findings.append(f"{place}: names the effect {match[1]} as text; outside of its folder it has a class")
    findings += [f"{file}: knows no effect any more; take it out of BY_CLASS" for file in sorted(set(BY_CLASS) - used)]
    return names, findings


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2]).resolve()
    names, findings = check(root)
    for finding in findings:
        print(finding)
    if not names:
        print(f"{root}: no effects found")
    return 1 if findings or not names else 0


if __name__ == "__main__":
    sys.exit(main())
