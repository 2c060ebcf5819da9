"""A machine of machines.py as the TOML text that the programme reads (docs/formats.md, contract section 3)."""

import math

from machines import SLOW, TICK


def text(m):
    """The whole file. Units of a rotary axis: N m, kg m^2, rad."""
    force, way, mass = ("N m", "rad", "kg m^2") if m.rotary else ("N", "m", "kg")
    if m.shaft:
        return two_bodies(m)
    constant = "torque_constant" if m.rotary else "force_constant"
    lines = head(m) + [f'{"inertia" if m.rotary else "mass"} = "{m.mass!r} {mass}"'] + limits(m, way)
    return "\n".join(lines + motor(m, force, way, constant, m.force_constant, m.emf, "") + loops(m, force, way)
                     + friction(m, force, way)) + "\n"


def head(m):
    """Schema, timing, kind."""
    return ['schema = "stiction.machine/1"', f'name = "second truth, {"rotary" if m.rotary else "linear"} axis"', "",
            "[timing]", f'fast_period = "{TICK * 1e6!r} us"', f'slow_period = "{SLOW * 1e3!r} ms"', "", "[axis.X]",
            f'kind = "{"rotary" if m.rotary else "linear"}"']


def limits(m, way):
    """Stroke, speed, acceleration."""
    return [f'travel = "{m.stroke:.6g} {way}"', f'max_velocity = "{m.speed:.6g} {way}/s"',
            f'max_acceleration = "{m.acceleration:.6g} {way}/s^2"', ""]


def motor(m, force, way, constant, value, emf, shaft):
    """Motor and inverter."""
    lines = ["[axis.X.motor]", f'model = "{m.model}"', f'{constant} = "{value!r} {force}/A"']
    if m.model != "force":
        lines += [f'phase_resistance = "{m.resistance!r} Ohm"', f'phase_inductance = "{m.inductance!r} H"',
                  f'emf_constant = "{emf!r} V s/{shaft or way}"']
    if m.model == "synchronous":
        lines += [f'mutual_inductance = "{m.mutual!r} H"']
        lines += [f"pole_pairs = {round(2 * math.pi / m.pitch)}" if m.rotary else f'pole_pair_pitch = "{m.pitch!r} m"']
    lines += ["", "[axis.X.inverter]", f'dead_time = "{m.dead_time * 1e6!r} us"', f'voltage_limit = "{m.volts!r} V"',
              f'current_limit = "{m.amperes!r} A"', ""]
    return lines


def loops(m, force, way):
    """Encoder and controllers."""
    lines = ["[axis.X.encoder]", f'increment = "{m.increment!r} {way}"', f'velocity = "{m.velocity}"']
    if m.shaft:
        lines += [f'on = "{m.encoder_on}"']
    lines += ["", "[axis.X.position_controller]", f'gain = "{m.position_gain!r} 1/s"',
              f'increment = "{m.position_increment!r} {way}"', "", "[axis.X.velocity_controller]",
              f'gain = "{m.velocity_gain!r} A s/{way}"', f'integral_time = "{m.integral_time!r} s"', ""]
    if m.model != "force":
        lines += ["[axis.X.current_controller]", f'gain = "{m.current_gain!r} V/A"',
                  f'integral_time = "{m.current_time!r} s"', ""]
    lines += ["[axis.X.feedforward]", f"velocity = {m.feed_speed!r}", f"current = {m.feed_current!r}", ""]
    # Without feedforward the axis follows its set-points by speed over position gain.
    behind = 0.1 * m.stroke + 2 * m.speed / m.position_gain
    return lines + ["[axis.X.supervision]", f'following_error = "{behind:.6g} {way}"', ""]


def friction(m, force, way):
    """The law in use, and dry friction for commands that want it."""
    slope = f"{force} s/{way}"
    name = "classical" if m.friction == "coulomb_viscous" else m.friction
    lines = ["[axis.X.friction]", f'use = "{name}"', "", f"[axis.X.friction.{name}]"]
    if name == "maxwell_slip":
        return lines + ["stiffness = [" + ", ".join(f'"{k!r} {force}/{way}"' for k, _ in m.elements) + "]",
                        "level = [" + ", ".join(f'"{f!r} {force}"' for _, f in m.elements) + "]",
                        f'viscous = "{m.viscous!r} {slope}"']
    lines += [f'coulomb = "{m.coulomb!r} {force}"', f'viscous = "{m.viscous!r} {slope}"']
    if name in ("lugre", "elasto_plastic", "dahl"):
        lines += [f'stiffness = "{m.stiffness!r} {force}/{way}"']
    if name in ("lugre", "elasto_plastic"):
        lines += [f"static_ratio = {m.static_ratio!r}", f'stribeck_velocity = "{m.stribeck!r} {way}/s"',
                  f"damping_ratio = {m.damping_ratio!r}"]
    if name == "elasto_plastic":
        lines += [f"break_away_share = {m.break_away_share!r}"]
    if name == "classical":
        lines += [f"static_ratio = {m.static_ratio!r}"]
    return lines


def two_bodies(m):
    """A rotary motor that drives the load through an elastic shaft; its unit of angle is that of the load, or 1 rad is
    1 m of the load (lead 2 pi m), so that no ratio hides in the numbers."""
    force, way, mass = ("N m", "rad", "kg m^2") if m.rotary else ("N", "m", "kg")
    load, inertia = (1 - m.motor_part) * m.mass, m.motor_part * m.mass
    lines = head(m) + [f'{"inertia" if m.rotary else "mass"} = "{load!r} {mass}"'] + limits(m, way)
    turn = ["ratio = 1"] if m.rotary else [f'lead = "{2 * math.pi!r} m"']
    lines += ["[axis.X.transmission]", *turn, f'motor_inertia = "{inertia!r} kg m^2"',
              f'stiffness = "{m.shaft!r} {force}/{way}"', f"damping_ratio = {m.shaft_damping_ratio!r}", ""]
    constant = "torque_constant"
    return "\n".join(lines + motor(m, "N m", way, constant, m.force_constant, m.emf, "rad") + loops(m, force, way)
                     + friction(m, force, way)) + "\n"
