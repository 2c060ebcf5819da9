#!/usr/bin/env python3
"""A drive with a cam as a process: its set-points beside those of `stiction simulate cam`, and tables that are none."""

import csv
import pathlib
import struct
import subprocess
import tempfile
import unittest

from drive_process import BIN, Drive

DONE, REFUSED = 0, 2
MOTION = """schema = "stiction.cam/1"
[cam.{name}]
cycle = "{cycle}"
master = "{master}"
slave = "{slave}"
periodic = {periodic}
[[cam.{name}.segment]]
length = "{first}"
stroke = "{stroke}"
law = "{law}"
[[cam.{name}.segment]]
end = "{cycle}"
to = "{end}"
law = "3-4-5"
"""


def crc32(data):
    """CRC-32/MPEG-2, bit by bit."""
    value = 0xFFFFFFFF
    for byte in data:
        value ^= byte << 24
        for _ in range(8):
            value = (value << 1 ^ 0x04C11DB7) & 0xFFFFFFFF if value & 0x80000000 else value << 1
    return value


class Cam(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def motion(self, name="cam", cycle="360 deg", master="rotary", slave="linear", periodic="true", first="150 deg",
               stroke="20 mm", law="3-4-5", end="0 mm"):
        file = self.folder / f"{name}.toml"
        file.write_text(MOTION.format(name=name, cycle=cycle, master=master, slave=slave, periodic=periodic, first=first,
                                      stroke=stroke, law=law, end=end))
        return file

    def table(self, *options, **motion):
        file = self.motion(**motion)
        out = file.with_suffix(".scam")
        subprocess.run([BIN / "stiction", "cam", "table", file, "--out", out, *options], check=True,
                       stdout=subprocess.DEVNULL)
        return out

    def run_drive(self, *options, machine="screw-linear-scale"):
        with Drive(*map(str, options), machine=machine, serve=False) as drive:
            _, said = drive.process.communicate(timeout=240)
            return drive.process.returncode, said.decode()

    def refused(self, found, *options, **more):
        status, said = self.run_drive(*options, **more)
        self.assertEqual(status, REFUSED, said)
        self.assertIn(found, said)
        return said

    def rows(self, file, prefix=""):
        with open(file, encoding="utf-8") as stream:
            lines = [line for line in stream if not line.startswith("#")]
        names = ("t[s]", *(f"{prefix}{name}" for name in ("x_set[m]", "v_set[m/s]", "a_set[m/s^2]")))
        return [[float(row[name]) for name in names] for row in csv.DictReader(lines)]

    def test_set_points_are_those_of_the_simulation_to_the_last_digit(self):
        table, trace, log = self.table(), self.folder / "trace.csv", self.folder / "log.csv"
        status, said = self.run_drive("--cam", table, "--master", "virtual", "--speed", "130 rpm", "--hold", "3",
                                      "--trace", trace)
        self.assertEqual(status, DONE, said)
        subprocess.run([BIN / "stiction", "simulate", "cam", "--machine", "screw-linear-scale", "--cam",
                        table.with_suffix(".toml"), "--speed", "130 rpm", "--cycles", "2", "--log", log], check=True,
                       stdout=subprocess.DEVNULL)
        driven = {round(row[0] / 62.5e-6): row[1:] for row in self.rows(trace, "X.")}
        simulated = self.rows(log, "X.")
        self.assertGreater(len(simulated), 14000)
        # The trace has ten digits; a digit more would be that of the writer.
        different = sum(driven[round(row[0] / 62.5e-6)] != [float(f"{x:.10g}") for x in row[1:]] for row in simulated)
        print(f"stictiond --cam against simulate cam: {different} of {len(simulated)} rows different")
        self.assertEqual(different, 0)

    def test_a_damaged_table_refuses_the_start(self):
        good = self.table().read_bytes()
        cam = ("--master", "virtual", "--speed", "130 rpm", "--hold", "0.1", "--cam", self.folder / "bad.scam")

        def bad(data):
            (self.folder / "bad.scam").write_bytes(data)
        for place in (20, 70, 100, len(good) - 2):
            bad(good[:place] + bytes([good[place] ^ 1]) + good[place + 1:])
            said = self.refused("a table with a changed byte", *cam)
            self.assertIn("fault 67", said)
        bad(good[:40])
        self.refused("fewer bytes than a table has", *cam)
        bad(b"not a table " * 20)
        self.refused("a file of a different kind", *cam)
        bad(good[:-4] + b"0000" + good[-4:])
        self.refused("bytes missing or added", *cam)
        bad(good[:4] + struct.pack("<H", 9) + good[6:])
        self.refused("a different version", *cam)
        # A position that jumps at a joint, with a checksum that is right.
        changed = bytearray(good[:-4])
        at = 64 + 40 + 8
        changed[at:at + 8] = struct.pack("<q", struct.unpack("<q", good[at:at + 8])[0] + (1 << 30))
        bad(bytes(changed) + struct.pack("<I", crc32(changed)))
        self.refused("a table whose position, speed or acceleration jumps", *cam)
        self.refused("found no file that can be read", *cam[:-1], self.folder / "none.scam")
        self.refused("fewer bytes than a table has", *cam[:-1], self.folder)

    def test_a_table_of_a_different_kind_or_cycle_refuses_the_start(self):
        one = self.table()
        rest = ("--master", "virtual", "--speed", "130 rpm", "--cam", one, "--cam")
        self.refused("a table for a rotary axis", *rest,
                     self.table(name="dial", slave="rotary", stroke="20 deg", end="0 deg"))
        self.refused("as both have one master", *rest, self.table(name="twice", cycle="720 deg"))
        self.refused("as both have one master", *rest,
                     self.table(name="shear", master="linear", cycle="1 m", first="400 mm"))
        self.refused("expected a linear one, as the axis of --master is", "--master", "X", "--speed", "0.1 m/s",
                     "--cam", one, machine="mcfv5050ln")

    def test_a_curve_beyond_the_axis_refuses_the_start_with_figures(self):
        for strange, found in ((("--speed", "600 rpm"), "the limits of the axis"), (("--speed", "nan"), "--speed"),
                               (("--speed", "-1 rpm"), "--speed"), (("--speed", "1 m/s"), "--speed"),
                               (("--speed", "1e9 rpm"), "--speed"), ((), "found no --speed")):
            self.refused(found, "--cam", self.table(), "--master", "virtual", "--hold", "0.1", *strange)
        self.refused("within the travel", "--cam", self.table(name="far", stroke="260 mm"), "--master", "virtual",
                     "--hold", "0.1", "--speed", "10 rpm")
        self.refused("expected what the axes follow", "--cam", self.table())
        self.refused("expected virtual, an axis of", "--master", "Q", "--speed", "1 rpm")
        self.refused("found the only axis", "--master", "X", "--speed", "1 m/s")
        self.refused("expected a table to follow", "--master", "virtual", "--speed", "1 rpm", "--hold", "1")
        self.refused("clients alone move the axes", "--master", "X", "--speed", "1 m/s", "--hold", "1")

    def test_an_encoder_that_cannot_be_the_master_refuses_the_start(self):
        def encoder(*settings):
            return [part for setting in settings for part in ("--set", f"drive.master_encoder.{setting}")]
        master = ("--master", "can:5", "--speed", "1 rpm")
        for strange in ("can:0", "can:128", "can:", "can:5x"):
            self.refused("expected can:NODE with a node from 1 to 127", "--master", strange, "--speed", "1 rpm")
        self.refused("clients alone move the axes", *master, "--hold", "1")
        self.refused("found no such table", *master)
        self.refused("found no counts_per_turn", *master, *encoder("interface=can0"))
        self.refused("found no position_increment", "--master", "can:5", "--speed", "1 m/s", "--cam",
                     self.table(name="shear", master="linear", cycle="1 m", first="400 mm"),
                     *encoder("interface=can0", "counts_per_turn=4096"))
        self.refused("expected a whole number of them", *master, *encoder("interface=can0", "counts_per_turn=1000.5"))
        self.refused("counts in two periods of the encoder", "--master", "can:5", "--speed", "6000 rpm",
                     *encoder("interface=can0", "counts_per_turn=65536", "range=4096"))


if __name__ == "__main__":
    unittest.main()
