"""A tight spot of the guide: 13 to 25 % more friction on a few millimetres, a flat top with soft edges."""

import paths  # noqa: F401
import numpy as np

import plant
from hidden import Cause


def tight_spot(rng, machine, session):
    """The spot lies where training and held-out logs pass; its size is given, not scaled to a share."""
    ratio, width = rng.uniform(0.13, 0.25), rng.uniform(4e-3, 8e-3) / machine.length
    if machine.rotary:
        width = machine.stroke * rng.uniform(0.012, 0.025)
    low = max(s[:, 0].min() for s in session.sets)
    high = min(s[:, 0].max() for s in session.sets)
    centre = rng.uniform(low + 0.1 * (high - low), high - 0.1 * (high - low))
    edge = width * rng.uniform(0.1, 0.3)

    def apply(s, size):
        u = np.abs(s.places() - centre)
        s.table(plant.LEVEL_AT_PLACE, size * 0.5 * (1 - np.tanh((u - width / 2) / edge)))
    return Cause("position_dependent_friction", apply, ratio, ratio, ratio, "tight spot",
                 lambda z: {"relative": z, "centre": centre, "width": width})
