"""Set-points in closed form: rows of position, speed and acceleration, one a tick."""

import numpy as np
from numpy.polynomial import Polynomial

# 0 to 1 over 0..1, speed, acceleration and jerk zero at both ends.
RISE = Polynomial([0, 0, 0, 0, 35, -84, 70, -20])


def moves(tick, start, pieces):
    """Point to point. pieces: (time of the move in s, displacement, rest after it in s); the first rest is 20 ms.

    Returns rows of x_set, v_set, a_set in m or rad and s.
    """
    rows, at = [np.tile([start, 0, 0], (round(0.02 / tick), 1))], start
    for duration, displacement, rest in pieces:
        s = np.arange(round(duration / tick)) * tick / duration
        rows.append(np.column_stack([at + displacement * RISE(s), displacement / duration * RISE.deriv(1)(s),
                                     displacement / duration**2 * RISE.deriv(2)(s)]))
        at += displacement
        rows.append(np.tile([at, 0, 0], (round(rest / tick), 1)))
    return np.vstack(rows)


def sine(tick, centre, amplitude, frequency, duration):
    """A sine whose amplitude grows from 0 within half of a period: centre + amplitude * rise(t) * sin(2 pi f t)."""
    t = np.arange(round(duration / tick)) * tick
    w, fade = 2 * np.pi * frequency, 0.5 / frequency
    s = np.minimum(t / fade, 1.0)
    r, r1, r2 = RISE(s), RISE.deriv(1)(s) / fade, RISE.deriv(2)(s) / fade**2
    x = amplitude * r * np.sin(w * t)
    v = amplitude * (r1 * np.sin(w * t) + r * w * np.cos(w * t))
    a = amplitude * (r2 * np.sin(w * t) + 2 * r1 * w * np.cos(w * t) - r * w**2 * np.sin(w * t))
    return np.column_stack([centre + x, v, a])


def speed(tick, start, value, ramp, duration):
    """A constant speed, reached within `ramp` s along RISE; for endless axes."""
    t = np.arange(round(duration / tick)) * tick
    s = np.minimum(t / ramp, 1.0)
    whole = RISE.integ()
    x = start + value * (ramp * whole(s) + np.maximum(t - ramp, 0.0))
    return np.column_stack([x, value * RISE(s), value / ramp * RISE.deriv()(s) * (t < ramp)])
