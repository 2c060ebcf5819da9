"""Set-points in closed form: position, speed and acceleration at each tick, all exact.

Source of the sin^2 profile: Biagiotti, Melchiorri 2008, chapter 3 (trigonometric profiles); polynomials: tests/axes.
Units: m or rad, s.
"""

import paths  # noqa: F401
import numpy as np

from setpoints import RISE

SHORTEST = 0.04  # s; least time of a change of speed, so that a record of 1 kHz holds the set-points


class Motion:
    """Set-points of one log, built piece by piece; rows of x_set, v_set, a_set, one a tick."""

    def __init__(self, tick, start):
        self.tick, self.at, self.rows, self.ticks = tick, start, [], 0
        self.rest(0.1)

    @property
    def time(self):
        """Duration so far, s."""
        return self.ticks * self.tick

    def add(self, x, v, a):
        """Appends rows; x is counted from the present position."""
        self.rows.append(np.column_stack([self.at + x, v, a]))
        self.ticks += len(x)

    def rest(self, duration):
        """Stands still."""
        n = max(1, round(duration / self.tick))
        self.add(np.zeros(n), np.zeros(n), np.zeros(n))

    def move(self, way, speed, acceleration):
        """A move whose acceleration is a peak of sin^2, with constant speed between where the way allows it."""
        if abs(way) < 1e-12:
            return
        speed = min(speed, np.sqrt(abs(way) * acceleration / 2))
        n_a = round(max(2 * speed / acceleration, SHORTEST) / self.tick)
        n_c = max(0, round((abs(way) / speed - n_a * self.tick) / self.tick))
        ramp, cruise = n_a * self.tick, n_c * self.tick
        v = way / (ramp + cruise)
        a = 2 * v / ramp
        t = np.arange(n_a) * self.tick
        up_v = a * (t / 2 - ramp / (4 * np.pi) * np.sin(2 * np.pi * t / ramp))
        up_x = a * (t**2 / 4 + ramp**2 / (8 * np.pi**2) * (np.cos(2 * np.pi * t / ramp) - 1))
        up_a = a * np.sin(np.pi * t / ramp) ** 2
        self.add(up_x, up_v, up_a)
        even = np.arange(n_c) * self.tick
        self.add(v * ramp / 2 + v * even, np.full(n_c, v), np.zeros(n_c))
        self.add(v * (ramp / 2 + cruise) + v * t - up_x, v - up_v, -up_a)
        self.at += way

    def step(self, way, duration):
        """A polynomial of seventh degree from rest to rest within a time, for reversals of a few micrometres."""
        n = max(16, round(duration / self.tick))
        duration, s = n * self.tick, np.arange(n) / n
        self.add(way * RISE(s), way / duration * RISE.deriv(1)(s), way / duration**2 * RISE.deriv(2)(s))
        self.at += way

    def oscillate(self, amplitude, frequency, periods):
        """A sine around the present position that fades in and out within a period each."""
        n = round((periods + 2) / frequency / self.tick)
        t, fade = np.arange(n) * self.tick, 1 / frequency
        total, w = n * self.tick, 2 * np.pi * frequency
        s, e = np.minimum(t / fade, 1.0), np.minimum((total - t) / fade, 1.0)
        r = RISE(s) * RISE(e)
        r1 = (RISE.deriv(1)(s) * RISE(e) - RISE(s) * RISE.deriv(1)(e)) / fade
        r2 = (RISE.deriv(2)(s) * RISE(e) - 2 * RISE.deriv(1)(s) * RISE.deriv(1)(e)
              + RISE(s) * RISE.deriv(2)(e)) / fade**2
        sin, cos = np.sin(w * t), np.cos(w * t)
        self.add(amplitude * r * sin, amplitude * (r1 * sin + r * w * cos),
                 amplitude * (r2 * sin + 2 * r1 * w * cos - r * w**2 * sin))

    def table(self):
        """All rows."""
        return np.ascontiguousarray(np.vstack(self.rows))


class Room:
    """What the axis can do: half of the stroke, largest speed and acceleration, length of its contact."""

    def __init__(self, stroke, speed, acceleration, contact):
        self.half, self.speed, self.acceleration, self.contact = stroke / 2, speed, acceleration, contact


def log_uniform(rng, low, high, size=None):
    """A number, or several, even in its logarithm."""
    return np.exp(rng.uniform(np.log(low), np.log(high), size))


def place(rng, room, motion, at_least=0.0):
    """A way from the present position to another one within the stroke."""
    for _ in range(50):
        way = rng.uniform(-0.95, 0.95) * room.half - motion.at
        if abs(way) >= at_least:
            return way
    return -1.5 * motion.at


