"""A random member of the class of each name of contract.md section 4; few are an element of any dictionary.

Sources: friction over speed: Armstrong, Dupont, Canudas de Wit 1994; lag: Hess, Soom 1990; cogging and ripple of the
force constant: Gieras 2018; subdivision errors: Heydemann 1981; saturation: Krause, Wasynczuk, Sudhoff 2013. SI units.
"""

import paths  # noqa: F401
import numpy as np

import controllers as law
import laws
import plant
import smooth
from hidden import Cause
from trajectories import log_uniform


def sign(rng):
    """Plus or minus one."""
    return 1.0 if rng.random() < 0.5 else -1.0


def mass_mismatch(rng, machine, session):
    way = sign(rng)

    def apply(s, size):
        s.p[plant.LOAD if s.p[plant.TWO] else plant.DRIVEN] += way * size * machine.mass
    return Cause("mass_mismatch", apply, 0.01, 1e-4, 0.5, "another mass",
                 lambda z: {"mass": (1 + way * z) * machine.mass}, nuisance=("mass",), aliases=("force_constant",))


def coulomb_mismatch(rng, machine, session):
    way = sign(rng)

    def apply(s, size):
        s.factors.append(lambda log, t: np.full(len(t), 1 + way * size))
    return Cause("coulomb_mismatch", apply, 0.02, 1e-4, 0.8, "another level of the same contact",
                 lambda z: {"coulomb": (1 + way * z) * machine.coulomb}, nuisance=("coulomb",))


def viscous_mismatch(rng, machine, session):
    way = sign(rng)

    def apply(s, size):
        s.p[plant.VISCOUS] += way * size * machine.viscous
    return Cause("viscous_mismatch", apply, 0.02, 1e-4, 0.9, "another slope",
                 lambda z: {"viscous": (1 + way * z) * machine.viscous}, nuisance=("viscous",))


def viscous_nonlinear(rng, machine, session):
    kind = str(rng.choice(["process", "power", "saturating"]))
    knee = machine.speed * log_uniform(rng, 0.03, 0.4)
    draw, power = smooth.process(rng, rng.uniform(0.7, 1.6)), float(rng.choice([rng.uniform(0.4, 0.75),
                                                                             rng.uniform(1.4, 2.6)]))
    knee_power, way = rng.uniform(1.0, 2.5), sign(rng)

    def curve(v):
        u = np.abs(v) / knee
        if kind == "process":
            return (draw(np.log1p(u)) - draw(np.zeros(1))[0])
        if kind == "power":
            return way * (np.abs(v) / machine.speed) ** power
        return way * u / (1 + u**knee_power) ** (1 / knee_power)
    speeds = np.abs(session.motion(1)[::16])
    speeds = speeds[speeds > 0]
    slope = np.dot(curve(speeds), speeds) / np.dot(speeds, speeds)
    norm = np.sqrt(np.mean((curve(speeds) - slope * speeds) ** 2))

    def apply(s, size):
        v = s.speeds()
        s.table(plant.ODD_SPEED, size * (curve(v) - slope * v) / norm)
    return Cause("viscous_nonlinear", apply, 0.01 * machine.coulomb, 1e-6 * machine.coulomb, 2 * machine.coulomb,
                 f"{kind} over speed less its line", lambda z: {"rms_force": z, "power": power, "knee": knee},
                 aliases=("stribeck",))


def stribeck(rng, machine, session):
    speed = log_uniform(rng, 1e-3, 2e-2) / machine.length
    speed = min(speed, 0.06 * machine.speed)
    power, kind = rng.uniform(0.6, 2.6), str(rng.choice(["exponential", "rational"]))

    def apply(s, size):
        u = (s.speeds() / speed) ** power
        s.table(plant.LEVEL_AT_SPEED, size * (np.exp(-u) if kind == "exponential" else 1 / (1 + u)))
    return Cause("stribeck", apply, 0.05, 1e-3, 2.0, f"{kind} fall of the level, exponent {power:.2f}",
                 lambda z: {"relative_break_away": z, "velocity": speed, "exponent": power}, aliases=("speed_powers",))


def friction_asymmetry(rng, machine, session):
    kind = str(rng.choice(["coulomb", "coulomb and viscous", "viscous"]))
    draw, way, other = smooth.process(rng, 1.2), sign(rng), sign(rng)
    level = rng.uniform(0.4, 1.5)

    def apply(s, size):
        if kind != "viscous":
            s.p[plant.ASYMMETRY] += way * size
        if kind != "coulomb":
            v = s.speeds() / machine.speed
            s.table(plant.EVEN_SPEED, other * level * size * machine.coulomb * v * np.exp(0.4 * draw(np.log1p(8 * v))))
            s.p[plant.ASYMMETRY_VISCOUS] = 1.0
    return Cause("friction_asymmetry", apply, 0.01, 1e-5, 0.6, f"{kind} part", lambda z: {"relative": way * z},
                 accept=("constant_force",) if kind == "coulomb" else (), nuisance=("constant",),
                 aliases=() if kind == "coulomb" else ("constant",))


