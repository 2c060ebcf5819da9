#!/usr/bin/env python3
"""The rules of the matrix on programmes and machine files of its own: what counts as a failure, as known, as a rate."""

import pathlib
import stat
import tempfile
import unittest

import machines
import matrix
import program
import records
import tally
import walk

FILE = """
schema = "stiction.machine/1"
[axis.X]
mass = "225 kg"
travel = "500 mm"
max_velocity = "80 m/min"
max_acceleration = "20 m/s^2"
  [axis.X.friction]
  use = "lugre"
    [axis.X.friction.lugre]
    coulomb = "90 N"
    viscous = "500 N s/m"
    [axis.X.friction.maxwell_slip]
    stiffness = ["1e6 N/m", "1e5 N/m"]
    level = ["14 N", "16 N"]
    viscous = "500 N s/m"
    [axis.X.friction.parabolic]
    force_at_1_m_per_s = "300 N"
    [axis.X.friction.linear_ramp]
    coulomb = "90 N"
    slope = "12000 N s/m"
    viscous = "500 N s/m"
[axis.Y]
mass = "520 kg"
  [axis.Y.friction]
  use = "dahl"
    [axis.Y.friction.dahl]
    coulomb = "200 N"
    [axis.Y.friction.curve]
    speed = ["1 mm/s", "1 m/s"]
    forward = ["80 N", "100 N"]
    backward = ["90 N", "100 N"]
"""
MACHINE = machines.Machine("table", FILE)


class MachineFiles(unittest.TestCase):
    def test_give_every_axis_with_every_model_that_its_own_file_has(self):
        cells = machines.table_of_cells([MACHINE], [1, 2])
        models = ["X/lugre", "X/maxwell_slip", "X/parabolic", "X/linear_ramp", "Y/dahl", "Y/curve"]
        self.assertEqual([str(cell) for cell in cells],
                         ["table/-/-/1"] + [f"table/{model}/{seed}" for seed in (1, 2) for model in models])

    def test_have_nothing_to_change_where_there_is_no_friction(self):
        bare = machines.Machine("bare", """
[axis.L]
kind = "rotary"
  [axis.L.friction]
    [axis.L.friction.coulomb_viscous]
    coulomb = "0 N m"
    viscous = "0 N m s/rad"
""")
        self.assertIsNone(bare.with_coulomb("L", "coulomb_viscous", 1.2))

    def test_give_the_values_that_identification_has_to_find(self):
        self.assertEqual(MACHINE.truths("X", "lugre"),
                         {"mass_kg": 225.0, "coulomb_N": 90.0, "viscous_N_s_per_m": 500.0})
        self.assertEqual(MACHINE.truths("X", "maxwell_slip")["coulomb_N"], 30.0)
        self.assertEqual(MACHINE.truths("X", "parabolic"), {"mass_kg": 225.0})
        self.assertEqual(MACHINE.truths("X", "lugre", 1.2)["coulomb_N"], 108.0)
        # 90 N at the break velocity of 7.5 mm/s, by when 3.75 N are viscous.
        self.assertAlmostEqual(MACHINE.truths("X", "linear_ramp")["coulomb_N"], 86.25)
        self.assertEqual(MACHINE.truths("Y", "curve"), {"mass_kg": 520.0})

    def test_give_the_whole_mass_that_a_motor_moves_at_the_axis(self):
        text = """
[axis.X]
mass = "200 kg"
  [axis.X.transmission]
  ratio = "3/2"
  lead = "10 mm"
  motor_inertia = "2e-4 kg m^2"
  screw_inertia = "1e-4 kg m^2"
  [axis.X.motor]
  torque_constant = "0.5 N m/A"
[axis.J]
kind = "rotary"
inertia = "0.5 kg m^2"
  [axis.J.transmission]
  ratio = 100
  motor_inertia = "1e-5 kg m^2"
[axis.Z]
mass = "100 kg"
  [axis.Z.gravity]
  force = "981 N"
  counterweight_mass = "90 kg"
  [axis.Z.motor]
  force_constant = "94 N/A"
"""
        machine = machines.Machine("trains", text)
        # 100 turns a metre of the screw, 150 of the motor: 628.3 and 942.5 rad.
        self.assertAlmostEqual(machine.moved("X"), 200.0 + 2e-4 * 942.477796**2 + 1e-4 * 628.318531**2, places=4)
        self.assertAlmostEqual(machine.moved("J"), 0.6)
        self.assertAlmostEqual(machine.moved("Z"), 190.0)
        self.assertAlmostEqual(machine.force_constant("X"), 0.5 * 942.477796, places=5)
        self.assertEqual(machine.force_constant("Z"), 94.0)

    def test_of_other_friction_differ_by_an_effect_alone(self):
        changed = machines.Machine("other", MACHINE.with_coulomb("X", "lugre", 1.2)).tables
        self.assertEqual(changed["axis"]["X"].pop("effect"), [{"name": "coulomb_mismatch", "coulomb": "108 N"}])
        self.assertEqual(changed, MACHINE.tables)
        self.assertIn('coulomb = "102 N"', MACHINE.with_coulomb("Y", "curve", 1.2))

    def test_without_a_coulomb_level_take_part_of_that_of_the_axis_other_models(self):
        self.assertIn('coulomb = "18 N"', MACHINE.with_coulomb("X", "parabolic", 1.2))
        self.assertIsNone(MACHINE.with_coulomb("X", "parabolic", 0.8), "no law has less than no friction")


