#!/usr/bin/env python3
"""Machine files of real data sheets: `stiction machine new` gets their figures as they are printed, and what the
programme reads from the file it makes has to agree to 1e-6 with textbook formulas, which are written here apart."""

import math
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

PROGRAM, PRINT_AXIS = sys.argv[1:3]
TOLERANCE = 1e-6
MOST_ANSWERS = 25
G = 9.80665  # m/s^2, standard gravity

# Siemens, SIMOTICS 1FT7 Synchronous Motors, Configuration Manual (PFT7S) 01/2009, 6SN1197-0AD13-0BP2, p. 90, Tab 4-8,
# motor 1FT7044-AK7 with the recommended motor module: R_ph and L_D are those of a winding, k_E is between two lines.
POLES, J_MOT, K_T, K_E = 6, 5.43, 0.88, 57.0  # 2p, 1e-4 kg m^2, N m/A rms, V rms/1,000 rpm
R_PH, L_D, I_MAX_INV = 0.61, 4.2, 18.0  # Ohm, mH, A rms
# A screw of lead 10 mm (mm a turn) and its inertia; load, limits and encoder are those of screw-motor-encoder.toml.
LEAD, J_SCREW = 10.0, 2.41  # mm, 1e-4 kg m^2
SIEMENS_1FT7044 = {
    "transmission": "screw", "load": "200 kg", "travel": "500 mm", "max-velocity": "30 m/min",
    "max-acceleration": "8 m/s^2", "lead": "10 mm", "motor-inertia": "5.43e-4 kg m^2",
    "screw-inertia": "2.41 kg cm^2", "amperes": "rms", "volts": "rms", "between": "line", "winding-between": "phase",
    "torque-constant": "0.88 N m/A", "voltage-constant": "57 V/1000 rpm", "resistance": "0.61 Ohm",
    "inductance": "4.2 mH", "pole-pairs": "3", "supply": "540 V", "current-limit": "18 A", "counts": "1048576",
}

# Mendricky 2006, 5.1: six carriages INA RUE 35, each preloaded with 2950 N, 15000 N of a linear motor's attraction,
# 2000 N of weight, coefficient 0.003 without seals: (5.2) has 104.1 N.
GUIDES_OF_THESIS = {
    "transmission": "direct", "travel": "500 mm", "max-velocity": "80 m/min", "max-acceleration": "20 m/s^2",
    "amperes": "peak", "volts": "peak", "between": "phase", "force-constant": "94 N/A", "resistance": "1.8 Ohm",
    "inductance": "16.2 mH", "pole-pair-pitch": "72 mm", "supply": "600 V", "current-limit": "70 A",
    "increment": "1 nm", "guide-coefficient": "0.003", "carriages": "6", "seal-drag": "0 N", "preload": "2950 N",
    "attraction": "15000 N",
}


def made(folder, answers):
    """The file of `machine new` and what the programme reads from it: all in SI units at the table."""
    file = folder / "made.toml"
    file.unlink(missing_ok=True)
    flags = [part for name, answer in answers.items() for part in (f"--{name}", answer)]
    subprocess.run([PROGRAM, "machine", "new", *flags, "--out", file], check=True, capture_output=True,
                   stdin=subprocess.DEVNULL)
    lines = subprocess.run([PRINT_AXIS, file], check=True, capture_output=True, text=True).stdout.splitlines()
    return file.read_text(encoding="utf-8"), {name: float(value) for name, value in map(str.split, lines)}


