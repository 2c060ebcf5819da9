"""Set-points for an axis that the programme's own experiments are not made for, within the limits of its machine file,
and records of them. `stiction simulate replay` runs them; the noise of guides and of the current's sensor is added
here."""

import csv
import math
import random

PERIOD = 1e-3  # s
# As in `stiction simulate commissioning`: force on the carriage, rms below a corner, and the recorded motor signal's.
SLOW, SLOW_CORNER = 2.5, 3.0  # N, Hz
FAST, FAST_CORNER = 2.0, 40.0  # N, Hz
SENSOR_FORCE = 2.8  # N, 0.03 A of the cross table's 94 N/A


class Limits:
    """What a record may use of travel, speed and acceleration: m, or rad of a rotary axis."""

    def __init__(self, travel, speed, acceleration, rotary):
        self.rotary = rotary
        self.amplitude = 0.18 * travel if rotary else min(0.09, 0.4 * travel)
        self.sine_speed = 0.6 * speed if rotary else min(0.6 * speed, 0.2667)
        self.speed = 0.6 * speed
        self.acceleration = 0.4 * acceleration


def sine(limits, share=1.0, laps=2.0):
    """Position, speed and acceleration of a sine whose phase starts gently: what a circle is to one axis of it."""
    amplitude = limits.amplitude * min(share, 1.0)
    rate = share * min(limits.sine_speed / amplitude, math.sqrt(limits.acceleration / amplitude))
    start = 1.0  # s until the full rate
    points, phase, time = [], 0.0, 0.0
    while phase < 2.0 * math.pi * laps:
        u = min(time / start, 1.0)
        turning = rate * u * u * (3.0 - 2.0 * u)
        growing = rate * 6.0 * u * (1.0 - u) / start
        # The phase is the integral of `turning`.
        phase = rate * (start * (u**3 - 0.5 * u**4) + max(time - start, 0.0))
        points.append((-amplitude * math.cos(phase) + amplitude, amplitude * math.sin(phase) * turning,
                       amplitude * (math.cos(phase) * turning**2 + math.sin(phase) * growing)))
        time += PERIOD
    return points


def constant_speeds(limits, speeds, stroke):
    """Each speed there and back; between them the axis is accelerated as a cosine of time."""
    points, position = [], 0.0

    def pause(duration):
        points.extend([(position, 0.0, 0.0)] * round(duration / PERIOD))

    pause(0.2)
    for speed in speeds:
        ramp = max(0.5 * math.pi * speed / limits.acceleration, 0.02)
        hold = max(min(stroke / speed, 3.0), 0.15)
        for direction in (1.0, -1.0):
            begin, time = position, 0.0
            while time < 2.0 * ramp + hold:
                if time < ramp:
                    a = 0.5 * math.pi / ramp * speed * math.sin(math.pi * time / ramp)
                    v = 0.5 * speed * (1.0 - math.cos(math.pi * time / ramp))
                    x = 0.5 * speed * (time - ramp / math.pi * math.sin(math.pi * time / ramp))
                elif time < ramp + hold:
                    a, v, x = 0.0, speed, 0.5 * speed * ramp + speed * (time - ramp)
                else:
                    left = 2.0 * ramp + hold - time
                    a = -0.5 * math.pi / ramp * speed * math.sin(math.pi * left / ramp)
                    v = 0.5 * speed * (1.0 - math.cos(math.pi * left / ramp))
                    x = speed * (ramp + hold) - 0.5 * speed * (left - ramp / math.pi * math.sin(math.pi * left / ramp))
                points.append((begin + direction * x, direction * v, direction * a))
                time += PERIOD
            position = begin + direction * speed * (ramp + hold)
            pause(0.1)
    return points


