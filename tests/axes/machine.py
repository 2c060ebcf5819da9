"""A machine file's text into the arrays that the equations take. It refuses a key that it does not read, so that no
case says more than the oracle does; equations.md section 9 has the conventions where the file's format leaves a choice."""

import math
import tomllib

import numpy as np

import controllers as law
import encoders as scale
import plants
import reduction
from quantities import si

GRAVITY = 9.80665  # m/s^2, the standard acceleration of ISO 80000-3
STRUCTURES = {"cascade": law.CASCADE, "p-voltage": law.P_VOLTAGE, "pd": law.PD, "pid": law.PID}
LAWS = {"coulomb_viscous": plants.COULOMB, "classical": plants.COULOMB, "linear_ramp": plants.RAMP, "lugre": plants.LUGRE}
UNREAD = {"name", "travel", "max_velocity", "max_acceleration", "modulo"}  # limits and names, no part of an equation


class Table:
    """A table of the file that counts which of its keys were read."""

    def __init__(self, values, path):
        self.values, self.path, self.read = values, path, set()

    def get(self, key, default=0.0):
        """SI value or text of a key."""
        self.read.add(key)
        value = self.values.get(key, default)
        name = isinstance(value, str) and not (value[:1].isdigit() or value[:1] in "-.")
        return value if value is None or name else si(value)

    def raw(self, key, default=None):
        """The value as the file has it."""
        self.read.add(key)
        return self.values.get(key, default)

    def sub(self, key):
        """A table within, empty where there is none."""
        self.read.add(key)
        return Table(self.values.get(key, {}), f"{self.path}.{key}")

    def closed(self):
        """Raises where a key was not read."""
        left = set(self.values) - self.read - UNREAD
        if left:
            raise ValueError(f"{self.path}: found {sorted(left)}; expected only keys that the oracle has equations for")


