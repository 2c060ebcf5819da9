"""Files for the fuzzer of the command line: the shipped machines, small logs of them, what other fuzzers begin with and
have learned, and each of them with a few changes."""

import math
import pathlib
import re
import resource
import signal
import subprocess

# What a reader of numbers must bear.
NUMBERS = ["0", "-1", "1", "1e-9", "1e9", "1e308", "-1e308", "1e400", "nan", "inf", "-inf", "", "0.1.2", "1e-320", "٣",
           "0x10", "1,5", " ", "-0", "9223372036854775808"]
HEADERS = ["t[s]", "X.x[mm]", "Y.x_set[m]", "i[A]", "x[N]", "Q.u[V]", "X.F_ext[N]", "", "[m]"]
SUFFIXES = {"machine_file": ".toml", "csv_log": ".csv", "recording": ".txt", "quantity": ".txt"}
LARGEST_FILE = 500_000_000  # bytes that a command may write
WAITING = 20  # times its own time that a command may take on a busy machine
LONGEST = 300_000  # bytes of a file that is changed: a run then takes tenths of a second


def limit(seconds):
    """In the programme's process: its own time counts, and a full disk is an error to be told, not a signal."""
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST_FILE, LARGEST_FILE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def collect(program, root, corpora, folder, patience):
    """Files by kind: "machine", "run" (logs that a command can work with), "log", "other". Runs are made in `folder`,
    each in at most `patience` seconds of its own."""
    files = {"machine": sorted((program.parents[1] / "share/stiction/machines").glob("*.toml")), "log": [], "other": [],
             "project": [root / "examples/cams/step_cam.toml", root / "examples/cams/spring_cam.toml"],
             "motion": sorted((root / "examples/cams").glob("*.toml")) + sorted((root / "tests/fuzz/seeds/cam_motion").glob("*.toml"))}
    for base in [root / "tests/fuzz/seeds", corpora]:
        for kind, suffix in SUFFIXES.items():
            found = sorted((base / kind).glob("*"))[:200] if (base / kind).is_dir() else []
            place = {"machine_file": "machine", "csv_log": "log"}.get(kind, "other")
            for number, file in enumerate(found):
                copy = folder / f"{base.name}-{kind}-{number}{suffix}"
                copy.write_bytes(file.read_bytes())
                files[place].append(copy)
    files["run"] = made_runs(program, folder, patience)
    for name, lines in (("empty.csv", []), ("header.csv", ["t[s],X.x[mm],X.i[A]"])):
        (folder / name).write_text("\n".join(lines) + "\n", encoding="utf-8")
        files["log"].append(folder / name)
    return files


def set_points(axis):
    """Swings of 40 mm that get slower, then some of 0.1 mm: reversals and speeds enough for every command. Without the
    motor's force beside them it is no log."""
    rows, phase, swing = [f"t[s],{axis}.x_set[mm],{axis}.x[mm],{axis}.F[N]"], 0.0, 20.0
    for k in range(4000):
        time = 0.002 * k
        before, phase = phase, phase + 0.002 * max(5.0 - 0.7 * time, 1.5) * (1.0 if swing > 1.0 else 4.0)
        if time > 5.0 and before // (2.0 * math.pi) != phase // (2.0 * math.pi):  # where the axis turns
            swing = 0.05
        x = swing * (1.0 - math.cos(phase))
        rows.append(f"{time:.3f},{x:.6f},{x:.6f},{math.copysign(90.0, math.sin(phase)):.0f}")
    return rows


