"""Reads "83.3 1/s" and "7e-5 N m s/rad" into SI; a table of the units that the cases use, and nothing else."""

import math

PREFIXES = {"n": 1e-9, "u": 1e-6, "m": 1e-3, "k": 1e3}
BASE = {"m": 1.0, "s": 1.0, "kg": 1.0, "N": 1.0, "A": 1.0, "V": 1.0, "Ohm": 1.0, "H": 1.0, "Hz": 1.0, "rad": 1.0, "1": 1.0}
ANGLES = {"deg": math.pi / 180, "rev": 2 * math.pi, "turn": 2 * math.pi, "rpm": 2 * math.pi / 60, "min": 60.0}


def factor_of(name):
    """Factor to SI of one unit, with a prefix or without: "um" -> 1e-6."""
    if name in BASE:
        return BASE[name]
    if name in ANGLES:
        return ANGLES[name]
    if len(name) > 1 and name[0] in PREFIXES and name[1:] in BASE:
        return PREFIXES[name[0]] * BASE[name[1:]]
    raise ValueError(f"found the unit '{name}'; expected one of {sorted(BASE | ANGLES)}, with n, u, m or k before it")


def product_of(text):
    """Factor of a product such as "kg m^2"."""
    result = 1.0
    for part in text.split():
        name, _, power = part.partition("^")
        result *= factor_of(name) ** int(power or 1)
    return result


def si(value):
    """SI value of a quantity of a machine file; a plain number is without dimension and stays as it is."""
    if not isinstance(value, str):
        return float(value)
    number, _, unit = value.partition(" ")
    numerator, *denominators = unit.split("/")
    factor = product_of(numerator) if numerator else 1.0
    for part in denominators:
        factor /= product_of(part)
    return float(number) * factor
