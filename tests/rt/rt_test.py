#!/usr/bin/env python3
"""The drive's programme and the simulated machine on Debian's real-time kernel in counted time (toolchain/rt/run): starts
over CAN (vcan, and two emulated SJA1000 controllers) and Modbus, the circle at 48 m/min idle and loaded, cyclictest in
the same boot; an adapter unplugged, a link down, a time of day that is set and a suspension while an axis is held; deaths
of all kinds and stops under load, seen from the buses. One processor, one instruction a nanosecond; the plant answers on
that processor too. Needs the programmes (release build) and what
toolchain/setup rt installs. Counted time judges the length of paths and the kernel's part of them, never hardware."""

import argparse
import collections
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).parents[2]
BIN = pathlib.Path(os.environ.get("STICTION_BIN", ROOT / "build/release/bin"))
FOLDER = pathlib.Path(os.environ.get("STICTION_RT_DIR", ROOT / "build/rt"))
PHASES = 5  # starts of cyclictest at each period, and of the loop beside it
SCRIPT_SIZE = 1 << 17  # characters; that of 100 starts has 80 000
TWO_AXES = FOLDER / "two_axes.toml"
PROGRAMMES = [BIN / "stictiond", BIN / "stiction-plant", BIN / "can_adapter_test", BIN / "can_kill_list", BIN / "can_faults", BIN / "stops_under_load",
              BIN.parent / "tests/firmware/stictiond/libheld_fsync.so"]
TOOLS = ["/usr/bin/cyclictest", "/usr/bin/hackbench", "/usr/bin/chrt", shutil.which("ip", path="/bin:/sbin:/usr/bin:/usr/sbin")]
DATA = [*sorted((ROOT / "firmware/machine/shipped").glob("*.toml")), *sorted(pathlib.Path("/usr/share/xml/udunits").glob("*.xml"))]

# The machine's nodes stand for computers of their own. They have the priority of the drive's loop: above it, they would
# interrupt the loop where it hands them a frame, below it, the loop interrupts them where they hand it theirs, in both
# cases with the bus' locks held, which costs two changes of the thread and back each time.
PLANT = ["chrt", "-f", "80", "stiction-plant"]
# The machine's folder and the units' database where the programmes look for them; a bus; no budget for real-time threads,
# of which the plant on the drive's own processor takes most.
PREPARE = """
export UDUNITS2_XML_PATH=/data/udunits2.xml
mkdir -p /share/stiction
ln -s /data /share/stiction/machines
ip link add vcan0 type vcan
ip link set vcan0 mtu 72 up
echo -1 >/proc/sys/kernel/sched_rt_runtime_us
# What the kernel puts off until after its start.
sleep 5
# run NAME: the functions plant and drive until the drive has ended, LOAD beside the loop.
run() {
  plant >$1.plant 2>&1 &
  plant=$!
  while kill -0 $plant 2>/dev/null && [ ! -s $1.plant ]; do sleep 0.01; done
  drive >$1.drive 2>&1 &
  drive=$!
  if [ -n "$LOAD" ]; then
    while kill -0 $drive 2>/dev/null && ! grep -qs 'has begun' $1.drive; do sleep 0.01; done
    $LOAD >/dev/null 2>&1 &
    load=$!
  fi
  (sleep 30; echo "ended after 30 s" >>$1.drive; kill -9 $drive) 2>/dev/null &
  watch=$!
  wait $drive
  echo $? >$1.status
  kill $watch $plant 2>/dev/null
  [ -z "$LOAD" ] || killall -9 ${LOAD%% *}
  wait $plant $load 2>/dev/null
  LOAD= load=
  echo "$(cut -d ' ' -f 1 /proc/uptime) s: $1 ended with $(cat $1.status)"
  [ "$(cat $1.status)" = 0 ] || grep -h -e fault -e found -e ended $1.drive | head -n 3
}
"""
# Two controllers on one bus, and what a person does to their computer meanwhile: an interface that is deleted, a PCI card
# that is removed, both back under the same name.
CONTROLLERS = """
for i in 0 1; do /bin/ip link set can$i type can bitrate 1000000; /bin/ip link set can$i txqueuelen 100; /bin/ip link set can$i up; done
"""
ADAPTERS = CONTROLLERS + """
echo 1 >/sys/module/suspend/parameters/pm_test_delay
export SUSPEND="echo core >/sys/power/pm_test && echo mem >/sys/power/state"
# adapter NAME INTERFACE OTHER: the machine on the other interface, the tests on the first.
adapter() {
  PLANT --machine emps --bus can:$3 --set drive.can.interface=$3 --set drive.axis.X.node=1 >$1.plant 2>&1 &
  plant=$!
  while kill -0 $plant 2>/dev/null && [ ! -s $1.plant ]; do sleep 0.01; done
  export ADAPTER=$2 DOWN="/bin/ip link set $2 down" UP="/bin/ip link set $2 up"
  chrt -R -f 80 can_adapter_test --gtest_color=no >$1.drive 2>&1
  echo $? >$1.status
  kill $plant
  wait $plant
}
export UNPLUG="/bin/ip link del vcan0" PLUG="/bin/ip link add vcan0 type vcan && /bin/ip link set vcan0 up"
adapter vcan vcan0 vcan0
device=$(readlink -f /sys/class/net/can0/device)
export UNPLUG="echo 1 >$device/remove"
export PLUG="echo 1 >/sys/bus/pci/rescan && sleep 0.1 && /bin/ip link set can0 type can bitrate 1000000 && /bin/ip link set can0 up"
adapter sja1000 can0 can1
""".replace("PLANT", " ".join(PLANT))
# Programmes of their own, which start drive and machine themselves.
DEATHS = """
ip link add vcan1 type vcan
ip link set vcan1 up
export HELD_FSYNC_LIBRARY=/bin/libheld_fsync.so
can_kill_list >deaths.drive 2>&1
echo $? >deaths.status
can_faults >faults.drive 2>&1
echo $? >faults.status
stops_under_load STOPS >stops.drive 2>&1
echo $? >stops.status
"""
# A circle whose kernel notes when each timer of a sleeper expires, and what that interrupted. It costs 1 us a tick.
TRACE_BEGIN = """
mkdir /tracing
mount -t tracefs tracing /tracing
echo 60000 >/tracing/buffer_size_kb
echo 1 >/tracing/events/timer/hrtimer_expire_entry/enable
"""
TRACE_END = """
echo 0 >/tracing/tracing_on
sed -n 's/^ *\\(.*\\)-[0-9]* .* hrtimer_expire_entry: .*function=hrtimer_wakeup now=/\\1 /p' /tracing/trace >timers
echo 0 >/tracing/events/timer/hrtimer_expire_entry/enable
umount /tracing
"""
LOAD = "hackbench -g 1 -f 4 -l 1000000000"


