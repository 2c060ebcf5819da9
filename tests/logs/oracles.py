#!/usr/bin/env python3
"""Oracles for logs, and a small sample that the plain tests judge by them.

usage: oracles.py PROGRAM [CASE...]     cases: plant, bound, contact, hundred, thousand, slow_circle (all)
  plant        the event-driven axis against scipy's solve_ivp with events
  contact      Dahl's contact against solve_ivp
  bound        weighted least squares reaches the Cramer-Rao bound of fisher.py in 200 noise draws
  hundred      a noise-free log of 100 Hz: `stiction identify` gives mass, viscous and Coulomb friction
  thousand     the same of 1 kHz, and what scipy's filtered least squares gives
  slow_circle  circles at 50 Hz, where a filtered position beside an unfiltered force makes Coulomb friction negative
Status 1 when a case fails.
"""

import pathlib
import sys
import tempfile
import types

import numpy as np
from scipy.integrate import solve_ivp
from scipy.signal import butter, sosfiltfilt

import axis as plant
import fisher
import judge
import machines
import motions
import truth

ESTIMATED = ("mass_kg", "viscous_N_s_per_m", "coulomb_N")


failures = []


def demand(condition, text):
    """Prints what a case found and expected, and keeps what is not so."""
    print(("  " if condition else "  FAILED: ") + text)
    if not condition:
        failures.append(text)


def free_mass(stiffness):
    return types.SimpleNamespace(mass=10.0, viscous=30.0, coulomb=8.0, offset=0.7, stiffness=stiffness)


def push(t):
    return 14 * np.sin(2 * np.pi * 1.1 * t) + 5 * np.sin(2 * np.pi * 3.7 * t + 1)


def march(body, end):
    """The product of this folder: a force held through each tick, at its middle."""
    mechanics, count = plant.Mechanics([body], [0.0]), round(end / plant.TICK)
    for k in range(count):
        mechanics.advance(np.array([push((k + 0.5) * plant.TICK)]))
    return mechanics.x[0], mechanics.v[0]


def by_events(body, end):
    """solve_ivp from event to event: slides until the speed is 0, rests until the force exceeds the Coulomb friction."""
    t, x, direction = 0.0, 0.0, 0
    while t < end - 1e-12:
        force = push(t) - body.offset
        if direction == 0 and abs(force) <= body.coulomb * (1 - 1e-12):
            later = np.arange(t, end, 1e-5)
            moving = np.flatnonzero(np.abs(push(later) - body.offset) > body.coulomb)
            t = later[moving[0]] if moving.size else end
            continue
        direction = direction or np.sign(force)
        slope = lambda t, y: [y[1], (push(t) - body.offset - direction * body.coulomb - body.viscous * y[1]) / body.mass]
        stop = lambda t, y: direction * y[1]
        stop.terminal, stop.direction = True, -1
        found = solve_ivp(slope, (t, end), [x, direction * 1e-12], rtol=1e-10, atol=1e-13, events=stop, max_step=0.01)
        t, x, v = found.t[-1], found.y[0, -1], found.y[1, -1]
        force = push(t) - body.offset
        direction = 0 if abs(force) <= body.coulomb else np.sign(force)
    return x, v if t >= end and found.status == 0 else 0.0


def case_plant(program):
    body = free_mass(0.0)
    for end in (0.37, 1.9, 4.0):
        x, v = march(body, end)
        x0, v0 = by_events(body, end)
        # A tick's held force is 1e-9 of the motion off; an event found 10 us late moves it by some 1e-8 m.
        demand(abs(x - x0) < 1e-6, f"position after {end} s: {x:.9f} m; solve_ivp {x0:.9f} m; at most 1 um apart")


def case_contact(program):
    body = free_mass(2e5)
    slope = lambda t, y: [y[1], (push(t) - body.offset - y[2] - body.viscous * y[1]) / body.mass,
                          body.stiffness * y[1] * (1 - y[2] / body.coulomb * np.sign(y[1]))]
    found = solve_ivp(slope, (0, 2.0), [0, 0, 0], rtol=1e-9, atol=1e-12, max_step=1e-3)
    x, _ = march(body, 2.0)
    demand(abs(x - found.y[0, -1]) < 2e-6, f"position: {x:.9f} m; solve_ivp {found.y[0, -1]:.9f} m; at most 2 um apart")


def case_bound(program):
    """Whitened least squares with the true spectrum is efficient: its scatter is the bound (200 draws: within 15 %)."""
    rng, rate, count = np.random.default_rng(3), 200.0, 2000
    body = machines.published("emps.X")
    body.increment, body.noise, body.offset = 1e-5, 0.0, 0.5
    t = np.arange(count) / rate
    phase = 2 * np.pi * 0.8 * t
    x, v, a = 0.02 * np.sin(phase), 0.02 * 5.0265 * np.cos(phase), -0.02 * 5.0265**2 * np.sin(phase)
    made = {"x_true": x, "v": v, "a": a, "f": body.coulomb * np.sign(v)}
    bounds = fisher.bounds(fisher.information(t, made, body, 0.01, 0.0))
    f = np.fft.rfftfreq(count, 1 / rate)
    noise = fisher.noise_spectrum(f, body, rate, 0.01, 0.0)
    columns = np.fft.rfft(np.stack([a, v, np.sign(v), np.ones(count)])) / np.sqrt(noise)
    columns = np.hstack([columns.real, columns.imag])
    estimates = []
    for _ in range(200):
        white = np.fft.rfft(rng.standard_normal(count)) * np.sqrt(noise)
        y = white / np.sqrt(noise)
        estimates.append(np.linalg.lstsq(columns.T, np.concatenate([y.real, y.imag]), rcond=None)[0])
    scatter = np.std(estimates, axis=0)
    for name, s, b in zip(fisher.NAMES, scatter, bounds):
        # The bound's taper gives away 5 % of the record at most, the scatter of 200 draws is known to 5 %.
        demand(0.85 < s / b < 1.15, f"{name}: scatter {s:.4g}, bound {b:.4g}")


