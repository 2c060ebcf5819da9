"""Set-points of the records: position, speed and acceleration as functions of time, each in closed form."""

import numpy as np


def smooth_step(u):
    """0 to 1 over u in 0..1 with two continuous derivatives: value, first, second derivative over u."""
    u = np.clip(u, 0.0, 1.0)
    return u**3 * (10 + u * (6 * u - 15)), 30 * u**2 * (1 - u) ** 2, 60 * u * (1 - u) * (1 - 2 * u)


class Moves:
    """Moves from stop to stop with raised-cosine ramps of the speed; a pause before each."""

    def __init__(self, start, moves):
        """moves: list of (pause s, displacement m, speed m/s, largest acceleration m/s^2)."""
        self.start, self.pieces = start, []
        at, now = start, 0.0
        for pause, displacement, speed, acceleration in moves:
            length = abs(displacement)
            speed = min(speed, np.sqrt(2 * acceleration * length / np.pi))
            ramp = np.pi * speed / (2 * acceleration)
            now += pause
            self.pieces.append((now, at, np.sign(displacement), length, speed, ramp))
            now += length / speed + ramp
            at += displacement
        self.duration, self.end = now, at

    def __call__(self, t):
        x, v, a = np.full_like(t, self.end), np.zeros_like(t), np.zeros_like(t)
        if self.pieces:
            x[t < self.pieces[0][0]] = self.start
        for k, (begin, at, sign, length, speed, ramp) in enumerate(self.pieces):
            until = self.pieces[k + 1][0] if k + 1 < len(self.pieces) else np.inf
            rows = np.flatnonzero((t >= begin) & (t < until))
            tau, whole = t[rows] - begin, length / speed + ramp
            late = tau > whole / 2  # the second half is the first one mirrored
            s = np.clip(np.where(late, whole - tau, tau), 0.0, None)
            up, phase = s < ramp, np.pi * np.minimum(s, ramp) / ramp
            distance = speed * (np.minimum(s, ramp) / 2 - ramp / (2 * np.pi) * np.sin(phase)) + speed * np.maximum(s - ramp, 0)
            x[rows] = at + sign * np.where(late, length - distance, distance)
            v[rows] = sign * speed * (1 - np.cos(phase)) / 2
            a[rows] = sign * np.where(late, -1, 1) * np.where(up, speed * np.pi / (2 * ramp) * np.sin(phase), 0)
        return x, v, a


class Sines:
    """A sum of sines that fades in and out; one sine is the axis of a circle."""

    def __init__(self, centre, amplitudes, frequencies, phases, duration, fade=0.5):
        self.centre, self.duration, self.fade = centre, duration, fade
        self.terms = list(zip(amplitudes, frequencies, phases))
        self.gain = 1.0

    def __call__(self, t):
        w, w1, w2 = smooth_step(t / self.fade)
        o, o1, o2 = smooth_step((self.duration - t) / self.fade)
        w, w1, w2 = w * o, (w1 * o - w * o1) / self.fade, (w2 * o - 2 * w1 * o1 + w * o2) / self.fade**2
        y, y1, y2 = np.zeros_like(t), np.zeros_like(t), np.zeros_like(t)
        for amplitude, frequency, phase in self.terms:
            omega, angle = 2 * np.pi * frequency, 2 * np.pi * frequency * t + phase
            sine, cosine = self.gain * amplitude * np.sin(angle), self.gain * amplitude * np.cos(angle)
            y, y1, y2 = y + sine, y1 + omega * cosine, y2 - omega**2 * sine
        return self.centre + w * y, w1 * y + w * y1, w2 * y + 2 * w1 * y1 + w * y2


def speeds(rng, axis, duration, direction=0):
    """Constant speeds over a range of 30 to 1, out and back, or in one direction only."""
    count = int(rng.integers(4, 8))
    values = axis.max_velocity * np.geomspace(rng.uniform(0.4, 0.8), 0.02, count)
    acceleration = axis.max_acceleration * rng.uniform(0.1, 0.5)
    moves, budget = [], duration / count
    ways = (direction,) if direction else (1, -1)
    room = 0.8 * axis.travel / (count if direction else 1)
    for value in rng.permutation(values):
        length = min(room, value * 0.8 * budget / len(ways))
        moves += [(0.1 * budget / len(ways), way * length, value, acceleration) for way in ways]
    return Moves(-0.4 * axis.travel * (direction or 1), moves)


def trapezoids(rng, axis, duration):
    """Moves between drawn positions with the accelerations of positioning."""
    moves, at, now = [], 0.0, 0.0
    while now < duration:
        target = rng.uniform(-0.4, 0.4) * axis.travel
        if abs(target - at) < 0.05 * axis.travel:
            continue
        speed, acceleration = axis.max_velocity * rng.uniform(0.2, 0.9), axis.max_acceleration * rng.uniform(0.1, 0.7)
        moves.append((rng.uniform(0.02, 0.3), target - at, speed, acceleration))
        at, now = target, Moves(0.0, moves).duration
    return Moves(0.0, moves[:-1] or moves)


def within_limits(motion, axis, share):
    """Scales a sum of sines to a share of the limit that it meets first."""
    t = np.linspace(0, motion.duration, 4000)
    x, v, a = motion(t)
    motion.gain = share * min(0.45 * axis.travel / np.abs(x - motion.centre).max(), axis.max_velocity / np.abs(v).max(),
                              axis.max_acceleration / np.abs(a).max())
    return motion


def circle(rng, axis, duration):
    frequency = np.exp(rng.uniform(np.log(0.3), np.log(3.0)))
    motion = Sines(0.0, [1.0], [frequency], [rng.uniform(0, 2 * np.pi)], duration)
    return within_limits(motion, axis, rng.uniform(0.3, 0.9))


def multisine(rng, axis, duration):
    frequencies = np.exp(rng.uniform(np.log(0.2), np.log(6.0), 7))
    motion = Sines(0.0, frequencies**-1.3, frequencies, rng.uniform(0, 2 * np.pi, 7), duration)
    return within_limits(motion, axis, rng.uniform(0.4, 0.9))


KINDS = {"speeds": speeds, "trapezoids": trapezoids, "circle": circle, "multisine": multisine}
