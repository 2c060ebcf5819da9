#!/usr/bin/env python3
"""Set-points from outside in the loop: a motion controller by python3-can, cansend and candump before the drive, whose
axes are the simulated machine. Needs what loop_test.py needs."""

import pathlib
import re
import subprocess
import unittest

import loop
from loop import FOLDER, figure

# The drive behind two buses: its nodes' and a motion controller's.
SERVED = ("--set", "drive.can_server.interface=vcan1", "--set", "drive.axis.X.server_node=1",
          "--set", "drive.axis.Y.server_node=2")
ALLOWED = (*SERVED, "--set", "drive.can_server.motion=allowed")
CONTROLLER_BUS = "ip link add vcan1 type vcan\nip link set vcan1 up\n"
# Another peer records the bus; a third one sends a frame of four bytes in place of six while the axis stands enabled.
CONTROLLED = """(
candump -L vcan1 >session.log & dump=$!
(until [ $(wc -l <session.log) -gt 1000 ]; do sleep 0.01; done; cansend vcan1 401#0F000000) &
python3 {folder}/motion_controller.py vcan1 1 >controller.csv 2>controller.txt
kill $dump
kill -TERM $(pidof stictiond)) &
"""
# A controller whose clock is 150 ppm slow and whose SYNC the drive follows. The drive's clock may be changed by 200 ppm
# (SyncFollower::largest_share), so that it gains 50 ppm: half a cycle, the furthest that it can begin apart, takes 10 s.
OWN_CLOCK = (*ALLOWED, "--set", "drive.can_server.sync=followed")
FOLLOWED = """(
sleep 0.2
python3 {folder}/motion_controller.py vcan1 1 --own-clock 0.00100015 --warm-up 11000 --moves 3 --break-off 550 --listen 20 \
  >own_clock.csv 2>own_clock.txt
kill -TERM $(pidof stictiond)) &
"""
# The lines of docs/drive.md; on the nodes' own bus.
SHARED = (*ALLOWED, "--set", "drive.can_server.commander_timeout=0 s", "--set", "drive.can_server.interface=vcan0",
          "--set", "drive.can_server.data_bit_rate=8e6 bit/s")
BY_HAND = """(
sleep 0.2
candump -L vcan0,381:7FF >by_hand.log & dump=$!
for frame in 301#060001 301#070001 301#0F0001 401#1F0080C3C901 401#0F0080C3C901; do cansend vcan0 $frame; sleep 0.05; done
sleep 1
cansend vcan0 301#060001
sleep 0.3
kill $dump
kill -TERM $(pidof stictiond)) &
"""
# Its lines of Python.
DOCUMENTED = """(
sleep 0.2
python3 documented.py >documented.txt 2>&1
sleep 0.2
kill -TERM $(pidof stictiond)) &
"""
REFUSED = """(
sleep 0.2
candump -L -T 300 vcan1 >refused.log &
for word in 0600 0700 0F00; do cansend vcan1 401#${word}40420F00; sleep 0.05; done
sleep 0.4
kill -TERM $(pidof stictiond)) &
"""


def decoded(log, dbc):
    """What candump recorded of little-endian messages, by what the DBC says of them: (time, name, signals)."""
    signals, names = {}, {}
    for line in dbc.splitlines():
        if message := re.match(r"BO_ (\d+) (\w+): (\d+)", line):
            number = int(message[1])
            names[number], signals[number] = (message[2], int(message[3])), []
        elif signal := re.match(r" SG_ (\w+) : (\d+)\|(\d+)@1([+-]) \(([^,]+),0\)", line):
            signals[number].append((signal[1], int(signal[2]), int(signal[3]), signal[4] == "-", float(signal[5])))
    for line in log.splitlines():
        time, number, data = re.match(r"\(([\d.]+)\) \w+ ([0-9A-F]+)#(?:#.)?(.*)", line).groups()
        number, data = int(number, 16), bytes.fromhex(data)
        name, size = names[number]
        if len(data) != size:
            yield float(time), f"{name} of {len(data)} bytes", {}
            continue
        bits = int.from_bytes(data, "little")
        values = {}
        for signal, first, count, signed, scale in signals[number]:
            raw = bits >> first & (1 << count) - 1
            values[signal] = (raw - (1 << count) if signed and raw >> count - 1 else raw) * scale
        yield float(time), name, values


