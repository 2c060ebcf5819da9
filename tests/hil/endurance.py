#!/usr/bin/env python3
"""Minutes of drive time in the loop with random faults: one drive's programme over CAN and one simulated machine on a
kernel of their own, in simulated time, and an independent Modbus master that keeps the axis in motion, resets every fault
and enables the axis again. Status 1: a fault was not seen, an alarm was false, the drive did not come back, or memory
grew.

usage: endurance.py [--minutes 10] [--every SECONDS] [--seed 1] [DIR]

The machine is the measured EMPS at its own 1 ms, which a real CAN bus of 1 Mbit/s carries, on a long axis with an index
mark every 100 mm. The loop's kernel makes 400 to 1500 ticks a second of the machine's own time, whatever
their period: the cross table's 62.5 us would take more than sixteen times as long.
"""

import argparse
import json
import pathlib
import re
import shlex
import sys
import tempfile
import time

import loop
from loop_test import FAULTS, figure

PERIOD = 1e-3  # s
LASTING = 3000  # ticks of a fault: three seconds, longer than a run from mark to mark
GRACE = 1000  # ticks behind its end in which a fault may still be named for it
PORT = 15021
# Without current sensors there is no offset of one.
KINDS = {kind: numbers for kind, _, numbers, *_ in FAULTS if kind != "current-offset"}

MACHINE = ["--machine", "emps", "--set", "drive.can.interface=vcan0", "--set", "drive.axis.X.node=1"]
DRIVE = ["axis.X.travel=60 m", "drive.axis.X.homing.method=index-positive", "drive.axis.X.homing.creep_speed=0.05 m/s",
         "drive.axis.X.quick_stop_deceleration=1 m/s^2",  # what the machine can
         "drive.axis.X.encoder_jump=20 um",  # 1 m/s^2 leaves 1 um from one tick to the next
         f"drive.modbus_server.address=127.0.0.1:{PORT}", "drive.modbus_server.motion=allowed",
         "drive.modbus_server.commander_timeout=0 s"]
SCRIPT = loop.BUS + """
{plant} >plant.txt 2>&1 &
plant=$!
while [ ! -s plant.txt ]; do sleep 0.01; done
{drive} >drive.txt 2>&1 &
drive=$!
while ! grep -q 'has begun' drive.txt; do kill -0 $drive || exit 3; sleep 0.1; done
python3 {peer} {port} {minutes} $drive $plant >peer.txt 2>&1
kill -TERM $drive
wait $drive
echo $? >drive.status
kill $plant
wait $plant
"""


def script(minutes, every, seed):
    plant = [loop.BIN / "stiction-plant", *MACHINE, "--bus", "can:vcan0", "--at", "X=-25 m", "--mark", "X.index=0 m",
             "--mark", "X.index_every=100 mm", "--fault-every", f"{every} s", "--seed", seed]
    for kind in KINDS:
        plant += ["--fault", f"{kind},ticks={LASTING}"]
    drive = [loop.BIN / "stictiond", *MACHINE, "--hal", "can"]
    for assignment in DRIVE:
        drive += ["--set", assignment]
    return SCRIPT.format(plant=shlex.join(map(str, plant)), drive=shlex.join(map(str, drive)), port=PORT,
                         minutes=minutes, peer=pathlib.Path(__file__).parent / "endurance_peer.py")


def logged_faults(text):
    """(tick of the machine, number) of each fault that the drive logged."""
    begin = float(re.search(r"([\d.]+) s: the loop has begun", text)[1])
    return [(round((float(when) - begin) / PERIOD) + 3, int(number))
            for when, number in re.findall(r"([\d.]+) s: axis \d+: fault (\d+) ", text)]


def judge(plant, drive, status, peer):
    """Prints what became of each fault; true when all was as it must be."""
    injected = [(int(tick), kind) for tick, kind in re.findall(r"tick (\d+): (\S+) on axis X", plant)]
    faults = logged_faults(drive)
    seen, named_otherwise = 0, 0
    for tick, kind in injected:
        own = [fault for fault in faults if tick - 1 <= fault[0] <= tick + LASTING + GRACE]
        faults = [fault for fault in faults if fault not in own]
        if own and own[0][1] in KINDS[kind]:
            seen += 1
        elif own:
            named_otherwise += 1
        print(f"{tick * PERIOD:9.3f} s  {kind:<20}", " ".join(
            f"fault {number} after {at - tick + 1} ticks" + (";" if (at, number) != own[-1] else "")
            for at, number in own) or "NOT SEEN")
    for tick, number in faults:
        print(f"{tick * PERIOD:9.3f} s  FALSE ALARM: fault {number}")
    first, last = peer["memory"][1], peer["memory"][-1]  # a minute from the start on
    grown = [after - before for (before, _), (after, _) in zip(first, last)]
    files = [after - before for (_, before), (_, after) in zip(first, last)]
    print(f"{peer['polls']} polls by Modbus, {peer['runs']} runs from mark to mark, {peer['enabled']} times enabled, "
          f"{peer['resets']} faults reset; at the end the axis is {peer['state']}, the drive's status {status}")
    return {"injected": len(injected), "seen": seen, "otherwise": named_otherwise, "false": len(faults),
            "memory": [[sample[0][0] / 1e6, sample[1][0] / 1e6] for sample in (peer["memory"][0], first, last)],
            # The end of a fault can be one again: an encoder that jumps back.
            "good": 0 < len(injected) == seen <= peer["resets"] and not faults and status == 0 and peer["runs"] > 0
            and max(grown) <= 0 and max(files) <= 0}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--every", type=float, default=60.0, help="seconds from fault to fault in the mean")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    options = parser.parse_args()
    folder = options.folder or pathlib.Path(tempfile.mkdtemp(prefix="stiction-endurance-"))
    begin = time.monotonic()
    loop.boot(folder, script(options.minutes, options.every, options.seed), timeout=240 * options.minutes + 120)
    wall = time.monotonic() - begin
    said = {name: (folder / f"{name}.txt").read_text() for name in ("plant", "drive", "peer")}
    try:
        peer = json.loads(said["peer"])
    except ValueError:
        sys.exit("endurance: the Modbus peer did not come to its end:\n" + said["peer"] + said["drive"][-2000:])
    result = judge(said["plant"], said["drive"], int((folder / "drive.status").read_text()), peer)
    (drive_0, plant_0), (drive_1, plant_1), (drive_2, plant_2) = result["memory"]
    print(f"memory of the drive {drive_0:.2f} MB at the start, {drive_1:.2f} MB after a minute, {drive_2:.2f} MB at the end; "
          f"of the machine {plant_0:.2f}, {plant_1:.2f}, {plant_2:.2f} MB; {wall:.0f} s")
    figure("drive time in the loop with random faults",
           f"{options.minutes:g} min, {result['injected']} injected, {result['seen']} seen, {result['otherwise']} by another "
           f"name, {result['false']} false, memory {drive_1:.2f} to {drive_2:.2f} MB")
    return 0 if result["good"] else 1


if __name__ == "__main__":
    sys.exit(main())