def speeds(rng, room, motion, duration):
    """Moves forth and back at several speeds, from crawling to the largest one."""
    count = int(rng.integers(5, 8))
    low = log_uniform(rng, 0.002, 0.01)
    for ratio in rng.permutation(low ** np.linspace(0.0, 1.0, count) * rng.uniform(0.85, 1.0)):
        speed = ratio * room.speed
        way = min(speed * duration / count * rng.uniform(0.3, 0.45), rng.uniform(0.6, 0.95) * 2 * room.half)
        acceleration = room.acceleration * rng.uniform(0.2, 0.8) * max(ratio, 0.02) ** 0.3
        sign = 1.0 if motion.at + way < 0.97 * room.half else -1.0
        if abs(motion.at + sign * way) > 0.97 * room.half:
            motion.move(-motion.at - sign * 0.9 * room.half, 0.5 * room.speed, 0.3 * room.acceleration)
        motion.move(sign * way, speed, acceleration)
        motion.rest(rng.uniform(0.02, 0.2))
        motion.move(-sign * way, speed, acceleration)
        motion.rest(rng.uniform(0.02, 0.2))
        if motion.time > duration:
            break


def crawl(rng, room, motion, duration):
    """Slow constant speeds forth and back."""
    speed = room.speed * log_uniform(rng, 3e-4, 4e-3)
    way = speed * duration * rng.uniform(0.3, 0.45)
    way *= 1.0 if motion.at < 0 else -1.0
    motion.move(way, speed, 0.02 * room.acceleration)
    motion.rest(rng.uniform(0.01, 0.1))
    motion.move(-way * rng.uniform(0.5, 1.0), speed * rng.uniform(0.7, 1.4), 0.02 * room.acceleration)


def small_reversals(rng, room, motion, duration):
    """Short strokes around a place, several amplitudes from below the contact's length to many of it."""
    end = motion.time + duration
    while motion.time < end:
        amplitude = room.contact * log_uniform(rng, 0.4, 60.0)
        fastest = max(np.sqrt(7.6 * amplitude / (0.15 * room.acceleration)), 2.2 * amplitude / (0.3 * room.speed), 0.06)
        time = fastest * log_uniform(rng, 1.0, 6.0)
        for _ in range(int(rng.integers(2, 5))):
            motion.step(amplitude, time)
            motion.step(-amplitude * rng.uniform(0.5, 1.0), time)
        if rng.random() < 0.3:
            motion.rest(rng.uniform(0.05, 0.4))


def oscillation(rng, room, motion):
    """A sine of random amplitude and frequency within the room; a circle is one."""
    frequency = log_uniform(rng, 0.4, 6.0)
    w = 2 * np.pi * frequency
    most = min(0.9 * (room.half - abs(motion.at)), 0.6 * room.speed / w, 0.5 * room.acceleration / w**2)
    motion.oscillate(most * log_uniform(rng, 0.05, 1.0), frequency, int(rng.integers(2, 6)))


def accelerations(rng, room, motion, duration):
    """Moves of one length at several accelerations."""
    end = motion.time + duration
    while motion.time < end:
        acceleration = room.acceleration * log_uniform(rng, 0.08, 0.9)
        motion.move(place(rng, room, motion, 0.3 * room.half), room.speed * rng.uniform(0.3, 1.0), acceleration)
        motion.rest(rng.uniform(0.02, 0.3))


def stations(rng, room, motion, duration):
    """A production programme: stops at random places with dwells."""
    end = motion.time + duration
    while motion.time < end:
        motion.move(place(rng, room, motion), room.speed * log_uniform(rng, 0.03, 0.8),
                    room.acceleration * rng.uniform(0.15, 0.7))
        motion.rest(log_uniform(rng, 0.03, 0.8))


def record(rng, room, tick, parts):
    """One log: its parts one after the other; parts are pairs of a kind and a duration in s."""
    motion = Motion(tick, 0.0)
    for kind, duration in parts:
        if kind == "home":
            motion.move(place(rng, room, motion, 0.2 * room.half), 0.5 * room.speed, 0.4 * room.acceleration)
        elif kind == "oscillation":
            end = motion.time + duration
            while motion.time < end:
                oscillation(rng, room, motion)
                motion.rest(0.05)
        elif kind == "speeds":
            speeds(rng, room, motion, motion.time + duration)
        else:
            {"crawl": crawl, "small": small_reversals, "accelerations": accelerations,
             "stations": stations}[kind](rng, room, motion, duration)
    motion.rest(0.1)
    return motion.table()


def commissioning(rng, room, tick):
    """Two or three training logs and one or two held-out ones of other motions; lists of tables of set-points."""
    u = rng.uniform
    train = [[("home", 0), ("speeds", u(7, 11))],
             [("home", 0), ("small", u(2, 4)), ("crawl", u(2, 3)), ("home", 0), ("small", u(1, 2)), ("crawl", u(1, 3)),
              ("oscillation", u(1, 2))]]
    if rng.random() < 0.5:
        train.append([("home", 0), ("accelerations", u(3, 5)), ("oscillation", u(2, 4)), ("crawl", u(1, 2))])
    else:
        train[0].append(("accelerations", u(2, 4)))
    held = [[("stations", u(5, 8)), ("crawl", u(1, 3)), ("small", u(1, 2)), ("oscillation", u(1, 3))]]
    if rng.random() < 0.5:
        held.append([("home", 0), ("oscillation", u(2, 4)), ("small", u(2, 3)), ("stations", u(3, 6))])
    return [record(rng, room, tick, parts) for parts in train], [record(rng, room, tick, parts) for parts in held]
