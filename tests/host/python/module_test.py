"""The module of Python against the commands, against the laws in C++, and as its users err.

usage: module_test.py STICTION FOLDER EXAMPLES     FOLDER: has the package; EXAMPLES: the folder examples
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

STICTION, FOLDER, EXAMPLES = sys.argv[1:4]
sys.path.insert(0, FOLDER)
import numpy as np  # noqa: E402

import stiction  # noqa: E402

CROSS_TABLE = "mcfv5050ln"


def printed(*arguments):
    """The document that a command prints."""
    return json.loads(subprocess.run([STICTION, *arguments, "--json"], check=True, capture_output=True,
                                     text=True).stdout)


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="stiction-python-")
        cls.log = Path(cls.folder.name) / "circle.csv"
        kept = stiction.simulate("circle", CROSS_TABLE, friction="lugre", feed="16 m/min", logs=True)
        cls.kept = kept.logs[0]
        cls.kept.write(cls.log)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_circle_is_the_document_of_the_command(self):
        found = stiction.simulate("circle", CROSS_TABLE, friction=["lugre", "dahl"], feed="16 m/min", direction="both")
        self.assertEqual(found, printed("simulate", "circle", "--machine", CROSS_TABLE, "--friction", "lugre,dahl",
                                        "--feed", "16 m/min", "--direction", "both"))

    def test_experiments_are_the_documents_of_the_commands(self):
        found = stiction.simulate("break-away", CROSS_TABLE, friction="lugre")
        self.assertEqual(found, printed("simulate", "break-away", "--machine", CROSS_TABLE, "--friction", "lugre"))

    def test_keys_are_set_as_the_command_sets_them(self):
        heavy = stiction.machine(CROSS_TABLE, set="axis.X.mass=300 kg")
        self.assertEqual(heavy.axes["X"]["mass"], 300.0)
        found = stiction.simulate("circle", stiction.machine(heavy, set="axis.Y.mass=100 kg"))
        self.assertEqual(found, printed("simulate", "circle", "--machine", CROSS_TABLE, "--set", "axis.X.mass=300 kg",
                                        "--set", "axis.Y.mass=100 kg"))

    def test_identification_is_the_document_of_the_command(self):
        self.assertEqual(stiction.identify(self.log, CROSS_TABLE, axis="X", fix=["viscous=500 N s/m"]),
                         printed("identify", str(self.log), "--machine", CROSS_TABLE, "--axis", "X", "--fix",
                                 "viscous=500 N s/m"))

    def test_diagnosis_is_the_document_of_the_command(self):
        parts = []
        found = stiction.diagnose(self.log, CROSS_TABLE, axis="X", progress=parts.append)
        self.assertEqual(found, printed("diagnose", str(self.log), "--machine", CROSS_TABLE, "--axis", "X"))
        self.assertIn("X: selection", parts)

    def test_tuning_is_the_document_of_the_command(self):
        found = stiction.tune_friction(CROSS_TABLE, axis="X", feed="16 m/min", no_pulse=True)
        self.assertEqual(found, printed("tune-friction", "--machine", CROSS_TABLE, "--axis", "X", "--feed", "16 m/min",
                                        "--no-pulse"))

    def test_replay_is_the_document_of_the_command(self):
        found = stiction.replay(self.log, CROSS_TABLE, friction="lugre", signals="double", logs=True)
        self.assertEqual(found, printed("simulate", "replay", "--from", str(self.log), "--machine", CROSS_TABLE,
                                        "--friction", "lugre", "--signals", "double"))
        self.assertEqual([log.run for log in found.logs], ["lugre"])
        self.assertEqual(len(found.logs[0]["X.x"]), len(self.kept["X.x"]))

    def test_frequency_response_is_the_document_of_the_command(self):
        found = stiction.frequency_response(CROSS_TABLE, axis="X", passes=1, logs=True)
        self.assertEqual(found, printed("simulate", "frequency-response", "--machine", CROSS_TABLE, "--axis", "X",
                                        "--passes", "1"))
        log = Path(self.folder.name) / "test.csv"
        found.logs[0].write(log)
        measured = stiction.frequency_response(CROSS_TABLE, log, loop=["current", "velocity"])
        self.assertEqual(measured, printed("simulate", "frequency-response", "--machine", CROSS_TABLE, "--from", str(log),
                                           "--loop", "current,velocity"))

    def test_cam_is_the_document_of_the_command(self):
        motion = Path(EXAMPLES) / "cams" / "indexing.toml"
        runs = []
        found = stiction.simulate("cam", "servo-joint", cam=motion, speed="20 rpm", cycles=1, logs=True,
                                  progress=runs.append)
        self.assertEqual(found, printed("simulate", "cam", "--machine", "servo-joint", "--cam", str(motion), "--speed",
                                        "20 rpm", "--cycles", "1"))
        self.assertEqual(len(runs), len(found.logs))
        self.assertIn("master", "".join(found.logs[0]))
        verified = stiction.simulate("cam", "cam-stand", verification=True)
        self.assertEqual(verified, printed("simulate", "cam", "--machine", "cam-stand", "--verification"))

    def test_fleet_is_the_document_of_the_command(self):
        folder = Path(self.folder.name) / "fleet"
        folder.mkdir()
        rows = []
        for axis, coulomb in (("a", 18.0), ("b", 24.0)):
            for month in (1, 2, 3):
                key = f"axis.X.friction.coulomb_viscous.coulomb={coulomb + 0.1 * month} N"
                log = f"{axis}{month}.csv"
                stiction.simulate("circle", "emps", set=key, logs=True).logs[0].write(folder / log)
                rows.append(f"{axis},emps,2026-0{month}-01,{log}")
        listed = folder / "fleet.csv"
        listed.write_text("axis,machine,date,log\n" + "\n".join(rows) + "\n", encoding="utf-8")
        steps = []
        found = stiction.fleet(listed, folder / "out", diagnosis=False, progress=steps.append)
        self.assertEqual(found, printed("fleet", str(listed), "--out", str(folder / "again"), "--no-diagnosis"))
        self.assertIn("records: 6 of 6", steps)
        for name in ("fleet.json", "fleet.csv", "fleet.npz"):
            self.assertEqual((folder / "out" / name).read_bytes(), (folder / "again" / name).read_bytes(), name)
        coulomb = found.arrays["parameter"] == "coulomb"
        values = found.arrays["value"][coulomb]
        self.assertEqual(list(found.arrays["axis"][coulomb]), ["a"] * 3 + ["b"] * 3)
        self.assertLess(np.max(np.abs(values / [18.1, 18.2, 18.3, 24.1, 24.2, 24.3] - 1.0)), 0.02)
        self.assertEqual(stiction.fleet(listed, diagnosis=False), found)  # kept nowhere

    def test_signals_are_views_of_the_librarys_memory(self):
        kept = stiction.Log(self.kept._core)
        x = kept["X.x"]
        self.assertEqual(kept.units["X.x"], "m")
        self.assertFalse(x.flags.owndata)
        self.assertFalse(x.flags.writeable)
        self.assertEqual(x.ctypes.data, self.kept["X.x"].ctypes.data)
        self.assertEqual(len(x), len(kept["t"]))
        del kept
        self.assertGreater(np.ptp(x), 0.17)  # a circle of 90 mm

    def test_arrays_keep_their_memory(self):
        x = stiction.read_log(self.log)["X.x"]  # the log itself is gone
        self.assertTrue(np.array_equal(x, self.kept["X.x"]))

    def test_log_has_the_columns_of_its_file(self):
        log = stiction.read_log(self.log)
        lines = [line for line in self.log.read_text().splitlines() if not line.startswith("#")]
        head = [cell.split("[")[0] for cell in lines[0].split(",")]
        rows = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:200]])
        for name in log:
            self.assertTrue(np.array_equal(log[name][:199], rows[:, head.index(name)]), name)
        self.assertEqual(len(log["t"]), len(lines) - 1)


class Batches(unittest.TestCase):
    def test_axis_of_a_batch_is_the_axis_alone(self):
        t = np.arange(3200) * stiction.machine(CROSS_TABLE).period
        x_set = 1e-3 * np.sin(2 * np.pi * 5.0 * t) ** 3
        member = (stiction.machine(CROSS_TABLE), "X")
        other = (stiction.machine(CROSS_TABLE, set="axis.X.mass=300 kg"), "X")
        alone = stiction.batch([member], x_set)
        many = stiction.batch([member, other] * 8, x_set, every=4)
        self.assertEqual(many["x"].shape, (800, 16))
        self.assertTrue(np.array_equal(many["x"][:, 0], alone["x"][::4, 0]))
        self.assertFalse(np.array_equal(many["x"][:, 0], many["x"][:, 1]))
        self.assertFalse(many["fault"].any())
        self.assertGreater(np.ptp(alone["x"]), 1.9e-3)  # it follows

    def test_every_instruction_set_gives_the_same(self):
        x_set = 1e-4 * np.sin(np.arange(400) * 1e-2)
        found = [stiction.batch([(CROSS_TABLE, "X")] * 5, x_set, rows="e", instruction_set=name)["e"]
                 for name in stiction.instruction_sets()]
        for each in found[1:]:
            self.assertTrue(np.array_equal(each, found[0]))

    def test_axis_that_trips_leaves_the_others(self):
        x_set = np.zeros((400, 2))
        x_set[100:, 1] = 0.5  # m, more than any following error may be
        found = stiction.batch([(CROSS_TABLE, "X"), (CROSS_TABLE, "Y")], x_set)
        self.assertEqual(found["fault"][0], 0)
        self.assertNotEqual(found["fault"][1], 0)


class CoulombAndViscous:
    """m v' = F - F_C sgn(v) - mu v, its viscous part implicit: what docs/friction_model.md says of the baseline D."""

    def __init__(self, mass, coulomb, viscous):
        self.gain, self.coulomb, self.viscous = stiction.BENCH_STEP / mass, coulomb, viscous

    def advance(self, velocity, force):
        sign = (velocity > 0.0) - (velocity < 0.0)
        return (velocity + self.gain * (force - self.coulomb * sign)) / (1.0 + self.gain * self.viscous)


