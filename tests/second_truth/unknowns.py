"""Effects without a name: functions of two coordinates, events, memory of load, switching, rest, way after a turn."""

import paths  # noqa: F401
import numpy as np

import plant
import smooth
from hidden import Cause
from trajectories import log_uniform


def named(form, apply, size, least, most, shape):
    """A Cause without a name of the vocabulary."""
    return Cause(f"unknown:{form}", apply, size, least, most, shape)


def place_and_speed(rng, machine, session):
    """A force that is a product of two processes, of position and of speed, without a mean over either."""
    at, over = smooth.process(rng, machine.stroke * log_uniform(rng, 0.08, 0.25)), smooth.process(rng, 0.6)
    x, v = session.motion(0)[::160], np.abs(session.motion(1)[::160])
    mean, mean_v = np.mean(at(x)), np.mean(over(np.log1p(10 * v / machine.speed)))

    def apply(s, size):
        s.table(plant.PLACE_OF_SPEED, at(s.places()) - mean)
        s.table(plant.SPEED_OF_PLACE, size * (over(np.log1p(10 * s.speeds() / machine.speed)) - mean_v))
    c = machine.coulomb
    return named("place and speed", apply, 0.02 * c, 1e-6 * c, 2 * c, "product of processes over position and speed")


def place_and_acceleration(rng, machine, session):
    """A mass that changes along the stroke."""
    at = smooth.process(rng, machine.stroke * log_uniform(rng, 0.08, 0.25))
    mean = np.mean(at(session.motion(0)[::160]))

    def apply(s, size):
        s.table(plant.MASS_AT_PLACE, np.clip(size * (at(s.places()) - mean), -0.6, 2.0))
    return named("place and acceleration", apply, 0.01, 1e-5, 0.4, "mass as a process over position")


def events(rng, machine, session):
    """A few pulses of force in each log, of random place, length and sign."""
    pulses = []
    for sets in session.sets:
        end = len(sets) * session.tick
        count = int(rng.integers(2, 6))
        pulses.append([(rng.uniform(0.1, 0.95) * end, log_uniform(rng, 0.02, 0.3), rng.normal() + np.sign(rng.normal()))
                       for _ in range(count)])

    def apply(s, size):
        s.forces.append(lambda log, t: size * sum(
            h * np.exp(-np.abs((t - at) / width) ** 3) for at, width, h in pulses[log]))
    c = machine.coulomb
    return named("events", apply, 0.1 * c, 1e-4 * c, 20 * c, "pulses of force at random times")


def memory_of_load(rng, machine, session):
    """Friction whose level remembers the motor's force of the last second."""
    time, reference = log_uniform(rng, 0.2, 2.0), machine.coulomb + 0.3 * machine.mass * machine.acceleration

    def apply(s, size):
        s.p[plant.MEMORY_SIZE], s.p[plant.MEMORY_TIME], s.p[plant.MEMORY_FORCE] = size, time, reference
    return named("memory of load", apply, 0.05, 1e-4, 3.0, f"level of friction follows force with {time:.2f} s")


def switching(rng, machine, session):
    """A level of friction, or a force, that jumps between two values at random times."""
    of_force = rng.random() < 0.5
    jumps = []
    for sets in session.sets:
        end, at, state, own = len(sets) * session.tick, 0.0, rng.random() < 0.5, []
        while at < end:
            at += rng.exponential(1.5) + 0.2
            own.append(at)
        jumps.append((float(state), np.array(own)))

    def square(log, t):
        state, at = jumps[log]
        return 2 * np.mod(state + np.searchsorted(at, t), 2) - 1

    def apply(s, size):
        if of_force:
            s.forces.append(lambda log, t: size * machine.coulomb * square(log, t))
        else:
            s.factors.append(lambda log, t: 1 + size * square(log, t))
    return named("switching", apply, 0.02, 1e-5, 0.7, "a force" if of_force else "the level of friction")


def rest(rng, machine, session):
    """Friction that ages at rest and is renewed over a way."""
    way, time = log_uniform(rng, 2e-4, 5e-3) / machine.length, log_uniform(rng, 0.01, 0.1)

    def apply(s, size):
        s.p[plant.REST_SIZE], s.p[plant.REST_WAY], s.p[plant.REST_TIME] = size, way, time
    return named("rest", apply, 0.05, 1e-4, 2.0, f"level after rest, renewed over {way:.3g}")


def way_since_reversal(rng, machine, session):
    """A level of friction that depends on the way since the last reversal, over millimetres."""
    scale = log_uniform(rng, 1e-3, 1e-2) / machine.length
    draw = smooth.process(rng, 1.0)

    def apply(s, size):
        s.p[plant.WAY_STEP] = 6 * scale / (plant.NODES - 1)
        u = np.linspace(0.0, 6.0, plant.NODES)
        s.table(plant.LEVEL_AT_WAY, np.clip(size * draw(u) * np.exp(-(u / 3.5) ** 4), -0.8, 3.0))
    return named("way since reversal", apply, 0.05, 1e-4, 0.8, f"process over {scale:.3g}")


UNKNOWNS = (place_and_speed, place_and_acceleration, events, memory_of_load, switching, rest, way_since_reversal)
