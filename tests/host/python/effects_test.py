"""Effects written in Python: each against the machine file's effect of the same equation, and as users err.

usage: effects_test.py FOLDER EXAMPLES     FOLDER: has the package; EXAMPLES: the folder examples
"""

import functools
import math
import os
import signal
import sys
import tempfile
import threading
import unittest
from pathlib import Path

FOLDER, EXAMPLES = sys.argv[1:3]
sys.path.insert(0, FOLDER)
import numpy as np  # noqa: E402

import stiction  # noqa: E402

CROSS_TABLE = "mcfv5050ln"
CIRCLE = {"friction": "lugre", "feed": "48 m/min"}
PITCH, COSINE, SINE = 0.024, 8.0, -5.0  # m, N, N


def ripple(time, position, speed, motor_force):
    angle = 2.0 * math.pi / PITCH * position
    return COSINE * math.cos(angle) + SINE * math.sin(angle)


def spring(time, position, speed, motor_force, *, stiffness=400.0, neutral=0.02):
    return -stiffness * (position - neutral)


def twin(folder, effect, machine=CROSS_TABLE, axis="X"):
    """The machine with an effect of its file."""
    text = Path(stiction.machine(machine).file).read_text(encoding="utf-8")
    path = Path(folder) / "twin.toml"
    path.write_text(f"{text}\n[[axis.{axis}.effect]]\n{effect}\n", encoding="utf-8")
    return path


def difference(own, other):
    """Largest difference of two logs, relative to the largest value of the column."""
    return max(np.max(np.abs(own[name] - other[name])) / max(np.max(np.abs(other[name])), 1e-300)
               for name in other if not np.array_equal(own[name], other[name])) \
        if any(not np.array_equal(own[name], other[name]) for name in other) else 0.0