def presliding_hysteresis(rng, machine, session):
    kind = str(rng.choice(["dahl", "elasto_plastic", "bouc_wen", "maxwell_slip"]))
    reach = machine.coulomb / machine.contact_stiffness()
    rigid = machine.friction == "coulomb_viscous"
    stiffer = not rigid and rng.random() < 0.3
    soft = rng.uniform(0.15, 0.5) if stiffer else rng.uniform(1.8, 4.0) * (0.3 if rigid else 1.0)
    shape = {"dahl": float(rng.choice([1.0, 1.5, 2.0])), "elasto_plastic": rng.uniform(0.3, 0.85),
             "bouc_wen": rng.uniform(1.0, 3.0), "maxwell_slip": 1.0}[kind]
    gamma = rng.uniform(0.2, 0.9)
    slips = np.sort(log_uniform(rng, 0.15, 4.0, 8))
    parts = rng.dirichlet(np.full(8, 2.0))

    def apply(s, size):
        p, at = s.p, plant.LAW_B
        length = reach * soft * max(size, 1.0) ** (-1.0 if stiffer else 1.0)
        p[at:at + laws.LAW] = p[plant.LAW_A:plant.LAW_A + laws.LAW]
        p[at + laws.KIND] = {"dahl": laws.DAHL, "elasto_plastic": laws.ELASTO, "bouc_wen": laws.BOUC_WEN,
                             "maxwell_slip": laws.MAXWELL}[kind]
        p[at + laws.STIFFNESS] = p[at + laws.LEVEL] / length
        p[at + laws.SHAPE], p[at + laws.SHAPE2] = shape, gamma
        if kind == "maxwell_slip":
            p[at + laws.ELEMENTS] = 8
            p[at + laws.FIRST:at + laws.FIRST + 16:2] = parts * p[at + laws.LEVEL] / (slips * length)
            p[at + laws.FIRST + 1:at + laws.FIRST + 17:2] = parts * p[at + laws.LEVEL]
        p[plant.SHARE_B] = min(size, 1.0)
    return Cause("presliding_hysteresis", apply, 0.3, 1e-3, 25.0, f"{kind} contact, {soft:.2f} times the length",
                 lambda z: {"part": min(z, 1.0), "length": reach * soft * max(z, 1.0) ** (-1.0 if stiffer else 1.0)},
                 aliases=("backlash",))


def friction_lag(rng, machine, session):
    kind = int(rng.choice([plant.FIRST_ORDER, plant.SECOND_ORDER, plant.PURE_DELAY]))

    def apply(s, size):
        s.p[plant.LAG], s.p[plant.LAG_TIME] = kind, size
    return Cause("friction_lag", apply, 1.5e-3, 1.3e-4, 4e-2, ("", "first order", "second order", "pure delay")[kind],
                 lambda z: {"time": z}, aliases=("delay",))


def position_dependent_friction(rng, machine, session):
    draw = smooth.process(rng, machine.stroke * log_uniform(rng, 0.06, 0.4))
    x = session.motion(0)[::160]
    mean, spread = np.mean(draw(x)), np.std(draw(x))

    def apply(s, size):
        s.table(plant.LEVEL_AT_PLACE, np.clip(size * (draw(s.places()) - mean) / spread, -0.8, 3.0))
    return Cause("position_dependent_friction", apply, 0.01, 1e-5, 0.5, "process over position",
                 lambda z: {"relative_rms": z})


def thermal_drift(rng, machine, session):
    whole = rng.random() < 0.5
    way = -1.0 if rng.random() < 0.75 else 1.0
    rise, span = smooth.monotone(rng, 0.3), session.end()
    longest = max(len(s) for s in session.sets) * session.tick

    def apply(s, size):
        def factor(log, t):
            u = (session.begins[log] + t) / span if whole else t / longest
            return 1 + way * size * rise(np.clip(u, 0.0, 1.0))
        s.factors.append(factor)
    return Cause("thermal_drift", apply, 0.03, 1e-4, 0.8, "over the session" if whole else "in each log anew",
                 lambda z: {"relative_change": way * z}, aliases=("drift",))


def constant_force(rng, machine, session):
    way = sign(rng)

    def apply(s, size):
        s.p[plant.CONSTANT] += way * size
    return Cause("constant_force", apply, 0.01 * machine.coulomb, 1e-6 * machine.coulomb, machine.coulomb, "a constant",
                 lambda z: {"force": way * z}, accept=("friction_asymmetry",), nuisance=("constant",))


