"""The commands whose JSON is validated: each is run really, on a shipped machine, in one scratch folder."""

import json
import pathlib
import re
import shlex
import subprocess

SOURCE = pathlib.Path(__file__).resolve().parents[2]

STEADY = "# amperes: amplitude\nv[mm/s],i[A]\n" + "".join(
    f"{sign * speed},{sign * current}\n" for sign in (1, -1)
    for speed, current in ((1, 1.0), (2, 1.01), (5, 1.05), (10, 1.1), (20, 1.2), (50, 1.4)))

SWEEP = """schema = "stiction.sweep-spec/1"
command = "simulate circle"
machine = "emps"
pareto = ["peak_error", "peak_voltage_X"]
robust = "peak_error"
[option]
friction = ["coulomb_viscous", "lugre"]
feed = "2 m/min"
[set]
"axis.X.mass" = { values = [0.9, 1.1], relative = true }
"axis.X.position_controller.gain" = { values = ["150 1/s", "160 1/s"], design = true }
"""

FLEET = """axis,machine,date,log
table,emps,2026-01-01,lap.csv
table,emps,2026-02-01,gain/speeds.csv
table,emps,2026-03-01,gain/other-circle.csv
table,emps,2026-04-01,missing.csv
"""

# In order: later ones read what earlier ones wrote. other.toml is the shipped cross table under a different name.
COMMANDS = """
simulate circle --machine mcfv5050ln --friction lugre --feed '8 m/min, 16 m/min' --direction both --json
simulate circle --machine mcfv5050ln --set axis.Y.friction.use=classical --log run.csv --out circle --json
simulate circle --machine emps --log lap.csv --json
simulate constant-velocity --machine mcfv5050ln --friction lugre --json
simulate constant-velocity --machine emps --json
simulate impact --machine mcfv5050ln --friction all --json
simulate impact --machine emps --out impact --json
simulate constant-velocity --machine servo-joint --friction lugre --json
simulate impact --machine servo-joint --friction lugre --out joint --json
simulate l-shape --machine mcfv5050ln --friction lugre --json
simulate presliding --machine mcfv5050ln --json
simulate friction-lag --machine mcfv5050ln --json
simulate break-away --machine mcfv5050ln --json
simulate stick-slip --machine mcfv5050ln --json
simulate frequency-response --machine mcfv5050ln --axis X --passes 1 --json
simulate frequency-response --machine emps --json
simulate frequency-response --machine servo-joint --passes 1 --json
simulate frequency-response --from test.xml --json
simulate replay --from run.csv --machine mcfv5050ln --friction lugre --json
simulate replay --from lap.csv --machine emps --json
simulate commissioning --machine emps --hide 3 --out records --json
simulate commissioning --machine emps --set 'axis.X.velocity_controller.gain=300 V s/m' --out gain --json
machine check endless.toml --json
machine --check mcfv5050ln --json
inspect run.csv --machine mcfv5050ln --json
inspect records/circle.csv --machine emps --json
inspect spare.csv --axis X --machine mcfv5050ln --json
identify records/speeds.csv records/circle.csv --machine records/machine.toml --out identified --json
identify run.csv --axis X --machine mcfv5050ln --json
identify steady.csv --axis X --machine mcfv5050ln --json
diagnose records/speeds.csv records/circle.csv records/reversals.csv --machine records/machine.toml --out diagnosis --json
diagnose gain/speeds.csv gain/circle.csv --holdout gain/other-circle.csv --machine emps --json
compare lap.csv --machine emps --json
compare run.csv --machine mcfv5050ln,other.toml --friction lugre,classical --out logs --json
compare --reference circle --machine mcfv5050ln,other.toml --friction lugre --out circles --json
tune-friction records/circle.csv --machine emps --no-pulse --out tuned --json
tune-friction --machine mcfv5050ln --axis X --feed '16 m/min' --no-pulse --json
identify --reference circle --machine mcfv5050ln --json
simulate cam --machine servo-joint --cam indexing.toml --speed '20 rpm' --cycles 1 --out cam-run --json
simulate cam --machine screw-linear-scale --cam shear.toml --name carriage --speed '0.2 m/s' --cycles 1 --json
simulate cam --machine cam-stand --cam stand.toml --speed '130 rpm' --model 'cascade, lagrange' --cycles 1 --json
simulate cam --machine cam-stand --verification --json
cam shape stand.toml --machine cam-stand --speed '130 rpm' --out shapes --json
sweep sweep.toml --out swept --json
fleet fleet.csv --out fleet --json
tune-cam --machine cam-stand --cam stand.toml --speed '130 rpm' --out tuned-cam --json
cam laws --json
cam check indexing.toml --json
cam check indexing.toml --machine servo-joint --speed '20 rpm' --json
cam rank --stroke '90 deg' --rise '180 deg' --speed '20 rpm' --machine servo-joint --json
cam rank --stroke '40 mm' --rise '180 deg' --speed '60 rpm' --machine screw-linear-scale --json
cam design indexing.toml --machine servo-joint --speed '20 rpm' --out cam --json
cam step step_cam.toml --out shop --json
cam step spring_cam.toml --out spring --json
""".strip().splitlines()