class Twins(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="stiction-effects-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def circle(self, machine, **more):
        return stiction.simulate("circle", machine, logs=True, **CIRCLE, **more).logs[0]

    def test_ripple_in_python_is_the_ripple_of_the_file(self):
        other = self.circle(twin(self.folder, f'name = "force_ripple"\npitch = "{PITCH} m"\ncosine = ["{COSINE} N"]\n'
                                              f'sine = ["{SINE} N"]'))
        found = difference(self.circle(CROSS_TABLE, effects={"X": ripple}), other)
        print(f"force ripple in Python against its twin, every signal of a circle: {found:.2g} of its largest value")
        self.assertLessEqual(found, 1e-12)
        self.assertGreater(difference(self.circle(CROSS_TABLE), other), 1e-4)  # and it acts

    def test_several_functions_add_up(self):
        other = self.circle(twin(self.folder, 'name = "position_spring"\nstiffness = "800 N/m"\nneutral = "20 mm"'))
        both = {"X": [spring, functools.partial(spring, stiffness=400.0)]}
        self.assertLessEqual(difference(self.circle(CROSS_TABLE, effects=both), other), 1e-12)

    def test_torque_of_a_rotary_axis_is_over_angles(self):
        machine = stiction.machine("servo-joint")
        axis = next(iter(machine.axes))
        self.assertEqual(machine.axes[axis]["kind"], "rotary")
        cam = {"cam": Path(EXAMPLES) / "cams" / "indexing.toml", "speed": "20 rpm", "cycles": 1, "logs": True}
        spring = 'name = "position_spring"\nstiffness = "0.02 N m/rad"\nneutral = "0.1 rad"'
        other = stiction.simulate("cam", twin(self.folder, spring, machine, axis), **cam).logs[0]
        states = []

        def torsion(time, angle, speed, motor_torque):
            states.append(angle)
            return -0.02 * (angle - 0.1)
        own = stiction.simulate("cam", machine, effects={axis: torsion}, **cam).logs[0]
        self.assertLessEqual(difference(own, other), 1e-12)
        angle = next(own[name] for name in own if own.units[name] == "rad")
        self.assertLess(abs(max(states) - np.max(angle)), 0.05 * np.ptp(angle))

    def test_time_goes_on_in_steps_of_the_plant(self):
        times = []

        def push(time, position, speed, motor_force):
            times.append(time)
            return 0.0
        period = stiction.machine(CROSS_TABLE).period
        log = self.circle(CROSS_TABLE, effects={"X": push})
        steps = np.unique(times)
        self.assertEqual(steps[0], 0.0)
        self.assertTrue(np.allclose(np.diff(steps), period / 4.0, rtol=1e-6, atol=0.0))
        self.assertEqual(difference(log, self.circle(CROSS_TABLE)), 0.0)  # no force, no difference

    def test_replays_have_effects_too(self):
        log = Path(self.folder) / "circle.csv"
        self.circle(CROSS_TABLE, effects={"X": ripple}).write(log)
        alone, with_it = (stiction.replay(log, CROSS_TABLE, friction="lugre", effects=effects, logs=True).logs[0]
                          for effects in (None, {"X": ripple}))
        measured = stiction.read_log(log)
        self.assertLess(difference(with_it, {"X.x": measured["X.x"]}), 1e-6)
        self.assertGreater(difference(alone, {"X.x": measured["X.x"]}), 1e-6)


class Errors(unittest.TestCase):
    def assert_refuses(self, text, effects, experiment="circle", **options):
        with self.assertRaises(stiction.InputError) as raised:
            stiction.simulate(experiment, CROSS_TABLE, effects=effects, **(options or CIRCLE))
        self.assertIn(text, str(raised.exception))

    def test_what_was_found_and_what_was_expected(self):
        self.assert_refuses("effect: found 'Z'; expected an axis of mcfv5050ln: X, Y", {"Z": ripple})
        self.assert_refuses("effect on axis X: found float; expected a function of (time, position, speed, motor_force)",
                            {"X": 3.0})
        self.assert_refuses("effect on axis X: found <lambda>(x, v); expected a function of", {"X": lambda x, v: 0.0})
        self.assert_refuses("effect on axis X: found that its function returned a value of type str; expected the force "
                            "as a number", {"X": lambda t, x, v, f: "3 N"})
        self.assert_refuses("returned a value of type NoneType", {"X": lambda t, x, v, f: None})
        self.assert_refuses("effect on axis X: found the force nan at 0.000000 s, position",
                            {"X": lambda t, x, v, f: math.nan})
        self.assert_refuses("found the force inf at", {"X": lambda t, x, v, f: np.float64(np.inf)})
        self.assert_refuses("simulate break-away: found an effect on axis X, which no run has asked for; expected an "
                            "experiment with that axis in closed loop", {"X": ripple}, "break-away", friction="lugre")

    def test_what_a_function_raises_ends_the_call(self):
        def fail(time, position, speed, motor_force):
            if time > 0.01:
                raise ZeroDivisionError("no such place")
            return 0.0
        with self.assertRaisesRegex(ZeroDivisionError, "no such place"):
            stiction.simulate("circle", CROSS_TABLE, effects={"X": fail}, **CIRCLE)

    def test_force_beyond_the_drive_is_its_fault(self):
        with self.assertRaisesRegex(stiction.Fault, "axis X: fault"):
            stiction.simulate("circle", CROSS_TABLE, effects={"X": lambda t, x, v, f: 1e5}, **CIRCLE)

    def test_ctrl_c_ends_a_single_run(self):
        seen = threading.Event()

        def handler(number, frame):
            seen.set()
            raise KeyboardInterrupt
        before = signal.signal(signal.SIGINT, handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        calls = 0

        def interrupt(time, position, speed, motor_force):
            nonlocal calls
            calls += 1
            if calls == 1000:
                os.kill(os.getpid(), signal.SIGINT)
                seen.wait()  # the main thread's, which ends the run at a next call
            return 0.0
        with self.assertRaises(KeyboardInterrupt):
            stiction.simulate("circle", CROSS_TABLE, effects={"X": interrupt}, friction="lugre", feed="0.5 m/min")
        lap = 2.0 * math.pi * 0.09 / (0.5 / 60.0) / stiction.machine(CROSS_TABLE).period * 4.0
        self.assertLess(calls, 0.5 * lap)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
