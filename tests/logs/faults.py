"""What users' logs have wrong: each fault is made on a sound record, as it arises in practice."""

import numpy as np

FAULTS = ("none", "rms", "millimetres", "sign", "shift", "forward", "backward", "saturated", "gap", "inject")
QUESTIONS = {"rms": "amperes", "millimetres": "length", "sign": "sign", "shift": "shift"}  # what has to be asked


def arises(record):
    """Volts are not logged as rms values."""
    return record.fault != "rms" or record.axis.effort == "i"


def test_signal(rng, axis, rate):
    """A known test signal at the controller's output: eleven sines of a third of the Coulomb friction, up to 60 Hz or a
    fifth of the log's rate, above which the log's samples would not tell the signal."""
    last = min(60.0, 0.2 * rate)
    frequencies = np.geomspace(min(3.0, last / 4), last, 11) * rng.uniform(0.9, 1.0)
    phases = rng.uniform(0, 2 * np.pi, 11)
    size = axis.coulomb / axis.force_constant / 3 * np.sqrt(2 / 11)
    return lambda t: size * np.sin(2 * np.pi * np.outer(t, frequencies) + phases).sum(axis=1)


def before(record, rng):
    """What happens on the machine, before it is simulated."""
    axis = record.axis
    if record.fault == "inject":
        record.inject, record.set_points = test_signal(rng, axis, record.cell[1]), True
    elif record.fault == "saturated":  # a limit below the largest demand
        x, v, a = record.motion(np.arange(0, record.motion.duration, 1e-3))
        demand = np.abs(axis.mass * a + axis.viscous * v + axis.coulomb * np.sign(v)).max() / axis.force_constant
        axis.limit = round(0.8 * demand, 3)
    elif record.fault == "shift":
        record.shift = rng.choice([-1, 1]) * rng.uniform(5e-3, 12e-3)


def after(record, rng):
    """What happens on the way into the log."""
    log, effort = record.log, "i[A]" if record.axis.effort == "i" else "u[V]"
    if record.fault == "rms":
        log[effort] = log[effort] / np.sqrt(2) * (1 + rng.uniform(-0.001, 0.001))
    elif record.fault == "millimetres":
        for header in {"x[m]", "x_set[m]", "v[m/s]"} & set(log):
            log[header] = log[header] * 1e3
    elif record.fault == "sign":
        log[effort] = -log[effort]
    elif record.fault == "shift":  # the effort's channel is late (or the position's, where the shift is negative)
        period = np.median(np.diff(record.t))
        steps = int(np.sign(record.shift) * max(1, np.ceil(abs(record.shift) / period)))
        n = abs(steps)
        for late in {effort} if steps > 0 else {"x[m]", "v[m/s]"} & set(log):
            log[late] = np.concatenate([np.full(n, log[late][0]), log[late][:-n]])
        record.shift = steps * period
    elif record.fault == "gap":  # two stretches are missing, as after a full buffer
        for at in (0.3, 0.65):
            first = int((at + rng.uniform(-0.05, 0.05)) * len(record.t))
            record.rows[first:first + max(5, int(rng.uniform(0.1, 0.6) / np.median(np.diff(record.t))))] = False
        edges = np.flatnonzero(np.diff(np.concatenate([[0], record.rows.astype(int), [0]])))
        longest = np.argmax(edges[1::2] - edges[::2])
        record.clean[:] = False
        record.clean[edges[2 * longest]:edges[2 * longest + 1]] = True
    elif record.fault == "inject":
        log["i_inject[A]" if effort == "i[A]" else "u_inject[V]"] = record.truth["inject"]
    elif record.fault == "saturated":  # with what lies 20 ms, and two samples, around
        reach = 2 + int(0.02 / np.median(np.diff(record.t)))
        limited = np.abs(record.truth["effort"]) > 0.98 * record.axis.limit
        record.clean = np.convolve(limited, np.ones(2 * reach + 1), "same") < 0.5