def position_spring(rng, machine, session):
    neutral = rng.uniform(-0.35, 0.35) * machine.stroke
    cubic, square = rng.uniform(-0.3, 0.6), rng.uniform(-0.3, 0.3)

    def apply(s, size):
        u = (s.places() - neutral) / machine.stroke
        s.table(plant.AT_PLACE, -size * u * (1 + cubic * u**2 + square * u))
    return Cause("position_spring", apply, 0.03 * machine.coulomb, 1e-6 * machine.coulomb, 4 * machine.coulomb,
                 "nearly linear over position", lambda z: {"force_over_stroke": z, "neutral": neutral, "cubic": cubic,
                                                          "square": square})


def pitch_of(rng, machine):
    """A pitch: that of the poles, or any that is short beside the stroke."""
    if rng.random() < 0.4 and machine.pitch < 0.5 * machine.stroke:
        return machine.pitch
    return machine.stroke * log_uniform(rng, 0.025, 0.25)


def rippled(rng, machine):
    """A ripple over position of unit size, and its pitch."""
    pitch, parts = pitch_of(rng, machine), smooth.harmonics(rng, 4)
    uneven = smooth.process(rng, 0.4 * machine.stroke)
    return lambda x: smooth.wave(parts, 2 * np.pi * x / pitch) * (1 + 0.1 * uneven(x)), pitch, parts


def force_ripple(rng, machine, session):
    ripple, pitch, parts = rippled(rng, machine)

    def apply(s, size):
        s.table(plant.AT_PLACE, size * ripple(s.places()))
    return Cause("force_ripple", apply, 0.02 * machine.coulomb, 1e-6 * machine.coulomb, 3 * machine.coulomb,
                 f"{len(parts)} harmonics", lambda z: {"pitch": pitch, "amplitude": z}, aliases=("position_waves",))


def force_constant_ripple(rng, machine, session):
    ripple, pitch, parts = rippled(rng, machine)

    def apply(s, size):
        s.table(plant.CONSTANT_AT_PLACE, size * ripple(s.places()))
    return Cause("force_constant_ripple", apply, 0.01, 1e-5, 0.4, f"{len(parts)} harmonics",
                 lambda z: {"pitch": pitch, "relative": z})


def force_constant_mismatch(rng, machine, session):
    way = sign(rng)

    def apply(s, size):
        s.p[plant.FORCE] *= 1 + way * size
    return Cause("force_constant_mismatch", apply, 0.01, 1e-5, 0.3, "another force constant",
                 lambda z: {"force_constant": machine.force_constant * (1 + way * z)},
                 nuisance=("mass", "coulomb", "viscous"))


def force_saturation(rng, machine, session):
    power, knee = rng.uniform(1.5, 4.0), rng.uniform(0.0, 0.4)
    a = np.abs(session.motion(2)).max()
    v = np.abs(session.motion(1)).max()
    used = (machine.mass * a + machine.coulomb + machine.viscous * v) / machine.force_constant

    def apply(s, size):
        u = np.maximum(s.p[plant.SAT_STEP] * np.arange(plant.NODES) / used - knee, 0.0) / (1 - knee)
        s.table(plant.SATURATION, np.maximum(1 - size * u**power, 0.2))
    return Cause("force_saturation", apply, 0.02, 1e-4, 0.7,
                 f"falls with the power {power:.2f} of current above {knee:.2f}",
                 lambda z: {"loss_at_most_used_current": z, "power": power}, aliases=("mass", "force_constant"))


def backlash(rng, machine, session):
    part, damping = rng.uniform(0.25, 0.6), rng.uniform(0.15, 0.5)
    mode = 2 * np.pi * rng.uniform(350.0, 700.0)

    def apply(s, size):
        if not s.p[plant.TWO]:
            split(s, machine, part, part * (1 - part) * machine.mass * mode**2, damping)
        s.p[plant.HALF_GAP] = size / 2
    reach = 1e-6 / machine.length
    return Cause("backlash", apply, 2 * reach, 0.02 * reach, 80 * reach, "dead zone before a stiff shaft",
                 lambda z: {"width": z}, aliases=("presliding",))


def split(s, machine, motor_part, stiffness, damping_ratio, behind=False):
    """Makes two bodies of one. behind: the encoder and friction stay on the driven one."""
    p = s.p
    p[plant.TWO], p[plant.SHAFT] = 1.0, stiffness
    total = p[plant.DRIVEN]
    p[plant.DRIVEN], p[plant.LOAD] = motor_part * total, (1 - motor_part) * total
    p[plant.SHAFT_DAMPING] = 2 * damping_ratio * np.sqrt(stiffness * motor_part * (1 - motor_part) * total)
    p[plant.ENCODER_ON_LOAD] = p[plant.FRICTION_ON_LOAD] = 0.0 if behind else 1.0