def noise_free(rate, kind, index=1):
    """A record of an EMPS-like axis without any noise, encoder of 1 nm, with set-points."""
    record = truth.draw_record(40 + index, ("emps.X", rate, 1e-9), index, kind=kind, law="coulomb", duration=8.0, set_points=True)
    record.effort_noise, record.axis.force_noise, record.axis.noise = 0.0, 0.0, 0.0
    return record


def slow(frequency, amplitude, rate):
    record = noise_free(rate, "circle")
    record.motion = motions.Sines(0.0, [amplitude], [frequency], [0.3], 12.0)
    record.ticks = truth.sample_ticks(np.random.default_rng(0), rate, 12.0)
    record.name = f"circle-{frequency}Hz-at-{rate}Hz"
    return record


def judge_estimates(row, tolerance, what):
    if row["status"]:
        return demand(False, f"{what}: {row['message']}")
    for name in ESTIMATED:
        p = row["parameters"][name]
        given = "nothing" if p["value"] is None else f"{p['value']:.5g}"
        off = None if p["value"] is None else abs(p["value"] / p["true"] - 1)
        demand(off is not None and off <= tolerance[name],
               f"{what}: {name} {given}; true {p['true']:.5g}, within {100 * tolerance[name]:.2g} %")


def filtered_least_squares(record, cutoff):
    """The textbook's inverse dynamics: every column through one zero-phase filter, rows at rest left out."""
    t, x, volts = record.t, record.log["x[m]"], record.log["u[V]"]
    # A voltage is held for the period after its sample: the force around the sample is the mean of it and the last one.
    force = (volts + np.concatenate([volts[:1], volts[:-1]])) / 2 * record.axis.force_constant
    filter_ = lambda y: sosfiltfilt(butter(4, cutoff, fs=1 / (t[1] - t[0]), output="sos"), y)
    v, a = fisher.reconstruction(t, x)
    moving = np.abs(v) > 2e-3
    columns = np.column_stack([filter_(c) for c in (a, v, np.where(moving, np.sign(v), record.truth["f"] / record.axis.coulomb), np.ones_like(t))])
    return np.linalg.lstsq(columns[20:-20], filter_(force)[20:-20], rcond=None)[0]


def tolerance_of(record, facts):
    """What the theory permits on a noise-free log: four bounds (what the samples do not tell is all the noise there
    is), and beside them what a force half a control period late makes of the viscous friction, since the voltage is
    held for 1 ms after its sample: m * 0.5 ms * <a^2>/<v^2>. At least 1 %."""
    truth_ = record.truth
    late = record.axis.mass * 0.5e-3 * np.mean(truth_["a"] ** 2) / np.mean(truth_["v"] ** 2) / record.axis.viscous
    extra = {"mass_kg": 0.0, "viscous_N_s_per_m": 1.5 * late, "coulomb_N": 0.0}
    parameters = facts["parameters"]
    return {name: max(0.01, 4 * parameters[name]["bound"] / parameters[name]["true"]) + extra[name] for name in ESTIMATED}


def run_records(program, records, what, with_scipy=False):
    with tempfile.TemporaryDirectory() as folder:
        for record in truth.run(records):
            facts = truth.write(record, folder)
            if with_scipy:
                values = filtered_least_squares(record, 40.0)
                for name, value in zip(ESTIMATED, values):
                    true = facts["parameters"][name]["true"]
                    demand(abs(value / true - 1) < 0.01,
                           f"{record.name}: scipy's filtered least squares gives {name} {value:.5g}; true {true:.5g}")
            judge_estimates(judge.identify(program, facts), tolerance_of(record, facts), f"{record.name}, {what}")


def case_hundred(program):
    run_records(program, [noise_free(100, "multisine"), noise_free(100, "speeds", 2)], "noise-free, 100 Hz")


def case_thousand(program):
    run_records(program, [noise_free(1000, "multisine"), noise_free(1000, "speeds", 2)], "noise-free, 1 kHz", True)


def case_slow_circle(program):
    run_records(program, [slow(2.0, 0.005, 50), slow(1.0, 0.01, 50)], "50 Hz")


CASES = {"plant": case_plant, "contact": case_contact, "bound": case_bound, "hundred": case_hundred,
         "thousand": case_thousand, "slow_circle": case_slow_circle}


def main():
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= set(CASES):
        sys.exit(__doc__)
    failed = []
    for name in sys.argv[2:] or CASES:
        print(f"{name}:")
        before = len(failures)
        CASES[name](str(pathlib.Path(sys.argv[1])))
        if len(failures) > before:
            failed.append(name)
    print(f"failed: {', '.join(failed)}" if failed else "all cases passed")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
