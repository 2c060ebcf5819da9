"""Motions of a slave behind a master that turns steadily: an electronic cam, recorded while it runs.

Laws of VDI 2143 part 1, from rest to rest over a unit of the master: 3-4-5 polynomial and inclined sine. Units: m or
rad, s; the master in rad.
"""

import dataclasses

import paths  # noqa: F401
import numpy as np

SETTLED = 4.0  # s at least that a cam has run before its record begins


def polynomial(t):
    """3-4-5: way, slope and curvature over a unit of the master."""
    return (t**3 * (10 + t * (-15 + 6 * t)), 30 * t**2 * (1 - t) ** 2, 60 * t * (1 - t) * (1 - 2 * t))


def inclined_sine(t):
    """The same of the sinoid of Bestehorn."""
    w = 2 * np.pi
    return t - np.sin(w * t) / w, 1 - np.cos(w * t), w * np.sin(w * t)


@dataclasses.dataclass
class Cam:
    """Dwell, rise, dwell, return over a cycle of the master; shares of it, the way, the law of rise and return."""

    shares: np.ndarray
    start: float
    way: float
    laws: tuple

    def at(self, phase):
        """Way and its derivatives over the cycle at phases from 0 to 1."""
        ends = np.cumsum(self.shares)
        y, v, a = np.full(len(phase), self.start), np.zeros(len(phase)), np.zeros(len(phase))
        y[(phase >= ends[1]) & (phase < ends[2])] += self.way
        for part, law, base, way in ((1, self.laws[0], 0.0, self.way), (3, self.laws[1], self.way, -self.way)):
            inside = (phase >= ends[part - 1]) & (phase < ends[part])
            length = self.shares[part]
            lift, slope, curve = law((phase[inside] - ends[part - 1]) / length)
            y[inside] += base + way * lift
            v[inside], a[inside] = way * slope / length, way * curve / length**2
        return y, v, a

    def fastest(self, room):
        """The shortest cycle within the room's speed and acceleration, s."""
        _, v, a = self.at(np.linspace(0, 1, 2000, endpoint=False))
        return max(np.abs(v).max() / room.speed, np.sqrt(np.abs(a).max() / room.acceleration))


def draw(rng, room):
    """A cam within the stroke."""
    shares = rng.dirichlet([1.5, 6.0, 2.5, 6.0])
    way = rng.uniform(0.3, 0.9) * 2 * room.half * rng.choice([-1.0, 1.0])
    start = -0.5 * way + rng.uniform(-0.5, 0.5) * (0.95 * 2 * room.half - abs(way))
    return Cam(shares, start, way, tuple((polynomial, inclined_sine)[int(rng.integers(2))] for _ in range(2)))


def run(cam, period, tick, duration):
    """Set-points from rest in the first dwell on, the master's angle at each tick, and the ticks before the record."""
    before = int(np.ceil(SETTLED / period)) * period
    cycles = np.ceil(duration / period)
    t = np.arange(round((before + cycles * period) / tick)) * tick
    # The record begins anywhere in a cycle, the run in the middle of the first dwell.
    phase = (t / period + 0.5 * cam.shares[0]) % 1.0
    y, v, a = cam.at(phase)
    return np.column_stack([y, v / period, a / period**2]), 2 * np.pi * phase, round(before / tick)


def session(rng, room, tick):
    """Two training runs of one cam at different speeds of the master, and one at another: runs as of run()."""
    cam = draw(rng, room)
    fastest = cam.fastest(room)
    train = [run(cam, fastest / rng.uniform(*speeds), tick, rng.uniform(7, 11))
             for speeds in ((0.75, 0.95), (0.25, 0.5))]
    return train, [run(cam, fastest / rng.uniform(0.55, 0.7), tick, rng.uniform(6, 9))]
