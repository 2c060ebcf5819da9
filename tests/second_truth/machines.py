"""Random machines: drawn as numbers, written as a machine file (what the user has), and as parameters of plant.py.

Rules: magnitude and symmetrical optimum for the loops, Leonhard 2001, chapters 3 and 7; friction per mass and
presliding lengths as in Mendricky 2006, Tab 4.2 and 5.3. SI; mass means kg m^2, force N m, way rad on a rotary axis.
"""

import dataclasses
import math

import paths  # noqa: F401
import numpy as np

import controllers as law
import laws
import plant
from trajectories import Room, log_uniform

TICK, SLOW = 62.5e-6, 1e-3
LAW_NAMES = ("lugre", "coulomb_viscous", "maxwell_slip", "dahl", "elasto_plastic")


@dataclasses.dataclass
class Machine:
    """One axis; units: see the module. Two bodies have a shaft (N/m) with damping, and the motor's part of the mass."""

    rotary: bool
    mass: float
    speed: float
    acceleration: float
    stroke: float
    length: float
    model: str
    force_constant: float
    resistance: float
    inductance: float
    mutual: float
    emf: float
    pitch: float
    dead_time: float
    volts: float
    amperes: float
    increment: float
    velocity: str
    position_gain: float
    position_increment: float
    velocity_gain: float
    integral_time: float
    current_gain: float
    current_time: float
    feed_speed: float
    feed_current: float
    friction: str
    coulomb: float
    viscous: float
    static_ratio: float
    stribeck: float
    stiffness: float
    damping_ratio: float
    break_away_share: float
    elements: tuple
    rate: float
    bits: int
    motor_part: float = 0.0
    shaft: float = 0.0
    shaft_damping_ratio: float = 0.0
    encoder_on: str = "load"

    def room(self):
        """What its trajectories may do."""
        return Room(self.stroke, self.speed, self.acceleration, self.coulomb / self.contact_stiffness())

    def contact_stiffness(self):
        """Initial stiffness of the contact; of dry friction that of a length that its servo resolves, N/m."""
        if self.friction == "maxwell_slip":
            return sum(k for k, _ in self.elements)
        return self.stiffness if self.friction != "coulomb_viscous" else self.coulomb / (20e-6 / self.length)

    def facts(self):
        """Everything, for truth.json."""
        return dataclasses.asdict(self)

    def plant(self):
        """(parameters, tables, flags) of plant.py, and its friction law at LAW_A."""
        p, tables, on = plant.blank()
        p[plant.DRIVEN] = self.mass
        p[plant.FORCE] = self.force_constant
        p[plant.MODEL] = {"force": plant.IDEAL, "dc": plant.DC, "synchronous": plant.THREE_PHASE}[self.model]
        p[plant.EMF], p[plant.RESISTANCE] = self.emf, self.resistance
        p[plant.INDUCTANCE] = self.inductance - self.mutual
        p[plant.ELECTRICAL] = 2 * math.pi / self.pitch
        p[plant.DEAD] = self.dead_time
        p[plant.INCREMENT] = self.increment
        p[plant.VISCOUS] = self.viscous
        p[plant.X_LOW] = -0.6 * self.stroke
        p[plant.X_STEP] = 1.2 * self.stroke / (plant.NODES - 1)
        p[plant.V_STEP] = 1.3 * self.speed / (plant.NODES - 1) ** 2
        p[plant.SAT_STEP] = self.amperes / (plant.NODES - 1)
        p[plant.REST_SPEED] = 2e-5 * self.speed
        if self.shaft:
            motor, load = self.motor_part * self.mass, (1 - self.motor_part) * self.mass
            p[plant.TWO], p[plant.DRIVEN], p[plant.LOAD], p[plant.SHAFT] = 1.0, motor, load, self.shaft
            p[plant.SHAFT_DAMPING] = 2 * self.shaft_damping_ratio * math.sqrt(self.shaft * motor * load / self.mass)
            p[plant.FRICTION_ON_LOAD] = 1.0
            p[plant.ENCODER_ON_LOAD] = float(self.encoder_on == "load")
        write_law(p, plant.LAW_A, self)
        return p, tables, on

    def control(self):
        """Settings of tests/axes/controllers.py."""
        c = np.zeros(law.SETTINGS)
        c[law.STRUCTURE], c[law.TICK], c[law.PERIOD] = law.CASCADE, TICK, round(SLOW / TICK)
        c[law.GAIN], c[law.POSITION_INCREMENT] = self.position_gain, self.position_increment
        c[law.SPEED_GAIN], c[law.INTEGRAL_TIME] = self.velocity_gain, self.integral_time
        c[law.FEED_SPEED] = self.feed_speed
        c[law.FEED_ACCELERATION] = self.feed_current * self.mass / self.force_constant
        c[law.SPEED_KIND] = law.IDEAL_SPEED if self.velocity == "ideal" else law.MEAN_DIFFERENCE
        c[law.CURRENT_LOOP] = float(self.model != "force")
        c[law.CURRENT_GAIN], c[law.CURRENT_TIME], c[law.VOLTS] = self.current_gain, self.current_time, self.volts
        c[law.PHASES] = 3.0 if self.model == "synchronous" else 1.0
        c[law.LIMIT] = self.amperes
        return c


