"""Holds the sampled laws and what surrounds them against hand-made sequences and exact fractions; selftest.py runs it."""

import csv
import io
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from fractions import Fraction

import numpy as np

import cases
import compare
import controllers as law
import encoders
import endless
import simulate
import write_truth
from jit import COMPILED
from machine import Machine

HERE = pathlib.Path(__file__).resolve().parent


def text_of(controller, motor='model = "force"\n  force_constant = "2 N/V"', encoder='increment = "0 um"', extra=""):
    """A free mass of 4 kg with the given tables; 1 ms."""
    return (f'[timing]\nfast_period = "1 ms"\nslow_period = "1 ms"\n[axis.X]\nmass = "4 kg"\n[axis.X.motor]\n{motor}\n'
            f"[axis.X.encoder]\n{encoder}\n{controller}\n{extra}")


def settings(**values):
    """Settings of a law by name."""
    c = np.zeros(law.SETTINGS)
    c[law.TICK], c[law.PERIOD], c[law.PHASES] = 1e-3, 1, 1
    for name, value in values.items():
        c[getattr(law, name)] = value
    return c


def outputs(c, x_set, x, v_set=None, current=0.0):
    """Commands of a law for sequences of set-points and encoder readings, v_set 0 where it is left out."""
    s, u, made = np.zeros(law.MEMORY), np.zeros(3), []
    for k, (wanted, seen) in enumerate(zip(x_set, x)):
        speed = v_set[k] if v_set else 0.0
        made.append(law.control(c, s, k, wanted, speed, 0.0, seen, seen, 0.0, np.full(3, current), 0.0, u))
    return made


class Laws(unittest.TestCase):
    def test_p_voltage_is_gain_times_error_within_the_supply(self):
        c = settings(STRUCTURE=law.P_VOLTAGE, GAIN=12.0, LIMIT=7.4)
        np.testing.assert_allclose(outputs(c, [0.1, 1.0, -1.0], [0.0, 0.0, 0.0]), [1.2, 7.4, -7.4], rtol=1e-15)

    def test_pid_takes_the_new_error_into_its_integral_first(self):
        c = settings(STRUCTURE=law.PID, GAIN=10.0, INTEGRAL_TIME=4e-3)
        np.testing.assert_allclose(outputs(c, [1.0, 1.0, 0.0], [0.0, 0.5, 0.0]), [10 * 1.25, 10 * (0.5 + 0.375), 3.75])

    def test_integral_keeps_its_value_while_the_output_is_limited(self):
        c = settings(STRUCTURE=law.PID, GAIN=1.0, INTEGRAL_TIME=1e-3, LIMIT=1.5)
        np.testing.assert_allclose(outputs(c, [1.0, 0.5, 0.25], [0.0, 0.0, 0.0]), [1.5, 1.0, 1.0])

    def test_derivative_acts_on_the_difference_of_speeds(self):
        c = settings(STRUCTURE=law.PD, GAIN=0.0, DERIVATIVE=2.0, SPEED_KIND=law.MEAN_DIFFERENCE)
        # (x_k - x_(k-2))/2T, with x_0 before the start
        np.testing.assert_allclose(outputs(c, [0] * 4, [1.0, 1.001, 1.003, 1.003], v_set=[3.0] * 4),
                                   2 * (3 - np.array([0.0, 0.5, 1.5, 1.0])), atol=1e-9)

    def test_output_is_held_for_the_period_of_the_law(self):
        c = settings(STRUCTURE=law.PD, GAIN=1.0, PERIOD=3)
        np.testing.assert_allclose(outputs(c, [1, 2, 3, 4, 5, 6, 7.0], [0.0] * 7), [1, 1, 1, 4, 4, 4, 7])

    def test_cascade_rounds_the_position_error_and_feeds_speed_forward_each_tick(self):
        c = settings(STRUCTURE=law.CASCADE, GAIN=50.0, POSITION_INCREMENT=1e-3, SPEED_GAIN=2.0, INTEGRAL_TIME=2e-3,
                     FEED_SPEED=1.0, PERIOD=2)
        made = outputs(c, [1.4e-3, 9.0, -2.5e-3], [0.0, 0.0, 0.0], v_set=[0.1, 0.2, 0.0])
        errors, total, wanted = [0.05 + 0.1, 0.05 + 0.2, -0.15], 0.0, []
        for error in errors:
            total += error / 2
            wanted.append(2 * (error + total))
        np.testing.assert_allclose(made, wanted, rtol=1e-14)

    def test_notch_passes_slow_signals_and_damps_its_own_by_the_ratio_of_dampings(self):
        tick, frequency = 62.5e-6, 2000.0
        b0, b1, b2, a1, a2 = law.notch(frequency, 0.05, 0.7, tick)
        response = lambda z: (b0 + b1 / z + b2 / z**2) / (1 + a1 / z + a2 / z**2)
        self.assertAlmostEqual(response(1), 1.0, delta=1e-14)
        self.assertAlmostEqual(abs(response(np.exp(2j * np.pi * frequency * tick))), 0.05 / 0.7, delta=1e-13)

    def test_notch_filters_as_its_transfer_function_says(self):
        c = settings(STRUCTURE=law.CASCADE, NOTCH=1)
        c[law.B0:law.A2 + 1] = taps = law.notch(100.0, 0.1, 0.6, 1e-3)
        s, y = np.zeros(law.MEMORY), np.sin(np.arange(40.0) ** 1.3)
        made = [law.notched(c, s, value) for value in y]
        for k in range(2, 40):
            self.assertAlmostEqual(made[k], taps[0] * y[k] + taps[1] * y[k - 1] + taps[2] * y[k - 2]
                                   - taps[3] * made[k - 1] - taps[4] * made[k - 2], delta=1e-13)

    def test_current_loop_drives_the_error_of_each_phase(self):
        c = settings(STRUCTURE=law.PD, GAIN=3.0, CURRENT_LOOP=1, CURRENT_GAIN=7.0, CURRENT_TIME=2e-3, PHASES=3)
        s, u = np.zeros(law.MEMORY), np.zeros(3)
        command = law.control(c, s, 0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, np.array([0.5, 0.0, -0.5]), 0.4, u)
        self.assertEqual(command, 3.0)
        phases = 3.0 * np.sin(0.4 + np.arange(3) * 2 * math.pi / 3) - [0.5, 0.0, -0.5]
        np.testing.assert_allclose(u, 7.0 * phases * 1.5, rtol=1e-14)


