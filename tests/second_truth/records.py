"""Records: what a log holds of a simulated run, with sensors and quantisers, and the CSV of docs/formats.md."""

import dataclasses

import paths  # noqa: F401
import numpy as np

import plant
from machines import TICK


@dataclasses.dataclass
class Record:
    """Rows of one log, SI: time, set-points (three columns), position, current; `every` ticks a row."""

    t: np.ndarray
    sets: np.ndarray
    x: np.ndarray
    i: np.ndarray
    every: int

    def behind(self, rows):
        """The same from this row on, its time from 0."""
        return Record(self.t[:len(self.t) - rows], self.sets[rows:], self.x[rows:], self.i[rows:], self.every)


def late(values, delay):
    """A signal of ticks as it is recorded `delay` s late; its first value before it begins."""
    if delay == 0.0:
        return values
    n = np.arange(len(values), dtype=float)
    return np.interp(n - delay / TICK, n, values)


def record(machine, sets, run, skew=0.0, current_noise=None):
    """The log of a run: the encoder's position and the current at every row. skew: s by which the current is late."""
    every = round(1 / machine.rate / TICK)
    i = late(run[:, plant.I], skew)[::every]
    if current_noise is not None:
        i = i + current_noise
        if machine.bits:
            step = 2 * machine.amperes / 2**machine.bits
            i = step * np.round(i / step)
    return Record(np.arange(len(i)) * every * TICK, sets[::every], run[::every, plant.SHOWN], i, every)


def write(log, file, machine, setpoints=True, master=None):
    """Writes the CSV; without set-points their three columns are left out. master: rad, of each row."""
    way = "rad" if machine.rotary else "m"
    names, columns = ["t[s]"], [log.t]
    formats = ["%.10g"]
    if setpoints:
        names += [f"x_set[{way}]", f"v_set[{way}/s]", f"a_set[{way}/s^2]"]
        columns += list(log.sets.T)
        formats += ["%.15g", "%.12g", "%.12g"]
    names += [f"x[{way}]", "i[A]"]
    columns += [log.x, log.i]
    formats += ["%.15g", "%.9g"]
    if master is not None:
        names.append("master[rad]")
        columns.append(master)
        formats.append("%.12g")
    line = ",".join(formats) + "\n"
    with open(file, "w", encoding="utf-8") as out:
        out.write("# amperes: peak\n" + ",".join(names) + "\n")
        out.writelines(line % row for row in zip(*(column.tolist() for column in columns)))
