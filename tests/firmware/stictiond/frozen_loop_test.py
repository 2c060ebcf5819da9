#!/usr/bin/env python3
"""A loop that stands still while every other thread lives: fault 51, the power off beside it, nothing stale is shown."""

import ctypes
import os
import signal
import subprocess
import unittest

from drive_process import CONTROLWORD, Client, Drive, comes_true
from power_stage import ON_A_LINE, WRITE, PowerStage

SEIZE, INTERRUPT, DETACH = 0x4206, 0x4207, 17
WAIT_ALL = 0x40000000  # __WALL, also threads
FAULT, AXIS_FAULT, WATCHDOG_STARVED, SLAVE_FAILURE = 3, 102, 51, 4
FAULTED = 0x08  # of the statusword
ptrace = ctypes.CDLL(None, use_errno=True).ptrace
ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]


class FrozenLoop(unittest.TestCase):
    def freeze(self, thread):
        """One thread alone; a signal would stop them all."""
        if ptrace(SEIZE, thread, None, None) != 0:
            self.skipTest(f"this machine permits no tracing: {os.strerror(ctypes.get_errno())}")
        self.assertEqual(ptrace(INTERRUPT, thread, None, None), 0)
        os.waitpid(thread, WAIT_ALL)

    def test_takes_the_power_and_shows_a_fault_also_when_it_goes_on(self):
        stage = PowerStage()
        with Drive(*ON_A_LINE, "--set", f"drive.modbus_client.device={stage.address}", hal=("modbus",),
                   log=subprocess.DEVNULL) as drive:
            client = drive.client()
            self.assertTrue(comes_true(lambda: client.state() != 0), "the loop has not begun")
            self.freeze(drive.process.pid)  # the loop's is the first thread
            self.assertTrue(comes_true(lambda: (WRITE, 0) in stage.commands), "the power was not taken off")
            self.assertEqual(client.read(FAULT)[0], WATCHDOG_STARVED)
            self.assertEqual(client.read(AXIS_FAULT)[0], WATCHDOG_STARVED)
            self.assertEqual(client.state() & 0x4F, FAULTED)
            with self.assertRaises(Client.Refused) as refused:
                client.write(CONTROLWORD, 0)
            self.assertEqual(refused.exception.args, (SLAVE_FAILURE,))
            self.assertEqual(ptrace(DETACH, drive.process.pid, None, None), 0)
            self.assertTrue(comes_true(lambda: self.takes(client)), "the loop did not go on")
            self.assertTrue(comes_true(lambda: client.state() & 0x4F == FAULTED))
            self.assertNotEqual(client.read(AXIS_FAULT)[0], 0)  # an earlier one where this machine is busy
            self.assertFalse(stage.was_enabled())
            self.assertEqual(drive.end(signal.SIGTERM), 1)
            client.close()

    @staticmethod
    def takes(client):
        try:
            client.write(CONTROLWORD, 6)
        except Client.Refused:
            return False
        return True


if __name__ == "__main__":
    unittest.main()