class Sampling(unittest.TestCase):
    LAW = '[axis.X.controller]\nstructure = "pd"\ngain = "8 V/m"\n'

    def step(self, **tables):
        machine = Machine(text_of(self.LAW, **tables))
        sets = np.zeros((12, 3))
        sets[3:, 0] = 1.0
        return simulate.simulate(machine, sets)

    def test_command_acts_from_its_sample_to_the_next(self):
        made = self.step()
        np.testing.assert_allclose(made["command"][:5], [0, 0, 0, 8, 8 * (1 - made["q_load"][4])], rtol=1e-14)
        self.assertEqual(made["q_load"][3], 0.0)
        self.assertAlmostEqual(made["q_load"][4], 8 * 2 / 4 * 1e-6 / 2, delta=1e-20)
        self.assertAlmostEqual(made["v_load"][4], 8 * 2 / 4 * 1e-3, delta=1e-17)

    def test_dead_time_holds_the_output_back(self):
        made = self.step(extra='[axis.X.inverter]\ndead_time = "2 ms"\nvoltage_limit = "100 V"\n')
        self.assertEqual(made["command"][3], 8.0)
        self.assertEqual(made["v_load"][5], 0.0)
        self.assertAlmostEqual(made["v_load"][6], 8 * 2 / 4 * 1e-3, delta=1e-17)

    def test_late_encoder_shows_where_the_axis_was(self):
        made = self.step(encoder='increment = "0 um"\ndelay = "1.5 ms"')
        self.assertEqual(made["x"][4], 0.0)
        self.assertAlmostEqual(made["x"][5], 4 * 0.5e-3**2 / 2, delta=1e-18)
        self.assertAlmostEqual(made["x"][6], 4 * 1.5e-3**2 / 2, delta=1e-10)

    def test_encoder_rounds_to_the_nearest_and_halves_away_from_zero(self):
        for position, count in ((0.49, 0), (0.5, 1), (-0.5, -1), (1.49, 1), (-2.51, -3), (2.5, 3), (-1e-18, 0)):
            self.assertEqual(encoders.counted(position, 1.0), count)
        self.assertEqual(encoders.shown(0.1234, 0.0), 0.1234)

    def test_two_encoders_of_an_elastic_axis_differ_by_its_twist(self):
        machine, sets = cases.load("elastic_arm_gravity_cascade")
        made = simulate.simulate(machine, sets[:800])
        twist = made["q_motor"] - made["q_load"]
        self.assertGreater(np.abs(twist).max(), 1e-4)
        steps = 2 * math.pi / 1e6, 2 * math.pi / 16384 / 101
        np.testing.assert_allclose(made["x_load"] - made["x"], twist, rtol=0, atol=sum(steps) / 2 * (1 + 1e-9))


