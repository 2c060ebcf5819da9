"""One case from one number: machine, motions, noise, hidden causes at their share, and what an oracle would see."""

import paths  # noqa: F401
import numpy as np

import cams
import causes
import machines
import oracle
import plant
import residuals
import tight_spot
import tolerance
import trajectories
import unknowns
from hidden import Session, Setup
from noise import Noise
from records import late, record

KINDS = ("exact", "tolerance", "single", "pair", "triple", "unknown", "tight_spot")
COUNT = {"single": 1, "pair": 2, "triple": 3}
FURTHER = 3  # noisy nulls beside the case's own, from which its oracle knows what noise.py does not give in closed form


class Unreachable(Exception):
    """The asked share is out of this member's range; another one is drawn."""


def usual_steps(setup):
    """Steps of the plant in a tick: the selftest holds that twice as many change nothing."""
    if setup.p[plant.HALF_GAP]:
        return 8
    fine = setup.machine.friction == "coulomb_viscous" and setup.machine.increment * setup.machine.length < 5e-9
    return 4 if setup.p[plant.TWO] or setup.p[plant.LAG] or fine else 2


def late_sets(sets, delay):
    """Set-points that a drive has `delay` s late, between ticks along straight lines."""
    return sets if delay == 0.0 else np.column_stack([late(column, delay) for column in sets.T])


