"""Many axes at once, from the textbook: rigid mass, friction, cascade sampled at its periods, winding with its
resistance and inductance. Double precision; not the drive's code, nor the simulator's.

Rigid Coulomb friction is solved by events: inside of a tick of constant force the speed is an exponential, its zero is
found in closed form, and there the mass sticks or goes back. A contact with stiffness is Dahl's, over displacement
(trapezoidal rule), where time does not occur.
"""

import numpy as np
from scipy.signal import bilinear, lfilter

TICK = 62.5e-6
SLOW = 16  # ticks of a period of the position controller
CHUNK = 2048


def limited(values, limit):
    """np.clip to both sides of zero; at this size clip itself takes five times as long."""
    return np.minimum(np.maximum(values, -limit), limit)


def notch_of(axis):
    """b, a of (3.19), bilinear with the frequency kept."""
    if not axis.notch:
        return np.array([1.0, 0, 0]), np.array([1.0, 0, 0])
    frequency, numerator, denominator = axis.notch
    omega = 2 / TICK * np.tan(np.pi * frequency * TICK)
    return bilinear([1 / omega**2, 2 * numerator / omega, 1], [1 / omega**2, 2 * denominator / omega, 1], 1 / TICK)


class Mechanics:
    """Mass, viscous friction, offset, and Coulomb friction that is set-valued or Dahl's."""

    def __init__(self, axes, x0):
        get = lambda key: np.array([getattr(a, key) for a in axes], float)
        self.m, self.c, self.level, self.offset = get("mass"), get("viscous"), get("coulomb"), get("offset")
        self.stiffness = get("stiffness")
        self.rigid = not self.stiffness.any()
        self.rate = self.c / self.m
        self.g1 = (1 - np.exp(-self.rate * TICK)) / self.rate
        self.g2 = (TICK - self.g1) / self.rate
        self.x, self.v = np.array(x0, float), np.zeros(len(axes))
        self.f = np.zeros(len(axes))  # Coulomb part of the friction force

    def acceleration(self, force):
        """At this instant, for the record of truth."""
        return (force - self.offset - self.f - self.c * self.v) / self.m

    def advance(self, force):
        (self.slide if self.rigid else self.creep)(force - self.offset)

    def slide(self, force):
        x, v = self.x, self.v
        moves = v != 0
        sign = np.where(moves, np.sign(v), np.sign(force))
        a = (force - sign * self.level - self.c * v) / self.m
        stuck = ~moves & (np.abs(force) <= self.level)
        a[stuck] = 0.0
        v1 = v + a * self.g1
        x1 = x + v * TICK + a * self.g2
        crossed = np.flatnonzero(v1 * sign < 0)
        if crossed.size:
            self.turn(crossed, force, sign, a, x1, v1)
        self.x, self.v = x1, v1
        self.f = np.where(v1 != 0, np.sign(v1) * self.level, limited(force, self.level))

    def turn(self, k, force, sign, a, x1, v1):
        """Where the speed becomes zero inside of the tick: sticks there, or goes back for the rest of the tick."""
        v, rate = self.v[k], self.rate[k]
        when = -np.log1p(rate * v / a[k]) / rate
        g1 = -np.expm1(-rate * when) / rate
        at = self.x[k] + v * when + a[k] * (when - g1) / rate
        back = np.where(np.abs(force[k]) > self.level[k], (force[k] + sign[k] * self.level[k]) / self.m[k], 0.0)
        rest = TICK - when
        v1[k], x1[k] = back * rest, at + back * rest**2 / 2

    def creep(self, force):
        x, v, f = self.x, self.v, self.f
        a = (force - f - self.c * v) / self.m
        for _ in range(2):
            d = v * TICK + a * self.g2
            u = self.stiffness * d
            w = np.abs(u) / (2 * self.level)
            f1 = (f * (1 - w) + u) / (1 + w)
            a = (force - (f + f1) / 2 - self.c * v) / self.m
        self.x, self.v, self.f = x + v * TICK + a * self.g2, v + a * self.g1, f1


class CurrentCascade:
    """P position, PI velocity with notch and feedforwards, PI current, dead time, winding."""

    def __init__(self, axes):
        get = lambda key: np.array([getattr(a, key) for a in axes], float)
        self.kv, self.q, self.kp, self.tn = get("position_gain"), get("position_increment"), get("velocity_gain"), get("integral_time")
        self.ki, self.ti, self.limit = get("current_gain"), get("current_integral_time"), get("limit")
        self.kf, count = get("force_constant"), get("count")
        self.feed = np.array([a.file["mass"] for a in axes]) / self.kf
        self.r, self.emf = get("resistance") / count, get("emf")
        self.decay = np.exp(-TICK * get("resistance") / get("inductance"))
        taps = [notch_of(a) for a in axes]
        self.b, self.a = np.array([t[0] for t in taps]).T, np.array([t[1] for t in taps]).T
        zero = lambda: np.zeros(len(axes))
        self.held, self.sum, self.current_sum, self.s1, self.s2, self.i = (zero() for _ in range(6))
        self.volts = [zero() for _ in range(axes[0].dead_ticks)]

    def act(self, tick, x_set, v_set, a_set, encoder, v, inject):
        if tick % SLOW == 0:
            self.held = self.q * np.rint((x_set - encoder) / self.q)
        error = self.kv * self.held + v_set - v
        total = self.sum + error * (TICK / self.tn)
        y = self.kp * (error + total)
        out = self.b[0] * y + self.s1
        self.s1 = self.b[1] * y - self.a[1] * out + self.s2
        self.s2 = self.b[2] * y - self.a[2] * out
        wanted = out + self.feed * a_set + inject
        i_set = limited(wanted, self.limit)
        self.sum = np.where(i_set == wanted, total, self.sum)
        error = i_set - self.i
        self.current_sum += error * (TICK / self.ti)
        self.volts.append(limited(self.ki * (error + self.current_sum), 600.0))
        u = self.volts.pop(0)
        before = self.i
        self.i = before * self.decay + (u - self.emf * v) / self.r * (1 - self.decay)
        return before, self.kf * before, self.kf * (before + self.i) / 2