class Records(unittest.TestCase):
    def test_stay_within_the_limits_of_the_axis_and_are_what_their_derivatives_say(self):
        limits = records.Limits(0.25, 0.2, 1.0, rotary=False)  # the ball-screw axis that ships
        for name, _, points in records.commissioning(limits):
            with self.subTest(name):
                places = [x for x, _, _ in points]
                self.assertLess(max(places) - min(places), 0.25)
                self.assertLess(max(abs(v) for _, v, _ in points), 0.2)
                self.assertLess(max(abs(a) for _, _, a in points), 1.0)
                for (x, v, a), (x_next, v_next, a_next) in zip(points, points[1:]):
                    # By the trapezoidal rule; what is left of a period's jerk.
                    self.assertAlmostEqual(x_next - x, 0.5e-3 * (v + v_next), delta=2e-7)
                    self.assertAlmostEqual(v_next - v, 0.5e-3 * (a + a_next), delta=2e-5)

    def test_repeat_with_their_seed(self):
        noise = [records.coloured(records.drawing(seed, "X", "sine"), 2.0, 40.0, 100) for seed in (1, 1, 2)]
        self.assertEqual(noise[0], noise[1])
        self.assertNotEqual(noise[0], noise[2])


class Programmes(unittest.TestCase):
    """Shell scripts in the programme's place."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        (self.root / "bin").mkdir()

    def walk_with(self, script):
        place = self.root / "bin/stiction"
        place.write_text(f"#!/bin/sh\n{script}\n")
        place.chmod(place.stat().st_mode | stat.S_IXUSR)
        cell = machines.Cell("table", "X", "lugre", 1)
        return walk.Walk(program.Program(place), MACHINE, cell, self.root, {"thermal_drift"}, True)

    def failures(self, script, **options):
        walked = self.walk_with(script)
        walked.command("step", "simulate", "circle", **options)
        return [failure.what for failure in walked.report.failures]

    def test_that_die_are_found(self):
        self.assertEqual(self.failures("[ $2 = --help ] || kill -SEGV $$"), ["SIGSEGV"])
        self.assertEqual(self.failures("[ $2 = --help ] || { echo 'terminate called after x' >&2; exit 1; }"),
                         ["uncaught exception"])

    def test_that_hang_are_ended_and_found(self):
        waits = self.walk_with("[ $2 = --help ] || sleep 60").program.run("x", waiting=0.2)
        self.assertEqual(waits.broke(), "no end")
        works = self.walk_with("[ $2 = --help ] || while :; do :; done").program.run("x", patience=1)
        self.assertEqual(works.broke(), "no end")

    def test_may_refuse_with_one_sentence_where_the_machine_lacks_something(self):
        says = "echo 'm.toml: found one axis; expected two' >&2; exit 2"
        self.assertEqual(self.failures(says, may_refuse=True), [])
        self.assertEqual(self.failures(says), ["exit 2"])
        self.assertEqual(self.failures("exit 2", may_refuse=True), ["refused without one sentence of what it needs"])
        self.assertEqual(self.failures("echo 'no' >&2; exit 2", may_refuse=True),
                         ["refused without one sentence of what it needs"])
        self.assertEqual(self.failures(f"echo a; {says}", may_refuse=True),
                         ["refused without one sentence of what it needs"])

    def test_that_print_what_is_no_number_are_found(self):
        self.assertEqual(self.failures("echo 'current inf A'"), ["a figure that is no number"])
        self.assertEqual(self.failures("echo 'information, a nanometre, 3 nanoseconds'"), [])

    def test_owe_a_report_in_their_folder(self):
        self.assertEqual(self.failures("mkdir -p there", out="there"), ["no report.html"])

    def test_name_their_commands_in_their_help(self):
        help_text = ("Usage: x\\nOptions:\\n  --machine M  x\\n\\n"
                     "Subcommands:\\n  circle    a circle\\n  l-shape   a path\\n")
        walked = self.walk_with(f"printf '{help_text}'")
        self.assertEqual(walked.program.experiments, ["circle", "l-shape"])
        self.assertEqual(walked.program.options["circle"], {"--machine"})

    def test_that_name_something_on_an_exact_file_are_found(self):
        verdict = ('{"findings": [{"effect": "thermal_drift", "p_value": 1e-9, "explains": 0.5, "parameters": {}}], '
                   '"unexplained": {}}')
        walked = self.walk_with(f"[ $2 = --help ] || {{ mkdir -p step; echo >step/report.html; "
                                f"echo '{verdict}' >step/verdict.json; }}")
        walked.expect_nothing(["a.csv"], [], "step")
        self.assertEqual([failure.what for failure in walked.report.failures], ["false name thermal_drift"])


class Tally(unittest.TestCase):
    def test_bounds_a_sample_by_chance(self):
        # Of 20 cases of 1.5 %: three and more have 0.3 %, four and more 0.02 %.
        self.assertEqual(tally.most_by_chance(0.015, 20, 0.001), 3)
        self.assertEqual(tally.most_by_chance(0.015, 20, 0.005), 2)
        self.assertEqual(tally.most_by_chance(0.0, 20, 0.001), 0)
        self.assertEqual(tally.most_by_chance(1.0, 20, 0.001), 20)

    def test_takes_the_interval_of_wilson(self):
        # Brown, Cai, DasGupta, Stat. Sci. 16 (2001): of n = 10 and none, 0 to 0.278.
        low, high = tally.wilson(0, 10)
        self.assertEqual(low, 0.0)
        self.assertAlmostEqual(high, 0.2775, places=4)

    def test_counts_cases_that_hang_together_as_what_they_are_worth(self):
        alone, together = tally.Rate("alone"), tally.Rate("together")
        for group in range(10):
            for case in range(10):
                alone.add(group < 8, (group, case))
                together.add(group < 8, group)
        for own, of_all in zip(alone.interval(), tally.wilson(80, 100)):
            self.assertAlmostEqual(own, of_all, places=2)
        # Ten groups, but for the one that their mean takes: 8 of 10, less a tenth.
        low, high = together.interval()
        self.assertAlmostEqual(low, tally.wilson(7.2, 9)[0])
        self.assertAlmostEqual(high, tally.wilson(7.2, 9)[1])
        without_scatter = tally.Rate("even")
        for case in range(100):
            without_scatter.add(case % 10 < 8, case // 10)
        self.assertEqual(without_scatter.interval(), tally.wilson(80, 100))

    def test_of_few_cases_asks_for_an_interval_that_meets_what_is_wanted_and_of_many_for_the_value(self):
        rate = tally.Rate("named", least=0.9, hits=17, cases=20)
        self.assertTrue(rate.holds(exactly=False))
        self.assertFalse(rate.holds(exactly=True))
        self.assertFalse(tally.Rate("named", least=0.9, hits=8, cases=20).holds(exactly=False))
        self.assertFalse(tally.Rate("inside", most=0.98, hits=500, cases=500).holds(exactly=False))

    def test_tells_known_failures_from_others_and_from_those_that_are_gone(self):
        failure = tally.Failure("table/X/lugre/1", "diagnose", "false name stribeck", "p = 1e-9")
        known = tally.Known("table/X/lugre/1", "diagnose", "false name stribeck", "drawn by chance")
        gone = tally.Known("table/X/lugre/1", "diagnose", "false name backlash", "drawn by chance")
        other = tally.Known("table/X/lugre/2", "diagnose", "false name backlash", "that seed did not run")
        self.assertEqual(tally.sort_out([failure], [], {"table/X/lugre/1"}), ([failure], [], []))
        self.assertEqual(tally.sort_out([failure], [known, gone, other], {"table/X/lugre/1"}), ([], [failure], [gone]))

    def test_refuses_a_known_failure_without_a_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder) / "known.toml"
            place.write_text('[[known]]\ncell = "table/X/lugre/1"\nstep = "diagnose"\nwhat = "exit 1"\n')
            self.assertRaises(tally.BadList, tally.read_known, place)
            place.write_text(place.read_text() + 'reason = "see there"\n')
            self.assertEqual(len(tally.read_known(place)), 1)
            place.write_text(place.read_text() + place.read_text())
            self.assertRaises(tally.BadList, tally.read_known, place)

    def test_counts_experiments_that_every_machine_refused(self):
        class Known:
            experiments = ["circle", "impact", "replay"]

        class Of:
            program = Known

        report = walk.Report(machines.Cell("table", "X", "lugre", 1), served={"circle"})
        self.assertEqual([failure.step for failure in matrix.unserved(Of, [report])], ["simulate impact"])


if __name__ == "__main__":
    unittest.main()
