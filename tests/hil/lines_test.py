#!/usr/bin/env python3
"""The drive's programme against the simulated machine with nothing between them but digital lines: a chip of gpio-sim and
a folder of the PWM class's shape, on a kernel in simulated time. Needs what loop_test.py needs."""

import json
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

import loop
from loop_test import figure

FOLDER = pathlib.Path(os.environ.get("STICTION_HIL_DIR", tempfile.mkdtemp(prefix="stiction-hil-")))
HERE = pathlib.Path(__file__).parent
PERIOD = 1e-3  # s, of gpio_axis.toml
SWITCH = -30e-3  # m

# 1 s after the start the axis searches its switch at 20 mm/s, 4000 edges a second; 4 s after it, it stands homed.
SEARCHING, HOMED = "1 s", "4 s"
# Kind, time, ticks that it lasts, faults that may be named for it (faults.hpp), periods from its tick's begin within
# which: a tick shows the level of a line at once, edges 50 us later, their rate at the tick's end.
FAULTS = [
    ("power-stage", SEARCHING, 1000, {5}, 1.0),
    ("tracks-together", SEARCHING, 1, {36}, 1.1),
    ("track-noise", SEARCHING, 1, {36}, 2.1),
    # Ten increments are 50 us apart: a jump from one tick to the next, or too fast.
    ("encoder-jump", SEARCHING, 1000, {17, 36}, 2.1),
    # Until the set-point has moved by 1 mm, 50 ms at that speed.
    ("encoder-open", SEARCHING, 1000, {16}, 52.0),
    ("limit-negative", HOMED, 1000, {21}, 1.0),
    ("limit-positive", HOMED, 1000, {21}, 1.0),
    ("torque-off", SEARCHING, 1000, {89}, 1.0),
    ("torque-off-channel", SEARCHING, 1000, {89}, 1.0),
]

RUN = """
{plant} >{name}.plant 2>&1 &
plant=$!
while [ ! -s {name}.plant ]; do sleep 0.01; done
{beside}
{drive} >{name}.drive 2>&1
echo $? >{name}.status
sleep 0.5
kill $plant
wait $plant
"""


# Beside the drive that serves: a Modbus master homes the axis again and again and resets what there is, for 12 s.
PORT = 15022
SERVED = """
(while ! grep -q 'has begun' served.drive; do sleep 0.1; done
python3 {peer} {port} 0.2 $plant >served.peer 2>&1
kill -TERM $(pidof stictiond)) &
"""


def script(name, faults=(), task=("--hold", "4"), beside=""):
    machine = ["--machine", HERE / "gpio_axis.toml", "--set", "drive.gpio.pwm_chip=/run/pwm"]
    plant = [loop.BIN / "stiction-plant", *machine, "--bus", "gpio", "--mark", f"X.limit_negative={SWITCH} m"]
    for fault in faults:
        plant += ["--fault", fault]
    drive = [loop.BIN / "stictiond", *machine, "--hal", "gpio", *task]
    return RUN.format(name=name, plant=shlex.join(map(str, plant)), drive=shlex.join(map(str, drive)), beside=beside)


def served():
    task = ["--set", f"drive.modbus_server.address=127.0.0.1:{PORT}", "--set", "drive.modbus_server.motion=allowed",
            "--set", "drive.modbus_server.commander_timeout=0 s"]
    return script("served", ["tracks-together,at=4 s"], task, SERVED.format(peer=HERE / "endurance_peer.py", port=PORT))


# What the lines of switch tracks show, from beside the drive: time and level of each change, until the drive has ended.
WATCH = """
import glob, json, time
lines = {line: glob.glob(f"/sys/devices/platform/gpio-sim.*/gpiochip*/sim_gpio{line}/value") for line in (12, 13)}
files = {line: open(found[0]) for line, found in lines.items()}
def level(file):
    file.seek(0)
    return file.read().strip() == "1"
seen = {line: False for line in files}
changes = []
while not glob.glob("cam.status"):
    for line, file in files.items():
        now = level(file)
        if now != seen[line]:
            changes.append((time.monotonic(), line, now))
            seen[line] = now
    time.sleep(0.001)
json.dump(changes, open("cam.lines", "w"))
"""
CAM = """schema = "stiction.cam/1"
[cam.a]
cycle = "360 deg"
master = "rotary"
slave = "linear"
periodic = true
[[cam.a.segment]]
length = "150 deg"
stroke = "5 mm"
law = "3-4-5"
[[cam.a.segment]]
end = "360 deg"
to = "0 mm"
law = "3-4-5"
"""


class Run:
    def __init__(self, name, folder=FOLDER / "lines"):
        self.drive = (folder / f"{name}.drive").read_text()
        self.plant = (folder / f"{name}.plant").read_text()
        self.status = int((folder / f"{name}.status").read_text())
        begun = re.search(r"([\d.]+) s, tick \d+: ", self.plant)
        self.broken = float(begun[1]) if begun else None  # s
        self.faults = [(float(time), int(number))
                       for time, number in re.findall(r"([\d.]+) s: axis 0: fault (\d+) ", self.drive)]
        rest = re.search(r"coasted by (\S+) um for (\d+) ticks, position (\S+) mm", self.plant)
        self.ran_on, self.stands = float(rest[1]) * 1e-6, float(rest[3]) * 1e-3


