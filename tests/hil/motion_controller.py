#!/usr/bin/env python3
"""A motion controller of its own, by python3-can: enables one axis of the drive over CiA 402, moves it to and fro with a
target each SYNC, and breaks off in the middle of the last move. Prints a line a cycle: time, target, statusword,
position, following error (s, increments)."""

import argparse
import math
import struct
import sys
from time import monotonic as time_of_day, sleep

import can

STATE_BITS, ENABLED, FAULT = 0x6F, 0x27, 0x08
# The controlword that leads on from each state to operation enabled.
NEXT = {0x40: 0x06, 0x21: 0x07, 0x23: 0x0F, 0x27: 0x0F}


def smooth(way, share):
    """A move with jerk limits: share of its time from 0 to 1."""
    share = min(max(share, 0.0), 1.0)
    return way * (share - math.sin(2 * math.pi * share) / (2 * math.pi))


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("interface")
    options.add_argument("node", type=int)
    options.add_argument("--way", type=int, default=20_000_000, help="of each move, increments")
    options.add_argument("--cycles", type=int, default=500, help="of each move")
    options.add_argument("--moves", type=int, default=2)
    options.add_argument("--break-off", type=int, default=250, help="cycles of the last move that are sent")
    options.add_argument("--own-clock", type=float, help="seconds from SYNC to SYNC, which are its own then")
    options.add_argument("--warm-up", type=int, default=0, help="cycles before it enables the axis")
    options.add_argument("--listen", type=int, default=400, help="cycles after the last target")
    o = options.parse_args()
    bus = can.Bus(interface="socketcan", channel=o.interface,
                  can_filters=[{"can_id": base + o.node, "can_mask": 0x7FF} for base in (0x380, 0x480)])

    next_sync = time_of_day() + 0.01

    def state():
        """Of one cycle, as SYNC brings it."""
        nonlocal next_sync
        if o.own_clock:
            sleep(max(next_sync - time_of_day(), 0))
            next_sync += o.own_clock
            bus.send(can.Message(arbitration_id=0x80, is_extended_id=False))
        newest = None  # behind its own SYNC there may be several, or none yet
        while True:
            message = bus.recv(timeout=0 if newest else 5)
            if message is None:
                return newest or sys.exit("no answer of the drive")
            if message.arbitration_id == 0x380 + o.node:
                word, position = struct.unpack("<Hi", message.data)
            else:
                _, error = struct.unpack("<ii", message.data)
                newest = message.timestamp, word, position, error
                if not o.own_clock:
                    return newest

    def send(controlword, target):
        bus.send(can.Message(arbitration_id=0x400 + o.node, is_extended_id=False,
                             data=struct.pack("<Hi", controlword, target)))

    for _ in range(o.warm_up):
        state()
    time, word, position, error = state()
    while word & STATE_BITS != ENABLED:  # the target stands where the axis does
        send(NEXT.get(word & STATE_BITS, 0), position)
        time, word, position, error = state()
    begin = position
    for move in range(o.moves):
        last = move == o.moves - 1
        for k in range(o.break_off if last else o.cycles + 50):
            way = smooth(o.way, (k + 1) / o.cycles)
            target = begin + round(way if move % 2 == 0 else o.way - way)
            print(f"{time:.6f},{target},{word},{position},{error}")
            send(0x0F, target)
            time, word, position, error = state()
    for _ in range(o.listen):
        print(f"{time:.6f},,{word},{position},{error}")
        time, word, position, error = state()


if __name__ == "__main__":
    main()