def write_law(p, at, machine):
    """The friction law of the file into the parameters of plant.py."""
    kind = {"lugre": laws.LUGRE, "coulomb_viscous": laws.COULOMB, "maxwell_slip": laws.MAXWELL, "dahl": laws.DAHL,
            "elasto_plastic": laws.ELASTO}[machine.friction]
    p[at + laws.KIND], p[at + laws.LEVEL], p[at + laws.STATIC] = kind, machine.coulomb, machine.static_ratio
    p[at + laws.STRIBECK], p[at + laws.STIFFNESS] = machine.stribeck, machine.stiffness
    sliding = machine.mass * (1 - machine.motor_part)
    damped = kind in (laws.LUGRE, laws.ELASTO)
    p[at + laws.DAMPING] = 2 * machine.damping_ratio * math.sqrt(machine.stiffness * sliding) if damped else 0.0
    p[at + laws.SHAPE] = machine.break_away_share if kind == laws.ELASTO else 1.0
    if kind == laws.MAXWELL:
        p[at + laws.ELEMENTS] = len(machine.elements)
        for k, pair in enumerate(machine.elements):
            p[at + laws.FIRST + 2 * k:at + laws.FIRST + 2 * k + 2] = pair


def maxwell_elements(rng, coulomb, length, count):
    """Stiffness and level of springs that slip one after the other; the last at a few lengths."""
    slips = length * np.sort(log_uniform(rng, 0.1, 5.0, count))
    levels = rng.dirichlet(np.full(count, 3.0)) * coulomb
    return tuple((float(rounded(f / s, 4)), float(rounded(f, 5))) for f, s in zip(levels, slips))


def rounded(value, digits=4):
    """A value with the digits that a file prints, so that file and plant are the same machine."""
    return float(f"{value:.{digits}g}")