@dataclasses.dataclass
class Run:
    """A drive and its machine: name, period, what the drive does, what runs beside it."""
    name: str
    bus: str  # can, sja1000 or modbus
    period: str
    task: tuple
    load: str = ""
    trace: bool = False

    def script(self):
        if self.bus == "can":
            # The delay of the set-points is a multiple of every period here.
            machine = ["--machine", "mcfv5050ln", "--set", f"timing.fast_period={self.period}", "--set",
                       "timing.set_point_delay=500 us"]
            plant = ["--bus", "can:vcan0", "--at", "X=90 mm"]
            drive = ["--hal", "can", "--set", "drive.can.interface=vcan0"]
            if self.period == "250 us":  # half of whose rate is the notch's own frequency
                machine += ["--set", "axis.X.notch=", "--set", "axis.Y.notch="]
        elif self.bus == "sja1000":
            machine = ["--machine", f"/data/{TWO_AXES.name}", "--set", f"timing.fast_period={self.period}", "--set",
                       f"timing.slow_period={self.period}", "--set", "drive.axis.X.node=1", "--set", "drive.axis.Y.node=2"]
            plant = ["--bus", "can:can1", "--set", "drive.can.interface=can1", "--at", "X=90 mm"]
            drive = ["--hal", "can", "--set", "drive.can.interface=can0"]
        else:
            machine = ["--machine", "emps"]
            plant = ["--bus", "modbus:127.0.0.1:15020"]
            drive = ["--hal", "modbus", "--set", f"timing.fast_period={self.period}", "--set",
                     f"timing.slow_period={self.period}", "--set", "axis.X.max_velocity=0.04 m/s", "--set",
                     "axis.X.velocity_controller.gain=30 V s/m", "--set", "axis.X.position_controller.gain=3 1/s", "--set",
                     "drive.modbus_client.device=127.0.0.1:15020"]
        task = list(self.task) + (["--trace", "trace.csv"] if self.trace else [])
        text = f"LOAD='{self.load}'\n" if self.load else ""
        text += f"plant() {{ exec {shlex.join([*PLANT, *machine, *plant])}; }}\n"
        text += f"drive() {{ exec {shlex.join(['stictiond', *machine, *drive, *task])}; }}\n"
        text += f"run {self.name}\n"
        if self.trace:
            text += f"sha256sum trace.csv >{self.name}.sum\nrm -f trace.csv\n"
        return text


