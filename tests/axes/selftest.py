#!/usr/bin/env python3
"""Holds the oracle against closed forms, against LSODA, and (control_test.py) against its own conventions."""

import math
import unittest

import numpy as np
from scipy.special import ellipk

import cases
import lsoda
import plants
import reduction
import simulate
from control_test import Endless, Laws, Programmes, Sampling  # run by unittest.main()
from encoders import increment_of
from machine import Machine
from jit import COMPILED
from plants import DC, IA, QL, QM, VL, VM
from quantities import si


def moved(p, y, duration, steps, u=(0.0, 0.0, 0.0)):
    """The state after `duration` s in equal steps of constant u."""
    y, u, mode = np.array(y, float), np.array(u, float), np.zeros(plants.MODES, np.int64)
    out, work = np.zeros(plants.STATES), np.zeros((5, plants.STATES))
    plants.begin(p, y, u, mode)
    for _ in range(steps):
        simulate.advance(p, y, u, mode, duration / steps, out, work)
    return y


def state(**values):
    """A state at rest but for the values given, QL, VL, ... by name; one position and speed for both bodies."""
    y = np.zeros(plants.STATES)
    for name, value in values.items():
        y[getattr(plants, name)] = value
    return y


def single(mass=1.0):
    """Parameters of one free mass."""
    p = plants.blank()
    p[plants.LOAD] = mass
    return p


def double(load=2.0, motor=0.5, stiffness=8e3, gap=0.0):
    """Parameters of two bodies, kg and N/m."""
    p = single(load)
    p[plants.MOTOR], p[plants.TWO], p[plants.STIFFNESS], p[plants.HALF_GAP] = motor, 1.0, stiffness, gap / 2
    return p


def energy(p, y):
    """Kinetic and elastic energy and that of the weight, J."""
    twist = y[QM] - y[QL]
    twist = math.copysign(max(abs(twist) - p[plants.HALF_GAP], 0.0), twist)
    height = p[plants.WEIGHT] * y[QL] + p[plants.MOMENT] * (1 - math.cos(y[QL] - p[plants.ZERO]))
    return (p[plants.LOAD] * y[VL]**2 + p[plants.MOTOR] * y[VM]**2 + p[plants.STIFFNESS] * twist**2) / 2 + height


