"""The odds that an ideal observer has, in nats: half of the squared norm of the effect's residual after whitening.

The whitening is an autoregression of order 12 fitted to the noise (least squares over all logs; Brockwell, Davis 1991,
chapter 8), rows at 250 Hz. The file's own nuisances (constant, contact, viscous, mass) are projected out, but for those
that the cause itself is; for aliases, the best linear combination of the columns of a confusable name as well.
"""

import paths  # noqa: F401
import numpy as np

import laws
import plant
import residuals

ORDER, RATE = 12, 250.0


def thinned(values, rate):
    """Rows at 250 Hz of signals in the band, along the first axis."""
    return values[::max(1, round(rate / RATE))]


def fit(noises):
    """Coefficients of the autoregression and its innovation's variance."""
    rows, targets = [], []
    for n in noises:
        lagged = np.column_stack([n[ORDER - k:len(n) - k] for k in range(1, ORDER + 1)])
        rows.append(lagged)
        targets.append(n[ORDER:])
    a, y = np.vstack(rows), np.concatenate(targets)
    ridge = 1e-9 * np.trace(a.T @ a) / ORDER * np.eye(ORDER)
    w = np.linalg.solve(a.T @ a + ridge, a.T @ y)
    return w, float(np.mean((y - a @ w) ** 2))


def whitened(values, w):
    """The prediction error of a signal, or of the columns of a matrix."""
    out = np.array(values[ORDER:], float)
    for k in range(1, ORDER + 1):
        out -= w[k - 1] * values[ORDER - k:len(values) - k]
    return out


class Oracle:
    """Noise, nuisances and alias columns of one case; logs, masks: of the noiseless null."""

    def __init__(self, machine, session, logs, masks, noises, channel):
        self.machine, self.session, self.logs, self.masks, self.channel = machine, session, logs, masks, channel
        rate = machine.rate
        self.w, self.variance = fit([thinned(n, rate) for n in noises])
        self.counts = [thinned(m, rate)[ORDER:] for m in masks]
        self.motions = [residuals.Motion(machine, log) for log in logs]

    def column(self, parts):
        """A whitened column from one signal per log."""
        rate, out = self.machine.rate, []
        for part, mask, count in zip(parts, self.masks, self.counts):
            banded = residuals.low_passed(np.where(mask, part, 0.0), rate)
            if self.channel == "command":
                banded = residuals.high_passed(banded, rate)
            out.append(np.where(count, whitened(thinned(banded, rate), self.w), 0.0))
        return np.concatenate(out) / np.sqrt(self.variance)

    def nuisances(self, left_out):
        """The file's own directions but for those of the cause."""
        m, made = self.motions, {}
        made["constant"] = [np.ones(len(k.v)) for k in m]
        made["coulomb"] = [k.contact for k in m]
        made["viscous"] = [k.v for k in m]
        made["mass"] = [k.a for k in m]
        return [self.column(parts) for name, parts in made.items() if name not in left_out]

    def alias(self, name):
        """Columns of a set of aliases of diagnosis.md."""
        m, c = self.motions, self.machine
        over = lambda f: [f(k) for k in m]
        rate = c.rate
        drive = [c.force_constant * log.i for log in self.logs]
        slow = 0.01 * c.speed
        sets = {
            "constant": lambda: [over(lambda k: np.ones(len(k.v)))],
            "mass": lambda: [over(lambda k: k.a)],
            "force_constant": lambda: [over(lambda k: k.a), over(lambda k: k.contact), over(lambda k: k.v)],
            "stribeck": lambda: [over(lambda k, s=s: k.contact * np.exp(-(k.v / (s * slow)) ** 2))
                                 for s in (0.1, 0.4, 1.5, 6)],
            "speed_powers": lambda: [over(lambda k: k.v**3), over(lambda k: np.sign(k.v) * np.sqrt(np.abs(k.v)))],
            "delay": lambda: [[np.gradient(d) * rate for d in drive], over(lambda k: k.v),
                              over(lambda k: np.gradient(np.gradient(k.a)) * rate**2)],
            "drift": lambda: [[k.contact * log.t**n for k, log in zip(m, self.logs)] for n in (1, 2)]
            + [[k.v * log.t**n for k, log in zip(m, self.logs)] for n in (1, 2)],
            "backlash": lambda: [[np.gradient(np.gradient(np.tanh(d / c.coulomb))) * rate**2 for d in drive]],
            "presliding": self.softer,
            "position_waves": lambda: [over(lambda k, n=n, f=f: f(2 * np.pi * n * k.x / c.pitch))
                                       for n in (1, 2) for f in (np.sin, np.cos)],
        }
        return [self.column(parts) for parts in sets[name]()]

    def softer(self):
        """The file's contact at half and twice its stiffness, less itself."""
        if self.machine.friction == "coulomb_viscous":
            return []
        p, out = self.machine.plant()[0], []
        for ratio in (0.5, 2.0):
            q = p.copy()
            q[plant.LAW_A + laws.STIFFNESS] *= ratio
            for k in range(int(q[plant.LAW_A + laws.ELEMENTS])):
                q[plant.LAW_A + laws.FIRST + 2 * k] *= ratio
            out.append([laws.along(q, plant.LAW_A, k.x, k.v) - k.contact for k in self.motions])
        return out

    def nats(self, effects, left_out, further=()):
        """Half of the squared norm of an effect (one signal per log) beside the nuisances and further columns."""
        y = self.effect(effects)
        columns = self.nuisances(left_out) + list(further) if self.channel == "force" else list(further)
        if columns:
            basis = np.column_stack(columns)
            basis = basis / np.maximum(np.linalg.norm(basis, axis=0), 1e-300)
            u, s, _ = np.linalg.svd(basis, full_matrices=False)
            u = u[:, s > 1e-8 * s[0]]
            y = y - u @ (u.T @ y)
        return float(0.5 * np.dot(y, y))

    def effect(self, effects):
        """An effect that is in the band already, whitened."""
        rate, out = self.machine.rate, []
        for part, count in zip(effects, self.counts):
            out.append(np.where(count, whitened(thinned(part, rate), self.w), 0.0))
        return np.concatenate(out) / np.sqrt(self.variance)
