"""Reduces a drive train to the axis' own coordinate: radians of a rotary load, metres of a linear one.

Source: energy equality of geared shafts, Sciavicco, Siciliano 2000, chapter 4; the lead screw in the same way (a
turn of 2 pi rad moves the load by the lead).
"""

import math
from fractions import Fraction


def motor_per_load(ratio=1, lead=None, circumference=None):
    """Radians of the motor's shaft per unit of the load (rad/rad or rad/m), n in equations.md.

    ratio: motor turns per output turn (Fraction or number); lead: m per turn of the screw; circumference: m per turn of
    the pulley. With neither the load turns with the gear's output.
    """
    if lead is not None and circumference is not None:
        raise ValueError("found lead and pulley_circumference; expected one of them")
    per_turn = lead if lead is not None else circumference
    if per_turn is None:
        return float(ratio)
    if per_turn <= 0:
        raise ValueError(f"found {per_turn} m a turn; expected a positive length")
    return float(ratio) * 2 * math.pi / per_turn


def motor_side(n, motor_inertia=0.0, screw_inertia=0.0, lead=None):
    """Mass (kg) or inertia (kg m^2) of motor and screw at the load's coordinate: J_m n^2 + J_s (2 pi/lead)^2."""
    screw = screw_inertia * (2 * math.pi / lead) ** 2 if screw_inertia else 0.0
    return motor_inertia * n**2 + screw


def parse_ratio(value):
    """The exact fraction of "355/113", "50" or a number."""
    return Fraction(value) if isinstance(value, str) else Fraction(repr(value)) if isinstance(value, float) else Fraction(value)


def free_free(motor, load, stiffness):
    """Natural frequency (rad/s) and reduced mass of two bodies (kg or kg m^2) joined by a spring (N/m or N m/rad).

    Source: Inman 2014, section 4.1: omega^2 = k (1/m1 + 1/m2), one over the reduced mass.
    """
    reduced = motor * load / (motor + load)
    return math.sqrt(stiffness / reduced), reduced


def shaft_damping(damping_ratio, motor, load, stiffness):
    """Damping (N s/m or N m s/rad) that gives the free-free mode this ratio: d = 2 zeta sqrt(k mu), mu = reduced mass."""
    return 2 * damping_ratio * math.sqrt(stiffness * free_free(motor, load, stiffness)[1])