class Result:
    """What a run left."""

    def __init__(self, folder, name):
        self.drive = (folder / f"{name}.drive").read_text()
        self.status = int((folder / f"{name}.status").read_text())
        self.times = {part: tuple(map(float, values)) for part, *values in re.findall(
            r"^(lateness|work|read|control|write) +([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+)$", self.drive, re.M)}
        processor = re.search(r"^processor time .* ([\d.]+) us a tick$", self.drive, re.M)
        self.tick = float(processor[1]) * 1e3 if processor else None  # instructions without waiting
        missed = re.search(r"^missed ticks (\d+)$", self.drive, re.M)
        self.missed = int(missed[1]) if missed else None
        checksum = folder / f"{name}.sum"
        self.trace = checksum.read_text() if checksum.exists() else ""

    def why(self):
        """The first line that says what went wrong."""
        return next((line for line in self.drive.splitlines() if "fault" in line or "ended" in line or "found" in line), "")


def write_two_axes():
    """The measured axis twice, as a table whose circle fits classical frames of 1 Mbit/s."""
    text = (ROOT / "firmware/machine/shipped/emps.toml").read_text(encoding="utf-8")
    axis = text[text.index("[axis.X]"):]
    TWO_AXES.parent.mkdir(parents=True, exist_ok=True)
    TWO_AXES.write_text(text + "\n" + axis.replace("axis.X", "axis.Y"), encoding="utf-8")


def figure(name, text):
    """A figure of docs/results.md."""
    with open(FOLDER / "figures.txt", "a", encoding="utf-8") as file:
        file.write(f"{name:<64} {text}\n")


