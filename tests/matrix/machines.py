"""What the machine files hold, read apart from the programme: axes, friction models, the values that an identification
has to find, and a machine whose Coulomb friction is not that of its file."""

import dataclasses
import fractions
import math
import re
import tomllib

# A number and its unit, in SI; the units that masses, friction and limits of the shipped files are written in.
SI = {"": 1.0, "kg": 1.0, "kg m^2": 1.0, "N": 1.0, "N m": 1.0, "N s/m": 1.0, "N m s/rad": 1.0, "N/m": 1.0, "m": 1.0,
      "mm": 1e-3, "um": 1e-6, "m/s": 1.0, "mm/s": 1e-3, "m/min": 1.0 / 60.0, "m/s^2": 1.0, "deg": math.pi / 180.0,
      "rad": 1.0, "rad/s": 1.0, "rad/s^2": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "N/um": 1e6, "1": 1.0}


def si(text):
    """A quantity of a machine file in SI units."""
    if isinstance(text, (int, float)):
        return float(text)
    number, _, unit = text.strip().partition(" ")
    return float(number) * SI[unit.strip()]


def table_at(table, *path):
    for key in path:
        table = table.get(key, {})
    return table


@dataclasses.dataclass(frozen=True)
class Machine:
    """A shipped machine file."""
    name: str
    text: str

    @property
    def tables(self):
        return tomllib.loads(self.text)

    @property
    def axes(self):
        return list(self.tables.get("axis", {}))

    def axis(self, name):
        return self.tables["axis"][name]

    def rotary(self, axis):
        return self.axis(axis).get("kind") == "rotary"

    def models(self, axis):
        """The friction models that the file has parameters of."""
        return [key for key, value in table_at(self.axis(axis), "friction").items() if isinstance(value, dict)]

    def parameters(self, axis, model):
        return self.axis(axis)["friction"][model]

    def coulomb(self, axis, model):
        """Level of Coulomb friction (N, N m) of a model; None where its law has none."""
        parameters = self.parameters(axis, model)
        if "coulomb" in parameters:
            return si(parameters["coulomb"])
        if "level" in parameters:
            return sum(map(si, parameters["level"]))
        if "forward" in parameters:  # a measured curve: both directions at the lowest speed
            return 0.5 * (si(parameters["forward"][0]) + si(parameters["backward"][0]))
        return None

    def straight_level(self, axis, model, factor=1.0):
        """What the straight line of sliding has at standstill, with `factor` times the Coulomb friction; None where
        sliding is no straight line. A ramp reaches its Coulomb friction at the break velocity, from where on viscous
        friction grows."""
        coulomb = self.coulomb(axis, model)
        parameters = self.parameters(axis, model)
        if coulomb is None or "forward" in parameters:
            return None
        if "slope" in parameters:
            return factor * coulomb * (1.0 - si(parameters["viscous"]) / si(parameters["slope"]))
        return factor * coulomb

    def turns(self, axis):
        """Radians of the motor and of the screw, pulley or rotary axis for a metre (radian) of the axis."""
        train = table_at(self.axis(axis), "transmission")
        turn = train.get("lead", train.get("pulley_circumference"))
        screw = 2.0 * math.pi / si(turn) if turn else 1.0
        return float(fractions.Fraction(str(train.get("ratio", 1)).replace(" ", ""))) * screw, screw

    def moved(self, axis):
        """The mass (inertia) that the motor moves, reduced to the axis by its energy: the load with what moves along,
        the motor's rotor, and screw or pulley."""
        values = self.axis(axis)
        train = table_at(values, "transmission")
        motor, screw = self.turns(axis)
        load = si(values["inertia" if values.get("kind") == "rotary" else "mass"])
        load += si(table_at(values, "gravity").get("counterweight_mass", 0.0))
        return load + si(train.get("motor_inertia", 0.0)) * motor**2 + si(train.get("screw_inertia", 0.0)) * screw**2

    def force_constant(self, axis):
        """Force (torque) at the axis for an ampere or a volt."""
        motor = self.axis(axis)["motor"]
        at_axis = "force_constant" in motor
        number = float(motor["force_constant" if at_axis else "torque_constant"].split()[0])
        return number if at_axis else number * self.turns(axis)[0]

    def truths(self, axis, model, factor=1.0):
        """What identification has to find, by the names of its result: the file's values, Coulomb friction times
        `factor`. The contact of a model is no truth of another model's fit, so only what laws share is asked for."""
        values = self.axis(axis)
        rotary = self.rotary(axis)
        truths = {"inertia_kg_m2" if rotary else "mass_kg": self.moved(axis)}
        coulomb = self.straight_level(axis, model, factor)
        if coulomb is not None:
            truths["coulomb_N_m" if rotary else "coulomb_N"] = coulomb
        if "viscous" in self.parameters(axis, model):
            truths["viscous_N_m_s_per_rad" if rotary else "viscous_N_s_per_m"] = si(
                self.parameters(axis, model)["viscous"])
        return truths

    def with_coulomb(self, axis, model, factor):
        """The file of a machine with another level of Coulomb friction, by the effect that diagnosis has to name; None
        where no level can be changed. A law without a level of its own gets the part of the axis' other models."""
        level = self.coulomb(axis, model)
        if level:  # a machine without friction has nothing to change
            true = factor * level
        else:
            others = [self.coulomb(axis, other) for other in self.models(axis)]
            others = [each for each in others if each]
            if not others or factor < 1.0:
                return None
            true = (factor - 1.0) * max(others)
        unit = "N m" if self.rotary(axis) else "N"
        return self.text + f'\n[[axis.{axis}.effect]]\nname = "coulomb_mismatch"\ncoulomb = "{true:.9g} {unit}"\n'

    def using(self, axis, model):
        """Arguments that put a friction model in use."""
        return ["--set", f"axis.{axis}.friction.use={model}"]

    def limits(self, axis):
        """Travel, speed and acceleration that the axis bears, in SI units."""
        values = self.axis(axis)
        travel = values.get("travel", "360 deg")  # an endless axis has none
        return si(travel), si(values["max_velocity"]), si(values["max_acceleration"])


def shipped(program):
    """The machines that ship, in the order in which the programme lists them."""
    return [Machine(name, (program.machines_folder / f"{name}.toml").read_text(encoding="utf-8"))
            for name in program.machines()]


@dataclasses.dataclass(frozen=True, order=True)
class Cell:
    """One row of the matrix. The machine as a whole, without axis and model, is a row as well."""
    machine: str
    axis: str
    model: str
    seed: int

    def __str__(self):
        return f"{self.machine}/{self.axis}/{self.model}/{self.seed}"

    def file_name(self):
        return re.sub(r"[^\w.-]", "_", str(self))


WHOLE = "-"


def table_of_cells(machines, seeds):
    """Every machine as a whole, and every axis with every model that its file has, once for each seed."""
    cells = []
    for machine in machines:
        cells.append(Cell(machine.name, WHOLE, WHOLE, seeds[0]))
        for seed in seeds:
            for axis in machine.axes:
                cells += [Cell(machine.name, axis, model, seed) for model in machine.models(axis)]
    return cells