class RealSheets(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def expect(self, found, wanted):
        for name, value in wanted.items():
            self.assertLessEqual(abs(found[name] / value - 1.0), TOLERANCE, f"{name}: {found[name]}, wanted {value}")

    def test_a_ball_screw_with_a_synchronous_motor(self):
        self.assertLessEqual(len(SIEMENS_1FT7044), MOST_ANSWERS)
        text, found = made(self.folder, SIEMENS_1FT7044)
        metres_per_turn = LEAD * 1e-3
        # A torque M turns by 2 pi while a force F moves by the lead: work is the same.
        force_per_torque = 2.0 * math.pi / metres_per_turn
        # Kinetic energy: at 1 m/s the shaft turns with as many rad/s.
        mass_of_screw = (J_MOT + J_SCREW) * 1e-4 * force_per_torque**2
        amplitude = math.sqrt(2.0)
        # At 1 m/s the motor makes so many thousand turns a minute; a star's phase has 1/sqrt(3) of the line's voltage.
        thousand_rpm = 60.0 / metres_per_turn / 1000.0
        self.expect(found, {
            "mass_kg": 200.0 + mass_of_screw,
            "load_mass_kg": 200.0,
            "force_constant_N_per_A": K_T / amplitude * force_per_torque,
            # Power of three windings in sine operation: 3/2 of the amplitudes' product.
            "phase_force_constant_N_per_A": K_T / amplitude * force_per_torque / 1.5,
            "emf_constant_V_s_per_m": K_E * thousand_rpm * amplitude / math.sqrt(3.0),
            "phase_resistance_Ohm": R_PH,
            "phase_inductance_H": L_D * 1e-3,
            "pole_pair_pitch_m": metres_per_turn / (POLES / 2),
            "current_limit_A": I_MAX_INV * amplitude,
            "voltage_limit_V": 540.0,
            "increment_m": metres_per_turn / 2**20,
        })
        tables = tomllib.loads(text)["axis"]["X"]
        self.assertEqual(tables["transmission"]["motor_inertia"], "5.43e-4 kg m^2", "as the sheet has it")
        self.assertIn("ESTIMATE", text, "its friction is none of the sheet's")

    def test_the_same_sheet_between_lines(self):
        """A sheet of the same motor that gives all between lines: twice the resistance and inductance."""
        winding = made(self.folder, SIEMENS_1FT7044)[1]
        lines = dict(SIEMENS_1FT7044, resistance=f"{2.0 * R_PH} Ohm", inductance=f"{2.0 * L_D} mH")
        del lines["winding-between"]
        self.expect(made(self.folder, lines)[1], winding)

    def test_the_shipped_axis_is_this_sheet(self):
        made_of_sheet = made(self.folder, SIEMENS_1FT7044)[1]
        file = pathlib.Path(__file__).resolve().parents[3] / "firmware/machine/shipped/screw-motor-encoder.toml"
        lines = subprocess.run([PRINT_AXIS, file], check=True, capture_output=True, text=True).stdout.splitlines()
        shipped = {name: float(value) for name, value in map(str.split, lines)}
        del made_of_sheet["coulomb_N"], made_of_sheet["viscous_N_s_per_m"]  # estimated of guides that it does not name
        self.expect(shipped, made_of_sheet)

    def test_the_friction_of_the_shipped_axis_is_the_estimate_of_its_parts(self):
        parts = {"guide-coefficient": "0.003", "carriages": "4", "seal-drag": "5 N", "preload": "600 N",
                 "drag-torque": "0.25 N m"}
        text, found = made(self.folder, SIEMENS_1FT7044 | parts)
        guides = 0.003 * (200.0 * G + 4 * 600.0) + 4 * 5.0
        screw = 0.25 * 2.0 * math.pi / (LEAD * 1e-3)
        self.expect(found, {"coulomb_N": guides + screw, "viscous_N_s_per_m": (guides + screw) / 0.5})
        self.assertAlmostEqual(found["coulomb_N"], 190.0, delta=0.5)
        self.assertIn("ESTIMATE: 0.003 of weight", text)

    def test_guides_of_a_thesis(self):
        # The weight is that of a mass, of which the sheet asks.
        load = 2000.0 / G
        found = made(self.folder, GUIDES_OF_THESIS | {"load": f"{load:.9f} kg"})[1]
        self.expect(found, {"coulomb_N": 0.003 * (6 * 2950.0 + 15000.0 + 2000.0)})
        self.assertAlmostEqual(found["coulomb_N"], 104.1, delta=0.05)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
