#!/usr/bin/env python3
"""Stops are obeyed whatever else the drive is busy with: a disk that does not answer, floods of parameters, many clients."""

import os
import pathlib
import random
import resource
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import unittest

from drive_process import CONTROLWORD, ENABLED, Client, Drive, comes_true

VELOCITY_GAIN, STORE, PASSWORD = 1004, 0, 0x5354
STORE_RESULT, STORED, NOT_WRITTEN = 18, 1, 4
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

    def store(self, drive, client, gain):
        """How a request to store ended: STORED or NOT_WRITTEN, as its answer and the register both say."""
        client.write_float(VELOCITY_GAIN, gain)
        try:
            client.write(STORE, PASSWORD)
            answered = STORED
        except Client.Refused as refused:
            self.assertEqual(refused.args, (SLAVE_FAILURE,))
            answered = NOT_WRITTEN
        self.assertEqual(client.read(STORE_RESULT)[0], answered)
        return answered

    def test_a_file_that_the_system_lets_grow_no_further_is_told_and_the_set_before_is_kept(self):
        """RLIMIT_FSIZE, which the kernel enforces in write(): the file ends anywhere in the set."""
        drive = self.drive("--parameters", str(self.folder))
        client = self.client(drive)
        drive.open_commissioning(client)
        self.assertEqual(self.store(drive, client, 550), STORED)
        whole = (self.folder / "parameters").read_bytes()
        for most in (0, 1, len(whole) // 2, len(whole) - 1):
            resource.prlimit(drive.process.pid, resource.RLIMIT_FSIZE, (most, resource.RLIM_INFINITY))
            self.assertEqual(self.store(drive, client, 560), NOT_WRITTEN, f"{most} bytes")
            self.assertEqual((self.folder / "parameters").read_bytes(), whole)
        resource.prlimit(drive.process.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        self.assertEqual(self.store(drive, client, 560), STORED)
        self.assertIn("velocity_controller.gain 560", (self.folder / "parameters").read_text())

    def test_a_full_disk_is_told_and_the_set_before_is_kept(self):
        """A tmpfs of four pages in a mount namespace of the drive, filled to its last page (ENOSPC)."""
        mounted = ("unshare", "--user", "--map-root-user", "--mount", "sh", "-c",
                   'mount -t tmpfs -o size=16k tmpfs "$0" && exec "$@"', str(self.folder))
        if subprocess.run([*mounted, "true"], check=False, stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("this kernel gives no mount namespace to a user")
        drive = self.drive("--parameters", str(self.folder), command=mounted)
        client = self.client(drive)
        disk = pathlib.Path(f"/proc/{drive.process.pid}/root{self.folder}")
        drive.open_commissioning(client)
        self.assertEqual(self.store(drive, client, 550), STORED)
        whole = (disk / "parameters").read_bytes()
        filling = disk / "filling"
        with self.assertRaises(OSError):
            with open(filling, "wb", buffering=0) as file:
                while True:
                    file.write(bytes(4096))
        for _ in range(3):
            self.assertEqual(self.store(drive, client, 560), NOT_WRITTEN)
            self.assertEqual((disk / "parameters").read_bytes(), whole)
        filling.unlink()
        self.assertEqual(self.store(drive, client, 560), STORED)
        self.assertIn("velocity_controller.gain 560", (disk / "parameters").read_text())

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

    def test_the_first_master_is_served_beside_32_that_send_requests_wrong_in_every_field(self):
        """With the window for parameters open; the field and its value are drawn from a fixed seed."""
        drive = self.drive("--parameters", str(self.folder))
        master = self.client(drive)
        master.enable()
        drive.open_commissioning(master)
        end, sent = threading.Event(), [0] * 32

        def malformed(draw):
            pdu = draw.choice([
                struct.pack(">BHH", draw.choice((3, 4)), draw.randrange(65536), draw.randrange(65536)),
                struct.pack(">BHH", 6, draw.randrange(65536), draw.randrange(65536)),
                struct.pack(">BHHB", 16, draw.randrange(1300), draw.randrange(65536), draw.randrange(256)) + draw.randbytes(draw.randrange(250)),
                struct.pack(">BHHHHB", 23, *(draw.randrange(65536) for _ in range(4)), draw.randrange(256)) + draw.randbytes(draw.randrange(240)),
                bytes([draw.randrange(256)]) + draw.randbytes(draw.randrange(20))])
            # Controlwords and the request to store are not malformed: the master's axis is not to be stopped by them.
            if pdu[0] in (6, 16, 23):
                pdu = pdu[:1] + struct.pack(">H", 1000 + draw.randrange(64536)) + pdu[3:]
                pdu = pdu[:5] + struct.pack(">H", 1000 + draw.randrange(64536)) + pdu[7:] if pdu[0] == 23 else pdu
            length = draw.choice((len(pdu) + 1, len(pdu) + 1, len(pdu) + 1, draw.randrange(65536)))
            return struct.pack(">HHHB", draw.randrange(65536), draw.choice((0, 0, 0, draw.randrange(65536))), length,
                               draw.randrange(256)) + pdu

        def flood(number):
            draw = random.Random(number)
            while not end.is_set():
                try:
                    with socket.create_connection(("127.0.0.1", drive.port), timeout=10) as client:
                        client.settimeout(0.01)
                        for _ in range(draw.randrange(1, 200)):
                            client.sendall(malformed(draw))
                            sent[number] += 1
                            if end.is_set():
                                break
                        client.recv(4096)
                except OSError:
                    continue  # closed by the drive, as what came was no request
        floods = [threading.Thread(target=flood, args=(number,)) for number in range(32)]
        for thread in floods:
            thread.start()
        try:
            for round in range(50):
                master.write(CONTROLWORD, 7)
                self.assertTrue(comes_true(lambda: master.state() == 0x23), f"stop {round} was not obeyed")
                master.write(CONTROLWORD, 15)
                self.assertTrue(comes_true(lambda: master.state() == ENABLED))
            self.assertTrue(comes_true(lambda: min(sent) > 20), f"sent {sent}")
        finally:
            end.set()
            for thread in floods:
                thread.join()
        self.assertEqual(master.state(), ENABLED)
        self.assertEqual(drive.end(signal.SIGTERM), 0)

    def test_one_connection_commands_and_the_others_stop_alone(self):
        drive = self.drive()
        first, second = self.client(drive), self.client(drive)
        first.enable()
        owner, token, held = first.read(121, 3)
        self.assertEqual((owner, held), (2, 0))
        self.assertEqual(first.read(128), first.read(19), "the owner's connection is the first one's")
        self.assertNotEqual(second.read(128), second.read(19))
        for register, value in ((CONTROLWORD, 15), (CONTROLWORD + 1, 1), (CONTROLWORD + 12, 100)):
            with self.assertRaises(Client.Refused) as refused:
                second.write(register, value)
            self.assertEqual(refused.exception.args, (BUSY,))
        self.assertEqual(first.state(), ENABLED)
        second.write(CONTROLWORD, 6)
        self.assertTrue(comes_true(lambda: first.state() != ENABLED))
        with self.assertRaises(Client.Refused):
            first.write(CONTROLWORD, 15)
        self.assertTrue(comes_true(lambda: first.read(123)[0] == 2), "held by a stop over Modbus")
        self.assertNotEqual(first.read(122)[0], token)
        second.write(CONTROLWORD, 15)  # lifts it and moves nothing
        self.assertTrue(comes_true(lambda: first.read(123)[0] == 0))
        first.enable()
        # Gone, and the axis is that of the next one that commands it.
        first.close()
        self.assertTrue(comes_true(lambda: second.read(128)[0] == 0xFFFF))
        second.write(CONTROLWORD, 7)
        self.assertEqual(second.read(128), second.read(19))
        self.assertEqual(drive.end(signal.SIGTERM), 0)

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