def draw(rng, rotary=None, two=None, friction=None, stribeck=False, soft=False):
    """A random machine. rotary, two, friction: wishes; stribeck: its law has a falling part; soft: its gains are those
    of a machine with an elastic mode."""
    rotary = bool(rng.random() < 0.25) if rotary is None else rotary
    length = log_uniform(rng, 0.02, 0.3) if rotary else 1.0
    mass = rounded(log_uniform(rng, 1e-5, 10.0) if rotary else log_uniform(rng, 20.0, 2000.0))
    speed = log_uniform(rng, 0.25, 1.5) / length
    acceleration = log_uniform(rng, 2.0, 12.0) / length
    stroke = log_uniform(rng, 0.15, 1.0) / length
    if rotary:
        stroke = min(stroke, 6.0)
    friction = friction or str(rng.choice(("lugre", "elasto_plastic") if stribeck else LAW_NAMES))
    coulomb = rounded(mass * log_uniform(rng, 0.25, 1.2) / length)
    viscous = rounded(coulomb / speed * log_uniform(rng, 0.3, 2.5))
    reach = log_uniform(rng, 3e-6, 1e-4) / length
    stiffness = rounded(coulomb / reach)
    curved = friction in ("lugre", "elasto_plastic") and (stribeck or rng.random() < 0.6)
    static = rounded(rng.uniform(1.15, 1.5), 3) if curved else 1.0
    falling = rounded((log_uniform(rng, 2e-3, 1.5e-2) if stribeck else log_uniform(rng, 5e-4, 1e-2)) / length, 3)
    elements = maxwell_elements(rng, coulomb, reach, int(rng.integers(3, 6))) if friction == "maxwell_slip" else ()
    if elements:
        coulomb = sum(f for _, f in elements)
    most = 1.4 * (mass * acceleration + coulomb + viscous * speed)
    amperes = rounded(log_uniform(rng, 4.0, 60.0), 3)
    force_constant = rounded(most / amperes)
    model = str(rng.choice(["synchronous", "dc", "force"], p=[0.4, 0.4, 0.2]))
    dead = TICK * float(rng.choice([0, 1, 2, 3], p=[0.05, 0.15, 0.6, 0.2])) if model != "force" else 0.0
    emf = rounded(force_constant * 2 / 3)
    volts = 600.0 if emf * speed < 350.0 else rounded(emf * speed * 2)
    resistance = rounded(0.15 * volts / amperes * rng.uniform(0.4, 1.5))
    inductance = rounded(resistance * log_uniform(rng, 3e-3, 1.2e-2))
    mutual = rounded(inductance * rng.uniform(0.0, 0.15), 3) if model == "synchronous" else 0.0
    lag = dead + 1.5 * TICK
    current_gain = rounded((inductance - mutual) / (2 * lag) * rng.uniform(0.6, 1.1))
    bandwidth = log_uniform(rng, 30.0, 90.0) if soft else log_uniform(rng, 90.0, 330.0)
    integral = rounded(rng.uniform(1.3, 4.0) / bandwidth, 3)
    velocity_gain = rounded(bandwidth * mass / force_constant)
    finest = 1.2e-9 / length  # what the numbers of a drive hold: 2^30 counts a metre
    increment = rounded(finest * float(rng.choice([1, 5, 10, 20, 50, 100, 200, 500, 1000, 2000])), 3)
    # A servo is sensible where a count is small beside the contact and the force of a count of error beside friction.
    while increment > 2 * finest and (increment > 0.04 * reach or bandwidth**2 / 4 * mass * increment > 0.02 * coulomb
                                  or mass * 4e5 * increment * 0.05 > 0.02 * coulomb):
        increment = rounded(increment / 2, 3)
    step = velocity_gain * force_constant * increment / (2 * TICK)  # force of a count in a difference of means
    velocity = "mean-difference" if step < 0.1 * coulomb and rng.random() < 0.7 else "ideal"
    machine = Machine(
        rotary, mass, speed, acceleration, stroke, length, model, force_constant, resistance, inductance, mutual, emf,
        rounded(log_uniform(rng, 0.02, 0.08) if not rotary else 2 * math.pi / int(rng.integers(2, 12)), 8), dead, volts,
        amperes, increment, velocity, rounded(bandwidth / rng.uniform(3.0, 6.0)),
        increment if rng.random() < 0.5 and increment > 3 * finest else 0.0, velocity_gain, integral,
        current_gain, rounded(inductance / resistance * rng.uniform(0.3, 1.0), 3),
        float(rng.choice([1.0, 0.0], p=[0.9, 0.1])), float(rng.choice([1.0, 0.0], p=[0.85, 0.15])), friction, coulomb,
        viscous, static, falling, stiffness, rounded(rng.uniform(0.05, 0.5), 3), rounded(rng.uniform(0.3, 0.85), 3),
        elements, float(rng.choice([1000, 2000, 4000, 500], p=[0.7, 0.1, 0.1, 0.1])),
        int(rng.choice([0, 16, 14, 12, 10], p=[0.35, 0.25, 0.2, 0.15, 0.05])))
    while machine.bits and 2 * amperes / 2**machine.bits * force_constant > 0.06 * coulomb:
        machine.bits = machine.bits + 1 if machine.bits < 16 else 0
    machine.pitch = rounded(machine.pitch, 8)
    if two if two is not None else rng.random() < 0.12:
        add_shaft(rng, machine, bandwidth)
    return machine


def add_shaft(rng, machine, bandwidth):
    """Makes two bodies of it, with a mode well above the velocity loop; motor and load are written in the file."""
    machine.motor_part = rounded(rng.uniform(0.25, 0.6), 3)
    mode = bandwidth * log_uniform(rng, 5.0, 12.0)
    reduced = machine.motor_part * (1 - machine.motor_part) * machine.mass
    machine.shaft = rounded(reduced * mode**2)
    machine.shaft_damping_ratio = rounded(rng.uniform(0.03, 0.15), 3)
    machine.encoder_on = str(rng.choice(["load", "motor"]))
    machine.model, machine.mutual = "dc" if machine.model == "synchronous" else machine.model, 0.0
