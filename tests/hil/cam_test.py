#!/usr/bin/env python3
"""A cam behind an encoder on a bus, in the loop: the axis is the simulated machine over vcan, the encoder and the PLC are
peers of their own. Needs what loop_test.py needs."""

import json
import pathlib
import subprocess
import unittest

import loop
from loop import FOLDER, figure

HERE = pathlib.Path(__file__).parent
INTERFACE, NODE, COUNTS, PORT = "vcan1", 5, 65536, 15023
STROKE, RISE = 5e-3, 150.0 / 360.0  # m, of a cycle
IN_SYNC, FAULT = 1 << 2, 1 << 3
MASTER_LOST = 64

CAM = f"""schema = "stiction.cam/1"
[cam.a]
cycle = "360 deg"
master = "rotary"
slave = "linear"
periodic = true
[[cam.a.segment]]
length = "150 deg"
stroke = "{STROKE * 1e3:g} mm"
law = "3-4-5"
[[cam.a.segment]]
end = "360 deg"
to = "0 mm"
law = "3-4-5"
"""
BESIDE = """
ip link set lo up
ip link add {interface} type vcan
ip link set {interface} up
(while ! grep -q 'has begun' {name}.drive; do sleep 0.1; done
python3 {here}/encoder_peer.py {interface} {node} {counts} {port} >{name}.peer 2>{name}.peer_errors
kill -TERM $(pidof stictiond)) &
"""


def polynomial(t):
    """3-4-5 from 0 to 1."""
    return t**3 * (10 + t * (-15 + t * 6))


def lift(phase):
    """The motion of the file at a phase in cycles, m."""
    phase %= 1.0
    return STROKE * (polynomial(phase / RISE) if phase < RISE else 1.0 - polynomial((phase - RISE) / (1.0 - RISE)))


def double_word(words, at):
    """Two registers, the high word first."""
    value = words[at] << 16 | words[at + 1]
    return value - (1 << 32) if value >> 31 else value


class CamBehindAnEncoder(unittest.TestCase):
    def test_follows_it_over_a_bus_and_stops_where_it_falls_silent(self):
        folder = FOLDER / "cam"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "cam.toml").write_text(CAM)
        subprocess.run([loop.BIN / "stiction", "cam", "table", folder / "cam.toml", "--out", folder / "cam.scam"],
                       check=True, stdout=subprocess.DEVNULL)
        sets = (f"drive.modbus_server.address=127.0.0.1:{PORT}", "drive.modbus_server.motion=allowed",
                "drive.modbus_server.commander_timeout=0 s", f"drive.master_encoder.interface={INTERFACE}",
                f"drive.master_encoder.counts_per_turn={COUNTS}", "drive.master_encoder.period=1 ms")
        drive = ["--cam", "cam.scam", "--master", f"can:{NODE}", "--speed", "90 rpm",
                 *(part for each in sets for part in ("--set", each))]
        run = loop.Run("cam", (), drive=tuple(drive),
                       beside=BESIDE.format(name="cam", here=HERE, interface=INTERFACE, node=NODE, counts=COUNTS,
                                            port=PORT))
        result = loop.execute(folder, [run])["cam"]
        said = json.loads((folder / "cam.peer").read_text() or "{}")
        self.assertTrue(said, (folder / "cam.peer_errors").read_text() + result.drive)
        self.assertTrue(said["state"] & IN_SYNC, f"{said['state']}, refusal {said['refusal']}\n{result.drive}")
        # It engaged from where it stood: the same distance from the motion at every place of the master.
        apart = []
        for words in said["samples"]:
            phase, speed = double_word(words, 46) * 1e-6, double_word(words, 50) * 1e-6
            apart.append(double_word(words, 6) * 1e-8 - lift(phase))
            # Counts of 1/65536 turn over a filter of four periods.
            self.assertAlmostEqual(speed, 1.0, delta=2e-3)
        self.assertGreater(max(lift(double_word(words, 46) * 1e-6) for words in said["samples"]), 0.9 * STROKE)
        # A register's place of the master is one of 1e-6 cycles, 0.02 um of the axis, and it may be that of a tick before, 1.4 um.
        spread = max(apart) - min(apart)
        self.assertLess(spread, 2e-6)
        figure("cam behind an encoder on vcan, set position against the motion", f"{spread * 1e6:.2f} um (bound 2 um)")
        self.assertTrue(said["status_behind"] & FAULT, hex(said["status_behind"]))
        self.assertEqual({number for _, axis, number in result.faults() if axis == 0}, {MASTER_LOST}, result.drive)


if __name__ == "__main__":
    unittest.main(verbosity=2)