class ClosedForms(unittest.TestCase):
    def test_two_free_masses_vibrate_at_their_natural_frequency(self):
        p, y = double(), state(QL=-1e-3, QM=4e-3)
        omega, _ = reduction.free_free(0.5, 2.0, 8e3)
        for turns in (1.0, 10.0):
            after = moved(p, y, turns * 2 * math.pi / omega, int(4000 * turns))
            self.assertLess(np.abs(after - y)[:4].max(), 1e-13 * 5e-3 * 4000 * turns)
        half = moved(p, y, math.pi / omega, 4000)
        np.testing.assert_allclose(half[[QL, QM]], [1e-3, -4e-3], rtol=1e-11)

    def test_damping_ratio_of_the_shaft_is_the_decay_of_the_free_mode(self):
        p = double()
        omega, _ = reduction.free_free(0.5, 2.0, 8e3)
        p[plants.DAMPING] = reduction.shaft_damping(0.05, 0.5, 2.0, 8e3)
        duration = 2 * math.pi / (omega * math.sqrt(1 - 0.05**2))
        after = moved(p, state(QL=-1e-3, QM=4e-3), duration, 4000)
        self.assertAlmostEqual((after[QM] - after[QL]) / 5e-3, math.exp(-0.05 * omega * duration), delta=1e-11)

    def test_viscous_mass_approaches_its_terminal_speed(self):
        p = single(3.0)
        p[plants.FORCE] = 2.0
        p[plants.FRICTION_L + plants.KIND], p[plants.FRICTION_L + plants.VISCOUS] = plants.COULOMB, 4.0
        p[plants.FRICTION_L + plants.LEVEL] = p[plants.FRICTION_L + plants.STATIC] = 1.5
        after = moved(p, state(), 1.2, 2000, (5.0, 0, 0))
        terminal = (2.0 * 5.0 - 1.5) / 4.0
        self.assertAlmostEqual(after[VL], terminal * -math.expm1(-4.0 / 3.0 * 1.2), delta=1e-13)

    def test_pendulum_returns_after_the_period_of_the_elliptic_integral(self):
        for amplitude in (1e-3, 0.5, 2.5):
            p = single(0.02)
            p[plants.MOMENT], p[plants.ZERO] = 1.9, 0.3
            period = 4 * math.sqrt(0.02 / 1.9) * ellipk(math.sin(amplitude / 2)**2)
            y = state(QL=0.3 + amplitude, QM=0.3 + amplitude)
            after = moved(p, y, period, 8000)
            self.assertLess(abs(after[QL] - y[QL]), 1e-11 * amplitude)
            self.assertLess(abs(moved(p, y, period / 2, 4000)[QL] - (0.3 - amplitude)), 1e-11 * amplitude)

    def test_energy_is_kept_without_friction_through_gap_and_gravity(self):
        p = double(gap=2e-3)
        p[plants.WEIGHT], p[plants.MOMENT] = 3.0, 1.0
        y = state(QL=0.01, QM=0.03, VL=0.2, VM=-0.5)
        after = moved(p, y, 1.0, 20000)
        self.assertLess(abs(energy(p, after) / energy(p, y) - 1), 1e-10)

    def test_coulomb_friction_stops_a_mass_after_its_stopping_distance_and_holds_it(self):
        p = single(2.0)
        p[plants.FRICTION_L + plants.KIND] = plants.COULOMB
        p[plants.FRICTION_L + plants.LEVEL] = p[plants.FRICTION_L + plants.STATIC] = 5.0
        after = moved(p, state(VL=0.7, VM=0.7), 1.0, 37)
        self.assertEqual(after[VL], 0.0)
        self.assertAlmostEqual(after[QL], 2.0 * 0.7**2 / (2 * 5.0), delta=1e-15)

    def test_mass_sticks_up_to_the_static_level_and_slides_against_the_kinetic_one(self):
        p = single(2.0)
        p[plants.FORCE] = 1.0
        p[plants.FRICTION_L + plants.KIND], p[plants.FRICTION_L + plants.LEVEL] = plants.COULOMB, 5.0
        p[plants.FRICTION_L + plants.STATIC] = 6.5
        self.assertEqual(moved(p, state(), 0.5, 50, (6.4999, 0, 0))[QL], 0.0)
        self.assertAlmostEqual(moved(p, state(), 0.5, 50, (-6.5001, 0, 0))[QL], -1.5001 / 2 * 0.5**2 / 2, delta=1e-14)

    def test_mass_under_a_spring_turns_back_where_friction_lets_it(self):
        # A shaft held by an immense motor: each half swing ends 2 F/k lower, Inman 2014, section 1.10.
        p = double(2.0, 1e30, 800.0)
        p[plants.FRICTION_L + plants.KIND] = plants.COULOMB
        p[plants.FRICTION_L + plants.LEVEL] = p[plants.FRICTION_L + plants.STATIC] = 4.0
        half = math.pi / math.sqrt(800.0 / 2.0)
        for swings, left in ((1, -0.02), (2, 0.01), (3, -0.0), (5, -0.0)):
            after = moved(p, state(QL=0.03), swings * half, 3000 * swings)
            self.assertAlmostEqual(after[QL], left, delta=1e-12)

    def test_bristles_reach_the_steady_curve_and_the_presliding_stiffness(self):
        p = single(1e30)  # holds its speed
        at = plants.FRICTION_L
        p[at:at + plants.FRICTION] = [plants.LUGRE, 90.0, 120.0, 500.0, 1e-3, 8e5, 300.0, 0.0]
        for v in (2e-4, -1e-3, 0.05):
            y = moved(p, state(VL=v, VM=v), 6e-3 / abs(v), 40000)
            force = plants.friction(p, at, v, y[plants.ZL], math.copysign(1, v))[0]
            steady = math.copysign(90 + 30 * math.exp(-(v / 1e-3)**2), v) + 500 * v
            self.assertAlmostEqual(force, steady, delta=1e-8)
        y = moved(p, state(VL=1e-3, VM=1e-3), 1e-6, 100)
        self.assertAlmostEqual(y[plants.ZL] / y[QL], 1.0, delta=1e-5)

    def test_dc_motor_has_time_constant_stall_torque_and_idle_speed(self):
        p = single(1e30)
        p[plants.MODEL], p[plants.FORCE], p[plants.EMF] = DC, 0.036 * 50, 0.036
        p[plants.N], p[plants.RESISTANCE], p[plants.INDUCTANCE] = 50.0, 0.6, 0.5e-3
        after = moved(p, state(), 1e-3, 400, (24.0, 0, 0))
        self.assertAlmostEqual(after[IA], 40.0 * -math.expm1(-1.2), delta=1e-10)
        p[plants.LOAD] = 0.02
        after = moved(p, state(), 2.0, 20000, (24.0, 0, 0))
        self.assertAlmostEqual(after[VL], 24.0 / (0.036 * 50), delta=1e-10)
        p[plants.INDUCTANCE] = 0.0
        rate = p[plants.FORCE] * 0.036 * 50 / 0.6 / 0.02
        after = moved(p, state(), 3e-3, 400, (24.0, 0, 0))
        self.assertAlmostEqual(after[VL], 24.0 / (0.036 * 50) * -math.expm1(-rate * 3e-3), delta=1e-11)

    def test_three_phases_give_three_halves_of_the_force_of_a_winding(self):
        p = single(1e30)
        p[plants.MODEL], p[plants.FORCE], p[plants.EMF] = plants.THREE_PHASE, 62.8, 62.8
        p[plants.RESISTANCE], p[plants.INDUCTANCE], p[plants.ELECTRICAL] = 1.8, 16.2e-3, 2 * math.pi / 0.072
        for place in (0.0, 0.011, 0.05):
            angle = p[plants.ELECTRICAL] * place + np.arange(3) * 2 * math.pi / 3
            u = 1.8 * 3.0 * np.sin(angle)
            y = moved(p, state(QL=place, QM=place), 0.3, 20000, u + 17.0)  # a common voltage drives nothing
            self.assertAlmostEqual(plants.drive_force(p, y, u), 1.5 * 62.8 * 3.0, delta=1e-9)
            self.assertAlmostEqual(y[IA:IA + 3].sum(), 0.0, delta=1e-12)

    def test_winding_that_turns_has_the_currents_of_complex_impedance(self):
        p = single(1e30)
        p[plants.MODEL], p[plants.FORCE], p[plants.EMF] = plants.THREE_PHASE, 62.8, 62.8
        p[plants.RESISTANCE], p[plants.INDUCTANCE], p[plants.ELECTRICAL] = 1.8, 16.2e-3, 2 * math.pi / 0.072
        v = 0.5
        y = moved(p, state(VL=v, VM=v), 0.216, 20000)  # 24 time constants, 1.5 turns: sin(3 pi + ..)
        current = -62.8 * v / complex(1.8, p[plants.ELECTRICAL] * v * 16.2e-3)
        turn = p[plants.ELECTRICAL] * 0.108
        for k in range(3):
            true = (current * np.exp(1j * (turn + k * 2 * math.pi / 3))).imag
            self.assertAlmostEqual(y[IA + k], true, delta=1e-8)


