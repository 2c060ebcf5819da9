#!/usr/bin/env python3
"""Checks that #include lines run only along the arrows between rooms, and prints each that does not.

usage: check_rooms.py [ROOT]      status 1: findings

A room is a folder; a file belongs to the innermost room around it, or to the row with "*" that its path matches. ROOMS
below is the only table of arrows: what is not in it is an error, and whoever adds a row gives its reason. Folders must not include each other in a circle.
"""

import functools
import pathlib
import re
import sys

FIRMWARE = "firmware/include/stiction"

# Room: {what it may include, beside itself: why}. "sim" is that folder alone, "sim/*" with all folders below it.
ROOMS = {
    f"{FIRMWARE}/number": {},
    f"{FIRMWARE}/control": {f"{FIRMWARE}/number": "laws are written in fixed-point numbers"},
    f"{FIRMWARE}/motion": {f"{FIRMWARE}/number": "set-points are interpolated in fixed-point numbers"},
    f"{FIRMWARE}/drive": {
        f"{FIRMWARE}/control": "the cascade is made of the laws",
        f"{FIRMWARE}/motion": "and follows the set-points",
        f"{FIRMWARE}/number": "in fixed-point numbers",
    },
    f"{FIRMWARE}/design": {
        f"{FIRMWARE}/drive": "a design in SI units becomes the cascade's configuration",
        f"{FIRMWARE}/control": "and that of its laws",
        f"{FIRMWARE}/number": "in the drive's formats; doubles enter the firmware's headers here and nowhere else",
    },
    FIRMWARE: {f"{FIRMWARE}/*": "one header for who wants all of them"},
    "firmware/machine/model": {
        f"{FIRMWARE}/control": "a machine names what its drive does against friction (compensation_kind.hpp)",
    },
    "firmware/machine/file": {
        "firmware/machine/configuration": "the radius of a rotary axis is the largest that the drive's formats hold",
        f"{FIRMWARE}/control": "keys are held to what the drive's buffers and tables hold (compensation_kind.hpp)",
        f"{FIRMWARE}/motion": "and the turn of an endless axis to what it counts exactly (endless_phase.hpp)",
        "firmware/machine/model": "a file becomes a machine",
    },
    "firmware/machine/configuration": {
        "firmware/machine/model": "the drive's configuration is computed from a machine",
        f"{FIRMWARE}/*": "and is the cascade's own",
    },
    "firmware/machine/batch": {
        "firmware/machine/configuration": "a lane of a batch has the signals of doubles",
        f"{FIRMWARE}/*": "and the laws of the cascade",
    },
    "firmware/version": {},
    "firmware/stictiond": {
        "firmware/version": "a programme says which it is,",
        f"{FIRMWARE}/*": "the drive's programme runs the cascade",
        "hal/*": "over the backend that its command line names",
        "firmware/machine/*": "its configuration is computed before the loop starts, from the machine file",
        "sim/experiment": "and a motion to try it with may be one of the standard tests'",
    },
    "hal": {f"{FIRMWARE}/*": "the border to the world is written in the cascade's types"},
    "hal/can": {"hal": "it is a backend", f"{FIRMWARE}/*": "in the cascade's types"},
    "hal/gpio": {"hal": "it is a backend", f"{FIRMWARE}/*": "in the cascade's types"},
    "hal/modbus": {"hal": "it is a backend", f"{FIRMWARE}/*": "in the cascade's types"},
    "hal/simulated": {
        "hal": "it is a backend",
        f"{FIRMWARE}/*": "in the cascade's types",
        "firmware/machine/*": "of a machine",
        "sim/*": "the one place that knows both the border and the simulation",
    },
    "sim/number": {},
    "sim": {
        "firmware/machine/*": "machine files are read",
        "sim/effects": "with the keys of all effects",
        "sim/plant/friction": "and friction laws",
    },
    "sim/vocabulary": {
        "firmware/machine/*": "the keys that the drive knows",
        "sim": "are written from those of the simulation",
    },
    "sim/plant/friction": {
        f"{FIRMWARE}/number": "choices read alike for one axis and for a batch of them",
        "firmware/machine/model": "a law describes its parameters, and those of a machine say which acts",
        "sim/number": "and is written in arithmetic that is the same everywhere",
    },
    "sim/plant/feed": {"firmware/machine/model": "the parameters of a feed drive are a machine's"},
    "sim/effects": {
        "sim/number": "waves need sines",
        "firmware/machine/model": "an effect describes its parameters, and changes what a machine has or adds to it",
        "sim/plant/friction": "on every friction law",
    },
    # One folder an effect: its law belongs to the simulation, its regressor to the diagnosis.
    "sim/effects/*/regressor.cpp": {
        "sim/*": "an effect is looked for by the law that the simulation has of it",
        "firmware/machine/*": "on an axis as its file describes it",
        "host/diagnose/*": "in the residual of a diagnosis",
        "host/identify": "with the columns of the fits",
    },
    "sim/plant/batch": {
        "firmware/machine/batch": "the plant's numbers are batches",
        "firmware/machine/model": "a machine says what is simulated",
        "sim/number": "with the bits of one axis' arithmetic",
        "sim/plant": "the motors are those of one axis",
        "sim/plant/friction": "and so is friction",
        "sim/effects": "axes with effects go on alone",
    },
    "sim/plant": {
        "sim/number": "the mathematics that its parts share",
        "firmware/machine/model": "the plant is built from a machine",
        "sim/effects/*": "with what diagnosis added",
        "sim/plant/friction": "with one of the friction laws",
    },
    "sim/experiment": {
        "sim/number": "the mathematics of paths",
        "firmware/machine/*": "set-points cross the border to the drive's formats within the limits of a machine",
        f"{FIRMWARE}/*": "and end in the cascade's types",
    },
    "sim/cam": {
        "sim/number": "a motion gives the same table everywhere",
        "firmware/machine/*": "motion files have the units and the messages of machine files",
        f"{FIRMWARE}/*": "a motion becomes the drive's table",
    },
    "host/algebra": {},
    "host/log": {
        "host/algebra": "set-points are smoothed by least squares",
        "sim/*": "signals leave in SI units; set-points and units are those of the machine's files",
        "firmware/machine/*": "as its file describes it",
        f"{FIRMWARE}/*": "the cascade lists its own signals",
    },
    "host/sheet": {
        "firmware/machine/*": "data sheets become a machine file, in its units",
        "host/log": "what logs tell is not asked,",
        "host/identify": "mass and friction are identified from them",
        "sim/*": "on the file as it is read",
    },
    "host/response": {
        "host/log": "frequency responses are measured from logs",
        "sim/*": "with the controllers of a machine, and become results",
        "firmware/machine/*": "as its file describes it",
    },
    "host/batch": {
        "sim/*": "many axes are simulated at once",
        "firmware/machine/*": "as their files describe them",
        f"{FIRMWARE}/*": "with the cascade of the drive",
    },
    "host/simulate": {
        "host/batch": "replays run in the lanes of a batch",
        "host/log": "a run can be logged",
        "hal/*": "the host's build replaces the hal",
        "sim/*": "by the simulation",
        "firmware/machine/*": "as its file describes it",
        f"{FIRMWARE}/*": "never the control",
    },
    "host/identify": {
        "host/algebra": "fits are least squares",
        "host/log": "models are fitted to logs",
        "host/simulate": "and held against runs of the same motion",
        "sim/*": "they are those of the simulation",
        "firmware/machine/*": "as its file describes it",
        f"{FIRMWARE}/*": "and what they compensate is the control",
    },
    # Its rooms in the order in which each uses those above it: prepared records, statistics of their rows, classes of
    # functions, the search among them, the judge, and what is said and asked for in the end.
    "host/diagnose/statistics": {
        "host/algebra": "evidence is least squares",
        "host/identify": "over blocks of the rows of a fit",
    },
    "host/diagnose/record": {
        "host/diagnose/statistics": "disturbances are drawn from the spectrum of what is left",
        "host/identify": "the rows of a record are those of the fits",
        "host/log": "in logs",
        "host/simulate": "and in runs that reproduce them",
        "sim/*": "with the laws of the simulation",
        "firmware/machine/*": "of a machine as its file describes it",
        f"{FIRMWARE}/*": "and the control as it is",
    },
    "host/diagnose/spectrum": {
        "host/diagnose/record": "an encoder's error answers through the loop",
        "host/diagnose/statistics": "lines are looked for in what is whitened",
        "host/identify": "of the rows",
        "firmware/machine/model": "of a machine",
    },
    "host/diagnose/verdict": {
        "host/diagnose/record": "agreement is within the noise's floor",
        "host/log": "figures are shown in the axis' own units",
        "sim/*": "findings are effects, and charts those of results",
        "firmware/machine/model": "of a machine",
    },
    "host/diagnose/classes": {
        "host/diagnose/record": "functions of a record are made with the friction of its contact",
        "host/diagnose/spectrum": "periodic ones are made of lines",
        "host/diagnose/verdict": "a class describes a finding",
        "host/identify": "by columns over the motion of the rows",
        "host/log": "in the axis' own units",
        "sim/*": "as the effects of the simulation",
        "firmware/machine/model": "of a machine",
    },
    "host/diagnose/search": {
        "host/algebra": "weights are least squares",
        "host/diagnose/classes": "classes are chosen",
        "host/diagnose/record": "over records",
        "host/diagnose/spectrum": "with lines",
        "host/diagnose/statistics": "by evidence",
        "host/diagnose/verdict": "for findings",
        "host/identify": "over the rows of the fits",
        "sim/*": "that must be possible effects",
    },
    "host/diagnose/describe": {
        "host/diagnose/classes": "pictures show a class' force",
        "host/diagnose/search": "as it was found",
        "host/diagnose/spectrum": "what is left is looked at for lines",
        "host/diagnose/statistics": "and for significance",
        "host/diagnose/verdict": "and becomes part of the verdict",
        "host/log": "a slave is shown over its master",
        "host/identify": "over the rows of the fits",
    },
    "host/diagnose": {
        "host/algebra": "evidence is least squares",
        "host/diagnose/*": "the rooms of a diagnosis are gone through one after the other",
        "host/identify": "a cause is told from friction by the same fits",
        "host/log": "in logs",
        "host/simulate": "and in runs that reproduce them",
        "host/cam": "a cam that is proposed keeps the limits of its axis",
        "sim/*": "with the effects of the simulation",
        "firmware/machine/*": "as its file describes it",
        f"{FIRMWARE}/*": "and the control as it is",
    },
    "host/tune": {
        "host/algebra": "tables are fitted by least squares",
        "host/identify": "friction is compensated as it was identified",
        "host/log": "from logs",
        "host/simulate": "and tried on runs",
        "host/batch": "of which many run at once",
        "sim/*": "of a machine",
        "firmware/machine/*": "as its file describes it",
        f"{FIRMWARE}/*": "with the drive's own laws",
    },
    "host/cam": {
        "sim/*": "a profile is made for a machine",
        "firmware/machine/*": "as its file describes it",
        f"{FIRMWARE}/*": "in the tables that the drive interpolates",
    },
    "host/cam/step": {
        "host/cam": "a step cam is compared with an electronic one",
        "sim/cam": "its lift is a motion",
        "sim/*": "of the laws of the simulation",
        "firmware/machine/*": "and its project a file with units",
    },
    "host/sweep": {
        "host/simulate": "a row of a sweep is a run,",
        "host/identify": "an identification,",
        "host/diagnose": "a diagnosis",
        "host/diagnose/*": "with its verdict",
        "host/tune": "or a tuning",
        "host/log": "from a log",
        "sim/*": "with its figures",
        "firmware/machine/*": "on a machine as its file describes it",
        f"{FIRMWARE}/number": "in the drive's formats or in double ones",
    },
    "host/fleet": {
        "host/sweep": "shares a folder and a table's format with the sweeps,",
        "host/identify": "identifies each record",
        "host/diagnose": "diagnoses those that alarm",
        "host/diagnose/*": "with the same statistics",
        "host/log": "from their logs",
        "sim/*": "of axes of all laws",
        "firmware/machine/*": "as their machine files describe them",
    },
    # A programme of its own, which needs OpenCASCADE; it reads what `stiction cam step` has written.
    "host/solid": {},
    "host/plant": {
        "firmware/version": "a programme says which it is",
        "hal/*": "the simulated machine behind a real bus speaks the backends' frames",
        "sim/*": "and is the simulation",
        "firmware/machine/*": "as its file describes it",
        f"{FIRMWARE}/*": "at the control's border",
    },
    # Above the tools whose results it shows; none of them knows how it is shown.
    "host/report": {
        "host/cam": "profiles,",
        "host/cam/step": "step cams,",
        "host/diagnose/*": "causes,",
        "host/identify": "models,",
        "host/response": "frequency responses",
        "host/fleet": "fleets",
        "host/simulate": "and results of runs become pages",
        "host/tune": "parameters of the friction compensation too,",
        "host/log": "with the signals behind them",
        "sim/*": "beside the machine they belong to",
        "firmware/machine/*": "as its file describes it",
    },
    # What the command line, Python and C share: results as text and JSON, and commands as calls.
    "host/output": {
        "host/identify": "models,",
        "host/log": "the questions that logs leave open",
        "host/report": "and tables of the pages",
        "sim/*": "with results of runs are printed",
        "firmware/machine/*": "for a machine as its file describes it",
    },
    "host/requests": {
        "host/output": "the answer is the document of a command",
        "host/simulate": "that runs experiments,",
        "host/identify": "finds models,",
        "host/diagnose": "finds causes",
        "host/diagnose/*": "with their verdict,",
        "host/tune": "tunes the drive,",
        "host/response": "measures loops,",
        "host/cam": "follows cams",
        "host/fleet": "or judges fleets",
        "host/sweep": "in a folder as sweeps keep it,",
        "host/report": "with a page,",
        "host/log": "from logs",
        "sim/*": "with the laws of the simulation",
        "firmware/machine/*": "on a machine as its file describes it",
        f"{FIRMWARE}/number": "in the drive's formats or in double ones",
    },
    "host/python": {
        "host/requests": "functions of Python are requests,",
        "host/batch": "or many axes at once,",
        "host/simulate": "or a mass on the bench of friction",
        "host/report": "of a machine that is shown as reports show it",
        "host/identify": "what is refused",
        "host/log": "or in logs",
        "firmware/version": "a module says which it is",
        "firmware/machine/*": "of a machine as its file describes it",
    },
    "host/c_api": {
        "host/requests": "functions of C are requests",
        "host/simulate": "on a machine as commands load it",
        "host/log": "and logs",
        "firmware/version": "a library says which it is",
        "firmware/machine/*": "of a machine as its file describes it",
    },
    "host/studio": {
        "host/cam": "a motion is held against the limits of an axis",
        "host/cam/step": "becomes the lift of a step cam",
        "host/simulate": "and followed by it in runs of the simulation",
        "host/log": "whose logs it shows",
        "host/report": "on a page with the colours of the reports,",
        "sim/*": "with the laws of the simulation",
        "firmware/machine/*": "on a machine as its file describes it",
        f"{FIRMWARE}/number": "in the drive's formats,",
        f"{FIRMWARE}/motion": "and the drive's table is read back",
    },
    # What the page's compilation has in place of files, exceptions and the database of units.
    "host/studio/wasm": {
        "host/studio": "the page calls the studio",
        "firmware/machine/file": "with units and files of its own",
        "sim/*": "its units are those of the machine files, and no linear programme is solved there",
    },
    "host/cli": {
        "host/studio": "a command writes the studio's page,",
        "host/output": "or prints results",
        "host/requests": "of what its options say,",
        "firmware/version": "the programme says which it is",
        "host/log": "a command reads and writes logs",
        "host/simulate": "runs experiments",
        "host/response": "measures loops",
        "host/identify": "finds models",
        "host/diagnose/*": "and causes",
        "host/tune": "tunes the drive",
        "host/sheet": "makes machine files",
        "host/sweep": "runs all of it many times",
        "host/fleet": "follows many axes over months",
        "host/cam": "makes profiles",
        "host/cam/step": "and step cams",
        "host/report": "and shows the results",
        "sim/*": "for the machine it is given",
        "firmware/machine/*": "as its file describes it",
        f"{FIRMWARE}/number": "with the drive's formats or with double ones",
    },
    "tests": dict.fromkeys(("firmware/*", "hal/*", "sim/*", "host/*", "toolchain/*"), "tests may see everything"),
}

