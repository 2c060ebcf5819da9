#!/usr/bin/env python3
"""Stops are obeyed whatever else the drive is busy with: a disk that does not answer, floods of parameters, many clients."""

import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import unittest

from drive_process import CONTROLWORD, ENABLED, Client, Drive, comes_true

VELOCITY_GAIN, STORE, PASSWORD = 1004, 0, 0x5354
SLAVE_FAILURE, BUSY, ILLEGAL_FUNCTION = 4, 6, 1
HELD_FSYNC = os.environ["STICTION_HELD_FSYNC"]


class Stops(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def drive(self, *options, **more):
        drive = Drive(*options, log=subprocess.DEVNULL, **more)
        self.addCleanup(drive.__exit__)
        return drive

    def client(self, drive):
        client = drive.client()
        self.addCleanup(client.close)
        return client

    def test_a_disk_that_does_not_answer_holds_up_its_own_client_alone(self):
        held = self.folder / "held"
        held.touch()
        drive = self.drive("--parameters", str(self.folder), env={**os.environ, "LD_PRELOAD": HELD_FSYNC, "HELD_FSYNC": str(held)})
        storing, stopping = self.client(drive), self.client(drive)
        stopping.enable()
        drive.open_commissioning(storing)
        storing.write_float(VELOCITY_GAIN, 550)
        storing.send(bytes([6, 0, STORE, PASSWORD >> 8, PASSWORD & 0xFF]))
        for round in range(20):
            stopping.write(CONTROLWORD, 7)
            self.assertTrue(comes_true(lambda: stopping.state() == 0x23), f"stop {round} was not obeyed")
            stopping.write(CONTROLWORD, 15)
            self.assertTrue(comes_true(lambda: stopping.state() == ENABLED))
        storing.socket.settimeout(0.2)
        with self.assertRaises(TimeoutError, msg="the answer came before the parameters were on the disk"):
            storing.socket.recv(1)
        self.assertFalse((self.folder / "parameters").exists())
        held.unlink()
        storing.socket.settimeout(60)
        storing.receive()
        self.assertIn("axis.X.velocity_controller.gain 550", (self.folder / "parameters").read_text())
        self.assertEqual(drive.end(signal.SIGTERM), 0)

    def test_parameters_that_cannot_be_stored_are_answered_so(self):
        drive = self.drive()
        client = self.client(drive)
        drive.open_commissioning(client)
        with self.assertRaises(Client.Refused) as refused:  # without --parameters
            client.write(STORE, PASSWORD)
        self.assertEqual(refused.exception.args, (SLAVE_FAILURE,))
        drive = self.drive("--parameters", str(self.folder))
        client = self.client(drive)
        drive.open_commissioning(client)
        (self.folder / "parameters.new").mkdir()
        client.write_float(VELOCITY_GAIN, 550)
        with self.assertRaises(Client.Refused) as refused:
            client.write(STORE, PASSWORD)
        self.assertEqual(refused.exception.args, (SLAVE_FAILURE,))

    def test_stops_beside_clients_that_write_as_fast_as_they_can(self):
        drive = self.drive()
        stopping = self.client(drive)
        stopping.enable()
        drive.open_commissioning(stopping)
        end, refused = threading.Event(), set()

        def flood(client):
            while not end.is_set():
                try:
                    client.write_float(VELOCITY_GAIN, 500)
                except Client.Refused as error:
                    refused.update(error.args)
        floods = [threading.Thread(target=flood, args=(self.client(drive),)) for _ in range(4)]
        for thread in floods:
            thread.start()
        try:
            for round in range(50):
                stopping.write(CONTROLWORD, 7)
                self.assertTrue(comes_true(lambda: stopping.state() == 0x23), f"stop {round} was not obeyed")
                stopping.write(CONTROLWORD, 15)
                self.assertTrue(comes_true(lambda: stopping.state() == ENABLED))
        finally:
            end.set()
            for thread in floods:
                thread.join()
        self.assertEqual(refused, {BUSY})  # parameters were limited

    def test_the_first_of_33_clients_keeps_its_connection(self):
        drive = self.drive()
        clients = [self.client(drive) for _ in range(33)]
        self.assertTrue(comes_true(lambda: clients[0].state() == 0x40))
        with self.assertRaises(OSError):
            clients[32].state()
        self.assertEqual(clients[0].state(), 0x40)

    def test_a_stop_ends_a_motion_of_the_programme_and_other_commands_are_refused(self):
        drive = self.drive("--hold", "1000000")
        client = self.client(drive)
        self.assertTrue(comes_true(lambda: client.state() == ENABLED))
        for register, value in ((CONTROLWORD, 15), (CONTROLWORD + 1, 1)):
            with self.assertRaises(Client.Refused) as refused:
                client.write(register, value)
            self.assertEqual(refused.exception.args, (ILLEGAL_FUNCTION,))
        client.write(CONTROLWORD, 0)
        self.assertEqual(drive.end(), 0)


if __name__ == "__main__":
    unittest.main()
