"""The cases: each a machine file (machines/NAME.toml, whose first line says what it exercises) and set-points.

Values are those of catalogue parts of the size in question, rounded; none of them belongs to a measured machine.
"""

import pathlib
import re

from machine import Machine
from setpoints import moves, sine, speed

MACHINES = pathlib.Path(__file__).resolve().parent / "machines"
# Each a function of the tick (s) that gives rows of x_set, v_set, a_set.
CASES = {
    "servo_joint_p_voltage": lambda tick: moves(tick, 0.0, [(0.4, 1.2, 0.3), (0.25, -2.0, 0.4), (0.6, 0.5, 0.2)]),
    "pendulum_pd_voltage": lambda tick: moves(tick, 0.5235987755982988, [(0.8, 2.4, 0.3), (0.8, -3.0, 0.4)]),
    "ball_screw_pd_current": lambda tick: moves(tick, 0.0, [(0.25, 0.06, 0.1), (0.25, -0.06, 0.1), (0.3, 0.001, 0.1)]),
    "screw_scale_two_encoders": lambda tick: moves(tick, 0.0, [(0.15, 0.02, 0.05), (0.15, -0.02, 0.05)]),
    "belt_pid_current": lambda tick: moves(tick, 0.1, [(0.5, 0.8, 0.2), (0.4, -0.5, 0.3)]),
    "vertical_counterweight_cascade": lambda tick: moves(tick, 0.0, [(0.3, 0.05, 0.1), (0.3, -0.05, 0.1)]),
    "gear_backlash_pd_current": lambda tick: sine(tick, 0.0, 0.35, 1.25, 2.0),
    "endless_355_113_cascade": lambda tick: speed(tick, 0.0, 12.0, 0.4, 2.5),
    "linear_synchronous_cascade": lambda tick: moves(tick, 0.0, [(0.15, 0.03, 0.05), (0.15, -0.03, 0.05)]),
    "geared_pid_current_loop": lambda tick: moves(tick, 0.0, [(0.4, 1.0, 0.1), (0.4, -1.5, 0.1)]),
    "late_encoder_pid_voltage": lambda tick: sine(tick, 0.05, 0.02, 1.25, 2.4),
    "elastic_arm_gravity_cascade": lambda tick: moves(tick, 0.0, [(0.6, 1.4, 0.2), (0.6, -2.0, 0.2)]),
}


def text_of(name, increment=None):
    """The machine file's text. increment: of every encoder and of the position error, in m or rad, in place of its own; so
    fine that no count can fall to either side of a border by the last digits of an integrator."""
    text = (MACHINES / f"{name}.toml").read_text(encoding="utf-8")
    if increment is None:
        return text
    unit = "rad" if 'kind = "rotary"' in text else "m"
    return re.sub(r"(?m)^( *)(?:counts|increment) = .*$", rf'\1increment = "{increment!r} {unit}"', text)


def load(name, increment=None):
    """Machine and rows of set-points of a case."""
    machine = Machine(text_of(name, increment))
    return machine, CASES[name](machine.tick)