class Machine:
    """One axis of a machine file: plant and control parameters, encoders, the period of a tick in s."""

    def __init__(self, text):
        whole = tomllib.loads(text)
        self.text, (self.axis, values) = text, next(iter(whole["axis"].items()))
        axis = Table(values, f"axis.{self.axis}")
        self.kind = axis.get("kind", "linear")
        self.tick = si(whole["timing"]["fast_period"])
        self.slow = si(whole["timing"]["slow_period"])
        self.plant, self.control = plants.blank(), np.zeros(law.SETTINGS)
        self.read_train(axis)
        self.read_gravity(axis.sub("gravity"))
        self.read_motor(axis)
        for at, name, mass in ((plants.FRICTION_L, "friction", self.sliding_mass),
                               (plants.FRICTION_M, "motor_friction", self.motor_mass)):
            self.read_friction(axis.sub(name), at, mass)
        self.read_encoders(axis)
        self.read_controller(axis)
        axis.closed()
        kinked = plants.RAMP in (self.plant[plants.FRICTION_L], self.plant[plants.FRICTION_M]) or self.plant[plants.HALF_GAP]
        self.substeps = 128 if kinked else 32  # a bend within a step costs two orders of accuracy, equations.md 10

    def read_train(self, axis):
        """Inertias, shaft and gap; section 1 and 2."""
        p, train = self.plant, axis.sub("transmission")
        self.load = axis.get("inertia" if self.kind == "rotary" else "mass")
        counterweight = axis.sub("gravity").get("counterweight_mass")
        lead, around = train.get("lead", None), train.get("pulley_circumference", None)
        self.ratio = reduction.parse_ratio(train.raw("ratio", 1))
        p[plants.N] = reduction.motor_per_load(self.ratio, lead, around)
        if self.kind == "linear" and lead is None and around is None:
            p[plants.N] = 1.0
        p[plants.LOAD] = self.load + counterweight
        p[plants.MOTOR] = reduction.motor_side(p[plants.N], train.get("motor_inertia"), train.get("screw_inertia"), lead)
        self.total = p[plants.LOAD] + p[plants.MOTOR]
        stiffness = train.get("stiffness")
        ratio, damping = train.get("damping_ratio"), train.get("damping")
        p[plants.HALF_GAP] = train.get("backlash") / 2
        if stiffness:
            p[plants.TWO], p[plants.STIFFNESS] = 1.0, stiffness
            p[plants.DAMPING] = damping or reduction.shaft_damping(ratio, p[plants.MOTOR], p[plants.LOAD], stiffness)
        self.sliding_mass = p[plants.LOAD] if stiffness else self.total
        self.motor_mass = (p[plants.MOTOR] if stiffness else self.total) / p[plants.N] ** 2
        train.closed()

    def read_gravity(self, table):
        """Section 3."""
        p, mass = self.plant, table.get("counterweight_mass")
        carried = table.get("counterweight", mass * GRAVITY)
        if self.kind == "rotary":
            p[plants.MOMENT], p[plants.ZERO] = table.get("moment") - carried, table.get("zero")
        else:
            p[plants.WEIGHT] = table.get("force") - carried
        table.closed()

    def read_motor(self, axis):
        """Sections 5 and 6."""
        p, motor, inverter = self.plant, axis.sub("motor"), axis.sub("inverter")
        rotary = "torque_constant" in motor.values
        constant = motor.get("torque_constant" if rotary else "force_constant")
        p[plants.FORCE] = constant * p[plants.N]
        model = motor.get("model", "")
        self.electrical = model != "force"
        if self.electrical:
            p[plants.MODEL] = plants.DC if model == "dc" else plants.THREE_PHASE
            p[plants.EMF], p[plants.RESISTANCE] = motor.get("emf_constant"), motor.get("phase_resistance")
            p[plants.INDUCTANCE] = motor.get("phase_inductance")
        mutual, pitch, pairs = motor.get("mutual_inductance"), motor.get("pole_pair_pitch"), motor.get("pole_pairs")
        winding = motor.get("phase_force_constant", None)
        if model == "synchronous":
            p[plants.INDUCTANCE] -= mutual
            p[plants.ELECTRICAL] = pairs * p[plants.N] if pairs else 2 * math.pi / pitch
            p[plants.FORCE] = (winding if winding is not None else constant * 2 / 3) * p[plants.N]
        self.unit_force = constant * p[plants.N]  # N or N m of the load a unit of the command
        self.dead_ticks = round(inverter.get("dead_time") / self.tick)
        self.volts, self.amperes = inverter.get("voltage_limit"), inverter.get("current_limit")
        self.drives_current = "/A" in motor.raw("torque_constant" if rotary else "force_constant")
        motor.closed()
        inverter.closed()

    def read_friction(self, friction, at, mass):
        """Section 4; mass: kg or kg m^2 that a damping ratio of bristles refers to."""
        p = self.plant[at:at + plants.FRICTION]
        use = friction.get("use", None)
        if use is None:
            return friction.closed()
        table = friction.sub(use)
        p[plants.KIND] = LAWS[use]
        p[plants.LEVEL], p[plants.VISCOUS] = table.get("coulomb"), table.get("viscous")
        p[plants.STATIC] = p[plants.LEVEL] * table.get("static_ratio", 1.0)
        p[plants.SLOPE] = table.get("slope")
        if use == "lugre":
            p[plants.STRIBECK], p[plants.BRISTLE] = table.get("stribeck_velocity"), table.get("stiffness")
            p[plants.BRISTLE_DAMPING] = 2 * table.get("damping_ratio") * math.sqrt(p[plants.BRISTLE] * mass)
        table.closed()
        friction.closed()

    def read_encoders(self, axis):
        """Section 7: rows for position, speed and the second encoder; a missing one is the one for position."""
        first = axis.sub("encoder")
        self.speed_kind = {"ideal": law.IDEAL_SPEED, "mean-difference": law.MEAN_DIFFERENCE}[first.get("velocity", "ideal")]
        self.rows = [self.read_encoder(first, None)]
        for name in ("velocity_encoder", "second_encoder"):
            self.rows.append(self.read_encoder(axis.sub(name), self.rows[0]))
        self.second = bool(axis.values.get("second_encoder"))

    def read_encoder(self, table, default):
        """Body, increment (m or rad at the load), delay (s)."""
        if default and not table.values:
            return default
        on, counts = table.get("on", "load"), table.get("counts", None)
        increment = table.get("increment")
        if counts:
            increment = scale.increment_of(counts, on, self.kind, self.plant[plants.N])
        if table.get("noise"):
            raise ValueError(f"{table.path}: found noise; expected none, the truth has no chance in it")
        row = (1.0 if on == "motor" else 0.0, increment, table.get("delay"))
        table.closed()
        return row

    def encoders(self, substeps):
        """The table for the integrator, delays in sub-steps; they have to be a whole number of them."""
        made = np.zeros((3, scale.ENCODER))
        for at, (body, increment, delay) in zip(made, self.rows):
            steps = delay / self.tick * substeps
            if abs(steps - round(steps)) > 1e-9:
                raise ValueError(f"found a delay of {delay} s; expected a multiple of {self.tick / substeps} s")
            at[:] = body, increment, round(steps)
        return made

    def read_controller(self, axis):
        """Section 8."""
        c, table = self.control, axis.sub("controller")
        structure = table.get("structure", "cascade")
        period = table.get("period", self.slow if structure == "cascade" else self.tick)
        c[law.STRUCTURE], c[law.TICK], c[law.PERIOD] = STRUCTURES[structure], self.tick, round(period / self.tick)
        c[law.SPEED_KIND] = self.speed_kind
        unit = self.read_cascade(axis) if structure == "cascade" else self.read_single(table)
        current = axis.sub("current_controller")
        loop = self.electrical and unit == "A"
        c[law.CURRENT_LOOP], c[law.CURRENT_GAIN] = float(loop), current.get("gain")
        c[law.CURRENT_TIME], c[law.VOLTS] = current.get("integral_time"), self.volts
        c[law.PHASES] = 3.0 if self.plant[plants.MODEL] == plants.THREE_PHASE else 1.0
        supply = table.get("supply")
        c[law.LIMIT] = supply or (self.amperes if unit == "A" else self.volts)
        self.unit = unit
        table.closed()
        current.closed()

    def read_cascade(self, axis):
        """Settings of the cascade; returns the unit of the speed controller's output."""
        c = self.control
        place, speed = axis.sub("position_controller"), axis.sub("velocity_controller")
        feed, notch = axis.sub("feedforward"), axis.sub("notch")
        c[law.GAIN], c[law.POSITION_INCREMENT] = place.get("gain"), place.get("increment")
        c[law.SPEED_GAIN], c[law.INTEGRAL_TIME] = speed.get("gain"), speed.get("integral_time")
        c[law.FEED_SPEED] = feed.get("velocity")
        c[law.FEED_ACCELERATION] = feed.get("current") * self.total / self.unit_force
        if notch.values:
            c[law.NOTCH] = 1.0
            keys = ("frequency", "numerator_damping", "denominator_damping")
            c[law.B0:law.A2 + 1] = law.notch(*(notch.get(key) for key in keys), self.tick)
        for table in (place, speed, feed, notch):
            table.closed()
        return speed.raw("gain").split()[1]

    def read_single(self, table):
        """Settings of p-voltage, pd and pid; returns the unit of the output."""
        c = self.control
        c[law.GAIN], c[law.DERIVATIVE] = table.get("gain"), table.get("derivative")
        c[law.INTEGRAL_TIME] = table.get("integral_time")
        return table.raw("gain").split()[1].split("/")[0]

    def rest(self, position):
        """The state at rest at a position: no speed, no twist, no current, bristles without load."""
        y = np.zeros(plants.STATES)
        y[plants.QL] = y[plants.QM] = position
        return y