# Where a path in quotes starts.
INCLUDE_ROOTS = ("", "firmware/include", "toolchain/cortex-m")

# The standard headers that the firmware may use: freestanding in C++20 and without floating point, exceptions or heap.
FREESTANDING = {"atomic", "bit", "climits", "compare", "concepts", "cstddef", "cstdint", "initializer_list", "limits",
                "type_traits", "version"}
# By the letter freestanding only from C++26 on: std::array (P2976), but it is nothing but an aggregate, and std::span
# (P2833), a pointer and a length.
FREESTANDING |= {"array", "span"}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:<([^>]+)>|"([^"]+)"|(\S+))')
SOURCES = {".cpp", ".hpp", ".h", ".c"}


def sources(root):
    for top in sorted({room.split("/")[0] for room in ROOMS}):
        for file in sorted((root / top).rglob("*")):
            if file.suffix in SOURCES and "node_modules" not in file.parts:
                yield file.relative_to(root)


def room_of_file(path):
    return next((room for room in ROOMS if "*" in room and path.match(room)), None)


def room_of(folder):
    inside = [room for room in ROOMS if folder == room or folder.startswith(room + "/")]
    return max(inside, key=len, default=None)


def resolve(root, name):
    for start in INCLUDE_ROOTS:
        if (root / start / name).is_file():
            return pathlib.PurePosixPath(start, name)
    return None