def structural_resonance(rng, machine, session):
    behind, part, damping = rng.random() < 0.3, rng.uniform(0.2, 0.75), log_uniform(rng, 0.03, 0.2)
    fastest = 2 * np.pi * 600.0

    def apply(s, size):
        split(s, machine, part, part * (1 - part) * machine.mass * fastest**2 / size, damping, behind)
    return Cause("structural_resonance", apply, 4.0, 1.0, 400.0,
                 "a body behind the carriage" if behind else "a spring between motor and encoder",
                 lambda z: {"frequency_Hz": 600.0 / np.sqrt(z), "mass_ratio": 1 - part, "damping_ratio": damping},
                 aliases=("delay",))


def encoder_subdivision_error(rng, machine, session):
    least = max(12 * machine.increment, 2e-6 / machine.length)
    period = least * log_uniform(rng, 1.0, 20.0)
    parts = smooth.harmonics(rng, 4)

    def apply(s, size):
        s.p[plant.ERROR_PERIOD], s.p[plant.ERROR_ORDERS] = period, len(parts)
        s.p[plant.ERROR:plant.ERROR + 2 * len(parts)] = (size * parts).ravel()
    return Cause("encoder_subdivision_error", apply, 0.002 * period, 1e-6 * period, 0.04 * period,
                 f"{len(parts)} harmonics", lambda z: {"period": period, "amplitude": z}, aliases=("position_waves",))


def time_skew(rng, machine, session):
    def apply(s, size):
        s.skew += size
    return Cause("time_skew", apply, 2e-4, 1e-7, 2e-2, "current recorded late", lambda z: {"delay": z},
                 aliases=("delay",))


def periodic_disturbance(rng, machine, session):
    frequency, parts = log_uniform(rng, 2.0, 70.0), smooth.harmonics(rng, 2)
    phases = rng.uniform(0.0, 2 * np.pi, len(session.sets))
    beats = [smooth.process(rng, 4.0) for _ in session.sets]

    def apply(s, size):
        s.forces.append(lambda log, t: size * (1 + 0.1 * beats[log](t))
                        * smooth.wave(parts, 2 * np.pi * frequency * t + phases[log]))
    return Cause("periodic_disturbance", apply, 0.02 * machine.coulomb, 1e-6 * machine.coulomb, 2 * machine.coulomb,
                 f"{len(parts)} harmonics", lambda z: {"frequency_Hz": frequency, "amplitude": z})


def controller_gain_mismatch(rng, machine, session):
    which, way = str(rng.choice(["position_gain", "velocity_gain", "velocity_integral_time"])), sign(rng)
    at = {"position_gain": law.GAIN, "velocity_gain": law.SPEED_GAIN,
          "velocity_integral_time": law.INTEGRAL_TIME}[which]

    def apply(s, size):
        s.c[at] *= (1 + size) ** way
    return Cause("controller_gain_mismatch", apply, 0.03, 1e-5, 0.6, which,
                 lambda z: {which + "_factor": (1 + z) ** way}, channel="command")


def master_delay(rng, machine, session):
    def apply(s, size):
        s.behind += size
    return Cause("master_delay", apply, 1e-3, 1e-6, 3e-2, "set-points late", lambda z: {"delay": z}, channel="command")


CAUSES = {f.__name__: f for f in (
    mass_mismatch, coulomb_mismatch, viscous_mismatch, viscous_nonlinear, stribeck, friction_asymmetry,
    presliding_hysteresis, friction_lag, position_dependent_friction, thermal_drift, constant_force, position_spring,
    force_ripple, force_constant_ripple, force_constant_mismatch, force_saturation, backlash, structural_resonance,
    encoder_subdivision_error, time_skew, periodic_disturbance, controller_gain_mismatch,
    master_delay)}

# Names of which two cannot both be told: the first is part of the second, or both act through the same element.
NEVER_TOGETHER = [
    {"constant_force", "friction_asymmetry"}, {"mass_mismatch", "force_constant_mismatch"},
    {"coulomb_mismatch", "force_constant_mismatch"}, {"viscous_mismatch", "force_constant_mismatch"},
    {"backlash", "structural_resonance"}, {"force_saturation", "mass_mismatch"},
    {"force_saturation", "force_constant_mismatch"}, {"coulomb_mismatch", "thermal_drift"},
    {"backlash", "presliding_hysteresis"}, {"time_skew", "structural_resonance"},
    {"master_delay", "controller_gain_mismatch"}]