def made_runs(program, folder, patience):
    """Logs of one axis and of two, as CSV and as MAT, and a table of steady states."""
    made = []

    def makes(name, *arguments):
        """Whether the command has written the file."""
        try:
            subprocess.run([program, *map(str, arguments)], cwd=folder, check=False,
                           timeout=WAITING * patience, preexec_fn=lambda: limit(patience),
                           stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return False
        return (folder / name).exists()

    def keep(name, lines):
        (folder / name).write_text("\n".join(lines) + "\n", encoding="utf-8")
        made.append(folder / name)

    for machine, axis in (("mcfv5050ln", "X"), ("mcfv5050ln", "Y"), ("emps", "X")):
        name = f"{machine}-{axis}"
        wanted, log = f"{name}-set.csv", f"{name}.csv"
        keep(wanted, set_points(axis))
        if makes(log, "simulate", "replay", "--from", wanted, "--machine", machine, "--log", log):
            made += [folder / log] * 3
            for level in ("5", "7.3"):
                if makes(f"{name}-{level}.mat", "convert", log, f"{name}-{level}.mat", "--mat", level):
                    made.append(folder / f"{name}-{level}.mat")
    circle = ("simulate", "circle", "--machine", "mcfv5050ln", "--feed", "48 m/min", "--log", "circle.csv")
    if makes("circle.csv", *circle):
        lines = (folder / "circle.csv").read_text(encoding="utf-8").splitlines()
        head = [line for line in lines if line.startswith("#")]
        rows = lines[len(head):]
        keep("circle.csv", head + rows[:1] + rows[1::16])
    keep("steady.csv", ["v[m/min],i[A]"] + [f"{v},{0.9 + 0.1 * v}" for v in (0.1, 0.5, 1, 3, 8, 16, -0.1, -1, -8)])
    return made


def changed_bytes(draw, data):
    data = bytearray(data)
    for _ in range(draw.randint(1, 8)):
        at = draw.randrange(len(data) + 1)
        kind = draw.randrange(4)
        if kind == 0 and at < len(data):
            data[at] = draw.randrange(256)
        elif kind == 1:
            del data[at:at + draw.randint(1, 64)]
        elif kind == 2:
            data[at:at] = data[at:at + draw.randint(1, 64)]
        else:
            data[at:at] = bytes(draw.randrange(256) for _ in range(draw.randint(1, 4)))
    return bytes(data)


def changed_numbers(draw, text):
    """Some numbers of the text become others: odd ones, or a multiple of themselves."""
    places = list(re.finditer(r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?", text))
    for place in sorted(draw.sample(places, min(len(places), draw.randint(1, 4))), key=lambda p: -p.start()):
        if draw.random() < 0.5:
            new = draw.choice(NUMBERS)
        else:
            new = repr(float(place.group()) * draw.choice([-1.0, 1e-3, 0.1, 0.5, 2.0, 10.0, 1e3, 1e6]))
        text = text[:place.start()] + new + text[place.end():]
    return text


def changed_lines(draw, text):
    lines = text.split("\n")
    for _ in range(draw.randint(1, 3)):
        at = draw.randrange(len(lines))
        kind = draw.randrange(4)
        if kind == 0:
            del lines[at:at + draw.choice([1, 1, 3, 50])]
        elif kind == 1:
            lines[at:at] = [lines[at]] * draw.choice([1, 1, 2, 20])
        elif kind == 2:
            other = draw.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        else:
            lines = lines[:at]
        lines = lines or [""]
    return "\n".join(lines)


def changed_columns(draw, text):
    """A table with a column less, one named otherwise, or one whose values are all the same."""
    rows = [line.split(",") for line in text.split("\n")]
    head = next((k for k, row in enumerate(rows) if len(row) > 1), 0)
    column = draw.randrange(len(rows[head]))
    kind, same = draw.randrange(3), draw.choice(["0", "1"])
    for k, row in enumerate(rows[head:]):
        if column >= len(row):
            continue
        if kind == 0:
            del row[column]
        elif kind == 1 and k == 0:
            row[column] = draw.choice(HEADERS)
        elif kind == 2 and k > 0:
            row[column] = same
    return "\n".join(",".join(row) for row in rows)


def changed(draw, file, place):
    """Writes `file` with a few changes to `place`."""
    data = file.read_bytes()[:LONGEST]
    if draw.random() < 0.2 or b"\0" in data:
        place.write_bytes(changed_bytes(draw, data))
        return
    text = data.decode("utf-8", errors="surrogateescape")
    ways = [changed_numbers, changed_lines] + ([changed_columns] * 2 if file.suffix == ".csv" else [])
    for _ in range(draw.choice([1, 1, 2])):
        text = draw.choice(ways)(draw, text)
    place.write_bytes(text.encode("utf-8", errors="surrogateescape"))


def keys_of(machines):
    """Keys of machine files as --set takes them: "axis.X.friction.use"."""
    keys = set()
    for file in machines:
        table = ""
        for line in pathlib.Path(file).read_text(encoding="utf-8", errors="replace").splitlines():
            if found := re.match(r"\s*\[+([\w.\"-]+)\]+", line):
                table = found[1] + "."
            elif found := re.match(r"\s*([\w.]+)\s*=\s*(.*?)\s*(?:#.*)?$", line):
                keys.add((table + found[1], found[2]))
    return sorted(keys)
