"""The same axis written a second time as differential equations in time, for scipy's LSODA and Radau.

Bristles follow their published rates in time (not over displacement, as laws.py has them); elements of Maxwell-slip
stop at their level. Only what selftest.py integrates is here: no dry friction (its standstill is no differential
equation), no gap and no hidden tables. Between two ticks the voltage is constant. SI.
"""

import math

import paths  # noqa: F401
import numpy as np
from scipy.integrate import solve_ivp

import controllers as law
import machines
import plant
from encoders import shown


def bristle(m, sliding, v, z):
    """dz/dt and force of a bristle model of the file (LuGre, Dahl, elasto-plastic)."""
    s0 = m.stiffness
    g = m.coulomb * (1 + (m.static_ratio - 1) * math.exp(-(v / m.stribeck) ** 2))
    alpha = 1.0
    if m.friction == "elasto_plastic":
        zss = g / s0
        elastic = m.break_away_share * m.coulomb / s0
        if z * v <= 0 or abs(z) <= elastic:
            alpha = 0.0
        elif abs(z) < zss:
            alpha = 0.5 * math.sin(math.pi * (abs(z) - (zss + elastic) / 2) / (zss - elastic)) + 0.5
    rate = v - alpha * abs(v) * z * s0 / g
    damping = 2 * m.damping_ratio * math.sqrt(s0 * sliding) if m.friction != "dahl" else 0.0
    return rate, s0 * z + damping * rate


def rates(m, y, u):
    """dy/dt of [x_d, v_d, x_l, v_l, currents (3), states of the contact]."""
    xd, vd, xl, vl = y[:4]
    dy = np.zeros(len(y))
    load = (1 - m.motor_part) * m.mass if m.shaft else 0.0
    driven = m.mass - load
    v = vl if m.shaft else vd
    rub = m.viscous * v
    if m.friction == "maxwell_slip":
        for k, (stiffness, level) in enumerate(m.elements):
            z = min(max(y[7 + k], -level / stiffness), level / stiffness)
            dy[7 + k] = v if stiffness * abs(z) < level or z * v < 0 else 0.0
            rub += stiffness * z
    else:
        dy[7], force = bristle(m, load or driven, v, y[7])
        rub += force
    if m.model == "force":
        drive = m.force_constant * u[0]
    elif m.model == "dc":
        drive = m.force_constant * y[4]
        dy[4] = (u[0] - m.resistance * y[4] - m.emf * vd) / m.inductance
    else:
        drive, star = 0.0, sum(u) / 3
        for k in range(3):
            s = math.sin(2 * math.pi * xd / m.pitch + 2 * math.pi * k / 3)
            drive += m.force_constant * 2 / 3 * y[4 + k] * s
            dy[4 + k] = (u[k] - star - m.emf * vd * s - m.resistance * y[4 + k]) / (m.inductance - m.mutual)
    if m.shaft:
        damping = 2 * m.shaft_damping_ratio * math.sqrt(m.shaft * driven * load / m.mass)
        through = m.shaft * (xd - xl) + damping * (vd - vl)
        dy[1], dy[3] = (drive - through) / driven, (through - rub) / load
    else:
        dy[1] = dy[3] = (drive - rub) / driven
    dy[0], dy[2] = vd, vl
    return dy


def closed_loop(m, sets, method):
    """Positions of the measured body at each tick, without steps of the encoder."""
    c, memory, u = m.control(), np.zeros(law.MEMORY), np.zeros(3)
    c[law.POSITION_INCREMENT] = 0.0
    dead = round(m.dead_time / machines.TICK)
    y = np.zeros(7 + max(1, len(m.elements)))
    y[0] = y[2] = sets[0, 0]
    waiting, out = [np.zeros(3)] * dead, []
    least = 1e-9 * np.array([1e-6, 1e-4, 1e-6, 1e-4, 1e-3, 1e-3, 1e-3] + [1e-6] * (len(y) - 7))
    for k, (x_set, v_set, a_set) in enumerate(sets):
        on_load = m.shaft and m.encoder_on == "load"
        x, v = (y[2], y[3]) if on_load else (y[0], y[1])
        law.control(c, memory, k, x_set, v_set, a_set, shown(x, 0.0), x, v, y[4:7], 2 * math.pi / m.pitch * x, u)
        waiting.append(u.copy())
        acting = waiting.pop(0)
        out.append(x)
        done = solve_ivp(lambda t, s: rates(m, s, acting), (0, machines.TICK), y, method=method, rtol=1e-9, atol=least)
        y = done.y[:, -1]
        if m.friction == "maxwell_slip":
            for j, (stiffness, level) in enumerate(m.elements):
                y[7 + j] = min(max(y[7 + j], -level / stiffness), level / stiffness)
    return np.array(out)


def fixed_steps(m, sets, substeps):
    """The same by plant.py."""
    p, tables, on = m.plant()
    c = m.control()
    p[plant.INCREMENT] = c[law.POSITION_INCREMENT] = 0.0
    return plant.simulate((p, tables, on), c, sets, substeps=substeps)[:, plant.X]
