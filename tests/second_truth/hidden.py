"""What a hidden cause may change: the plant's parameters and tables, the controller, signals over time, the record."""

import dataclasses

import paths  # noqa: F401
import numpy as np

import plant


@dataclasses.dataclass
class Session:
    """Records of one case: set-points of the training logs, then of the held-out ones, and when each began (s)."""

    sets: list
    begins: list
    trained: int
    tick: float

    def end(self):
        """When the last training log ends, s."""
        return self.begins[self.trained - 1] + len(self.sets[self.trained - 1]) * self.tick

    def motion(self, column):
        """A column of all training set-points."""
        return np.concatenate([s[:, column] for s in self.sets[:self.trained]])


class Setup:
    """A machine to be simulated, to which causes add themselves."""

    def __init__(self, machine):
        self.machine = machine
        self.p, self.tables, self.on = machine.plant()
        self.c = machine.control()
        self.skew, self.behind = 0.0, 0.0  # s: of the record's current, of the set-points behind the master
        self.forces, self.factors = [], []

    def table(self, row, values):
        """Adds values over the nodes to a table."""
        self.tables[row] += values
        self.on[row] = True

    def places(self):
        """Positions of the nodes of the tables over position."""
        return self.p[plant.X_LOW] + self.p[plant.X_STEP] * np.arange(plant.NODES)

    def speeds(self):
        """Speeds of the nodes of the tables over speed."""
        return self.p[plant.V_STEP] * np.arange(plant.NODES, dtype=float) ** 2

    def signals(self, session, log):
        """Force on the carriage and factor of the friction level at each tick of a log."""
        n = len(session.sets[log])
        t = np.arange(n) * session.tick
        outside, factor = np.zeros(n), np.ones(n)
        for signal in self.forces:
            outside += signal(log, t)
        for signal in self.factors:
            factor *= signal(log, t)
        return outside, factor


@dataclasses.dataclass
class Cause:
    """A drawn cause: its name, how it enters a Setup at a size, a first size and the range, and what truth.json says.

    accept: other names of exactly the same thing; nuisance: columns of the file that it must not be projected from;
    aliases: column sets of oracle.py; channel: where its share is measured."""

    name: str
    apply: object
    size: float
    least: float
    most: float
    shape: str
    facts: object = lambda size: {"size": size}
    accept: tuple = ()
    nuisance: tuple = ()
    aliases: tuple = ()
    channel: str = "force"
