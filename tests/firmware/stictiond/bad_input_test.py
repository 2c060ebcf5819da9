#!/usr/bin/env python3
"""Odd numbers, full devices, folders and pipes for files, links, a second drive: refused before anything moves, with an
exit status and a sentence that say so."""

import os
import pathlib
import resource
import signal
import subprocess
import tempfile
import unittest

from drive_process import Client, Drive, comes_true

DONE, FAULT, REFUSED, FAILED = 0, 1, 2, 3
VELOCITY_GAIN, STORE, PASSWORD = 1004, 0, 0x5354


class BadInput(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_drive(self, *options, machine="emps", **more):
        """Exit status and what it said."""
        with Drive(*options, machine=machine, serve=False, **more) as drive:
            _, said = drive.process.communicate(timeout=120)
            return drive.process.returncode, said.decode()

    def refused(self, found, *options, **more):
        status, said = self.run_drive(*options, **more)
        self.assertEqual(status, REFUSED, said)
        self.assertIn(found, said)

    def test_times_that_are_none(self):
        for time in ("nan", "-nan", "inf", "1e300", "1e9", "0", "-1", "ten"):
            self.refused("expected a number of seconds above 0", "--hold", time)
        self.assertEqual(self.run_drive("--hold", "0.01")[0], DONE)

    def test_traces_that_cannot_be_written_are_refused_before_anything_moves(self):
        circle = ("--circle", "16 m/min", "--trace")
        os.mkfifo(self.folder / "fifo")
        for name, found in (("/dev/full", "an ordinary file"), (self.folder / "fifo", "expected"),
                            (self.folder, "Is a directory"), (self.folder / "no" / "trace.csv", "No such file")):
            self.refused(found, *circle, str(name), machine="mcfv5050ln")

    def test_a_disk_without_room_for_a_trace_is_found_before_anything_moves(self):
        def small_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
        self.refused("expected room for", "--circle", "16 m/min", "--trace", str(self.folder / "trace.csv"),
                     machine="mcfv5050ln", preexec_fn=small_files)

    def test_a_motion_that_does_not_fit_into_memory_is_refused_with_a_figure(self):
        self.refused("MB of memory", "--circle", "0.00001 m/min", machine="mcfv5050ln")

    def test_what_is_no_parameter_file_is_refused(self):
        for name in ("parameters", "run"):
            with self.subTest(name):
                os.mkfifo(self.folder / name)
                self.refused("expected", "--parameters", str(self.folder), "--hold", "0.01")
                (self.folder / name).unlink()
                (self.folder / name).mkdir()
                self.refused("expected", "--parameters", str(self.folder), "--hold", "0.01")
                (self.folder / name).rmdir()

    def test_a_link_in_the_place_of_the_new_parameter_file_is_not_followed(self):
        other = self.folder / "other"
        other.write_text("of a different owner")
        (self.folder / "parameters.new").symlink_to(other)
        with Drive("--parameters", str(self.folder), log=subprocess.DEVNULL) as drive:
            client = drive.client()
            drive.open_commissioning(client)
            client.write_float(VELOCITY_GAIN, 550)
            with self.assertRaises(Client.Refused):
                client.write(STORE, PASSWORD)
            client.close()
        self.assertEqual(other.read_text(), "of a different owner")

    def test_parameters_are_refused_until_an_operator_opens_the_window_and_nothing_is_stored(self):
        with Drive("--parameters", str(self.folder), log=subprocess.DEVNULL) as drive:
            client = drive.client()
            for write in (lambda: client.write_float(VELOCITY_GAIN, 550), lambda: client.write(STORE, PASSWORD)):
                with self.assertRaises(Client.Refused) as refused:
                    write()
                self.assertEqual(refused.exception.args, (1,))
            drive.open_commissioning(client)
            client.write_float(VELOCITY_GAIN, 550)
            drive.process.send_signal(signal.SIGUSR2)
            self.assertTrue(comes_true(lambda: client.read(16, 2)[1] == 0))
            with self.assertRaises(Client.Refused):
                client.write(STORE, PASSWORD)
            client.close()
        self.assertFalse((self.folder / "parameters").exists())

    def test_a_stored_set_that_is_damaged_leaves_the_axes_off_with_fault_50(self):
        (self.folder / "parameters").write_text("stiction.parameters/1\nlength 1\n")
        status, said = self.run_drive("--parameters", str(self.folder), "--hold", "0.01")
        self.assertEqual(status, FAULT, said)
        self.assertIn("the axes remain off (fault 50)", said)
        with Drive("--parameters", str(self.folder), log=subprocess.DEVNULL) as drive:
            client = drive.client()
            self.assertTrue(comes_true(lambda: client.read(102)[0] == 50))
            for word in (6, 7, 15, 0, 0x80, 6, 7, 15):
                client.write(100, word)
                self.assertEqual(client.state() & 0x4F, 0x08)
            self.assertEqual(client.read(120)[0], 0x6320)
            client.close()

    def test_a_second_drive_of_the_same_folder_is_refused(self):
        with Drive("--parameters", str(self.folder), log=subprocess.DEVNULL) as first:
            first.client().close()
            self.refused("a different drive that runs with this folder", "--parameters", str(self.folder), "--hold", "0.01")
            self.assertEqual(first.end(signal.SIGTERM), DONE)
        self.assertEqual(self.run_drive("--parameters", str(self.folder), "--hold", "0.01")[0], DONE)

    def test_the_next_start_says_how_a_run_broke_off(self):
        for number, said in ((signal.SIGKILL, "but while running"), (signal.SIGSEGV, "but by SIGSEGV")):
            with Drive("--parameters", str(self.folder), log=subprocess.DEVNULL) as drive:
                client = drive.client()
                self.assertTrue(comes_true(lambda: client.state() != 0), "the loop has not begun")
                client.close()
                self.assertEqual(drive.end(number), -number)
            for text in (f"the last run did not end in order, {said}", ""):
                status, log = self.run_drive("--parameters", str(self.folder), "--hold", "0.01")
                self.assertEqual(status, DONE)
                self.assertIn(text, log)
                self.assertEqual("did not end in order" in log, text != "")

    def test_figures_that_cannot_be_printed_do_not_look_like_a_refused_start(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            status, said = self.run_drive("--hold", "0.2", hal=("simulated",), out=full)
        self.assertIn(status, (FAILED, FAULT), said)  # a fault where this machine makes two ticks late
        self.assertNotEqual(status, REFUSED)


if __name__ == "__main__":
    unittest.main()
