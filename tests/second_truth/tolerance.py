"""A machine that is off its file by data-sheet tolerances, as each real one is.

Ranges: moving mass from CAD 1 %; force constant, EMF 3 % (magnets), resistance 7 %, inductance 15 % (motor makers'
sheets); friction from one identification: Coulomb 2 %, viscous 4 % (it drifts by 2 to 4 % between days), contact
stiffness 15 %; dead time a quarter of a tick.
"""

import paths  # noqa: F401
import laws
import plant
from machines import TICK

RANGES = {"mass": 0.01, "coulomb": 0.02, "viscous": 0.04, "force_constant": 0.03, "emf": 0.03, "resistance": 0.07,
          "inductance": 0.15, "stiffness": 0.15, "dead_time": 0.25}
# What may truly be said of a machine that is off so.
NAMES = {"mass": ["mass_mismatch"], "coulomb": ["coulomb_mismatch"], "viscous": ["viscous_mismatch"],
         "force_constant": ["force_constant_mismatch", "mass_mismatch", "coulomb_mismatch", "viscous_mismatch"],
         "stiffness": ["presliding_hysteresis"], "dead_time": ["time_skew", "loop_delay"]}


def draw(rng, machine):
    """Relative errors of the machine against its file; each present with probability 0.7. Of dead time: s."""
    off = {}
    for key, most in RANGES.items():
        value = float(most * rng.uniform(-1.0, 1.0))
        if rng.random() < 0.7:
            off[key] = value
    if machine.model == "force":
        for key in ("emf", "resistance", "inductance", "dead_time"):
            off.pop(key, None)
    if machine.friction == "coulomb_viscous":
        off.pop("stiffness", None)
    if "dead_time" in off:
        quarter = TICK / 4
        off["dead_time"] = quarter if off["dead_time"] > 0 or machine.dead_time < quarter else -quarter
    return off


def apply(setup, off):
    """Changes a Setup by the errors."""
    p = setup.p
    one = lambda key: 1 + off.get(key, 0.0)
    p[plant.DRIVEN] *= one("mass")
    p[plant.LOAD] *= one("mass")
    setup.factors.append(lambda log, t: 0 * t + one("coulomb"))
    for at, key in ((plant.VISCOUS, "viscous"), (plant.FORCE, "force_constant"), (plant.EMF, "emf"),
                    (plant.RESISTANCE, "resistance"), (plant.INDUCTANCE, "inductance"),
                    (plant.LAW_A + laws.STIFFNESS, "stiffness")):
        p[at] *= one(key)
    for k in range(int(p[plant.LAW_A + laws.ELEMENTS])):
        p[plant.LAW_A + laws.FIRST + 2 * k] *= one("stiffness")
    p[plant.DEAD] += off.get("dead_time", 0.0)


def names(off):
    """Names that are no error when they are said of it."""
    return sorted({name for key in off for name in NAMES.get(key, [])})