class MotionController(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = FOLDER / "controller"
        here = pathlib.Path(__file__).parent
        runs = [loop.Run("followed", (), drive=ALLOWED, beside=CONTROLLED.format(folder=here)),
                loop.Run("not_allowed", (), drive=SERVED, beside=REFUSED),
                loop.Run("by_hand", (), drive=SHARED, beside=BY_HAND),
                loop.Run("own_clock", (), drive=OWN_CLOCK, beside=FOLLOWED.format(folder=here)),
                loop.Run("documented", (), drive=ALLOWED, beside=DOCUMENTED)]
        if loop.SAMPLE:
            runs = runs[:2]
        example = re.search(r"```python\n(.*?)```", (loop.ROOT / "docs/drive.md").read_text(), re.S)[1]
        cls.folder.mkdir(parents=True, exist_ok=True)
        (cls.folder / "documented.py").write_text(example.replace('"can1"', '"vcan1"'))
        loop.boot(cls.folder, loop.BUS + CONTROLLER_BUS + "".join(run.script() for run in runs))
        cls.results = {run.name: loop.Result(cls.folder, run.name) for run in runs}
        cls.rows = [line.split(",") for line in (cls.folder / "controller.csv").read_text().splitlines()]
        cls.dbc = subprocess.run([loop.BIN / "stictiond", "--machine", "mcfv5050ln", "--dbc", *SERVED], check=True,
                                 capture_output=True, text=True).stdout

    def test_is_followed_with_one_cycle_of_delay(self):
        # A target answers a SYNC, is taken at the next one and reached at the one after it.
        targets = [int(target) for _, target, *_ in self.rows if target]
        positions = [int(row[3]) for row in self.rows]
        off = max(abs(positions[k + 2] - target) for k, target in enumerate(targets[:-4]))
        way = max(positions) - min(positions)
        figure("20 mm in 0.5 s streamed by python3-can over vcan: position from target",
               f"{off * 1e-3:.2f} um at most (bound 20 um), {way * 1e-6:.3f} mm gone")
        self.assertGreater(way, 19.9e6)
        # Half a period of the position controller beside the following error of the cross table.
        self.assertLess(off, 20e3)

    def test_that_breaks_off_is_noticed_after_three_cycles_and_nothing_moves_afterwards(self):
        result = self.results["followed"]
        self.assertEqual(result.status, 1, result.drive)
        self.assertEqual([fault[1:] for fault in result.faults()], [(0, 52)], result.drive)
        silent = [row for row in self.rows if not row[1]]
        # The first of these cycles took the last target; of those without one two are bridged.
        faulted = next(k for k, row in enumerate(silent) if int(row[2]) & 0x4F in (0x0F, 0x08))
        self.assertEqual(faulted, 3, [row[2] for row in silent[:8]])
        ran_on = abs(int(silent[-1][3]) - int(silent[0][3]))
        x = result.axes["X"]
        figure("set-points lost in motion",
               f"fault 52 in the third cycle (bound 3), {ran_on * 1e-6:.2f} mm to rest, {x.ran_on_um:.0f} um without power")
        # 80 mm/s for four cycles, and down at 10 m/s^2.
        self.assertLess(ran_on, 1.0e6)
        # The stop has ended when the power goes; then the carriage swings out on its bristles (10 Hz, damping 0.1).
        self.assertLess(abs(x.ran_on_um), 100.0, result.plant)
        self.assertLess(x.ran_on_ticks, 16000, result.plant)

    def test_that_sends_too_short_a_frame_is_refused_and_said_so(self):
        self.assertIn("CAN: axis 0: found a frame 0x401 of 4 bytes; expected 6; it is refused", self.results["followed"].drive)

    def test_is_seen_by_an_independent_recorder_as_the_dbc_describes_it(self):
        recorded = list(decoded((self.folder / "session.log").read_text(), self.dbc))
        names = {name for _, name, _ in recorded}
        self.assertLessEqual({"X_target", "X_state", "X_motion", "Y_state", "X_target of 4 bytes"}, names)
        shown = [values["actual_position"] for _, name, values in recorded if name == "X_state"]
        self.assertAlmostEqual(max(shown) - min(shown), 20e-3, delta=20e-6)
        syncs = [time for time, name, _ in recorded if name.startswith("sync")]
        self.assertAlmostEqual((syncs[-1] - syncs[0]) / (len(syncs) - 1), 1e-3, delta=1e-6)

    @unittest.skipIf(loop.SAMPLE, "a sample")
    def test_may_be_a_person_with_cansend_who_asks_for_a_profile_move(self):
        result = self.results["by_hand"]
        self.assertEqual(result.status, 0, result.drive)
        states = [values for _, name, values in decoded((self.folder / "by_hand.log").read_text(), self.dbc)]
        taken = next(k for k, values in enumerate(states) if int(values["statusword"]) & 0x1000)
        reached = [values for values in states[taken:] if int(values["statusword"]) == 0x0637]
        self.assertGreater(len(reached), 100, "each millisecond")
        off = max(abs(values["actual_position"] - 30e-3) for values in reached)
        figure("profile move of 60 mm by cansend over vcan: position where it is said to be reached",
               f"{off * 1e6:.2f} um off at most (bound 10.5 um)")
        self.assertLessEqual(off, 10.5e-6)  # target_window, and how far it goes in a tick
        self.assertEqual(int(states[-1]["statusword"]) & 0x6F, 0x21, "off again")
        self.assertIn("bus: 0 frames with an unknown identifier, 0 error frames, 0 not sent", result.drive)

    @unittest.skipIf(loop.SAMPLE, "a sample")
    def test_with_a_clock_of_its_own_is_followed_by_the_drives(self):
        result = self.results["own_clock"]
        self.assertIn("CAN: the clock follows the controller's SYNC", result.drive)
        rows = [line.split(",") for line in (self.folder / "own_clock.csv").read_text().splitlines()]
        targets = [int(target) for _, target, *_ in rows if target]
        self.assertGreater(len(targets), 1600, result.drive + (self.folder / "own_clock.txt").read_text())
        positions = [int(row[3]) for row in rows]
        # It reads what it was sent before its SYNC.
        off = min(max(abs(positions[k + late] - target) for k, target in enumerate(targets[:-4])) for late in (2, 3, 4))
        figure("the same by a controller whose clock is 150 ppm slow",
               f"{off * 1e-3:.2f} um at most (bound 20 um)")
        self.assertLess(off, 20e3)
        # No target was lost or doubled: the only fault is that of its end.
        self.assertEqual([fault[2] for fault in result.faults()], [52], result.drive)

    @unittest.skipIf(loop.SAMPLE, "a sample")
    def test_is_as_short_as_the_documents_show(self):
        result = self.results["documented"]
        self.assertEqual((self.folder / "documented.txt").read_text(), "")
        self.assertEqual(result.status, 0, result.drive)
        stands = float(re.search(r"axis X: .* position (\S+) mm", result.plant)[1])
        self.assertAlmostEqual(stands, 110.0, delta=0.1)  # without power it swings out on its bristles

    def test_without_permission_moves_nothing(self):
        result = self.results["not_allowed"]
        self.assertEqual(result.status, 0, result.drive)
        for word in ("0x0006", "0x0007", "0x000f"):
            self.assertIn(f"CAN: axis 0: found controlword {word}; expected none without", result.drive)
        states = [values for _, name, values in decoded((self.folder / "refused.log").read_text(), self.dbc)
                  if name == "X_state"]
        self.assertEqual({int(values["statusword"]) & 0x6F for values in states}, {0x40}, "switch on disabled")
        self.assertEqual(len({values["actual_position"] for values in states}), 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
