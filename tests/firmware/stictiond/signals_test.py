#!/usr/bin/env python3
"""Every signal, at a drive whose axis is enabled: a controlled stop, nothing, or the power off before the process ends."""

import os
import signal
import unittest

from drive_process import PATIENCE, Drive, comes_true
from power_stage import ON_A_LINE, WRITE, PowerStage

STOP = [signal.SIGTERM, signal.SIGINT, signal.SIGQUIT, signal.SIGHUP, signal.SIGPWR, signal.SIGXCPU]
IGNORED = [signal.SIGPIPE, signal.SIGXFSZ, signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM, signal.SIGVTALRM,
           signal.SIGPROF, signal.SIGIO, signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU, signal.SIGRTMIN + 3, signal.SIGRTMAX]
FATAL = [signal.SIGSEGV, signal.SIGBUS, signal.SIGFPE, signal.SIGILL, signal.SIGABRT, signal.SIGSYS, signal.SIGTRAP]
UNTOUCHED = {signal.SIGKILL, signal.SIGSTOP,                          # cannot be caught
             signal.SIGCHLD, signal.SIGCONT, signal.SIGURG, signal.SIGWINCH}  # end and stop nothing by default


class Signals(unittest.TestCase):
    def test_every_signal_that_could_end_or_halt_the_process_has_a_reaction(self):
        known = set(STOP) | set(IGNORED) | set(FATAL) | UNTOUCHED
        with Drive() as drive:
            drive.client().close()
            caught = {}
            with open(f"/proc/{drive.process.pid}/status", encoding="ascii") as status:
                for line in status:
                    if line.startswith(("SigIgn", "SigCgt")):
                        caught[line[:6]] = int(line.split()[1], 16)
            handled = caught["SigIgn"] | caught["SigCgt"]
            for number in signal.valid_signals():
                if number in UNTOUCHED:
                    continue
                self.assertTrue(handled >> (number - 1) & 1, f"signal {number} has its default reaction")
                self.assertTrue(number in known or number >= signal.SIGRTMIN or number == 16, number)

    def test_signals_that_ask_for_a_stop_make_a_controlled_one(self):
        for number in STOP:
            with self.subTest(number.name), Drive() as drive:
                client = drive.client()
                client.enable()
                self.assertEqual(drive.end(number), 0)
                client.close()

    def test_signals_that_mean_nothing_do_nothing(self):
        with Drive() as drive:
            client = drive.client()
            client.enable()
            for number in IGNORED:
                drive.process.send_signal(number)
            self.assertTrue(comes_true(lambda: client.read(4)[0] > 0 or client.state() == 0x27))
            self.assertEqual(client.state(), 0x27)
            self.assertEqual(drive.end(signal.SIGTERM), 0)
            client.close()

    def test_a_signal_that_ends_the_process_takes_the_power_off_first(self):
        for number in FATAL:
            stage = PowerStage()
            with self.subTest(number.name), Drive(*ON_A_LINE, "--set", f"drive.modbus_client.device={stage.address}",
                                                  hal=("modbus",)) as drive:
                drive.client().close()
                self.assertTrue(comes_true(lambda: stage.commands))
                self.assertEqual(drive.end(number), -number)
                self.assertTrue(stage.closed.wait(PATIENCE))
                # Not the exchange of the loop, which knows nothing of it, but a request of its own.
                self.assertIn((WRITE, 0), stage.commands)
                self.assertFalse(stage.enabled())
                self.assertIn(f"the power is off: the programme ends by {number.name}".encode(),
                              drive.process.stderr.read())


if __name__ == "__main__":
    os.environ.pop("JOURNAL_STREAM", None)
    unittest.main()
