#!/usr/bin/env python3
"""An encoder on a bus (CiA 406) and a PLC over Modbus in one, from inside the loop's kernel: the encoder turns up to a
turn a second, the PLC lets the first axis follow its cam from where it stands, and reads; then the encoder falls silent.
Independent of the drive: a raw socket of the kernel, and pymodbus.

usage: encoder_peer.py INTERFACE NODE COUNTS PORT   prints JSON: samples of master and axis, and the state before and
                                                    behind the silence
"""

import json
import socket
import struct
import sys
import threading
import time

from pymodbus.client import ModbusTcpClient

STATUSWORD, CONTROLWORD, MODE, CAM_COMMAND, CAM_OPTIONS, CAM_STATE = 100, 100, 101, 140, 144, 140
CAM_MODE, ENGAGE, SLAVE_RELATIVE, IN_SYNC = 0xFFFF, 1, 2, 1 << 2
PERIOD, RAMP = 1e-3, 1.0  # s


class Encoder(threading.Thread):
    """Sends its position every millisecond of the clock, each the one that it has at that time."""

    def __init__(self, interface, node, counts):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind((interface,))
        self.node, self.counts = node, counts
        self.turns_at = None
        self.silent = False

    def turns(self, time_now):
        way = max(0.0, time_now - self.turns_at) if self.turns_at else 0.0
        return 0.5 * way * way / RAMP if way < RAMP else way - 0.5 * RAMP

    def run(self):
        due = time.monotonic()
        while not self.silent:
            position = int(self.turns(due) * self.counts) & 0xFFFFFFFF
            self.socket.send(struct.pack("<IB3x8s", 0x180 + self.node, 4, struct.pack("<I", position)))
            due += PERIOD
            time.sleep(max(0.0, due - time.monotonic()))


def main(interface, node, counts, port):
    encoder = Encoder(interface, int(node), int(counts))
    encoder.start()
    peer = ModbusTcpClient("127.0.0.1", port=int(port))
    while not peer.connect():
        time.sleep(0.1)

    def read(address, count=1):
        return peer.read_input_registers(address, count, slave=1).registers

    def write(address, *values):
        reply = peer.write_registers(address, list(values), slave=1)
        if reply.isError():
            sys.exit(f"{address}: refused: {reply}")

    write(MODE, CAM_MODE)
    for word in (0x06, 0x07, 0x0F):
        write(CONTROLWORD, word)
        time.sleep(0.1)
    encoder.turns_at = time.monotonic()
    time.sleep(RAMP + 0.5)
    write(CAM_OPTIONS, SLAVE_RELATIVE)
    write(CAM_COMMAND, ENGAGE)
    end = time.monotonic() + 5.0
    while not read(CAM_STATE)[0] & IN_SYNC and time.monotonic() < end:
        time.sleep(0.05)
    said = {"state": read(CAM_STATE)[0], "refusal": read(CAM_STATE + 1)[0], "status": read(STATUSWORD)[0]}
    samples = []
    while len(samples) < 150:
        # One request: values of one tick.
        words = read(STATUSWORD, 52)
        samples.append(words)
        time.sleep(0.02)
    said["samples"] = samples
    encoder.silent = True
    time.sleep(1.0)
    said["status_behind"] = read(STATUSWORD)[0]
    print(json.dumps(said))


if __name__ == "__main__":
    main(*sys.argv[1:])
