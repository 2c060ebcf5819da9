"""The same closed loop with LSODA between the samples, borders found on its dense output.

Source: Petzold 1983, as scipy.integrate has it. It shares the equations (plants,
controllers, encoders) with simulate.py, and none of its steps.
"""

import numpy as np
from scipy.integrate import LSODA

import plants
from controllers import MEMORY, control
from encoders import BODY, DELAY, INCREMENT, POSITION, SECOND, VELOCITY, shown
from plants import ELECTRICAL, IA, MODES, QL, QM, STATES, VL, VM
from simulate import COLUMNS


def any_broken(p, y, u, mode):
    """Number of the first border that is passed, or -1."""
    return next((event for event in range(3) if plants.broken(p, y, u, mode, event)), -1)


def advance(p, y, u, mode, duration, rtol, atol):
    """The state after `duration` s of constant u."""
    def slope(t, state):
        dy = np.empty(STATES)
        plants.derivative(p, state, u, mode, dy)
        return dy

    start, borders = 0.0, 0
    while start < duration:
        solver = LSODA(slope, start, y, duration, rtol=rtol, atol=atol)
        while solver.status == "running" and any_broken(p, solver.y, u, mode) < 0:
            message = solver.step()
        if solver.status == "failed":
            raise ArithmeticError(message)
        if any_broken(p, solver.y, u, mode) < 0:
            return solver.y
        if solver.t == start:
            end = y.copy()  # at the border from the beginning
        else:
            path, low, high = solver.dense_output(), solver.t_old, solver.t
            while low < (low + high) / 2 < high:
                middle = (low + high) / 2
                low, high = (low, middle) if any_broken(p, path(middle), u, mode) >= 0 else (middle, high)
            start, end = high, path(high) if high < solver.t else solver.y.copy()
        borders += 1
        if borders > 40:
            raise ArithmeticError("found 40 borders in a sample; expected a few")
        plants.switch(p, end, u, mode, max(any_broken(p, end, u, mode), 0))
        y = end
    return y


def simulate(machine, sets, rtol=1e-13, atol=1e-18):
    """As simulate.simulate, without encoders that lag by other than whole ticks."""
    p, c, ticks = machine.plant, machine.control, machine.encoders(1)
    y, mode, memory = machine.rest(sets[0, 0]), np.zeros(MODES, np.int64), np.zeros(MEMORY)
    past, sent, table = [], [], np.zeros((len(sets), len(COLUMNS)))
    for k, (x_set, v_set, a_set) in enumerate(np.ascontiguousarray(sets, float)):
        past.append(y)
        then = [past[max(0, k - int(row[DELAY]))] for row in ticks]
        place = [shown(s[QM] if row[BODY] == 1 else s[QL], row[INCREMENT]) for s, row in zip(then, ticks)]
        true_speed = then[VELOCITY][VM] if ticks[VELOCITY, BODY] == 1 else then[VELOCITY][VL]
        u = np.zeros(3)
        command = control(c, memory, k, x_set, v_set, a_set, place[POSITION], place[VELOCITY], true_speed,
                          y[IA:IA + 3].copy(), p[ELECTRICAL] * place[VELOCITY], u)
        sent.append(u)
        acting = sent[k - machine.dead_ticks] if k >= machine.dead_ticks else np.zeros(3)
        plants.begin(p, y, acting, mode)
        table[k] = (x_set, v_set, a_set, place[POSITION], place[SECOND], command, acting[0], y[IA], y[QL], y[VL], y[QM],
                    y[VM], plants.drive_force(p, y, acting))
        y = advance(p, y, acting, mode, machine.tick, rtol, atol)
    return dict(zip(COLUMNS, table.T))
