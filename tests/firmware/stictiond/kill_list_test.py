#!/usr/bin/env python3
"""Everything that can die or halt around a drive, one after the other: the power is off or a controlled stop is made, and
the cause is in the log, in a register or in the next start's log. Prints how many of them ended so."""

import ctypes
import os
import pathlib
import resource
import signal
import socket
import subprocess
import tempfile
import unittest

from drive_process import CONTROLWORD, ENABLED, PATIENCE, Client, Drive, comes_true
from frozen_loop_test import DETACH, FAULT, INTERRUPT, SEIZE, WAIT_ALL, WATCHDOG_STARVED, ptrace
from log_lost_test import VELOCITY_GAIN
from power_stage import ON_A_LINE, WRITE, PowerStage
from signals_test import FATAL, STOP

STORE, PASSWORD, STORE_RESULT, NOT_WRITTEN = 0, 0x5354, 18, 4
LIBC = ctypes.CDLL(None, use_errno=True)
SYS_TGKILL = 234  # x86-64


def threads(process):
    """The drive's threads; the first is the loop's."""
    return sorted(int(task.name) for task in pathlib.Path(f"/proc/{process.pid}/task").iterdir())


class KillList(unittest.TestCase):
    """An item is a generator of one or several names, each yielded when what it names has ended as it must."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def over_modbus(self, **more):
        """A drive whose power stage is this test, and that stage; it serves, and its axis is off."""
        stage = PowerStage()
        drive = Drive(*ON_A_LINE, "--parameters", str(self.folder), "--set", f"drive.modbus_client.device={stage.address}",
                      hal=("modbus",), **more)
        client = drive.client()
        self.assertTrue(comes_true(lambda: client.state() != 0), "the loop has not begun")
        client.close()
        return drive, stage

    def next_start_says(self, text):
        with Drive("--parameters", str(self.folder), "--hold", "0.1", serve=False) as drive:
            _, said = drive.process.communicate(timeout=PATIENCE)
            self.assertIn(f"the last run did not end in order, but {text}".encode(), said)

    def power_is_off(self, stage):
        """By its last command, or by the end of the connection, which may overtake a request that was not read yet."""
        self.assertTrue(stage.closed.wait(PATIENCE))
        self.assertFalse(stage.enabled())

    def stops(self, drive, client):
        """A stop over Modbus and one by signal."""
        client.write(CONTROLWORD, 0)
        self.assertTrue(comes_true(lambda: client.state() != ENABLED), "the stop was not obeyed")
        self.assertEqual(drive.end(signal.SIGTERM), 0)
        client.close()

    def freeze(self, thread):
        if ptrace(SEIZE, thread, None, None) != 0:
            self.skipTest(f"this machine permits no tracing: {os.strerror(ctypes.get_errno())}")
        self.assertEqual(ptrace(INTERRUPT, thread, None, None), 0)
        os.waitpid(thread, WAIT_ALL)

    def a_thread_that_crashes(self):
        count, number = 1, 0
        while number < count:
            drive, stage = self.over_modbus()
            with drive:
                count = len(threads(drive.process))
                self.assertEqual(LIBC.syscall(SYS_TGKILL, drive.process.pid, threads(drive.process)[number], signal.SIGSEGV), 0)
                self.assertEqual(drive.end(), -signal.SIGSEGV)
                self.power_is_off(stage)
                self.assertIn(b"the power is off: the programme ends by SIGSEGV", drive.process.stderr.read())
            self.next_start_says("by SIGSEGV")
            number += 1
            yield f"thread {number} crashes"

    def a_loop_that_stands_still(self):
        drive, stage = self.over_modbus(log=subprocess.DEVNULL)
        with drive:
            self.freeze(drive.process.pid)
            self.assertTrue(comes_true(lambda: (WRITE, 0) in stage.commands), "the power was not taken off")
            client = drive.client()
            self.assertEqual(client.read(FAULT)[0], WATCHDOG_STARVED)
            client.close()
        yield "the loop stands still"

    def a_different_thread_that_stands_still(self):
        count, number = 2, 1
        while number < count:
            drive, stage = self.over_modbus(log=subprocess.DEVNULL)
            with drive:
                count = len(threads(drive.process))
                halted = threads(drive.process)[number]
                self.freeze(halted)
                drive.process.send_signal(signal.SIGTERM)
                # The thread that speaks with the stage may be the one: its silence then switches the stage off.
                seen = len(stage.commands)
                self.assertTrue(comes_true(lambda: not stage.enabled() or len(stage.commands) == seen))
                self.assertEqual(ptrace(DETACH, halted, None, None), 0)
                self.assertIn(drive.end(), (0, 1))
                self.assertFalse(stage.enabled())
            number += 1
            yield f"thread {number} stands still"

    def signals(self):
        for number in STOP:
            with Drive() as drive:
                client = drive.client()
                client.enable()
                self.assertEqual(drive.end(number), 0)
                client.close()
            yield f"{number.name}: controlled stop"
        for number in FATAL:
            drive, stage = self.over_modbus()
            with drive:
                self.assertEqual(drive.end(number), -number)
                self.power_is_off(stage)
            self.next_start_says(f"by {number.name}")
            yield f"{number.name}: power off, then the end"

    def killed_as_out_of_memory_does(self):
        drive, stage = self.over_modbus(log=subprocess.DEVNULL)
        with drive:
            self.assertEqual(drive.end(signal.SIGKILL), -signal.SIGKILL)
            self.assertTrue(stage.closed.wait(PATIENCE), "the stage hears that nobody is there any more")
        self.next_start_says("while running")
        yield "SIGKILL, as the kernel does when memory is out"

    def no_memory_to_be_had(self):
        with Drive(log=subprocess.DEVNULL) as drive:
            client = drive.client()
            client.enable()
            with open(f"/proc/{drive.process.pid}/statm", encoding="ascii") as statm:
                size = int(statm.read().split()[0]) * resource.getpagesize()
            resource.prlimit(drive.process.pid, resource.RLIMIT_AS, (size, size))
            drive.open_commissioning(client)
            for value in range(200):
                try:
                    client.write_float(VELOCITY_GAIN, 500 + value)
                except Client.Refused:
                    pass
            self.stops(drive, client)
        yield "no memory to be had"

    def standard_error(self):
        for what in ("2>/dev/full", "2>&-"):
            with Drive(command=("sh", "-c", f'exec "$@" {what}', "sh")) as drive:
                client = drive.client()
                client.enable()
                self.stops(drive, client)
            yield f"standard error {what}"
        reader, writer = os.pipe()
        with Drive(log=writer) as drive:
            os.close(writer)
            client = drive.client()
            client.enable()
            os.close(reader)
            self.stops(drive, client)
        yield "reader of the pipe gone"
        ours, its = socket.socketpair()
        status = os.fstat(its.fileno())
        with Drive(log=its, env={**os.environ, "JOURNAL_STREAM": f"{status.st_dev}:{status.st_ino}"}) as drive:
            its.close()
            client = drive.client()
            client.enable()
            ours.close()
            self.stops(drive, client)
        yield "journal gone"

    def disk(self):
        held = self.folder / "held"
        held.touch()
        with Drive("--parameters", str(self.folder), log=subprocess.DEVNULL,
                   env={**os.environ, "LD_PRELOAD": os.environ["STICTION_HELD_FSYNC"], "HELD_FSYNC": str(held)}) as drive:
            storing, client = drive.client(), drive.client()
            client.enable()
            drive.open_commissioning(storing)
            storing.send(bytes([6, 0, STORE, PASSWORD >> 8, PASSWORD & 0xFF]))
            client.write(CONTROLWORD, 7)
            self.assertTrue(comes_true(lambda: client.state() == 0x23), "the stop waits for the disk")
            held.unlink()
            storing.receive()
            storing.close()
            self.stops(drive, client)
        yield "a disk that does not answer"
        with Drive("--parameters", str(self.folder), log=subprocess.DEVNULL) as drive:
            client = drive.client()
            client.enable()
            drive.open_commissioning(client)
            resource.prlimit(drive.process.pid, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
            with self.assertRaises(Client.Refused):
                client.write(STORE, PASSWORD)
            self.assertEqual(client.read(STORE_RESULT)[0], NOT_WRITTEN)
            self.stops(drive, client)
        yield "a disk that takes no more"

    def test_nothing_that_dies_or_halts_leaves_the_axis_without_a_reaction(self):
        items = [self.a_thread_that_crashes, self.a_loop_that_stands_still, self.a_different_thread_that_stands_still,
                 self.signals, self.killed_as_out_of_memory_does, self.no_memory_to_be_had, self.standard_error, self.disk]
        good, failed = 0, 0
        for item in items:
            with self.subTest(item.__name__):
                try:
                    for name in item():
                        good += 1
                        print(name, flush=True)
                except BaseException:
                    failed += 1
                    raise
        print(f"{good} of {good + failed} ended in their reaction")


if __name__ == "__main__":
    os.environ.pop("JOURNAL_STREAM", None)
    unittest.main()