class Reduction(unittest.TestCase):
    def test_screw_adds_the_inertias_of_motor_and_screw(self):
        n = reduction.motor_per_load(2, lead=0.01)
        self.assertAlmostEqual(n, 2 * 2 * math.pi / 0.01, delta=1e-9)
        mass = reduction.motor_side(n, 2.1e-4, 5e-4, 0.01)
        self.assertAlmostEqual(mass, (4 * 2.1e-4 + 5e-4) * 4 * math.pi**2 / 1e-4, delta=1e-9)

    def test_belt_moves_by_the_circumference_in_a_turn(self):
        n = reduction.motor_per_load(3, circumference=0.15)
        self.assertAlmostEqual(2 * math.pi * 3 / n, 0.15, delta=1e-15)
        self.assertAlmostEqual(reduction.motor_side(n, 6e-5), 6e-5 * (3 * 2 * math.pi / 0.15)**2, delta=1e-12)

    def test_gear_accelerates_as_the_textbook_says(self):
        # Torque T at the motor, ratio n: output acceleration n T / (J + n^2 J_m), Sciavicco, Siciliano 2000, chapter 4.
        machine = Machine(cases.text_of("endless_355_113_cascade"))
        p, n = machine.plant, 355 / 113
        p[plants.FRICTION_L + plants.KIND] = plants.NO_FRICTION
        after = moved(p, state(), 0.1, 100, (2.0, 0, 0))
        self.assertAlmostEqual(after[VL], 0.1 * n * 0.6 * 2.0 / (0.004 + n**2 * 2.1e-4), delta=1e-12)

    def test_friction_of_the_motor_is_felt_through_the_gear(self):
        for elastic in (False, True):
            p = single(2.0)
            p[plants.N], p[plants.FORCE] = 50.0, 1.0
            p[plants.TWO], p[plants.MOTOR], p[plants.HALF_GAP] = float(elastic), 0.5, 0.1  # within the gap it is alone
            at = plants.FRICTION_M
            p[at:at + plants.VISCOUS + 1] = plants.COULOMB, 0.03, 0.04, 2e-3
            self.assertEqual(moved(p, state(), 0.1, 10, (50 * 0.0399, 0, 0))[VM], 0.0)
            mass, drive, slope = 0.5 if elastic else 2.5, 50 * 0.0401 - 50 * 0.03, 50**2 * 2e-3
            after = moved(p, state(), 0.1, 400, (50 * 0.0401, 0, 0))
            self.assertAlmostEqual(after[VM], drive / slope * -math.expm1(-slope / mass * 0.1), delta=1e-12)

    def test_file_gives_whole_gap_and_the_force_of_three_phases(self):
        p = Machine(cases.text_of("gear_backlash_pd_current")).plant
        self.assertAlmostEqual(p[plants.HALF_GAP], math.radians(0.05), delta=1e-18)
        machine = Machine(cases.text_of("geared_pid_current_loop"))
        angle = np.arange(3) * 2 * math.pi / 3
        y = state()
        y[IA:IA + 3] = 2.0 * np.sin(angle + math.pi / 2)
        y[QM] = y[QL] = math.pi / 2 / (4 * 50)
        self.assertAlmostEqual(plants.drive_force(machine.plant, y, np.zeros(3)), 0.3 * 50 * 2.0, delta=1e-12)
        machine = Machine(cases.text_of("linear_synchronous_cascade"))
        self.assertAlmostEqual(machine.plant[plants.INDUCTANCE], 16.2e-3, delta=1e-15)
        self.assertEqual(machine.plant[plants.FORCE], 62.8)

    def test_units_become_si(self):
        for text, value in (("30 m/min", 0.5), ("120 N/um", 1.2e8), ("360 deg", 2 * math.pi), ("62.5 us", 62.5e-6),
                            ("2.1e-4 kg m^2", 2.1e-4), ("60 rpm", 2 * math.pi), ("7e-5 N m s/rad", 7e-5),
                            ("-20 deg", -math.pi / 9)):
            self.assertAlmostEqual(si(text), value, delta=1e-15 * abs(value))
        with self.assertRaises(ValueError):
            si("3 furlong")

    def test_counts_of_the_motor_are_seen_through_the_gear(self):
        self.assertAlmostEqual(increment_of(10000, "motor", "linear", 2 * math.pi / 0.01), 1e-6, delta=1e-20)
        self.assertAlmostEqual(increment_of(4096, "load", "rotary", 345.0), 2 * math.pi / 4096, delta=1e-18)
        with self.assertRaises(ValueError):
            increment_of(4096, "load", "linear", 1.0)

    def test_unknown_key_is_refused(self):
        text = cases.text_of("belt_pid_current").replace("backlash", "x").replace('ratio = "3"', 'ratio = "3"\n  wobble = 1')
        with self.assertRaisesRegex(ValueError, "wobble"):
            Machine(text)


