"""The control laws, sampled, equations.md section 8: cascade, p-voltage, pd, pid, each with current loop or without.

Sources: Astrom, Hagglund 2006, chapters 3 (form, conditional integration) and 13
(sampling); the cascade and its order within a tick: docs/prototype_figures.md and Mendricky 2006.
"""

import math

from jit import compiled
from encoders import shown

CASCADE, P_VOLTAGE, PD, PID = range(4)
IDEAL_SPEED, MEAN_DIFFERENCE = range(2)
# Settings. PERIOD: ticks of a period of the structure, or of the cascade's position controller; TICK in s.
(STRUCTURE, TICK, PERIOD, GAIN, POSITION_INCREMENT, SPEED_GAIN, INTEGRAL_TIME, DERIVATIVE, LIMIT, SPEED_KIND, FEED_SPEED,
 FEED_ACCELERATION, NOTCH, B0, B1, B2, A1, A2, CURRENT_LOOP, CURRENT_GAIN, CURRENT_TIME, VOLTS, PHASES,
 SETTINGS) = range(24)
# Memory of the law.
STARTED, HELD, SUM, OUTPUT, S1, S2, SUM_A, SUM_B, SUM_C, LAST, MEAN, LAST_SET, MEMORY = range(13)


def notch(frequency, numerator, denominator, tick):
    """b0, b1, b2, a1, a2 of (s^2/w^2 + 2 zn s/w + 1)/(s^2/w^2 + 2 zd s/w + 1) through Tustin's rule, frequency kept.

    Source: Franklin, Powell, Workman 1998, section 6.1.
    frequency in Hz, tick in s.
    """
    c = 1 / math.tan(math.pi * frequency * tick)  # s/w becomes c (z - 1)/(z + 1)
    top = (c * c + 2 * numerator * c + 1, 2 - 2 * c * c, c * c - 2 * numerator * c + 1)
    low = (c * c + 2 * denominator * c + 1, 2 - 2 * c * c, c * c - 2 * denominator * c + 1)
    return [value / low[0] for value in top] + [low[1] / low[0], low[2] / low[0]]


@compiled
def limited(value, limit):
    """The value within plus and minus the limit; 0 means that there is no limit."""
    return value if limit == 0.0 else min(max(value, -limit), limit)


@compiled
def measured_speed(c, s, x, v, period):
    """Speed as the law sees it: the true one, or the difference of the means of two samples over the period."""
    if c[SPEED_KIND] == IDEAL_SPEED:
        return v
    if s[STARTED] == 0.0:
        s[LAST] = s[MEAN] = x
    mean = (x + s[LAST]) / 2
    speed = (mean - s[MEAN]) / period
    s[LAST], s[MEAN] = x, mean
    return speed


@compiled
def proportional_integral(s, at, error, gain, step, limit, added):
    """gain (1 + 1/(T s)) of the error plus `added`, within the limit; step = period/T, 0: no integral.

    The integral takes the new error before it is used, and keeps its value in a sample whose output is limited.
    """
    total = s[at] + error * step
    wanted = gain * (error + total) + added
    output = limited(wanted, limit)
    if output == wanted:
        s[at] = total
    return output


@compiled
def notched(c, s, y):
    """One sample of the notch (transposed direct form II)."""
    if c[NOTCH] == 0.0:
        return y
    out = c[B0] * y + s[S1]
    s[S1] = c[B1] * y - c[A1] * out + s[S2]
    s[S2] = c[B2] * y - c[A2] * out
    return out


@compiled
def cascade(c, s, tick, x_set, v_set, a_set, x, speed_x, v):
    """P position at its period, PI speed with notch and feedforwards at each tick; returns A or V."""
    if tick % int(c[PERIOD]) == 0:
        s[HELD] = shown(x_set - x, c[POSITION_INCREMENT])
    speed = measured_speed(c, s, speed_x, v, c[TICK])
    wanted_speed = v_set
    if c[SPEED_KIND] == MEAN_DIFFERENCE:
        wanted_speed, s[LAST_SET] = s[LAST_SET], v_set
    error = c[GAIN] * s[HELD] + c[FEED_SPEED] * wanted_speed - speed
    total = s[SUM] + (error * c[TICK] / c[INTEGRAL_TIME] if c[INTEGRAL_TIME] > 0.0 else 0.0)
    wanted = notched(c, s, c[SPEED_GAIN] * (error + total)) + c[FEED_ACCELERATION] * a_set
    output = limited(wanted, c[LIMIT])
    if output == wanted:
        s[SUM] = total
    return output


@compiled
def single_loop(c, s, tick, x_set, v_set, x, speed_x, v):
    """p-voltage, pd or pid; the output is held for the period. Returns A or V."""
    if tick % int(c[PERIOD]) == 0:
        period = c[TICK] * c[PERIOD]
        error = x_set - x
        damped = 0.0
        if c[STRUCTURE] != P_VOLTAGE:
            damped = c[DERIVATIVE] * (v_set - measured_speed(c, s, speed_x, v, period))
        step = period / c[INTEGRAL_TIME] if c[STRUCTURE] == PID else 0.0
        s[OUTPUT] = proportional_integral(s, SUM, error, c[GAIN], step, c[LIMIT], damped)
    return s[OUTPUT]


@compiled
def control(c, s, tick, x_set, v_set, a_set, x, speed_x, v, currents, angle, u):
    """One tick of the whole law; all inputs are of this instant.

    x: what the position encoder shows; speed_x, v: what the speed encoder shows, and the true speed of its body;
    currents: A of the windings; angle: electrical, rad. Writes V (or an ideal source's command) of the phases into u and
    returns the command before the current loop.
    """
    if c[STRUCTURE] == CASCADE:
        command = cascade(c, s, tick, x_set, v_set, a_set, x, speed_x, v)
    else:
        command = single_loop(c, s, tick, x_set, v_set, x, speed_x, v)
    s[STARTED] = 1.0
    u[0], u[1], u[2] = command, 0.0, 0.0
    if c[CURRENT_LOOP]:
        step = c[TICK] / c[CURRENT_TIME] if c[CURRENT_TIME] > 0.0 else 0.0
        for k in range(int(c[PHASES])):
            wanted = command * (math.sin(angle + k * 2 * math.pi / 3) if c[PHASES] == 3 else 1.0)
            u[k] = proportional_integral(s, SUM_A + k, wanted - currents[k], c[CURRENT_GAIN], step, c[VOLTS], 0.0)
    return command