class Laws(unittest.TestCase):
    def test_law_in_python_is_its_twin(self):
        machine = stiction.machine(CROSS_TABLE, set=["axis.X.friction.coulomb_viscous.coulomb=120 N",
                                                     "axis.X.friction.coulomb_viscous.viscous=400 N s/m"])
        mass = machine.axes["X"]["mass"]
        force = 800.0 * np.sin(np.arange(20_000) * 2e-3)
        twin = stiction.bench(machine, force, axis="X", friction="coulomb_viscous")
        own = stiction.bench(CoulombAndViscous(mass, 120.0, 400.0), force, mass=mass)
        for name in ("x", "v", "friction"):
            # Friction is a difference of velocities times mass over step: 1e-12 of the force that acts.
            scale = 800.0 if name == "friction" else 1.0
            self.assertLessEqual(np.max(np.abs(own[name] - twin[name])), 1e-12 * scale, name)
        self.assertGreater(np.max(np.abs(twin["v"])), 1e-3)
        print(f"law in Python against its twin: {np.max(np.abs(own['v'] - twin['v'])):.2g} m/s")


class Errors(unittest.TestCase):
    def assert_says(self, text, call):
        with self.assertRaises(stiction.InputError) as raised:
            call()
        self.assertIn(text, str(raised.exception))

    def test_what_was_found_and_what_was_expected(self):
        member = (CROSS_TABLE, "X")
        for text, call in (
                ("found 'simulate circel'; expected one of: simulate circle",
                 lambda: stiction.simulate("circel", CROSS_TABLE)),
                ("did you mean 'feed'?", lambda: stiction.simulate("circle", CROSS_TABLE, fed="1 m/min")),
                ("--feed: found '16 kg'", lambda: stiction.simulate("circle", CROSS_TABLE, feed="16 kg")),
                ("--signals: found 'half'", lambda: stiction.simulate("circle", CROSS_TABLE, signals="half")),
                ("axis.X.mass", lambda: stiction.machine(CROSS_TABLE, set="axis.X.mass=-3 kg")),
                ("nowhere.toml", lambda: stiction.machine("nowhere.toml")),
                ('did you mean "mcfv5050ln"?', lambda: stiction.machine("mcfv5050l")),
                ("simulate replay: found 2 logs; expected one", lambda: stiction.replay(["a", "b"], CROSS_TABLE)),
                ("--cam: found none", lambda: stiction.simulate("cam", "servo-joint", speed="20 rpm")),
                ("--cycles: found '0'; expected a whole number from 1 to 1000",
                 lambda: stiction.simulate("cam", "servo-joint", cam="a.toml", speed="20 rpm", cycles=0)),
                ("--master: found 'slow'; expected one of",
                 lambda: stiction.simulate("cam", "servo-joint", cam="a.toml", speed="20 rpm", master="slow")),
                ("--signal: found 'noise'", lambda: stiction.frequency_response(CROSS_TABLE, signal="noise")),
                ("--passes: found it with a log", lambda: stiction.frequency_response(CROSS_TABLE, "a.csv", passes=1)),
                ("--columns: found it without a log", lambda: stiction.frequency_response(CROSS_TABLE, columns="t[s]")),
                ("diagnose: found no log", lambda: stiction.diagnose([], CROSS_TABLE)),
                ("nowhere.csv", lambda: stiction.fleet("nowhere.csv")),
                ("false alarms: found 2 an axis in a year; expected 1e-6 to 1",
                 lambda: stiction.fleet("nowhere.csv", false_alarms=2.0)),
                ("expected one of them", lambda: stiction.fleet("nowhere.csv", full=True, diagnosis=False)),
                ("found no log; expected at least one", lambda: stiction.diagnose([], CROSS_TABLE)),
                ("--seed: found '-1'; expected a whole number", lambda: stiction.diagnose(
                    __file__, CROSS_TABLE, axis="X", seed=-1)),
                ("nowhere.csv", lambda: stiction.read_log("nowhere.csv")),
                ("members: found none", lambda: stiction.batch([], np.zeros(4))),
                ("axis: found none; expected one of X, Y", lambda: stiction.batch([CROSS_TABLE], np.zeros(4))),
                ("found an array of shape (4, 3); expected (ticks,), (ticks, 1) or (ticks, 2)",
                 lambda: stiction.batch([member] * 2, np.zeros((4, 3)))),
                ("v_set: found the shape (3, 1); expected that of x_set, (4, 1)",
                 lambda: stiction.batch([member], np.zeros(4), np.zeros(3))),
                ("every: found 0; expected at least 1", lambda: stiction.batch([member], np.zeros(4), every=0)),
                ("rows: found 'speed'; expected one of",
                 lambda: stiction.batch([member], np.zeros(4), rows=["speed"])),
                ("instruction_set: found 'avx3'", lambda: stiction.batch([member], np.zeros(4), instruction_set="avx3")),
                ("without advance()", lambda: stiction.bench(object(), np.zeros(4), mass=1.0)),
                ("mass: found none; expected the mass",
                 lambda: stiction.bench(CoulombAndViscous(1.0, 1.0, 1.0), np.zeros(4)))):
            with self.subTest(text):
                self.assert_says(text, call)

    def test_column_that_is_not_there(self):
        log = stiction.simulate("circle", CROSS_TABLE, friction="lugre", feed="48 m/min", logs=True).logs[0]
        with self.assertRaisesRegex(KeyError, "found no column 'X.y'; expected one of t, X.x_set"):
            log["X.y"]

    def test_exception_of_progress_ends_the_call(self):
        def refuse(_):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            stiction.simulate("circle", CROSS_TABLE, friction="lugre", progress=refuse)

    def test_ctrl_c_ends_a_batch(self):
        reports = []

        def interrupt_once(words):
            if not reports:
                threading.Timer(0.0, os.kill, (os.getpid(), signal.SIGINT)).start()
            reports.append(words)
        ticks = 4_000_000  # most of them are never done
        with self.assertRaises(KeyboardInterrupt):
            stiction.batch([(CROSS_TABLE, "X")], np.zeros(ticks), np.zeros(ticks), np.zeros(ticks), every=1000,
                           progress=interrupt_once)
        self.assertLess(len(reports), ticks // 4096)


class Stubs(unittest.TestCase):
    def test_name_everything_that_is_there(self):
        stubs = (Path(FOLDER) / "stiction" / "__init__.pyi").read_text()
        for name in stiction.__all__:
            self.assertRegex(stubs, rf"(?m)^(def {name}\(|class {name}[\[(:]|{name}: )")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