class Signs(unittest.TestCase):
    def test_gravity_pulls_towards_minus_x_and_the_counterweight_against_it(self):
        p = Machine(cases.text_of("vertical_counterweight_cascade")).plant
        p[plants.FRICTION_L + plants.KIND] = plants.NO_FRICTION
        after = moved(p, state(), 0.1, 10)
        self.assertAlmostEqual(after[QL], -0.5 * 10 / 190 * 9.80665 * 0.01, delta=1e-15)  # Atwood's machine

    def test_pendulum_rests_at_its_zero_and_falls_towards_it(self):
        p = Machine(cases.text_of("pendulum_pd_voltage")).plant
        zero = math.pi / 6
        self.assertAlmostEqual(plants.weight(p, state(QL=zero)), 0.0, delta=1e-15)
        self.assertAlmostEqual(plants.weight(p, state(QL=zero + math.pi / 2)), -1.3, delta=1e-14)
        self.assertAlmostEqual(plants.weight(p, state(QL=zero - math.pi / 2)), 1.3, delta=1e-14)

    def test_mirrored_motion_has_mirrored_results(self):
        for name in ("gear_backlash_pd_current", "geared_pid_current_loop", "belt_pid_current"):
            machine, sets = cases.load(name)
            sets = sets[:600] - sets[0]
            up, down = simulate.simulate(machine, sets), simulate.simulate(machine, -sets)
            for column in ("x", "command", "q_load"):
                np.testing.assert_allclose(down[column], -up[column], rtol=0, atol=1e-9 * np.abs(up[column]).max())

    def test_load_moves_only_after_the_motor_crossed_the_gap(self):
        p = double(gap=2e-3)
        after = moved(p, state(VM=0.01), 0.09999, 10)
        self.assertEqual(after[QL], 0.0)
        self.assertAlmostEqual(after[QM], 0.9999e-3, delta=1e-16)
        after = moved(p, state(VM=0.01), 0.105, 10)
        self.assertGreater(after[QL], 0.0)
        after = moved(p, state(VM=-0.01), 0.105, 10)
        self.assertLess(after[QL], 0.0)

    def test_shaft_never_pulls_through_its_gap(self):
        p = double(gap=2e-3)
        p[plants.DAMPING] = 1e3
        self.assertEqual(plants.shaft(p, state(QM=1.1e-3, VM=-1.0), 1), 0.0)
        self.assertGreater(plants.shaft(p, state(QM=1.1e-3, VM=1.0), 1), 0.0)
        self.assertEqual(plants.shaft(p, state(QM=0.9e-3, VM=1.0), 0), 0.0)