def boot(name, script):
    """Runs a script of the guest's in a boot of its own; the folder of its results."""
    folder = FOLDER / name
    folder.mkdir(parents=True, exist_ok=True)
    # All boots begin alike to the instruction, so their scripts have one size.
    text = PREPARE + script
    (folder / "guest.sh").write_text(text + "#" * (SCRIPT_SIZE - len(text)))
    # Counted time takes as long as the computer is busy with other things; this only ends what hangs.
    limit = {"RT_TIMEOUT": os.environ.get("RT_TIMEOUT", "3600")}
    done = subprocess.run([ROOT / "toolchain/rt/run", folder, folder / "guest.sh", *PROGRAMMES, *TOOLS, *DATA, TWO_AXES],
                          capture_output=True, text=True, check=False, env={**os.environ, **limit})
    if done.returncode != 0:
        sys.exit(f"rt: the boot '{name}' ended with {done.returncode}; expected 0\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return folder / "out"


def of_phases(starts):
    """The start whose 99.9 % is the middle one. A start's deadlines lie at one phase to the kernel's tick, which decides what
    a lateness at 99.9 % is and is another one at each start: one start against another compares phases, not programmes."""
    return sorted(starts, key=lambda found: found[1])[len(starts) // 2]


def cyclic(folder, period):
    """Median and 99.9 % of each start of cyclictest, us. Its histogram has a nanosecond a row."""
    starts = []
    for start in range(PHASES):
        rows = [tuple(map(int, line.split())) for line in (folder / f"cyclic{period}.{start}").read_text().splitlines()
                if re.match(r"\d+ \d+$", line)]
        total, seen, found = sum(count for _, count in rows), 0, []
        for latency, count in rows:
            seen += count
            while len(found) < 2 and seen >= (0.5, 0.999)[len(found)] * total:
                found.append(latency * 1e-3)
        starts.append(found)
    return starts


def traced_timers(file):
    """Of the timer of a loop of 125 us, which expires most often at one phase: how often it expired, how often it
    interrupted the machine, and how often that more than 1 us late."""
    rows = [(name, int(time)) for name, time in (line.rsplit(" ", 1) for line in file.read_text().splitlines())]
    phase = collections.Counter(time % 125000 // 100 for _, time in rows).most_common(1)[0][0] * 100
    delays = [(name, delay) for name, delay in ((name, (time - phase + 1000) % 125000 - 1000) for name, time in rows) if delay < 20000]
    met = [delay for name, delay in delays if name == "stiction-plant"]
    return len(delays), len(met), sum(delay > 1000 for delay in met)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--starts", type=int, default=5, help="starts of the drive over each bus")
    parser.add_argument("--stops", type=int, help="stops under load, half of them over each bus (ten for each start)")
    options = parser.parse_args()

    first = [Run("idle", "can", "125 us", ("--circle", "48 m/min"), trace=True)]
    rest = [Run("loaded", "can", "125 us", ("--circle", "48 m/min"), load=LOAD), *(Run(f"slower{k}", "can", "250 us", ("--hold", "1")) for k in range(PHASES))]
    starts = {bus: [Run(f"{bus}{k}", bus, period, ("--hold", hold)) for k in range(options.starts)]
              for bus, period, hold in (("can", "125 us", "0.05"), ("modbus", "10 ms", "0.5"))}
    timers = "".join(f"cyclictest -N -q -m -p 80 -i {period} -l 4000 -h 30000 | grep -v ' 000000$' >cyclic{period}.{start}\n"
                     for period in (125, 250) for start in range(PHASES))
    controllers = [Run("sja1000hold", "sja1000", "2 ms", ("--hold", "0.2")), Run("sja1000circle", "sja1000", "2 ms", ("--circle", "9 m/min"))]
    traced = Run("traced", "can", "125 us", ("--circle", "48 m/min"))
    whole = first + rest + starts["can"] + starts["modbus"]
    write_two_axes()
    with concurrent.futures.ThreadPoolExecutor() as pool:
        again = pool.submit(boot, "again", "".join(run.script() for run in first) + CONTROLLERS +
                            "".join(run.script() for run in controllers) + ADAPTERS.removeprefix(CONTROLLERS))
        deaths = pool.submit(boot, "deaths", TRACE_BEGIN + traced.script() + TRACE_END + DEATHS.replace("STOPS", str(options.stops or 10 * options.starts)))
        folder = boot("whole", "".join(run.script() for run in first) + timers + "".join(run.script() for run in whole[1:]))
        again, deaths = again.result(), deaths.result()
    results = {run.name: Result(folder, run.name) for run in whole}
    results |= {run.name: Result(again, run.name) for run in controllers}
    adapters = {name: Result(again, name) for name in ("vcan", "sja1000")}
    traced = traced_timers(deaths / "timers")
    deaths, faults, stops = (Result(deaths, name) for name in ("deaths", "faults", "stops"))
    again = Result(again, "idle")
    idle, loaded = results["idle"], results["loaded"]
    slower = [results[f"slower{k}"] for k in range(PHASES)]

    failures = []

    def row(what, found, bound="", held=True):
        print(f"{what:<58} {found:<34} {bound}{'' if held else '   NOT HELD'}")
        if not held:
            failures.append(what)

    print("Counted time: one processor, 1 instruction a ns; no statement about hardware follows from it.")
    (FOLDER / "figures.txt").unlink(missing_ok=True)
    for bus, runs in starts.items():
        good = sum(results[run.name].status == 0 for run in runs)
        row(f"starts to enabled and back, {bus} at {runs[0].period}", f"{good} of {len(runs)} with status 0", "all", good == len(runs))
        figure(f"starts on the real-time kernel in counted time: {bus}", f"{good} of {len(runs)}")
        missed = sum(results[run.name].missed or 0 for run in runs)
        row(f"missed ticks of these starts, {bus}", str(missed), "0", missed == 0)
    for result, what in ((idle, "idle"), (loaded, "loaded")):
        row(f"circle at 48 m/min, 125 us over CAN, {what}: status", str(result.status), "0", result.status == 0)
        row(f"  missed ticks, {what}", str(result.missed), "0", result.missed == 0)
        if result.times:
            median, high, largest = result.times["lateness"][:3]
            row(f"  lateness, us, {what}: median, 99.9 %, largest", f"{median:.2f}  {high:.2f}  {largest:.2f}", "99.9 % <= 12", high <= 12.0)
            figure(f"lateness at 125 us in counted time, {what}", f"99.9 %: {high:.2f} us, median {median:.2f} us, missed {result.missed}")
            row(f"  read with its waiting for the plant, us, {what}: mean", f"{result.times['read'][3]:.2f}")
            control, write = (result.times[part][3] * 1e3 for part in ("control", "write"))
            # What the loop's thread ran beside control and write: reading, and going to sleep and waking.
            counted = {"read and sleep": result.tick - control - write, "control": control, "write": write, "tick": result.tick}
            for part, instructions in counted.items():
                row(f"  instructions of {part}, without waiting, {what}: mean", f"{instructions:.0f}", "within 5 % of docs/results.md")
                figure(f"instructions of {part} in counted time, {what}", f"{instructions:.0f}")
    row("  one circle's timer that meets the machine at work", "{1} of {0} times, {2} of them over 1 us late".format(*traced))
    cyclic250 = cyclic(folder, 250)
    for period, found in ((125, cyclic(folder, 125)), (250, cyclic250)):
        row(f"cyclictest -N, us, {period} us: median, 99.9 %; of {PHASES} starts", "  ".join(f"{value:.2f}" for value in of_phases(found)) +
            "; {:.2f} to {:.2f}".format(min(high for _, high in found), max(high for _, high in found)))
    if all(run.times for run in slower):
        late = [run.times["lateness"][:2] for run in slower]
        found = of_phases(late)[1]
        ratio = found / of_phases(cyclic250)[1]
        row("lateness 99.9 % at 250 us over cyclictest's", "{:.2f} us ({:.2f} to {:.2f}), {:.2f} of it".format(
            found, min(high for _, high in late), max(high for _, high in late), ratio), "<= 1.2", ratio <= 1.2)
        figure("lateness 99.9 % at 250 us over cyclictest's in counted time", f"{ratio:.2f}")
    else:
        row("held at 250 us: status", ", ".join(str(run.status) for run in slower), "0", False)
    same = idle.trace != "" and idle.trace == again.trace
    row("the circle in a second boot: trace", "equal" if same else "different", "equal", same)
    if idle.times and again.times:
        apart = [abs(a - b) for a, b in zip(idle.times["lateness"][:2], again.times["lateness"][:2])]
        row("  lateness apart, us: median, 99.9 %", "  ".join(f"{value:.2f}" for value in apart), "<= 1", max(apart) <= 1.0)
    for run in controllers:
        result = results[run.name]
        row(f"two SJA1000 controllers, 1 Mbit/s, {' '.join(run.task)}: status, missed", f"{result.status}, {result.missed}", "0, 0",
            (result.status, result.missed) == (0, 0))
    for name, result in adapters.items():
        good, bad = (result.drive.count(word) for word in ("[       OK ]", "[  FAILED  ] HeldOverCan"))
        row(f"unplugged, link down, time of day set, suspended: {name}", f"{good} of 4 recovered", "all", (good, result.status) == (4, 0))
        figure(f"events of the computer recovered in counted time: {name}", f"{good} of 4")
        if result.status != 0:
            print("\n".join(line for line in result.drive.splitlines() if "Failure" in line or "FAILED" in line or "Which" in line))
    for what, result in (("deaths around a drive over CAN", deaths), ("faults injected in motion over CAN", faults)):
        good, count = re.search(r"^(\d+) of (\d+) ended in their reaction$", result.drive, re.M).groups()
        row(f"{what}: ended in their reaction", f"{good} of {count}", "all", result.status == 0)
        figure(f"{what} in counted time", f"{good} of {count}")
        if result.status != 0:
            print(result.drive)
    frozen = re.search(r"^the loop does not go on .* disabled after +([\d.]+) ms", deaths.drive, re.M)
    row("  the loop does not go on: power taken after, ms", frozen[1], "<= 110", float(frozen[1]) <= 110.0)
    figure("power taken from a loop that does not go on in counted time", f"{frozen[1]} ms")
    for bus, good, count, ticks in re.findall(r"^stops by (\w+) +(\d+) of (\d+) within 2 ticks, longest (\d+)", stops.drive, re.M):
        row(f"stops by {bus} under load within 2 ticks", f"{good} of {count}, longest {ticks}", "all", good == count)
        figure(f"stops under load in counted time: {bus}", f"{good} of {count}, longest {ticks} ticks")
    row("  the load", stops.drive.splitlines()[-1], "", stops.status == 0)
    for name, result in results.items():
        if result.status != 0:
            print(f"{name}: status {result.status}: {result.why()}")
    if failures:
        print(f"{len(failures)} bounds are not held")
    print(f"{sum(result.status == 0 for result in results.values())} of {len(results)} runs with status 0, "
          f"{len(failures)} bounds not held")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