class VoltageCascade:
    """The EMPS controller: P position, P velocity each millisecond, speed from means of two samples, ideal force."""

    def __init__(self, axes):
        get = lambda key: np.array([getattr(a, key) for a in axes], float)
        self.kv, self.kp, self.kf, self.limit = get("position_gain"), get("velocity_gain"), get("force_constant"), get("limit")
        self.ideal = np.array([a.velocity == "ideal" for a in axes])
        self.u, self.last, self.mean = np.zeros(len(axes)), None, None

    def act(self, tick, x_set, v_set, a_set, encoder, v, inject):
        if tick % SLOW == 0:
            if self.last is None:
                self.last = self.mean = encoder
            mean = (encoder + self.last) / 2
            speed = np.where(self.ideal, v, (mean - self.mean) / (SLOW * TICK))
            self.last, self.mean = encoder, mean
            u = self.kp * (self.kv * (x_set - encoder) - speed) + inject
            self.u = limited(u, self.limit)
        return self.u, self.kf * self.u, self.kf * self.u


def process_force(rng, axes, corner=100.0):
    """Chunks of a force that no model has: first-order noise below `corner` Hz, rms as each axis has it."""
    rho = np.exp(-2 * np.pi * corner * TICK)
    rms = np.array([a.force_noise for a in axes])
    state = rho * rms * rng.standard_normal((1, len(axes)))
    while True:
        drive = rng.standard_normal((CHUNK, len(axes))) * (rms * np.sqrt(1 - rho**2))
        out, state = lfilter([1.0], [1.0, -rho], drive, axis=0, zi=state)
        yield out


def simulate(rng, axes, motions, ticks, inject=None, progress=lambda text: None):
    """Records of axes of one kind of controller and friction, all at once.

    ticks: for each axis the ticks (of 62.5 us) at which its log has a sample, ascending.
    progress: is told now and then how far it is.
    inject: for each axis a function of time (test signal at the controller's output) or None.
    Returns for each axis a dictionary of arrays: x (as the encoder shows it), x_true, effort (without a sensor's noise),
    v, a, f (true speed, acceleration and Coulomb part of friction), x_set, v_set, a_set, inject.
    """
    count = len(axes)
    plant = Mechanics(axes, [m(np.zeros(1))[0][0] for m in motions])
    cascade = (CurrentCascade if axes[0].current_gain else VoltageCascade)(axes)
    increment, noise = np.array([a.increment for a in axes]), np.array([a.noise for a in axes])
    force_noise = process_force(rng, axes)
    end = 1 + max(int(t[-1]) for t in ticks)
    kept = [[] for _ in axes]
    for first in range(0, end, CHUNK):
        progress(f"{count} axes are simulated: {100 * first // end} %")
        t = (first + np.arange(CHUNK)) * TICK
        sets = np.stack([np.stack(m(t)) for m in motions], axis=-1)  # 3 x CHUNK x count
        added = np.zeros((CHUNK, count))
        for k, signal in enumerate(inject or []):
            if signal:
                added[:, k] = signal(t)
        jolts = next(force_noise)
        wobble = rng.standard_normal((CHUNK, count)) * noise
        out = np.empty((6, CHUNK, count))
        for k in range(CHUNK):
            encoder = increment * np.rint((plant.x + wobble[k]) / increment)
            now = cascade.act(first + k, sets[0, k], sets[1, k], sets[2, k], encoder, plant.v, added[k])
            out[0, k], out[1, k], out[2, k], out[4, k], out[5, k] = encoder, now[0], plant.v, plant.f, plant.x
            out[3, k] = plant.acceleration(now[1] + jolts[k])
            plant.advance(now[2] + jolts[k])
        for n in range(count):
            rows = ticks[n][(ticks[n] >= first) & (ticks[n] < first + CHUNK)] - first
            if rows.size:
                kept[n].append(np.vstack([out[:, rows, n], sets[:, rows, n], added[rows, n][None]]))
    names = ("x", "effort", "v", "a", "f", "x_true", "x_set", "v_set", "a_set", "inject")
    return [dict(zip(names, np.hstack(k))) for k in kept]
