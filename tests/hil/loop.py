"""The drive's programme against the simulated machine on a kernel of its own: what a test asks for, in Python."""

import dataclasses
import os
import pathlib
import re
import shlex
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).parents[2]
BIN = pathlib.Path(os.environ.get("STICTION_BIN", ROOT / "build/release/bin"))
FOLDER = pathlib.Path(os.environ.get("STICTION_HIL_DIR", tempfile.mkdtemp(prefix="stiction-hil-")))
FIGURES = BIN.parent / "figures"
PERIOD = 62.5e-6  # s
# A sample, which ends in minutes where a call of the guest's kernel takes long: this many of each list of faults. 0: all.
SAMPLE = int(os.environ.get("STICTION_HIL_SAMPLE", "0"))

# A bus, the machine's nodes on it, the drive; what each says goes to files beside.
BUS = """
ip link add vcan0 type vcan
ip link set vcan0 mtu 72 up
"""
RUN = """
{plant} > {name}.plant 2>&1 &
plant=$!
for i in $(seq 100); do [ -s {name}.plant ] && break; sleep 0.01; done
{beside}
{drive} > {name}.drive 2>&1
echo $? > {name}.status
sleep {afterwards}
kill $plant
wait $plant
"""


def sampled(rows, count=SAMPLE):
    """All rows, or in a sample so many of them; the commit draws, so that each has its turn and a failure can be repeated."""
    if not SAMPLE:
        return rows
    commit = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False).stdout
    first = int(commit.strip() or "0", 16)
    return [rows[(first + k) % len(rows)] for k in range(min(count, len(rows)))]


@dataclasses.dataclass
class Run:
    """One run of the drive: its name, its options, the plant's faults."""
    name: str
    task: tuple = ("--circle", "16 m/min")
    faults: tuple = ()
    drive: tuple = ()
    plant: tuple = ()
    both: tuple = ()  # options that both take
    beside: str = ""  # a command of the guest that runs beside the drive
    afterwards: float = 2.0  # s that the machine is watched for after the drive has ended

    def script(self):
        common = ["--machine", "mcfv5050ln", "--set", "drive.can.interface=vcan0", *self.both]
        plant = [BIN / "stiction-plant", *common[:2], *self.both, "--bus", "can:vcan0", "--at", "X=90 mm", *self.plant]
        for fault in self.faults:
            plant += ["--fault", fault]
        drive = [BIN / "stictiond", *common, "--hal", "can", *self.task, *self.drive]
        return RUN.format(name=self.name, plant=shlex.join(map(str, plant)), drive=shlex.join(map(str, drive)),
                          beside=self.beside, afterwards=self.afterwards)


@dataclasses.dataclass
class Axis:
    """An axis as the machine saw it."""
    off_since: int | None  # tick
    ran_on_um: float
    ran_on_ticks: int


class Result:
    """What a run left in `folder`."""

    def __init__(self, folder, name):
        self.drive = (folder / f"{name}.drive").read_text()
        self.plant = (folder / f"{name}.plant").read_text()
        self.status = int((folder / f"{name}.status").read_text())
        self.axes = {
            axis: Axis(int(tick), float(way), int(ticks))
            for axis, tick, way, ticks in re.findall(
                r"axis (\w+): stage off since tick (\d+), coasted by (\S+) um for (\d+) ticks", self.plant)
        }
        begin = re.search(r"([\d.]+) s: the loop has begun", self.drive)
        self.begin = float(begin[1]) if begin else None

    def faults(self):
        """(tick, axis, number) of each that the drive logged; at what it calls its begin comes the machine's tick 3."""
        return [(round((float(time) - self.begin) / PERIOD) + 3, int(axis), int(number))
                for time, axis, number in re.findall(r"([\d.]+) s: axis (\d+): fault (\d+) ", self.drive)]

    def counts(self, axis):
        """Answers of a node by what became of them."""
        line = re.search(rf"^axis {axis}: (\d+ answers.*)$", self.drive, re.M)[1]
        return {what: int(number) for number, what in re.findall(r"(\d+) ([a-z ]+)", line)}


def boot(folder, script, timeout=1800, through=()):
    """Runs a script of the guest's in `folder`, for `timeout` seconds at most; `through`: a command that runs it."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "guest.sh").write_text(script)
    done = subprocess.run([ROOT / "toolchain/hil/run", folder, *through, "bash", "guest.sh"], capture_output=True, text=True,
                          check=False, env={**os.environ, "HIL_TIMEOUT": str(round(timeout))})
    if done.returncode not in (0, 143):  # a plant that was told to end
        raise RuntimeError(f"the loop ended with {done.returncode}:\n{done.stdout[-3000:]}{done.stderr[-3000:]}")


def execute(folder, runs):
    """All runs one after another on one boot of the kernel; their results by name."""
    boot(folder, BUS + "".join(run.script() for run in runs))
    return {run.name: Result(folder, run.name) for run in runs}


def figure(name, text):
    """What a test measured, with its bound: printed and, of whole suites, kept."""
    line = f"{name:<64} {text}\n"
    print(line, end="")
    if SAMPLE:
        return
    FIGURES.mkdir(parents=True, exist_ok=True)
    with open(FIGURES / "hil.txt", "a", encoding="utf-8") as file:
        file.write(line)


def rows(file):
    """The rows of a log, without its comments."""
    with open(file, encoding="utf-8") as lines:
        return [line.rstrip("\n").split(",") for line in lines if not line.startswith("#")]
