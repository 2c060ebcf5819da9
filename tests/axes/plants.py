"""Right-hand sides of the axis, equations.md sections 1 to 6, for any integrator.

State y, SI, positions of both bodies in the load's coordinate: load position, load speed, motor position, motor speed,
bristle deflection of the load's and of the motor's friction, three currents. What changes its form at a border
(contact, direction, sticking) is in `mode`, so that the equations of one mode are smooth.
"""

import math

import numpy as np

from jit import compiled

QL, VL, QM, VM, ZL, ZM, IA, IB, IC, STATES = range(10)
CONTACT, WAY_L, WAY_M, STUCK_L, STUCK_M, MODES = range(6)
NO_FRICTION, COULOMB, RAMP, LUGRE = range(4)
IDEAL, DC, THREE_PHASE = range(3)
# A friction law: its kind, Coulomb and static level, viscous slope, Stribeck speed, bristle stiffness and damping, slope.
KIND, LEVEL, STATIC, VISCOUS, STRIBECK, BRISTLE, BRISTLE_DAMPING, SLOPE, FRICTION = range(9)
(LOAD, MOTOR, TWO, STIFFNESS, DAMPING, HALF_GAP, N, WEIGHT, MOMENT, ZERO, MODEL, FORCE, EMF, RESISTANCE, INDUCTANCE,
 ELECTRICAL) = range(16)
FRICTION_L = 16
FRICTION_M = FRICTION_L + FRICTION
PARAMETERS = FRICTION_M + FRICTION


@compiled
def friction(p, at, v, z, way):
    """Force that opposes v, and the speed of z, of the law whose parameters begin at p[at]; way: the sign of v."""
    kind = p[at + KIND]
    if kind == NO_FRICTION:
        return 0.0, 0.0
    if kind == COULOMB:
        return way * p[at + LEVEL] + p[at + VISCOUS] * v, 0.0
    if kind == RAMP:
        bend = p[at + LEVEL] / p[at + SLOPE]
        if abs(v) <= bend:
            return p[at + SLOPE] * v, 0.0
        return math.copysign(p[at + LEVEL] + (abs(v) - bend) * p[at + VISCOUS], v), 0.0
    level = p[at + LEVEL] + (p[at + STATIC] - p[at + LEVEL]) * math.exp(-(v / p[at + STRIBECK]) ** 2)
    rate = v - way * v * z * p[at + BRISTLE] / level
    return p[at + BRISTLE] * z + p[at + BRISTLE_DAMPING] * rate + p[at + VISCOUS] * v, rate


@compiled
def shaft(p, y, contact):
    """Force of the elastic shaft on the load (N or N m): dead zone, damping in contact only, never pulling."""
    twist, rate = y[QM] - y[QL], y[VM] - y[VL]
    if p[HALF_GAP] == 0.0:
        return p[STIFFNESS] * twist + p[DAMPING] * rate
    if contact == 0:
        return 0.0
    force = p[STIFFNESS] * (twist - contact * p[HALF_GAP]) + p[DAMPING] * rate
    return force if force * contact > 0.0 else 0.0


@compiled
def weight(p, y):
    """Force of gravity on the load, less what the counterweight carries: constant, or with the sine of the angle."""
    return -p[WEIGHT] - p[MOMENT] * math.sin(y[QL] - p[ZERO])


@compiled
def drive_force(p, y, u):
    """Force of the motor at the load's coordinate (N or N m); u: V of each phase, or the command of an ideal source."""
    if p[MODEL] == IDEAL:
        return p[FORCE] * u[0]
    if p[MODEL] == DC:
        if p[INDUCTANCE] == 0.0:
            return p[FORCE] * (u[0] - p[EMF] * p[N] * y[VM]) / p[RESISTANCE]
        return p[FORCE] * y[IA]
    total = 0.0
    for k in range(3):
        total += y[IA + k] * math.sin(p[ELECTRICAL] * y[QM] + k * 2 * math.pi / 3)
    return p[FORCE] * total