# Exit code 1, no JSON on standard output, a result folder all the same.
STOPPED = "simulate circle --machine mcfv5050ln --set 'axis.Y.position_controller.gain=700 1/s' --out stopped --json"

# Take longer than all others; where a folder with their results is given they are not run again.
LONG = {"diagnose --reference circle --machine mcfv5050ln --json": "measured/verdict.json",
        "simulate feed-cutting --machine stick-slip-feed --json": "feed/result.json",
        "compare --reference circle --machine mcfv5050ln --json": "comparison/result.json"}


def run(programme, line, folder, code=0):
    """Standard output of `PROGRAMME LINE` in `folder`; AssertionError where it does not end with `code`."""
    done = subprocess.run([str(programme), *shlex.split(line)], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != code:
        raise AssertionError(f"{programme.name} {line}\nended with {done.returncode}; expected {code}\n{done.stderr}")
    return done.stdout


def prepare(folder):
    """Inputs that no command writes."""
    shipped = SOURCE / "firmware/machine/shipped/mcfv5050ln.toml"
    (folder / "other.toml").write_text(shipped.read_text(encoding="utf-8"), encoding="utf-8")
    endless = SOURCE / "tests/axes/machines/endless_355_113_cascade.toml"
    (folder / "endless.toml").write_text(endless.read_text(encoding="utf-8"), encoding="utf-8")
    motion = SOURCE / "examples/cams/indexing.toml"
    (folder / "indexing.toml").write_text(motion.read_text(encoding="utf-8"), encoding="utf-8")
    for name in ("step_cam.toml", "quarter_turn.toml", "spring_cam.toml", "swing.toml"):
        (folder / name).write_text((SOURCE / "examples/cams" / name).read_text(encoding="utf-8"), encoding="utf-8")
    stand = SOURCE / "examples/cams/stand.toml"
    (folder / "stand.toml").write_text(stand.read_text(encoding="utf-8"), encoding="utf-8")
    shear = SOURCE / "examples/cams/flying_shear.toml"
    (folder / "shear.toml").write_text(shear.read_text(encoding="utf-8"), encoding="utf-8")
    (folder / "sweep.toml").write_text(SWEEP, encoding="utf-8")
    (folder / "fleet.csv").write_text(FLEET, encoding="utf-8")
    (folder / "steady.csv").write_text(STEADY, encoding="utf-8")
    made = SOURCE / "tests/fuzz/seeds/response_file/made.xml"
    (folder / "test.xml").write_text(made.read_text(encoding="utf-8"), encoding="utf-8")
    # A current that stays at a limit, and the motor's force beside it.
    rows = "".join(f"{k / 1000},{0.01 * k * k / 1e6},{min(k, 300) / 100},{94 * min(k, 300) / 100}\n" for k in range(600))
    (folder / "spare.csv").write_text("t[s],x[m],i[A],F[N]\n" + rows, encoding="utf-8")


def documents(programme, folder, made):
    """(what made it, document) of every JSON that the commands print or write; `made`: folder of results, or None."""
    prepare(folder)
    found = []
    for line in COMMANDS:
        found.append((line, json.loads(run(programme, line, folder))))
    if run(programme, STOPPED, folder, code=1) != "":
        raise AssertionError(f"{STOPPED}\nprinted on standard output; expected nothing there")
    for line, file in LONG.items():
        text = run(programme, line, folder) if made is None else (made / file).read_text(encoding="utf-8")
        found.append((line, json.loads(text)))
    for file in sorted(folder.rglob("*.json")):
        found.append((str(file.relative_to(folder)), json.loads(file.read_text(encoding="utf-8"))))
    return found


def subcommands(programme, folder, path=()):
    """The commands, as tuples of words, whose --help names --json."""
    text = run(programme, shlex.join([*path, "--help"]), folder)
    if re.search(r"^ +(-\w,)?--json\b", text, re.M):
        yield path
    below = text.partition("Subcommands:\n")[2]
    for name in re.findall(r"^  ([a-z][a-z-]*)", below, re.M):
        yield from subcommands(programme, folder, (*path, name))
