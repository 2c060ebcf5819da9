#!/usr/bin/env python3
"""The drive whose log nobody reads, or whose standard error is gone: it takes its commands and makes its stop."""

import os
import signal
import unittest

from drive_process import CONTROLWORD, ENABLED, Client, Drive, comes_true

VELOCITY_GAIN = 1004  # a parameter; each write of it is a line of the log
LINES = 3000          # more than a pipe and what waits for it hold


class LogLost(unittest.TestCase):
    def stops(self, drive, client):
        client.write(CONTROLWORD, 0)
        self.assertTrue(comes_true(lambda: client.state() != ENABLED), "the stop was not obeyed")
        self.assertEqual(drive.end(signal.SIGTERM), 0)

    def fill_log(self, client):
        for line in range(LINES):
            try:
                client.write_float(VELOCITY_GAIN, 500 + line % 7)
            except Client.Refused:
                pass  # faster than parameters are taken

    def test_a_pipe_that_nobody_reads_holds_up_neither_stop_nor_end(self):
        reader, writer = os.pipe()
        with Drive(log=writer) as drive:
            os.close(writer)
            client = drive.client()
            client.enable()
            self.fill_log(client)
            self.stops(drive, client)
            client.close()
        os.close(reader)

    def test_a_log_that_is_gone_does_not_end_the_drive(self):
        reader, writer = os.pipe()
        with Drive(log=writer) as drive:
            os.close(writer)
            client = drive.client()
            client.enable()
            os.close(reader)
            self.fill_log(client)
            self.assertEqual(client.state(), ENABLED)
            self.stops(drive, client)
            client.close()

    def test_a_full_or_closed_standard_error_does_not_end_the_drive(self):
        for what in ("2>/dev/full", "2>&-"):
            with self.subTest(what), Drive(command=("sh", "-c", f'exec "$@" {what}', "sh")) as drive:
                client = drive.client()
                client.enable()
                self.fill_log(client)
                self.assertEqual(client.state(), ENABLED)
                self.stops(drive, client)
                client.close()


if __name__ == "__main__":
    unittest.main()
