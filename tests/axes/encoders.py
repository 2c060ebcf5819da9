"""What encoders show of a position, in the unit of the axis (m or rad at the load's coordinate).

Source: uniform mid-tread quantiser, Gersho, Gray 1992, chapter 5. Rounding, not truncation: an axis at rest
at 0 would else sit on the border between two counts.
"""

import math

from jit import compiled

BODY, INCREMENT, DELAY, ENCODER = range(4)  # 0 load or 1 motor; increment, 0: none; delay in sub-steps
POSITION, VELOCITY, SECOND = range(3)  # rows of the table of encoders


@compiled
def counted(position, increment):
    """The whole number of increments nearest to the position; halves go away from zero."""
    return math.copysign(math.floor(abs(position) / increment + 0.5), position)


@compiled
def shown(position, increment):
    """The position in steps of the increment; as it is where the increment is 0."""
    return position if increment == 0.0 else increment * counted(position, increment) + 0.0


def increment_of(counts, on, kind, n):
    """Increment at the load's coordinate of `counts` edges a turn of the motor ("motor") or of the load ("load").

    n: rad of the motor per unit of the load (reduction.motor_per_load).
    """
    if on == "motor":
        return 2 * math.pi / counts / n
    if kind == "linear":
        raise ValueError("found counts on a linear load, which does not turn; expected increment")
    return 2 * math.pi / counts