@compiled
def derivative(p, y, u, mode, dy):
    """Writes dy/dt into dy, for the mode that is given."""
    n = p[N]
    on_load, dy[ZL] = friction(p, FRICTION_L, y[VL], y[ZL], mode[WAY_L])
    on_motor, dy[ZM] = friction(p, FRICTION_M, n * y[VM], y[ZM], mode[WAY_M])
    force = drive_force(p, y, u)
    if p[TWO] == 0.0:
        acceleration = (force + weight(p, y) - on_load - n * on_motor) / (p[LOAD] + p[MOTOR])
        dy[VL] = dy[VM] = 0.0 if mode[STUCK_L] else acceleration
    else:
        transmitted = shaft(p, y, mode[CONTACT])
        dy[VL] = 0.0 if mode[STUCK_L] else (transmitted + weight(p, y) - on_load) / p[LOAD]
        dy[VM] = 0.0 if mode[STUCK_M] else (force - transmitted - n * on_motor) / p[MOTOR]
    dy[QL], dy[QM] = y[VL], y[VM]
    for k in range(3):
        dy[IA + k] = 0.0
    if p[MODEL] == DC and p[INDUCTANCE] > 0.0:
        dy[IA] = (u[0] - p[RESISTANCE] * y[IA] - p[EMF] * n * y[VM]) / p[INDUCTANCE]
    elif p[MODEL] == THREE_PHASE:
        star = (u[0] + u[1] + u[2]) / 3  # the star point is free, so the mean of the voltages drives no current
        for k in range(3):
            emf = p[EMF] * n * y[VM] * math.sin(p[ELECTRICAL] * y[QM] + k * 2 * math.pi / 3)
            dy[IA + k] = (u[k] - star - emf - p[RESISTANCE] * y[IA + k]) / p[INDUCTANCE]


@compiled
def pushed(p, y, u, mode, body):
    """Force on a body at rest that its Coulomb friction has to hold (N or N m), and the level up to which it can."""
    n = p[N]
    on_load = friction(p, FRICTION_L, y[VL], y[ZL], 0)[0]
    on_motor = n * friction(p, FRICTION_M, n * y[VM], y[ZM], 0)[0]
    level_l = p[FRICTION_L + STATIC] if p[FRICTION_L + KIND] == COULOMB else 0.0
    level_m = n * p[FRICTION_M + STATIC] if p[FRICTION_M + KIND] == COULOMB else 0.0
    force = drive_force(p, y, u)
    if p[TWO] == 0.0:
        return force + weight(p, y) - on_load - on_motor, level_l + level_m
    transmitted = shaft(p, y, mode[CONTACT])
    if body == 0:
        return transmitted + weight(p, y) - on_load, level_l
    return force - transmitted - on_motor, level_m


@compiled
def has_ways(p, body):
    """Whether a law of this body changes its form where its speed changes sign."""
    load, motor = p[FRICTION_L + KIND], p[FRICTION_M + KIND]
    on_load, on_motor = load == COULOMB or load == LUGRE, motor == COULOMB or motor == LUGRE
    if p[TWO] == 0.0:
        return body == 0 and (on_load or on_motor)
    return on_load if body == 0 else on_motor


@compiled
def broken(p, y, u, mode, event):
    """Whether a border is passed: event 0 the load's direction or hold, 1 the motor's, 2 the contact."""
    if event < 2:
        if not has_ways(p, event):
            return False
        if mode[STUCK_L + event]:
            force, level = pushed(p, y, u, mode, event)
            return abs(force) > level
        return mode[WAY_L + event] * y[VL + 2 * event] < 0.0
    if p[TWO] == 0.0 or p[HALF_GAP] == 0.0:
        return False
    twist = y[QM] - y[QL]
    if mode[CONTACT] == 0:
        return abs(twist) > p[HALF_GAP]
    return mode[CONTACT] * twist < p[HALF_GAP]


@compiled
def decide(p, y, u, mode, body):
    """Sets direction or hold of a body that is at rest."""
    force, level = pushed(p, y, u, mode, body)
    mode[STUCK_L + body] = 1 if level > 0.0 and abs(force) <= level else 0
    mode[WAY_L + body] = 0 if mode[STUCK_L + body] else (1 if force >= 0.0 else -1)
    if p[TWO] == 0.0:
        mode[STUCK_M], mode[WAY_M] = mode[STUCK_L], mode[WAY_L]


@compiled
def switch(p, y, u, mode, event):
    """Changes the mode at a border that was located."""
    if event == 2:
        mode[CONTACT] = 0 if mode[CONTACT] else (1 if y[QM] > y[QL] else -1)
        return
    y[VL + 2 * event] = 0.0
    if p[TWO] == 0.0:
        y[VM] = 0.0
    decide(p, y, u, mode, event)


@compiled
def begin(p, y, u, mode):
    """Sets the whole mode for a state, at the start and wherever the drive's output jumps."""
    twist = y[QM] - y[QL]
    if mode[CONTACT] == 0 and p[TWO] and p[HALF_GAP] > 0.0 and abs(twist) > p[HALF_GAP]:
        mode[CONTACT] = 1 if twist > 0.0 else -1
    for body in range(2):
        if not has_ways(p, body):
            continue
        if y[VL + 2 * body] == 0.0:
            decide(p, y, u, mode, body)
        else:
            mode[STUCK_L + body] = 0
            mode[WAY_L + body] = 1 if y[VL + 2 * body] > 0.0 else -1
            if p[TWO] == 0.0:
                mode[STUCK_M], mode[WAY_M] = 0, mode[WAY_L]


def blank():
    """Parameters of a mass of 1 on which nothing acts."""
    p = np.zeros(PARAMETERS)
    p[LOAD] = p[N] = 1.0
    return p
