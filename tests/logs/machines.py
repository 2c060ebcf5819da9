"""Axes near the shipped ones: the true machine, which nobody is told, and the file that the programme is given.

The file knows the controller and the force constant exactly; its mass and its friction are wrong by up to 15 %.
"""

import dataclasses
import pathlib
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHIPPED = ROOT / "firmware/machine/shipped"
# stick-slip-feed has a feed drive and no axis, so no log of one; the axes with a screw are those of tests/matrix.
AXES = ("emps.X", "mcfv5050ln.X", "mcfv5050ln.Y")
FILE_ERROR = 0.15  # largest relative error of what the file says of mass and friction

UNITS = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "nm": 1e-9, "um": 1e-6, "mm": 1e-3, "m": 1.0, "m/min": 1 / 60, "mH": 1e-3}


def si(text):
    """"500 mm" -> 0.5. Units that are not in the table are SI units already."""
    if isinstance(text, (int, float)):
        return float(text)
    number, _, unit = text.partition(" ")
    return float(number) * UNITS.get(unit, 1.0)


@dataclasses.dataclass
class Axis:
    """The true axis; SI units, amperes are amplitudes, forces positive in +x, the offset is one of the motor's force:
    motor force = mass * a + viscous * v + coulomb * sgn(v) + offset."""

    cell: str  # "emps.X"
    name: str  # "X"
    mass: float
    coulomb: float
    viscous: float
    offset: float
    force_constant: float  # N/A, or N/V with a force motor
    stiffness: float  # of the contact before it slides, N/m; 0: rigid, set-valued Coulomb friction
    use: str  # friction law that the file names
    travel: float
    max_velocity: float
    max_acceleration: float
    position_gain: float
    position_increment: float
    velocity_gain: float
    integral_time: float  # 0: proportional
    current_gain: float  # 0: force motor
    current_integral_time: float
    resistance: float
    inductance: float
    emf: float
    count: int
    dead_ticks: int  # of 62.5 us
    notch: tuple  # frequency Hz, damping ratios of numerator and denominator; () without
    limit: float  # of current (all motors) or of voltage
    increment: float  # of the encoder
    noise: float  # of the encoder before it rounds, rms
    velocity: str  # as in the machine file
    file: dict = dataclasses.field(default_factory=dict)  # mass, coulomb, viscous, stiffness as the file has them

    @property
    def effort(self):
        return "i" if self.current_gain else "u"