class AgainstLsoda(unittest.TestCase):
    """The closed loop in both integrators over the first moves; each bound is in units of the motion's amplitude."""

    # Ticks and bound. LSODA adds up its own tolerance of 1e-13 a step (measured: 1e-11 where it restarts often); a bend
    # within a step (linear ramp, a shaft that stops pushing) costs the fixed step two orders.
    SMOOTH, KINKED = 2e-11, 1e-10
    CASES = {"servo_joint_p_voltage": (2170, SMOOTH), "pendulum_pd_voltage": (3000, KINKED),
             "ball_screw_pd_current": (1120, SMOOTH), "belt_pid_current": (2000, SMOOTH),
             "vertical_counterweight_cascade": (3600, SMOOTH), "gear_backlash_pd_current": (4000, KINKED),
             "endless_355_113_cascade": (1500, SMOOTH), "linear_synchronous_cascade": (3600, KINKED),
             "geared_pid_current_loop": (4000, SMOOTH), "late_encoder_pid_voltage": (1500, SMOOTH),
             "elastic_arm_gravity_cascade": (3600, SMOOTH), "screw_scale_two_encoders": (3600, KINKED)}

    @classmethod
    def setUpClass(cls):
        """Without compiled functions the first 120 ms of two cases, or this would take an hour."""
        if not COMPILED:
            cls.CASES = {name: (120, 1e-9) for name in ("ball_screw_pd_current", "endless_355_113_cascade")}

    def test_fixed_step_agrees_with_lsoda(self):
        for name, (ticks, bound) in self.CASES.items():
            with self.subTest(name):
                machine, sets = cases.load(name)
                fixed, other = simulate.simulate(machine, sets[:ticks]), lsoda.simulate(machine, sets[:ticks])
                for column in ("q_load", "q_motor"):
                    amplitude = np.ptp(other[column])
                    self.assertGreater(amplitude, 0.0)
                    self.assertLess(np.abs(fixed[column] - other[column]).max() / amplitude, bound, column)

    def test_half_of_the_step_changes_nothing(self):
        for name, (ticks, _) in self.CASES.items():
            with self.subTest(name):
                machine, sets = cases.load(name)
                sets = sets if COMPILED else sets[:ticks]
                one, two = (simulate.simulate(machine, sets, n * machine.substeps) for n in (1, 2))
                for column in ("q_load", "q_motor"):
                    self.assertLess(np.abs(one[column] - two[column]).max() / np.ptp(two[column]), 2e-12, column)
                rms = lambda values: math.sqrt(np.mean(values**2))
                self.assertLess(rms(one["command"] - two["command"]) / rms(two["command"]), 1e-9)

    def test_error_falls_with_the_fourth_power_of_the_step(self):
        p, y = double(), state(QL=-1e-3, QM=4e-3)
        omega, _ = reduction.free_free(0.5, 2.0, 8e3)
        errors = [abs(moved(p, y, 3 * 2 * math.pi / omega, n) - y)[QM] for n in (300, 600)]
        errors_v = [abs(moved(p, y, 3 * 2 * math.pi / omega, n) - y)[VM] for n in (300, 600)]
        self.assertAlmostEqual(math.log2(math.hypot(errors[0] * omega, errors_v[0])
                                         / math.hypot(errors[1] * omega, errors_v[1])), 4.0, delta=0.1)


if __name__ == "__main__":
    unittest.main()
