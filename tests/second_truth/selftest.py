#!/usr/bin/python3
"""Holds the second truth: step, LSODA and Radau, shares, the oracle's knowledge of the noise, time of a case.

usage: selftest.py [--quick]   exits with 1 where a figure is out of its bound
"""

import argparse
import sys
import time

import paths  # noqa: F401
import numpy as np
from scipy.linalg import toeplitz

import case as cases
import causes
import machines
import noise
import residuals
import spectra
import stretches
import trajectories
import whitening
from hidden import Setup

FAILED = []
EFFECTS = ("constant_force", "thermal_drift", "position_spring", "force_ripple", "structural_resonance",
           "controller_gain_mismatch")


def hold(what, value, bound):
    """Prints a figure beside its bound."""
    print(f"{'ok  ' if value <= bound else 'FAIL'} {what}: {value:.3g} (at most {bound:g})", flush=True)
    if not value <= bound:
        FAILED.append(what)


def halving(kind, seed, name):
    """Largest change of a sample of a hidden cause's noiseless logs at half of the step, in increments."""
    case, found, _, _ = cases.build(kind, seed, 0.1, name)
    setup = Setup(case.machine)
    for cause, size, _, _ in found:
        cause.apply(setup, size)
    steps = cases.usual_steps(setup)
    worst = 0.0
    for k in range(case.session.trained):
        a, b = case.run(setup, k, None, steps), case.run(setup, k, None, 2 * steps)
        worst = max(worst, np.abs(a.x - b.x).max())
    hold(f"half of the step, {'+'.join(f[0].name for f in found) or kind}, {case.machine.friction}, in increments of "
         f"{case.machine.increment:.2g}", worst / case.machine.increment, 0.1)
    return case, found


def share(case, found, asked):
    """The share, computed anew with a finer step."""
    for cause, size, _, _ in found:
        _, _, masks, noise = case.channel(cause.channel)
        power = residuals.power(case.effect(cause, size, 8), masks)
        hold(f"share of {cause.name} off by, of {asked}", abs(power / (power + noise) / asked - 1), 0.1)


def stretch(friction, seed, two, methods):
    """Small reversals over 80 ms, and the largest distance to scipy's integrators, in increments."""
    rng = np.random.default_rng([seed, 77])
    m = machines.draw(rng, rotary=False, two=two, friction=friction)
    motion = trajectories.Motion(machines.TICK, 0.0)
    motion.rows, motion.ticks = [], 0
    room = m.room()
    for way in (6.0, -4.0):
        motion.step(way * room.contact, 0.04)
    sets = motion.table()
    mine = stretches.fixed_steps(m, sets, 4 if two else 2)
    for method in methods:
        other = stretches.closed_loop(m, sets, method)
        hold(f"{method} 1e-9, {friction}{', two bodies' if two else ''}, {m.model}, in increments of {m.increment:.2g}",
             np.abs(mine - other).max() / m.increment, 0.1)


def inverse():
    """Products of whitened signals of a log with gaps against those by the inverse of its whole covariance."""
    rng = np.random.default_rng(5)
    n = 3 * whitening.MEMORY
    lags = np.arange(n) / spectra.RATE
    covariance = noise.slow_covariance(lags, 0.1) + noise.slow_covariance(lags, 10.0) + 0.1 * (lags == 0.0)
    count, weight = np.ones(n, bool), rng.uniform(1.0, 3.0, n)
    count[:20] = count[200:320] = count[700:900:3] = False
    log = whitening.Whitening(whitening.predictors(covariance), count, weight)
    signals = np.column_stack([np.ones(n), lags, np.sin(60 * lags), rng.normal(size=n)])
    whole = (toeplitz(covariance) * np.outer(weight, weight))[np.ix_(count, count)]
    wanted = signals[count].T @ np.linalg.solve(whole, signals[count])
    white = np.column_stack([log(signal) for signal in signals.T])
    scale = np.sqrt(np.outer(np.diag(wanted), np.diag(wanted)))
    off = np.abs((white.T @ white - wanted) / scale).max()
    hold("products of whitened signals against the inverse of the covariance, off by", off, 1e-3)


def matched(seed, cam, draws=24):
    """Spread of the matched filter of slow and fast effects over fresh noise, against what the nats say of it: |W y|.

    The logarithm of a spread with k degrees of freedom has an error of 1 / sqrt(2 k), three of which are let be."""
    case = cases.new_case("exact", seed, EFFECTS, 0, cam)
    nulls = case.nulls(draws, np.random.default_rng([seed, 55]))
    samples = {}
    for name in EFFECTS:
        cause = causes.CAUSES[name](case.rng_cause, case.machine, case.session)
        seer = case.seer(cause.channel)
        if cause.channel not in samples:
            noises, _ = case.samples(cause.channel, nulls)
            samples[cause.channel] = [seer.whitened(null) for null in zip(*noises)]
        y = seer.beside(case.effect(cause, cause.size), cause.nuisance)
        parts = np.split(y, np.cumsum([len(w.count) for w in seer.whitenings])[:-1])
        scores = np.array([[np.dot(n, part) / np.linalg.norm(part) for n, part in zip(null, parts)]
                           for null in samples[cause.channel]])
        spread = np.sqrt(np.mean(np.var(scores, axis=0, ddof=1)))
        hold(f"{name}, {'cam' if cam else 'linear'} {seed}, {case.machine.friction}: matched filter's spread "
             f"{spread:.2f}, logarithm off by", abs(np.log(spread)), 3 / np.sqrt(2 * (draws - 1) * len(parts)))


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    cases.build("exact", 1)  # compiles
    for k, friction in enumerate(("lugre", "dahl", "elasto_plastic", "maxwell_slip")):
        stretch(friction, 3 + k, False, ("LSODA",) if options.quick else ("LSODA", "Radau"))
    stretch("lugre", 9, True, ("LSODA",))
    inverse()
    for seed, cam in ((12, False), (23, True)) if options.quick else ((12, False), (10, False), (23, True)):
        matched(seed, cam)
    seconds = []
    names = list(causes.CAUSES)
    for k, name in enumerate(names[::5] if options.quick else names):
        case, found = halving("single", 500 + k, name)
        share(case, found, 0.1)
    for kind in ("exact", "pair", "single", "unknown", "tolerance", "tight_spot", "triple"):
        for seed in (1, 2) if options.quick else (1, 2, 3, 4):
            began = time.process_time()
            case, found, _, _ = cases.build(kind, seed)
            cases.odds(case, found)
            seconds.append((time.process_time() - began, kind, seed))
            print(f"     {kind} {seed}: {seconds[-1][0]:.1f} s of CPU", flush=True)
    hold("s of CPU a case, median", float(np.median([s[0] for s in seconds])), 10.0)
    hold("s of CPU a case, largest", max(seconds)[0], 30.0)
    sys.exit(1 if FAILED else 0)


if __name__ == "__main__":
    main()
