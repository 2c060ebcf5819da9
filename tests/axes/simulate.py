"""The oracle: Runge and Kutta's classical fourth-order rule with N equal sub-steps a tick, borders located by bisection.

Source: Hairer, Norsett, Wanner 1993, sections II.1 (rule)
and II.6 (discontinuities are located, the integration restarts there).
"""

import numpy as np

import plants
from controllers import MEMORY, TICK, control
from encoders import BODY, DELAY, INCREMENT, POSITION, SECOND, VELOCITY, shown
from jit import compiled
from plants import ELECTRICAL, IA, IC, MODES, QL, QM, STATES, VL, VM

COLUMNS = ("x_set", "v_set", "a_set", "x", "x_load", "command", "u", "i", "q_load", "v_load", "q_motor", "v_motor", "force")
BISECTIONS = 60
MOST_BORDERS = 40  # in a sub-step; beyond it the sub-step is taken as it is


@compiled
def runge_kutta(p, y, u, mode, h, out, work):
    """One step of length h from y into out; work: 5 rows of the state's size."""
    plants.derivative(p, y, u, mode, work[0])
    for j in range(STATES):
        work[4, j] = y[j] + h / 2 * work[0, j]
    plants.derivative(p, work[4], u, mode, work[1])
    for j in range(STATES):
        work[4, j] = y[j] + h / 2 * work[1, j]
    plants.derivative(p, work[4], u, mode, work[2])
    for j in range(STATES):
        work[4, j] = y[j] + h * work[2, j]
    plants.derivative(p, work[4], u, mode, work[3])
    for j in range(STATES):
        out[j] = y[j] + h / 6 * (work[0, j] + 2 * work[1, j] + 2 * work[2, j] + work[3, j])


@compiled
def any_broken(p, y, u, mode):
    """Whether any border is passed."""
    return plants.broken(p, y, u, mode, 0) or plants.broken(p, y, u, mode, 1) or plants.broken(p, y, u, mode, 2)


@compiled
def advance(p, y, u, mode, h, out, work):
    """Moves y by h, from border to border."""
    rest = h
    for _ in range(MOST_BORDERS):
        runge_kutta(p, y, u, mode, rest, out, work)
        if not any_broken(p, out, u, mode):
            y[:] = out
            return
        low, high = 0.0, rest
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            if middle == low or middle == high:
                break
            runge_kutta(p, y, u, mode, middle, out, work)
            if any_broken(p, out, u, mode):
                high = middle
            else:
                low = middle
        runge_kutta(p, y, u, mode, high, out, work)
        first = -1
        for event in range(3):
            if first < 0 and plants.broken(p, out, u, mode, event):
                first = event
        y[:] = out
        rest -= high
        if first >= 0:
            plants.switch(p, y, u, mode, first)
        if rest <= 0.0:
            return
    runge_kutta(p, y, u, mode, rest, out, work)
    y[:] = out


@compiled
def run(p, c, encoders, y, sets, substeps, dead, table):
    """Fills the table: a row a tick with COLUMNS; y is the state at the start, and after it the one at the end."""
    work, out = np.zeros((5, STATES)), np.zeros(STATES)
    mode, memory = np.zeros(MODES, np.int64), np.zeros(MEMORY)
    u, volts = np.zeros(3), np.zeros((dead + 1, 3))
    depth = int(encoders[:, DELAY].max()) + 1
    past = np.zeros((depth, STATES))
    for j in range(depth):
        past[j] = y
    now, h = 0, c[TICK] / substeps
    for k in range(sets.shape[0]):
        seen = np.zeros((3, 2))
        for e in range(3):
            then = past[(now - int(encoders[e, DELAY])) % depth]
            motor = encoders[e, BODY] == 1.0
            seen[e, 0] = shown(then[QM] if motor else then[QL], encoders[e, INCREMENT])
            seen[e, 1] = then[VM] if motor else then[VL]
        command = control(c, memory, k, sets[k, 0], sets[k, 1], sets[k, 2], seen[POSITION, 0], seen[VELOCITY, 0],
                          seen[VELOCITY, 1], y[IA:IC + 1], p[ELECTRICAL] * seen[VELOCITY, 0], u)
        volts[k % (dead + 1)] = u
        acting = volts[(k + 1) % (dead + 1)]  # the one of `dead` ticks ago; 0 V before the first
        plants.begin(p, y, acting, mode)
        table[k, 0:3] = sets[k]
        table[k, 3], table[k, 4], table[k, 5], table[k, 6] = seen[POSITION, 0], seen[SECOND, 0], command, acting[0]
        table[k, 7] = y[IA]
        table[k, 8], table[k, 9], table[k, 10], table[k, 11] = y[QL], y[VL], y[QM], y[VM]
        table[k, 12] = plants.drive_force(p, y, acting)
        for _ in range(substeps):
            advance(p, y, acting, mode, h, out, work)
            now = (now + 1) % depth
            past[now] = y


def simulate(machine, sets, substeps=None):
    """Runs the closed loop of a machine (machine.Machine) over set-points, rows of x_set, v_set, a_set, one a tick.

    Returns a dictionary of COLUMNS: positions in m or rad at the load's coordinate, force there in N or N m.
    """
    substeps = substeps or machine.substeps
    y = machine.rest(sets[0, 0])
    table = np.zeros((len(sets), len(COLUMNS)))
    run(machine.plant, machine.control, machine.encoders(substeps), y, np.ascontiguousarray(sets, float), substeps,
        machine.dead_ticks, table)
    return dict(zip(COLUMNS, table.T))