@functools.lru_cache
def given_by_recipes(root):
    """Files that a reader of docs/extending.md adds: tests are built with them from a tree of their own."""
    page = root / "docs/extending.md"
    return set(re.findall(r"^`([\w./-]+)`:$", page.read_text(encoding="utf-8"), re.M)) if page.is_file() else set()


def check_file(root, file, arrows):
    """Yields findings; adds to `arrows` the folders that this file's folder includes, with the place."""
    folder = file.parent.as_posix()
    room = room_of_file(file) or room_of(folder)
    if room is None:
        yield f"{file}: {folder} is not a room; add it to ROOMS with the reasons for its arrows"
        return
    for number, line in enumerate((root / file).read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        place = f"{file}:{number}"
        system, quoted, computed = match.groups()
        if computed:
            yield f"{place}: {computed} hides what is included; name the header"
        elif system:
            if room.startswith(FIRMWARE) and system not in FREESTANDING:
                yield f"{place}: <{system}> is not a freestanding header"
        else:
            target = resolve(root, quoted)
            if target is None and room.startswith("tests") and quoted in given_by_recipes(root):
                continue
            if target is None:
                yield f'{place}: there is no "{quoted}" (paths start at the repository\'s root or firmware/include)'
                continue
            to = target.parent.as_posix()
            start = room_of_file(file) or folder
            if to != start:
                arrows.setdefault(start, {}).setdefault(to, place)
            if not allowed(room, to):
                targets = ", ".join(ROOMS[room]) or "nothing else"
                yield f"{place}: {room} may not include {to}; it may include {targets}"


def allowed(room, to):
    return room_of(to) == room or any(
        to == target or (target.endswith("/*") and (to + "/").startswith(target[:-1])) for target in ROOMS[room])


def circles(arrows):
    """Yields a finding for each circle of folders."""
    state = {}

    def visit(folder, path):
        state[folder] = "open"
        for to, place in sorted(arrows.get(folder, {}).items()):
            if state.get(to) == "open":
                circle = path[path.index(to):] + [to]
                yield f"{place}: closes a circle: {' -> '.join(circle)}"
            elif to not in state:
                yield from visit(to, path + [to])
        state[folder] = "done"

    for folder in sorted(arrows):
        if folder not in state:
            yield from visit(folder, [folder])


def unlisted_tests(root):
    """Tests that no list names, by file or by pattern: nobody would see that they do not run."""
    for file in sorted((root / "tests").rglob("*_test.cpp")):
        for folder in file.relative_to(root).parents:
            lists = root / folder / "CMakeLists.txt"
            if lists.exists():
                own = file.relative_to(lists.parent)
                named = re.findall(r"[\w./*-]+_test\.cpp", lists.read_text(encoding="utf-8"))
                if any(len(pathlib.Path(name).parts) == len(own.parts) and own.match(name) for name in named):
                    break
        else:
            yield f"{file.relative_to(root)}: no CMakeLists.txt names this test; expected one that builds it"


def check(root):
    arrows = {}
    findings = [finding for file in sources(root) for finding in check_file(root, file, arrows)]
    return findings + list(circles(arrows)) + list(unlisted_tests(root)), arrows


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2]).resolve()
    findings, arrows = check(root)
    for finding in findings:
        print(finding)
    if not arrows:
        print(f"{root}: no sources found")
    return 1 if findings or not arrows else 0


if __name__ == "__main__":
    sys.exit(main())
