"""The odds that an ideal observer has, in nats: half of the squared norm of the effect's residual after whitening.

With the covariance C of the noise, y' C^-1 y / 2 is the expected logarithm of the likelihood ratio of a known effect y
against none (Kay 1998, chapter 4). The observer knows the noise as spectra.py does and whitens the rows at 250 Hz that
count as whitening.py does; selftest.py holds the spread of (W y).(W n) over fresh noise n against |W y|. A level of the
noise is the same for all frequencies: where the encoder's noise in the file's contact prevails among slow noise, as it
may with a short contact under a coarse encoder, effects along the contact have fewer nats than this (on two of twelve
machines, by a factor of 2 to 8), and so they have where dry friction seldom holds an axis that crawls. The file's own
nuisances (constant, contact, viscous, mass) are projected out, but for those that the cause itself is; for aliases, the
best linear combination of the columns of a confusable name as well.
"""

import paths  # noqa: F401
import numpy as np

import laws
import plant
import residuals
import spectra
import whitening
from spectra import thinned

# s at each end of a residual in which its filters still feel that the record ends, and let through noise that they hold
# back elsewhere: they fade as e^(-240 t) in the force and as e^(-3.1 t) in the command.
EDGE = {"force": 0.04, "command": 2.0}


class Oracle:
    """Noise, nuisances and alias columns of one case.

    noise: Noise; logs, masks: of the noiseless null; noises, parts: as spectra.known has them, at the record's rate."""

    def __init__(self, machine, noise, channel, logs, masks, noises, parts):
        self.machine, self.logs, self.masks, self.channel = machine, logs, masks, channel
        rate = machine.rate
        counts = [thinned(m, rate).copy() for m in masks]
        edge = round(EDGE[channel] * spectra.RATE)
        for count in counts:
            count[:edge] = count[-edge:] = False
        sets = [thinned(log.sets.T, rate).T for log in logs]
        covariance, weights = spectra.known(machine, noise, channel, sets, counts,
                                            *([thinned(n, rate) for n in part] for part in (noises, parts)))
        table = whitening.predictors(covariance)
        self.whitenings = [whitening.Whitening(table, c, w) for c, w in zip(counts, weights)]
        self.motions = [residuals.Motion(machine, log) for log in logs]

    def whitened(self, effects):
        """Signals in the band already, one per log, whitened."""
        return [w(thinned(part, self.machine.rate)) for w, part in zip(self.whitenings, effects)]

    def effect(self, effects):
        """The same as one column."""
        return np.concatenate(self.whitened(effects))

    def column(self, parts):
        """A whitened column from one signal per log."""
        return self.effect([residuals.banded(part, mask, self.machine.rate, self.channel)
                            for part, mask in zip(parts, self.masks)])

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

    def beside(self, effects, left_out, further=()):
        """An effect (one signal per log), whitened, less its best fit by the nuisances and further columns."""
        y = self.effect(effects)
        columns = self.nuisances(left_out) + list(further) if self.channel == "force" else list(further)
        if columns:
            basis = np.column_stack(columns)
            basis = basis / np.maximum(np.linalg.norm(basis, axis=0), 1e-300)
            u, s, _ = np.linalg.svd(basis, full_matrices=False)
            u = u[:, s > 1e-8 * s[0]]
            y = y - u @ (u.T @ y)
        return y

    def nats(self, effects, left_out, further=()):
        """Half of its squared norm."""
        y = self.beside(effects, left_out, further)
        return float(0.5 * np.dot(y, y))
