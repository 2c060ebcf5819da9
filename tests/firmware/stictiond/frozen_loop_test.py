#!/usr/bin/env python3
"""A loop that stands still while every other thread lives: fault 51, the power off beside it, nothing stale is shown."""

import ctypes
import os
import subprocess
import unittest

from drive_process import CONTROLWORD, Client, Drive, comes_true
from power_stage import ON_A_LINE, WRITE, PowerStage

SEIZE, INTERRUPT, DETACH = 0x4206, 0x4207, 17
WAIT_ALL = 0x40000000  # __WALL, also threads
FAULT, AXIS_FAULT, WATCHDOG_STARVED, SLAVE_FAILURE = 3, 102, 51, 4
ptrace = ctypes.CDLL(None, use_errno=True).ptrace
ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]


class FrozenLoop(unittest.TestCase):
    def freeze(self, thread):
        """One thread alone; a signal would stop them all."""
        if ptrace(SEIZE, thread, None, None) != 0:
            self.skipTest(f"this machine permits no tracing: {os.strerror(ctypes.get_errno())}")
        self.assertEqual(ptrace(INTERRUPT, thread, None, None), 0)
        os.waitpid(thread, WAIT_ALL)

    def test_takes_the_power_and_shows_a_fault_and_ends_by_it_when_it_goes_on(self):
        self.assertTrue(any(self.freezes_enabled() for _ in range(10)))

    def freezes_enabled(self):
        """False where the axis was not enabled then: a busy machine may make two ticks late."""
        stage = PowerStage()
        with Drive("--hold", "1000", *ON_A_LINE, "--set", f"drive.modbus_client.device={stage.address}", hal=("modbus",),
                   log=subprocess.DEVNULL) as drive:
            client = drive.client()
            self.assertTrue(comes_true(lambda: stage.was_enabled() or drive.process.poll() is not None))
            if drive.process.poll() is not None:
                return False
            self.freeze(drive.process.pid)  # the loop's is the first thread
            if not stage.enabled():
                return False
            self.assertTrue(comes_true(lambda: (WRITE, 0) in stage.commands), "the power was not taken off")
            self.assertFalse(stage.enabled())
            self.assertEqual(client.read(FAULT)[0], WATCHDOG_STARVED)
            self.assertEqual(client.read(AXIS_FAULT)[0], WATCHDOG_STARVED)
            self.assertEqual(client.state() & 0x4F, 0x08)
            with self.assertRaises(Client.Refused) as refused:
                client.write(CONTROLWORD, 0)
            self.assertEqual(refused.exception.args, (SLAVE_FAILURE,))
            self.assertEqual(ptrace(DETACH, drive.process.pid, None, None), 0)
            self.assertEqual(drive.end(), 1)
            self.assertFalse(stage.enabled())
            client.close()
        return True


if __name__ == "__main__":
    unittest.main()