class Case:
    """Machine, session, noise; runs of it with hidden causes."""

    def __init__(self, kind, seed, wishes, cam=False):
        self.kind, self.seed = kind, seed
        streams = [np.random.default_rng([seed, KINDS.index(kind), k]) for k in range(6)]
        self.rng_machine, self.rng_motion, self.rng_noise, self.rng_cause, self.rng_sensor, self.rng_oracle = streams
        self.machine = machines.draw(self.rng_machine, **wishes)
        self.masters, self.before = None, None
        if cam:
            runs = cams.session(self.rng_motion, self.machine.room(), machines.TICK)
            self.masters, self.before = ([made[k] for part in runs for made in part] for k in (1, 2))
            train, held = ([made[0] for made in part] for part in runs)
        else:
            train, held = trajectories.commissioning(self.rng_motion, self.machine.room(), machines.TICK)
        begins, at = [], 0.0
        for sets in train + held:
            begins.append(at)
            at += len(sets) * machines.TICK + self.rng_motion.uniform(2.0, 30.0)
        self.session = Session(train + held, begins, len(train), machines.TICK)
        self.noise = Noise(self.rng_noise, self.machine)
        self.noises = [self.draw_noise(self.rng_sensor, sets) for sets in self.session.sets]
        self.null()

    def draw_noise(self, rng, sets):
        """The noise of a log: force and encoder at each tick, current at each row."""
        rate = self.machine.rate
        every = round(1 / rate / machines.TICK)
        return (self.noise.on_carriage(rng, sets, machines.TICK), self.noise.of_encoder(rng, len(sets)),
                self.noise.of_current(rng, len(sets[::every]), 1 / rate))

    def run(self, setup, log, noise=None, substeps=None):
        """A log: recorded with noise as of draw_noise and steps, or without any."""
        m, sets = self.machine, self.session.sets[log]
        outside, factor = setup.signals(self.session, log)
        substeps = substeps or usual_steps(setup)
        quarter = setup.p[plant.DEAD] / machines.TICK * substeps
        if abs(quarter - round(quarter)) > 1e-6:
            substeps = 4
        arrays = (setup.p, setup.tables, setup.on)
        given = late_sets(sets, setup.behind)
        if noise is not None:
            force, error, current = noise
            made = plant.simulate(arrays, setup.c, given, outside + force, factor, error, substeps)
            self.check(made, sets)
            return record(m, sets, made, setup.skew, current)
        p, c = setup.p.copy(), setup.c.copy()
        p[plant.INCREMENT] = c[machines.law.POSITION_INCREMENT] = 0.0
        made = plant.simulate((p, setup.tables, setup.on), c, given, outside, factor, None, substeps)
        self.check(made, sets)
        return residuals.noiseless(m, sets, made, setup.skew)

    def check(self, made, sets):
        """Raises where the loop is not stable or its current not within the limits."""
        wrong = np.abs(made[:, plant.X] - sets[:, 0]).max()
        if not np.isfinite(wrong) or wrong > 0.05 * self.machine.stroke or not np.all(np.isfinite(made[:, plant.I])):
            raise Unreachable("the loop is not stable")
        if np.abs(made[:, plant.COMMAND]).max() > 0.95 * self.machine.amperes:
            raise Unreachable("the current is limited")
        if hasattr(self, "worst") and wrong > 8 * self.worst:
            raise Unreachable("the loop is hardly stable")

    def residual(self, channel, logs):
        """Residuals of the training logs in one channel."""
        m = self.machine
        if channel == "command":
            return [residuals.command(m, log, sets) for log, sets in zip(logs, self.session.sets)]
        return [residuals.force(m, log, mask) for log, mask in zip(logs, self.masks)]

    def null(self):
        """The noiseless and the noisy null of the training logs, and the noise of each channel."""
        trained = range(self.session.trained)
        exact = Setup(self.machine)
        self.clean = [self.run(exact, k) for k in trained]
        self.worst = max(np.abs(log.x - log.sets[:, 0]).max() for log in self.clean)
        self.masks = [residuals.moving(self.machine, log) for log in self.clean]
        self.noisy = [self.run(exact, k, self.noises[k]) for k in trained]
        self.channels, self.seers, self.more = {}, {}, None
        if self.channel("force")[3] > (0.06 * self.machine.coulomb) ** 2:
            raise Unreachable("the noise is too large for a servo")

    def channel(self, name):
        """(clean residuals, noise, masks, noise power) of a channel, computed once."""
        if name not in self.channels:
            clean, noisy = self.residual(name, self.clean), self.residual(name, self.noisy)
            noise = [a - b for a, b in zip(noisy, clean)]
            masks = self.masks if name == "force" else [np.ones(len(n), bool) for n in noise]
            self.channels[name] = (clean, noise, masks, residuals.power(noise, masks))
        return self.channels[name]

    def nulls(self, count, rng):
        """Noise and logs of further noisy nulls of the training logs, in half of the usual steps."""
        exact, out = Setup(self.machine), []
        for _ in range(10 * count):
            noises = [self.draw_noise(rng, sets) for sets in self.session.sets[:self.session.trained]]
            try:
                out.append((noises, [self.run(exact, k, noise, usual_steps(exact) // 2)
                                     for k, noise in enumerate(noises)]))
            except Unreachable:
                continue
            if len(out) == count:
                return out
        raise RuntimeError(f"found {len(out)} noisy nulls of {self.kind} {self.seed} in {10 * count}; expected {count}")

    def samples(self, name, nulls):
        """Of each log the noise of a channel in several nulls, and its part in closed form: nulls by rows."""
        m, every = self.machine, round(1 / self.machine.rate / machines.TICK)
        clean, _, masks, _ = self.channel(name)
        noises, parts = [[] for _ in clean], [[] for _ in clean]
        for drawn_now, logs in nulls:
            for k, (noisy, (force, _, current)) in enumerate(zip(self.residual(name, logs), drawn_now)):
                told = m.force_constant * current - (force[::every] if name == "force" else 0.0)
                noises[k].append(noisy - clean[k])
                parts[k].append(residuals.banded(told, masks[k], m.rate, name))
        return [np.array(n) for n in noises], [np.array(p) for p in parts]

    def seer(self, name):
        """The oracle of a channel, made once."""
        if name not in self.seers:
            if not self.more:
                self.more = self.nulls(FURTHER, self.rng_oracle)
            noises, parts = self.samples(name, [(self.noises, self.noisy)] + self.more)
            self.seers[name] = oracle.Oracle(self.machine, self.noise, name, self.clean, self.channel(name)[2], noises,
                                             parts)
        return self.seers[name]

    def effect(self, cause, size, steps=None):
        """The noiseless change of the residual by a cause, one signal per training log, in half of the usual steps (the
        selftest holds the share against finer ones)."""
        setup = Setup(self.machine)
        cause.apply(setup, size)
        steps = steps or usual_steps(setup) // 2
        logs = [self.run(setup, k, None, steps) for k in range(self.session.trained)]
        return [a - b for a, b in zip(self.residual(cause.channel, logs), self.channel(cause.channel)[0])]

    def sized(self, cause, share):
        """Size and effect at which the cause has the share, within 6 %; secant rule on the logarithms, bracketed."""
        _, _, masks, noise = self.channel(cause.channel)
        wanted = noise * share / (1 - share)
        low, high, size, before = cause.least, cause.most, cause.size, None
        for _ in range(9):
            size = min(max(size, low), high)
            try:
                effect = self.effect(cause, size)
                power = residuals.power(effect, masks)
            except Unreachable:
                if size <= cause.least * 1.01:
                    raise
                high, size = size, np.sqrt(size * low) if before is None else np.sqrt(size * before[0])
                continue
            if abs(power / wanted - 1) < 0.06:
                return size, effect, power / (power + noise)
            if (power < wanted and size >= 0.999 * high) or (power > wanted and size <= 1.001 * low):
                raise Unreachable(f"{cause.name}: share out of range")
            low, high = (size, high) if power < wanted else (low, size)
            slope = 2.0
            if before is not None and power != before[1] and size != before[0]:
                slope = np.log(power / before[1]) / np.log(size / before[0])
                if slope > 5.0 and max(power, before[1]) > 0.1 * wanted:
                    raise Unreachable(f"{cause.name}: shows at the verge of stability only")
                slope = np.clip(slope, 0.5, 6.0)
            before = (size, power)
            size *= np.clip((wanted / max(power, 1e-300)) ** (1 / slope), 0.02, 50.0)
            if not low < size < high:
                size = np.sqrt(low * high)
        raise Unreachable(f"{cause.name}: no size found")


def wishes_of(names, cam=False):
    """What the machine must be like for these causes to be possible."""
    wishes = {}
    if "friction_lag" in names:
        wishes["stribeck"] = True
    if {"structural_resonance", "backlash", "tolerance"} & set(names):
        wishes["two"] = False
    if "master_delay" in names and not cam:
        raise ValueError("found master_delay behind no master; expected the motion of a cam")
    if "structural_resonance" in names:
        wishes["soft"] = True
    return wishes


def choose(rng, count, first, cam=False):
    """Names of causes that can be told from one another; the first is given or drawn evenly."""
    known = [n for n in causes.CAUSES if cam or n != "master_delay"]
    while True:
        names = [first] if first else [str(rng.choice(known))]
        names += [str(n) for n in rng.choice([n for n in known if n != names[0]], count - 1, replace=False)]
        if not any(pair <= set(names) for pair in causes.NEVER_TOGETHER):
            return names


def new_case(kind, seed, names, attempt=0, cam=False):
    """A case whose null runs; a machine that its servo cannot move is replaced by the next one; attempt: of build."""
    for again in range(20):
        try:
            return Case(kind, seed + 1000003 * again + 100000007 * attempt, wishes_of(names, cam), cam)
        except Unreachable:
            continue
    raise RuntimeError(f"no machine for {kind} {seed}")


def drawn(case, factory, share):
    """A member of a class at its share; other members are tried where one cannot reach it."""
    for _ in range(3):
        cause = factory(case.rng_cause, case.machine, case.session)
        try:
            return (cause, *case.sized(cause, share))
        except Unreachable:
            continue
    return None


def build(kind, seed, share=0.1, name=None, cam=False):
    """The whole case: Case, list of (Cause, size, effect, share reached), errors of tolerance, records."""
    rng = np.random.default_rng([seed, KINDS.index(kind), 99])
    for attempt in range(20):
        names = choose(rng, COUNT[kind], name, cam) if kind in COUNT else [kind] if kind == "tolerance" else []
        case = new_case(kind, seed, names, attempt, cam)
        off, found = {}, []
        if kind in COUNT:
            found = [drawn(case, causes.CAUSES[n], share) for n in names]
        elif kind == "unknown":
            found = [drawn(case, unknowns.UNKNOWNS[int(rng.integers(len(unknowns.UNKNOWNS)))], share)]
        elif kind == "tight_spot":
            cause = tight_spot.tight_spot(case.rng_cause, case.machine, case.session)
            effect = case.effect(cause, cause.size)
            power, noise = residuals.power(effect, case.masks), case.channel("force")[3]
            found = [(cause, cause.size, effect, power / (power + noise))]
        elif kind == "tolerance":
            off = tolerance.draw(case.rng_cause, case.machine)
        if any(f is None for f in found):
            continue
        setup = Setup(case.machine)
        for cause, size, _, _ in found:
            cause.apply(setup, size)
        if off:
            tolerance.apply(setup, off)
        known = case.noisy if not (found or off) else []
        try:
            logs = known + [case.run(setup, k, case.noises[k]) for k in range(len(known), len(case.session.sets))]
        except Unreachable:
            continue
        return case, found, off, logs
    raise RuntimeError(f"no case for {kind} {seed} {name}")


def odds(case, found):
    """Nats of each hidden cause beside the others, and beside each set of aliases; the least of the first."""
    each, alias = {}, {}
    for k, (cause, _, effect, _) in enumerate(found):
        seer = case.seer(cause.channel)
        others = [seer.effect(e) for j, (c, _, e, _) in enumerate(found) if j != k and c.channel == cause.channel]
        each[cause.name] = seer.nats(effect, cause.nuisance, others)
        alias[cause.name] = {a: seer.nats(effect, cause.nuisance, others + seer.alias(a)) for a in cause.aliases}
    return (min(each.values()) if each else None), each, alias


def held_out(case, logs):
    """Mean square of the residual force on the held-out records, and on the same ones with nothing hidden; N².

    None where nothing hidden is not what the servo can hold."""
    exact, with_it, without, masks = Setup(case.machine), [], [], []
    try:
        for k in range(case.session.trained, len(logs)):
            mask = residuals.moving(case.machine, case.run(exact, k))
            for into, log in ((with_it, logs[k]), (without, case.run(exact, k, case.noises[k]))):
                into.append(residuals.force(case.machine, log, mask))
            masks.append(mask)
    except Unreachable:
        return None
    return [residuals.power(with_it, masks), residuals.power(without, masks)]