def shipped(cell):
    """The tables of an axis of a shipped file."""
    machine, name = cell.split(".")
    text = (SHIPPED / f"{machine}.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)["axis"][name], name


def published(cell):
    """The axis as the shipped file has it."""
    table, name = shipped(cell)
    motor, notch = table["motor"], table.get("notch")
    forced = motor["model"] == "force"
    friction = table["friction"]["coulomb_viscous"]
    current = table.get("current_controller", {})
    count = int(motor.get("count", 1))
    limit = si(table["inverter"]["voltage_limit"] if forced else table["inverter"]["current_limit"]) * count
    stiffness = si(table["friction"].get("lugre", {}).get("stiffness", 0))
    return Axis(
        cell=cell, name=name, mass=si(table["mass"]), coulomb=si(friction["coulomb"]), viscous=si(friction["viscous"]),
        offset=-3.1648 if forced else 0.0, force_constant=si(motor["force_constant"]), stiffness=stiffness,
        use=table["friction"]["use"], travel=si(table["travel"]), max_velocity=si(table["max_velocity"]),
        max_acceleration=si(table["max_acceleration"]), position_gain=si(table["position_controller"]["gain"]),
        position_increment=si(table["position_controller"].get("increment", 0)),
        velocity_gain=si(table["velocity_controller"]["gain"]),
        integral_time=si(table["velocity_controller"].get("integral_time", 0)), current_gain=si(current.get("gain", 0)),
        current_integral_time=si(current.get("integral_time", 0)), resistance=si(motor.get("phase_resistance", 0)),
        inductance=si(motor.get("phase_inductance", 0)), emf=si(motor.get("emf_constant", 0)), count=count,
        dead_ticks=round(si(table["inverter"]["dead_time"]) / 62.5e-6),
        notch=tuple(si(notch[k]) for k in ("frequency", "numerator_damping", "denominator_damping")) if notch else (),
        limit=limit, increment=si(table["encoder"]["increment"]), noise=0.0, velocity=table["encoder"]["velocity"])


def draw(rng, cell, increment, law=None, exact=False):
    """A true axis near a shipped one, with an encoder of this increment, and its file's errors.

    law: "coulomb" (set-valued, sticks rigidly), "dahl" (a contact with one stiffness), or None: drawn.
    exact: the file has the true values, and the offset as a constant force.
    """
    axis = published(cell)
    near = lambda value, width: value * (1 + rng.uniform(-width, width))
    axis.mass, axis.coulomb, axis.viscous = near(axis.mass, 0.2), near(axis.coulomb, 0.3), near(axis.viscous, 0.3)
    axis.force_constant = round(near(axis.force_constant, 0.1), 6)
    axis.offset = rng.uniform(-0.2, 0.2) * axis.coulomb
    law = law or ("coulomb" if axis.stiffness == 0 or rng.random() < 0.5 else "dahl")
    if law == "coulomb":
        axis.stiffness, axis.use = 0.0, "coulomb_viscous" if axis.current_gain == 0 else "classical"
    else:
        axis.stiffness, axis.use = near(axis.stiffness, 0.3), "dahl" if rng.random() < 0.5 else "lugre"
    axis.increment, axis.noise = increment, increment * rng.choice([0.0, 0.5])
    soften(axis)
    keys = ("mass", "coulomb", "viscous") + (("stiffness",) if axis.stiffness else ())
    axis.file = {key: near(getattr(axis, key), 0.0 if exact else FILE_ERROR) for key in keys}
    axis.file["constant_force"] = -axis.offset if exact else 0.0
    return axis


def soften(axis):
    """A drive with a coarse encoder has a tachometer or time-stamped edges for its speed, and a position gain at which
    one increment makes no more force than half of the Coulomb friction, or it would chatter."""
    if axis.increment <= 1e-6:
        return
    axis.velocity = "ideal"
    force = axis.increment * axis.velocity_gain * axis.force_constant
    axis.position_gain = round(min(axis.position_gain, 0.5 * axis.coulomb / force), 3)


def friction_table(axis):
    """What the file says of friction; every law that it may use has the same level and slope."""
    file = axis.file
    common = f'coulomb = "{file["coulomb"]:.6g} N"\nviscous = "{file["viscous"]:.6g} N s/m"\n'
    text = f'[axis.{axis.name}.friction]\nuse = "{axis.use}"\n[axis.{axis.name}.friction.coulomb_viscous]\n{common}'
    if axis.use == "classical":
        text += f"[axis.{axis.name}.friction.classical]\n{common}static_ratio = 1.0\n"
    if axis.stiffness:
        stiffness = f'stiffness = "{file["stiffness"]:.6g} N/m"\n'
        text += f"[axis.{axis.name}.friction.dahl]\n{common}{stiffness}"
        text += (f"[axis.{axis.name}.friction.lugre]\n{common}{stiffness}static_ratio = 1.0\n"
                 'stribeck_velocity = "1 mm/s"\ndamping_ratio = 0.1\n')
    return text


def effect_table(axis):
    """The offset as a force on the carriage, where the file knows it."""
    force = axis.file["constant_force"]
    return f'[[axis.{axis.name}.effect]]\nname = "constant_force"\nforce = "{force:.6g} N"\n' if force else ""


def motor_table(axis):
    if not axis.current_gain:
        return (f'model = "force"\nforce_constant = "{axis.force_constant:.6f} N/V"\n[axis.{axis.name}.inverter]\n'
                f'dead_time = "0 us"\nvoltage_limit = "{axis.limit:.6g} V"\n')
    return (f'model = "dc"\nphase_resistance = "{axis.resistance:.6g} Ohm"\nphase_inductance = "{axis.inductance:.6g} H"\n'
            f'emf_constant = "{axis.emf:.6g} V s/m"\nforce_constant = "{axis.force_constant:.6f} N/A"\n'
            f'count = {axis.count}\n[axis.{axis.name}.inverter]\ndead_time = "{axis.dead_ticks * 62.5:.6g} us"\n'
            f'voltage_limit = "600 V"\ncurrent_limit = "{axis.limit / axis.count:.6g} A"\n')


def controller_table(axis):
    unit = "A s/m" if axis.current_gain else "V s/m"
    at = f"axis.{axis.name}"
    text = f'[{at}.position_controller]\ngain = "{axis.position_gain:.9g} 1/s"\n'
    if axis.position_increment:
        text += f'increment = "{axis.position_increment:.6g} m"\n'
    text += f'[{at}.velocity_controller]\ngain = "{axis.velocity_gain:.9g} {unit}"\n'
    if axis.integral_time:
        text += f'integral_time = "{axis.integral_time:.6g} s"\n'
    if axis.current_gain:
        text += (f'[{at}.current_controller]\ngain = "{axis.current_gain:.6g} V/A"\n'
                 f'integral_time = "{axis.current_integral_time:.6g} s"\n')
        text += f"[{at}.feedforward]\nvelocity = 1.0\ncurrent = 1.0\n"
    if axis.notch:
        text += (f'[{at}.notch]\nfrequency = "{axis.notch[0]:.6g} Hz"\nnumerator_damping = {axis.notch[1]}\n'
                 f"denominator_damping = {axis.notch[2]}\n")
    return text


def machine_file(axis):
    """The text of the machine file that the programme is given."""
    at = f"axis.{axis.name}"
    fast = "62.5 us" if axis.current_gain else "1 ms"
    return (f'schema = "stiction.machine/1"\nname = "near {axis.cell}"\n[timing]\nfast_period = "{fast}"\n'
            f'slow_period = "1 ms"\n[{at}]\nmass = "{axis.file["mass"]:.6g} kg"\ntravel = "{axis.travel:.6g} m"\n'
            f'max_velocity = "{axis.max_velocity:.6g} m/s"\nmax_acceleration = "{axis.max_acceleration:.6g} m/s^2"\n'
            f"[{at}.motor]\n{motor_table(axis)}[{at}.encoder]\n"
            f'increment = "{axis.increment:.6g} m"\nnoise = "{axis.noise:.6g} m"\nvelocity = "{axis.velocity}"\n'
            f"{controller_table(axis)}{friction_table(axis)}{effect_table(axis)}")