def small_reversals(amplitudes, cycles=2.0, rate=4.0):
    """Sines of 4 Hz with a few micrometres and more, each ended where it began."""
    points = []
    for amplitude in amplitudes:
        duration, turn = cycles / rate, 2.0 * math.pi * rate
        count = round(duration / PERIOD)
        for k in range(count):
            time = k * PERIOD
            # sin^2 of half the duration as envelope: position, speed and acceleration begin and end at zero.
            w = math.pi / duration
            e, de = math.sin(w * time)**2, w * math.sin(2.0 * w * time)
            dde = 2.0 * w * w * math.cos(2.0 * w * time)
            s, ds = math.sin(turn * time), turn * math.cos(turn * time)
            points.append((amplitude * e * s, amplitude * (de * s + e * ds),
                           amplitude * (dde * s + 2.0 * de * ds - e * turn * turn * s)))
        points.extend([(0.0, 0.0, 0.0)] * 50)
    return points


def commissioning(limits):
    """Those like those of `stiction simulate commissioning`, to learn from and to judge on: name, held out, points."""
    top = limits.speed
    learn = [top * share for share in (0.004, 0.012, 0.03, 0.08, 0.2, 0.45, 1.0)]
    judge = [top * share for share in (0.008, 0.02, 0.055, 0.14, 0.3, 0.7)]
    stroke = limits.amplitude
    return [("speeds", False, constant_speeds(limits, learn, stroke)),
            ("sine", False, sine(limits)),
            ("reversals", False, small_reversals([a * 1e-6 for a in (5, 10, 20, 50, 100, 200)])),
            ("other-speeds", True, constant_speeds(limits, judge, 1.2 * stroke)),
            ("other-sine", True, sine(limits, share=0.7)),
            ("other-reversals", True, small_reversals([a * 1e-6 for a in (8, 30, 80, 150, 400)], 1.5))]


def coloured(draw, rms, corner, count):
    """Gaussian noise through a low-pass of first order."""
    keep, value, noise = math.exp(-2.0 * math.pi * corner * PERIOD), 0.0, []
    for _ in range(count):
        value = keep * value + rms * math.sqrt(1.0 - keep * keep) * draw.gauss(0.0, 1.0)
        noise.append(value)
    return noise


LINEAR = ["x_set[m]", "v_set[m/s]", "a_set[m/s^2]", "x[m]", "F[N]", "F_ext[N]"]
ROTARY = ["x_set[rad]", "v_set[rad/s]", "a_set[rad/s^2]", "x[rad]", "T[N m]", "T_ext[N m]"]


def write_set_points(place, axis, points, rotary, draw=None, share=1.0):
    """A log for `simulate replay`; with `draw` there is a force on the carriage, as guides and wipers give it, `share`
    of the usual one."""
    with open(place, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        names = (ROTARY if rotary else LINEAR)[:6 if draw else 5]  # a log must have a motor's signal
        push = [0.0] * len(points)
        if draw:
            push = [a + b for a, b in zip(coloured(draw, share * SLOW, SLOW_CORNER, len(points)),
                                          coloured(draw, share * FAST, FAST_CORNER, len(points)))]
        out.writerow(["t[s]"] + [f"{axis}.{name}" for name in names])
        for k, (x, v, a) in enumerate(points):
            row = [f"{k * PERIOD:.6f}", repr(x), repr(v), repr(a), repr(x), "0"]
            out.writerow(row + ([repr(push[k])] if draw else []))


def strip(simulated, place, axis, noise, draw, every=1, set_points=True):
    """What a drive would have recorded of a simulated log: set-points, position and the motor's signal, to which noise
    (in its unit) is added; of `every` so many rows the first. The force on the carriage is nobody's knowledge."""
    with open(simulated, newline="", encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    rows = list(csv.reader(lines))
    first = 0 if set_points else 3
    channels = (*LINEAR[first:4], *ROTARY[first:4], "i[A]", "u[V]")
    wanted = ["t[s]"] + [f"{axis}.{channel}" for channel in channels]
    kept = [rows[0].index(name) for name in wanted if name in rows[0]]
    motor = [rows[0].index(name) for name in wanted[-2:] if name in rows[0]]
    with open(place, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow([rows[0][k] for k in kept])
        for row in rows[1::every]:
            for k in motor:
                row[k] = repr(float(row[k]) + noise * draw.gauss(0.0, 1.0))
            out.writerow([row[k] for k in kept])


def drawing(seed, *names):
    return random.Random("/".join(map(str, (seed, *names))))