class Endless(unittest.TestCase):
    def test_phase_is_exact_in_whole_numbers(self):
        for row in endless.rows(10000, 10**9):
            denominator = 355 * 10000
            remainder = row["total[counts]"] * 113 % denominator
            self.assertEqual(Fraction(row["phase_numerator"], row["phase_denominator"]), Fraction(remainder, denominator))
            self.assertEqual(row["whole[turns]"], row["total[counts]"] * 113 // denominator)
            self.assertAlmostEqual(float(row["phase[rad]"]), 2 * math.pi * remainder / denominator, delta=1e-14)

    def test_a_billion_turns_forth_and_back_end_where_they_began(self):
        made = list(endless.rows(10000, 10**9))
        self.assertGreaterEqual(max(row["whole[turns]"] for row in made), 10**9 - 1)
        back = [row for row in made if row["total[counts]"] == 0]
        self.assertGreater(len(back), 5)
        self.assertTrue(all(row["phase_numerator"] == 0 for row in back))

    def test_a_rounded_modulus_would_be_seen(self):
        counts = endless.RATIO * 10000
        rounded = Fraction(round(counts))
        row = max(endless.rows(10000, 10**9), key=lambda r: r["total[counts]"])
        exact = Fraction(row["phase_numerator"], row["phase_denominator"])
        wrong = Fraction(row["total[counts]"]) / rounded % 1
        self.assertGreater(abs(wrong - exact), Fraction(1, 10**4))


class Programmes(unittest.TestCase):
    def test_every_case_writes_a_log_that_compares_equal_to_itself_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name in list(cases.CASES)[:None if COMPILED else 1]:
                table, file = write_truth.write(name, folder)
                machine = Machine(file.read_text(encoding="utf-8"))
                log = compare.read(table)
                self.assertAlmostEqual(log["t"][1][7], 7 * machine.tick, delta=1e-15)
                self.assertGreater(np.abs(next(log[c] for c in compare.COMMANDS if c in log)[1]).max(), 0.0)
                self.assertLess(np.abs(log["x_set"][1] - log["x"][1])[-1], 0.05 * np.ptp(log["x_set"][1]))
                self.assertEqual(self.status(table, table), 0)
                lines = table.read_text(encoding="utf-8").splitlines()
                cells = lines[len(lines) // 2].split(",")
                at = lines[0].split(",").index(next(h for h in lines[0].split(",") if h.startswith("x[")))
                cells[at] = repr(float(cells[at]) + 2e-9)
                lines[len(lines) // 2] = ",".join(cells)
                (folder / "other.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
                self.assertEqual(self.status(folder / "other.csv", table), 1)
                (folder / "other.csv").write_text("\n".join(lines[:-1]) + "\n", encoding="utf-8")
                self.assertEqual(self.status(folder / "other.csv", table), 2)

    def status(self, log, truth):
        try:
            with unittest.mock.patch("sys.stdout", io.StringIO()):
                return 0 if compare.compare(compare.read(log), compare.read(truth), 1e-6, 1e-9) else 1
        except ValueError:
            return 2

    def test_command_that_differs_is_seen(self):
        truth = {"t": ("s", np.arange(3.0)), "x": ("m", np.zeros(3)), "u": ("V", np.array([1.0, -2.0, 2.0]))}
        other = dict(truth, u=("V", np.array([1.0, -2.0, 2.0 + 6e-6])))
        name, ratio = compare.command_difference(other, truth)
        self.assertEqual(name, "u")
        self.assertAlmostEqual(ratio, 2e-6, delta=1e-12)

    def test_endless_prints_a_table(self):
        printed = subprocess.run([sys.executable, "-B", HERE / "endless.py", "--turns", "1000"], capture_output=True,
                                 text=True, check=True).stdout
        self.assertEqual(next(csv.DictReader(io.StringIO(printed)))["phase_numerator"], "0")
