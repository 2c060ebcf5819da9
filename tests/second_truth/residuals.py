"""Residual force and command residual of a record against the file, and the share of an effect.

r = K_F i - (m a + friction of the file along the measured motion); s = K_F (i - i of the file's controller, current
loop and motor along the measured motion), above 0.7 Hz. Both in the zero-phase band 0 to 100 Hz (Butterworth forth and
back; Oppenheim, Schafer 2010, chapter 7). Powers are mean squares about zero, so that a constant force has a share as
well; the noise's is that of the noisy null less the noiseless one, so that no error of the analysis counts as noise.
Under dry friction rows at standstill do not count: there friction is whatever the drive pushes. SI.
"""

import math

import paths  # noqa: F401
import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt, sosfreqz

import controllers as law
import laws
import plant
from fast import compiled
from machines import TICK
from records import Record

BAND, LEAST = 100.0, 0.7  # Hz; LEAST: of the command residual alone


def low_pass(rate, corner=BAND):
    """Sections of the low-pass; none where the corner is near half of the rate."""
    return None if corner > 0.45 * rate else butter(4, corner / (rate / 2), output="sos")


def high_pass(rate):
    """Sections of the high-pass of the command residual."""
    return butter(2, LEAST / (rate / 2), "high", output="sos")


def low_passed(values, rate, corner=BAND):
    """Zero-phase low-pass; as it is where the corner is near half of the rate."""
    sos = low_pass(rate, corner)
    return values if sos is None else sosfiltfilt(
        sos, values, padlen=min(len(values) - 1, int(rate / corner * 6)))


def high_passed(values, rate):
    """Zero-phase high-pass."""
    return sosfiltfilt(high_pass(rate), values)


def banded(values, mask, rate, channel):
    """A signal as it shows in the residual of a channel, "force" or "command"; rows out of the mask do not count."""
    values = low_passed(np.where(mask, values, 0.0), rate)
    return high_passed(values, rate) if channel == "command" else values


def passed(frequencies, rate, channel):
    """Factor of a power spectrum in the band of a channel; frequencies: Hz. Forth and back, so the gain's 4th power."""
    filters = [low_pass(rate)] + ([high_pass(rate)] if channel == "command" else [])
    out = np.ones(len(frequencies))
    for sos in filters:
        if sos is not None:
            out *= np.abs(sosfreqz(sos, frequencies, fs=rate)[1]) ** 4
    return out


def derivatives(x, step):
    """Speed and acceleration by central differences of sixth order."""
    pad = np.pad(x, 3, mode="edge")
    n = len(x)
    at = lambda k: pad[3 + k:3 + k + n]
    v = (45 * (at(1) - at(-1)) - 9 * (at(2) - at(-2)) + (at(3) - at(-3))) / (60 * step)
    a = (270 * (at(1) + at(-1)) - 27 * (at(2) + at(-2)) + 2 * (at(3) + at(-3)) - 490 * x) / (180 * step**2)
    return v, a


def moving(machine, log):
    """Rows that count: under dry friction those of a noiseless record that moves as it is set to, none near a stop."""
    if machine.friction != "coulomb_viscous":
        return np.ones(len(log.t), bool)
    v = derivatives(low_passed(log.x, machine.rate, 2 * BAND), 1 / machine.rate)[0]
    fast = np.minimum(v * np.sign(log.sets[:, 1]), np.abs(log.sets[:, 1])) > 2e-5 * machine.speed
    wide = max(1, round(0.008 * machine.rate))
    return np.convolve(~fast, np.ones(2 * wide + 1), "same") < 0.5


class Motion:
    """Motion of a record in the band and the file's columns along it: contact (N), speed, acceleration."""

    def __init__(self, machine, log):
        rate = machine.rate
        x = low_passed(log.x, rate, 2 * BAND)
        self.v, self.a = derivatives(x, 1 / rate)
        p = machine.plant()[0]
        if machine.friction == "coulomb_viscous":
            self.contact = machine.coulomb * np.sign(log.sets[:, 1])
        else:
            self.contact = laws.along(p, plant.LAW_A, x, self.v)
        self.x = x


def force(machine, log, mask):
    """Residual force, N; mask: the rows that count."""
    m = Motion(machine, log)
    raw = machine.force_constant * log.i - machine.mass * m.a - m.contact - machine.viscous * m.v
    return low_passed(np.where(mask, raw, 0.0), machine.rate)


@compiled
def _replayed(p, c, sets, x, v, dead, out):
    memory, u, y = np.zeros(law.MEMORY), np.zeros(3), np.zeros(plant.STATES)
    kept = dead + 1
    volts = np.zeros((kept, 3))
    for k in range(sets.shape[0]):
        y[plant.XD], y[plant.VD] = x[k], v[k]
        command = law.control(c, memory, k, sets[k, 0], sets[k, 1], sets[k, 2], x[k], x[k], v[k],
                              y[plant.IA:plant.IC + 1], p[plant.ELECTRICAL] * x[k], u)
        volts[k % kept] = u
        acting = volts[(k + 1) % kept]
        out[k] = command if p[plant.MODEL] == plant.IDEAL else plant.amplitude(p, y)
        if p[plant.MODEL] == plant.IDEAL:
            continue
        decay = math.exp(-p[plant.RESISTANCE] / p[plant.INDUCTANCE] * c[law.TICK])
        star = (acting[0] + acting[1] + acting[2]) / 3 if p[plant.MODEL] == plant.THREE_PHASE else 0.0
        phases = 3 if p[plant.MODEL] == plant.THREE_PHASE else 1
        for j in range(phases):
            turned = math.sin(p[plant.ELECTRICAL] * (x[k] + v[k] * c[law.TICK] / 2) + j * 2 * math.pi / 3)
            emf = p[plant.EMF] * v[k] * (turned if phases == 3 else 1.0)
            final = (acting[j] - star - emf) / p[plant.RESISTANCE]
            y[plant.IA + j] = final + (y[plant.IA + j] - final) * decay


def command(machine, log, sets):
    """Command residual, N; sets: set-points at every tick. The following error is interpolated, not the position."""
    ticks = np.arange(len(sets)) * TICK
    error = CubicSpline(log.t, log.sets[:, 0] - log.x, bc_type="natural")
    inside = np.minimum(ticks, log.t[-1])
    x, v = sets[:, 0] - error(inside), sets[:, 1] - error(inside, 1)
    out = np.zeros(len(sets))
    _replayed(machine.plant()[0], machine.control(), sets, x, v, round(machine.dead_time / TICK), out)
    raw = machine.force_constant * (log.i - out[::log.every][:len(log.i)])
    return low_passed(high_passed(raw, machine.rate), machine.rate)


def power(signals, masks):
    """Mean square over the rows of all logs that count."""
    return float(np.mean(np.concatenate([s[m] for s, m in zip(signals, masks)]) ** 2))


def noiseless(machine, sets, run, skew=0.0):
    """The record of a run without sensors' noise or steps."""
    every = round(1 / machine.rate / TICK)
    i = run[:, plant.I]
    if skew:
        n = np.arange(len(i), dtype=float)
        i = np.interp(n - skew / TICK, n, i)
    i = i[::every]
    return Record(np.arange(len(i)) * every * TICK, sets[::every], run[::every, plant.SHOWN], i, every)