class Lines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scripts = [script("health")]
        scripts.append(served())
        scripts += [script(kind, [f"{kind},at={at},ticks={ticks}"]) for kind, at, ticks, *_ in FAULTS]
        loop.boot(FOLDER / "lines", "".join(scripts), through=(HERE / "gpio_guest.sh",))

    def test_carry_an_axis_to_its_switch_and_hold_it_there(self):
        run = Run("health")
        self.assertEqual((run.status, run.faults), (0, []), run.drive + run.plant)
        self.assertIn("at least 0 edges lost; last fault of the encoder tracks: none", run.drive)
        # Where the switch opens the set-point is ahead of the axis by v / Kv = 5 mm/s / 40 1/s = 125 um and what friction
        # holds back, 71 um; it comes to rest behind a tick, 5 um, and the ramp, v^2 / 2a = 12.5 um. The axis follows.
        way = run.stands - SWITCH
        self.assertTrue(0 <= way < 214e-6, run.plant)
        figure("homing over lines, from the switch's edge to rest", f"{way * 1e6:.0f} um (bound 214 um)")

    def test_that_lost_an_edge_are_reset_over_modbus_and_the_axis_homes_again(self):
        run, peer = Run("served"), json.loads((FOLDER / "lines/served.peer").read_text())
        self.assertEqual([number for _, number in run.faults], [36], run.drive + run.plant)
        self.assertIn("last fault of the encoder tracks: both tracks changed at once", run.drive)
        self.assertEqual((peer["resets"], peer["enabled"], peer["state"]), (1, 2, "enabled"), peer)
        self.assertGreater(peer["runs"], 1, peer)
        self.assertEqual(run.status, 0, run.drive)

    def test_show_a_fault_in_its_time_under_its_own_name_and_nothing_moves_afterwards(self):
        for kind, _, _, numbers, within in FAULTS:
            with self.subTest(kind):
                run = Run(kind)
                self.assertEqual(run.status, 1, run.drive + run.plant)
                time, number = run.faults[0]
                self.assertIn(number, numbers, run.drive)
                taken = (time - run.broken) / PERIOD
                self.assertTrue(0 < taken <= within, f"after {taken} periods, expected within {within}\n{run.drive}")
                # Friction of 20 N stops 95 kg from 20 mm/s within 1 mm.
                self.assertLess(abs(run.ran_on), 1e-3, run.plant)
                figure(f"fault on lines: {kind}", f"fault {number} after {taken:.2f} periods (bound {within:g}), ran on by "
                                                  f"{run.ran_on * 1e6:.0f} um")


class Tracks(unittest.TestCase):
    """Switch tracks of a cam on lines of a chip, at a cycle a second for ten of them."""

    def test_switch_their_lines_by_the_place_of_the_master(self):
        folder = FOLDER / "tracks"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "cam.toml").write_text(CAM)
        (folder / "watch.py").write_text(WATCH)
        subprocess.run([loop.BIN / "stiction", "cam", "table", folder / "cam.toml", "--out", folder / "cam.scam"],
                       check=True, stdout=subprocess.DEVNULL)
        task = ["--cam", "cam.scam", "--master", "virtual", "--speed", "60 rpm", "--hold", "10"]
        for track, line, first, last in ((1, 12, 0.1, 0.3), (2, 13, 0.9, 0.2)):
            task += [f"--set=drive.cam_switch.track{track}.{key}={value}"
                     for key, value in (("line", line), ("first", first), ("last", last))]
        loop.boot(folder, script("cam", (), task, "python3 watch.py >watch.log 2>&1 &"),
                  through=(HERE / "gpio_guest.sh",))
        run = Run("cam", folder)
        self.assertEqual((run.status, run.faults), (0, []), run.drive + run.plant)
        changes = json.loads((folder / "cam.lines").read_text())
        worst = 0.0
        for line, width in ((12, 0.2), (13, 0.3)):
            edges = [(time, on) for time, of, on in changes if of == line]
            self.assertEqual([on for _, on in edges], [k % 2 == 0 for k in range(len(edges))], changes)
            self.assertEqual(len(edges) % 2, 0, "off at the end")
            ons, offs = [time for time, on in edges if on], [time for time, on in edges if not on]
            # The master comes to its speed, and brakes, within about a cycle.
            steady = range(2, len(ons) - 2)
            self.assertGreater(len(steady), 4, changes)
            for k in steady:
                worst = max(worst, abs(offs[k] - ons[k] - width), abs(ons[k] - ons[k - 1] - 1.0))
        # A tick of the drive and one of who watches, at each end.
        self.assertLess(worst, 4e-3, changes)
        figure("switch tracks on lines of a chip, width and period", f"off by up to {worst * 1e3:.1f} ms (bound 4 ms)")


if __name__ == "__main__":
    unittest.main(verbosity=2)
