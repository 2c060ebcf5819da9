#!/usr/bin/env python3
"""Keeps a drive busy over Modbus, from inside the loop's kernel: enables its first axis, sends it from index mark to
index mark by homing runs, resets what faults there are and begins again. An independent master: pymodbus.

usage: endurance_peer.py PORT MINUTES PID...   prints JSON: what was counted, and of each process a memory sample a minute
"""

import json
import os
import sys
import time

from pymodbus.client import ModbusTcpClient

STATUSWORD, CONTROLWORD = 100, 100  # input and holding register; the mode of operation comes behind the latter
HOMING = 6
DISABLE, SHUTDOWN, SWITCH_ON, ENABLE, START_HOMING, RESET = 0x00, 0x06, 0x07, 0x0F, 0x1F, 0x80
HOMED = 1 << 12
POLL = 0.1  # s
BACK = 10.0  # s that an axis may take at the end to come back from a last fault


def state_of(status):
    """CiA 402, 6041h: bits 0 to 3 and 6 tell the states without power, 5 and 6 with them the others."""
    return {0x40: "switch on disabled", 0x08: "fault"}.get(status & 0x4F) or \
        {0x21: "ready", 0x23: "switched on", 0x27: "enabled"}.get(status & 0x6F, "other")


def answer(status, before):
    """The next controlword."""
    state = state_of(status)
    if state == "enabled":
        return ENABLE if before == START_HOMING and status & HOMED else START_HOMING
    if state == "fault":
        return RESET if before == DISABLE else DISABLE
    return {"switch on disabled": SHUTDOWN, "ready": SWITCH_ON, "switched on": ENABLE}.get(state, DISABLE)


def memory(process):
    """Resident bytes and open files of a process."""
    with open(f"/proc/{process}/statm", encoding="ascii") as file:
        pages = int(file.read().split()[1])
    return [pages * os.sysconf("SC_PAGESIZE"), len(os.listdir(f"/proc/{process}/fd"))]


def main(port, minutes, *processes):
    peer = ModbusTcpClient("127.0.0.1", port=int(port))
    if not peer.connect():
        sys.exit("no connection")
    counted = {"polls": 0, "enabled": 0, "resets": 0, "runs": 0}
    samples = []
    word, state = None, None
    begin = time.monotonic()
    end = 60 * float(minutes)
    while (now := time.monotonic() - begin) < end or (state != "enabled" and now < end + BACK):
        if now >= 60 * len(samples):
            samples.append([memory(process) for process in processes])
        status = peer.read_input_registers(STATUSWORD, 1, slave=1).registers[0]
        counted["polls"] += 1
        before, state = state, state_of(status)
        counted["enabled"] += state == "enabled" != before
        counted["resets"] += before == "fault" != state
        asked, word = word, answer(status, word)
        counted["runs"] += (asked, word) == (START_HOMING, ENABLE) and state == "enabled"
        if word != asked:
            reply = peer.write_registers(CONTROLWORD, [word, HOMING], slave=1)
            if reply.isError():
                sys.exit(f"refused: {reply}")
        time.sleep(POLL)
    samples.append([memory(process) for process in processes])
    peer.write_registers(CONTROLWORD, [DISABLE, HOMING], slave=1)
    print(json.dumps({**counted, "state": state, "memory": samples}))


if __name__ == "__main__":
    main(*sys.argv[1:])
