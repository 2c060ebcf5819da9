"""The axis as differential equations and its closed loop in fixed steps, Numba compiled.

State: position and speed of the driven body D and of the load L (one body: both the same), three currents, the late
speed of a friction that lags. Runge and Kutta's classical rule; within a step a contact follows the displacement
(laws.py), and the standstill of dry friction is located by the secant rule. Equations: tests/axes/equations.md, 2, 4 to
6, 8.

Sources: Hairer, Norsett, Wanner 1993, II.1, II.6; Krause, Wasynczuk, Sudhoff 2013 (motor); Nordin, Gutman 2002 (gap);
Hess, Soom 1990 (friction that lags behind speed).
SI units; force means moment on a rotary axis.
"""

import math

import paths  # noqa: F401
import numpy as np

import laws
from controllers import MEMORY, TICK, control
from encoders import shown
from fast import compiled

XD, VD, XL, VL, IA, IB, IC, W1, W2, STATES = range(10)
IDEAL, DC, THREE_PHASE = range(3)
NO_LAG, FIRST_ORDER, SECOND_ORDER, PURE_DELAY = range(4)
(DRIVEN, LOAD, TWO, SHAFT, SHAFT_DAMPING, HALF_GAP, ENCODER_ON_LOAD, FRICTION_ON_LOAD, MODEL, FORCE, EMF, RESISTANCE,
 INDUCTANCE, ELECTRICAL, DEAD, INCREMENT, VISCOUS, SHARE_B, LAG, LAG_TIME, ASYMMETRY, ASYMMETRY_VISCOUS, CONSTANT,
 MEMORY_SIZE, MEMORY_TIME, MEMORY_FORCE, REST_SIZE, REST_WAY, REST_TIME, REST_SPEED, ERROR_PERIOD, ERROR_ORDERS,
 X_LOW, X_STEP, V_STEP, SAT_STEP, WAY_STEP, SCALARS) = range(38)
ERROR = SCALARS  # cosine and sine of each harmonic of the encoder's error, m
MOST_ORDERS = 6
LAW_A = ERROR + 2 * MOST_ORDERS
LAW_B = LAW_A + laws.LAW
PARAMETERS = LAW_B + laws.LAW
# Tables, linear between NODES. Over position: force, factor of the friction level, factor of the force constant, factor
# of another table over speed, factor of mass. Over speed (of its size): odd force, even force, factor of the level,
# force that the place multiplies. Over current (of its size): factor. Over way since a reversal: factor of the level.
(AT_PLACE, LEVEL_AT_PLACE, CONSTANT_AT_PLACE, PLACE_OF_SPEED, MASS_AT_PLACE, ODD_SPEED, EVEN_SPEED, LEVEL_AT_SPEED,
 SPEED_OF_PLACE, SATURATION, LEVEL_AT_WAY, TABLES) = range(12)
NODES = 4097
X, V, I, COMMAND, SHOWN, FRICTION_FORCE, OUTPUTS = range(7)


@compiled
def looked_up(tables, row, u):
    """Value of a table at the coordinate u in nodes; constant beyond its ends."""
    if u <= 0.0:
        return tables[row, 0]
    if u >= NODES - 1:
        return tables[row, NODES - 1]
    k = int(u)
    return tables[row, k] + (u - k) * (tables[row, k + 1] - tables[row, k])


@compiled
def speed_node(p, v):
    """Coordinate of a table over speed: even in the root of the speed, so that crawling has nodes too."""
    return math.sqrt(abs(v) / p[V_STEP])


@compiled
def level_factor(p, tables, on, x, v, way, level):
    """Factor of the friction level at a place and speed; way: direction of motion."""
    factor = level
    if on[LEVEL_AT_PLACE]:
        factor *= 1 + looked_up(tables, LEVEL_AT_PLACE, (x - p[X_LOW]) / p[X_STEP])
    if on[LEVEL_AT_SPEED]:
        factor *= 1 + looked_up(tables, LEVEL_AT_SPEED, speed_node(p, v))
    return max(factor * (1 + p[ASYMMETRY] * way), 0.01)


@compiled
def level_of(p, tables, on, at, x, v, side, level):
    """Steady level of a law at a place and speed, N."""
    return laws.steady(p, at, v, level_factor(p, tables, on, x, v, side, level))


@compiled
def friction(p, tables, on, z, x0, v0, x, v, late, way, level, new):
    """Friction on its body, positive against +v; `way`: the direction of dry friction, 0 while it sticks.

    x0, v0: of the start of the step."""
    seen = v if p[LAG] == NO_LAG else late
    mid = 0.5 * (v + v0) if p[LAG] == NO_LAG else late
    d = x - x0
    side = 1.0 if d > 0.0 or (d == 0.0 and v > 0.0) else -1.0
    total = p[VISCOUS] * seen
    share = p[SHARE_B]
    if share < 1.0:
        if p[LAW_A + laws.KIND] == laws.COULOMB:
            if way != 0:
                total += (1 - share) * way * p[LAW_A + laws.LEVEL] * level_factor(p, tables, on, x, seen, way, level)
        elif p[LAW_A + laws.KIND] != laws.NONE:
            mean = level_of(p, tables, on, LAW_A, x, mid, side, level)
            g = level_of(p, tables, on, LAW_A, x, seen, side, level)
            total += (1 - share) * laws.contact(p, LAW_A, z, 0, d, v, mean, g, new)
    if share > 0.0:
        mean = level_of(p, tables, on, LAW_B, x, mid, side, level)
        g = level_of(p, tables, on, LAW_B, x, seen, side, level)
        total += share * laws.contact(p, LAW_B, z, 1, d, v, mean, g, new)
    if on[ODD_SPEED]:
        total += math.copysign(looked_up(tables, ODD_SPEED, speed_node(p, seen)), seen)
    if on[EVEN_SPEED]:
        total += p[ASYMMETRY_VISCOUS] * looked_up(tables, EVEN_SPEED, speed_node(p, seen))
    return total


@compiled
def other_forces(p, tables, on, x, v):
    """Forces on the carriage that are no friction, positive in +x."""
    total = p[CONSTANT]
    if on[AT_PLACE]:
        total += looked_up(tables, AT_PLACE, (x - p[X_LOW]) / p[X_STEP])
    if on[PLACE_OF_SPEED]:
        total += looked_up(tables, PLACE_OF_SPEED, (x - p[X_LOW]) / p[X_STEP]) * looked_up(
            tables, SPEED_OF_PLACE, speed_node(p, v))
    return total


@compiled
def amplitude(p, y):
    """Current in amplitude amperes, as a drive shows it: the part of the windings' currents that makes force."""
    if p[MODEL] != THREE_PHASE:
        return y[IA]
    total = 0.0
    for k in range(3):
        total += y[IA + k] * math.sin(p[ELECTRICAL] * y[XD] + k * 2 * math.pi / 3)
    return total / 1.5


@compiled
def motor_force(p, tables, on, x, current):
    """Force of the motor for its amplitude amperes, N."""
    force = p[FORCE] * current
    if on[CONSTANT_AT_PLACE]:
        force *= 1 + looked_up(tables, CONSTANT_AT_PLACE, (x - p[X_LOW]) / p[X_STEP])
    if on[SATURATION]:
        force *= looked_up(tables, SATURATION, abs(current) / p[SAT_STEP])
    return force


@compiled
def derivative(p, tables, on, y, z, x0, v0, late, way, u, outside, level, dy, new):
    """Writes dy/dt into dy. x0, v0: of the friction's body at the start of the step; returns the force that friction
    has to hold where it sticks (way 0), and the friction."""
    two = p[TWO] > 0.0
    if p[LAG] == FIRST_ORDER:
        late = y[W1]
    elif p[LAG] == SECOND_ORDER:
        late = y[W2]
    if p[MODEL] == THREE_PHASE:
        sine, cosine = math.sin(p[ELECTRICAL] * y[XD]), math.cos(p[ELECTRICAL] * y[XD])
        half = 0.8660254037844386
        sa, sb, sc = sine, -0.5 * sine + half * cosine, -0.5 * sine - half * cosine
        current = (y[IA] * sa + y[IB] * sb + y[IC] * sc) / 1.5
        star = (u[0] + u[1] + u[2]) / 3
        emf = p[EMF] * y[VD]
        dy[IA] = (u[0] - star - emf * sa - p[RESISTANCE] * y[IA]) / p[INDUCTANCE]
        dy[IB] = (u[1] - star - emf * sb - p[RESISTANCE] * y[IB]) / p[INDUCTANCE]
        dy[IC] = (u[2] - star - emf * sc - p[RESISTANCE] * y[IC]) / p[INDUCTANCE]
    elif p[MODEL] == DC:
        current = y[IA]
        dy[IA] = (u[0] - p[RESISTANCE] * y[IA] - p[EMF] * y[VD]) / p[INDUCTANCE]
        dy[IB] = dy[IC] = 0.0
    else:
        current = u[0]
        dy[IA] = dy[IB] = dy[IC] = 0.0
    drive = motor_force(p, tables, on, y[XD], current)
    on_load = two and p[FRICTION_ON_LOAD] > 0.0
    xf, vf = (y[XL], y[VL]) if on_load else (y[XD], y[VD])
    rub = friction(p, tables, on, z, x0, v0, xf, vf, late, way, level, new)
    push = other_forces(p, tables, on, xf, vf) + outside
    stick = way == 0 and p[LAW_A + laws.KIND] == laws.COULOMB and p[SHARE_B] < 1.0
    if not two:
        mass = p[DRIVEN] + p[LOAD]
        if on[MASS_AT_PLACE]:
            mass *= 1 + looked_up(tables, MASS_AT_PLACE, (y[XD] - p[X_LOW]) / p[X_STEP])
        held = drive + push - rub
        dy[VD] = dy[VL] = 0.0 if stick else held / mass
    else:
        twist, rate = y[XD] - y[XL], y[VD] - y[VL]
        through = 0.0
        if p[HALF_GAP] == 0.0:
            through = p[SHAFT] * twist + p[SHAFT_DAMPING] * rate
        elif abs(twist) > p[HALF_GAP]:
            side = 1.0 if twist > 0.0 else -1.0
            through = p[SHAFT] * (twist - side * p[HALF_GAP]) + p[SHAFT_DAMPING] * rate
            if through * side < 0.0:
                through = 0.0
        if on_load:
            held = through + push - rub
            dy[VL] = 0.0 if stick else held / p[LOAD]
            dy[VD] = (drive - through) / p[DRIVEN]
        else:
            held = drive + push - rub - through
            dy[VD] = 0.0 if stick else held / p[DRIVEN]
            dy[VL] = through / p[LOAD]
    dy[XD], dy[XL] = y[VD], y[VL]
    dy[W1] = dy[W2] = 0.0
    if p[LAG] == FIRST_ORDER:
        dy[W1] = (vf - y[W1]) / p[LAG_TIME]
    elif p[LAG] == SECOND_ORDER:
        dy[W1] = 2 * (vf - y[W1]) / p[LAG_TIME]
        dy[W2] = 2 * (y[W1] - y[W2]) / p[LAG_TIME]
    return held, rub


@compiled
def stepped(p, tables, on, y, z, late, way, u, outside, level, h, out, work, new):
    """One step of Runge and Kutta's rule from y into out, the contacts' states at its end into new.

    late: the late speed of a pure delay at the start, the middle and the end. Returns friction at the end."""
    on_load = p[TWO] > 0.0 and p[FRICTION_ON_LOAD] > 0.0
    x0, v0 = (y[XL], y[VL]) if on_load else (y[XD], y[VD])
    derivative(p, tables, on, y, z, x0, v0, late[0], way, u, outside, level, work[0], new)
    for j in range(STATES):
        work[4, j] = y[j] + h / 2 * work[0, j]
    derivative(p, tables, on, work[4], z, x0, v0, late[1], way, u, outside, level, work[1], new)
    for j in range(STATES):
        work[4, j] = y[j] + h / 2 * work[1, j]
    derivative(p, tables, on, work[4], z, x0, v0, late[1], way, u, outside, level, work[2], new)
    for j in range(STATES):
        work[4, j] = y[j] + h * work[2, j]
    derivative(p, tables, on, work[4], z, x0, v0, late[2], way, u, outside, level, work[3], new)
    for j in range(STATES):
        out[j] = y[j] + h / 6 * (work[0, j] + 2 * work[1, j] + 2 * work[2, j] + work[3, j])
    seen = late[2] if p[LAG] == PURE_DELAY else out[W1] if p[LAG] == FIRST_ORDER else out[W2]
    x, v = (out[XL], out[VL]) if on_load else (out[XD], out[VD])
    return friction(p, tables, on, z, x0, v0, x, v, seen, way, level, new)


@compiled
def direction(p, tables, on, y, z, late, u, outside, level, work, new):
    """Direction of dry friction of a body at rest: 0 where it holds, else that of the force."""
    on_load = p[TWO] > 0.0 and p[FRICTION_ON_LOAD] > 0.0
    x = y[XL] if on_load else y[XD]
    held, _ = derivative(p, tables, on, y, z, x, 0.0, late, 0, u, outside, level, work[4], new)
    way = 1 if held > 0.0 else -1
    seen = 0.0 if p[LAG] == NO_LAG else late
    most = (1 - p[SHARE_B]) * p[LAW_A + laws.LEVEL] * p[LAW_A + laws.STATIC] * level_factor(
        p, tables, on, x, seen, way, level)
    return 0 if abs(held) <= most else way


@compiled
def advance(p, tables, on, y, z, late, way, u, outside, level, h, out, work, new):
    """Moves y and z by h; returns the direction of dry friction and the friction after it."""
    dry = p[LAW_A + laws.KIND] == laws.COULOMB and p[SHARE_B] < 1.0
    if not dry:
        rub = stepped(p, tables, on, y, z, late, 1, u, outside, level, h, out, work, new)
        y[:] = out
        z[:] = new
        return 1, rub
    at = VL if p[TWO] > 0.0 and p[FRICTION_ON_LOAD] > 0.0 else VD
    left, rub = h, 0.0
    for _ in range(8):
        if way == 0:
            way = direction(p, tables, on, y, z, late[0], u, outside, level, work, new)
        rub = stepped(p, tables, on, y, z, late, way, u, outside, level, left, out, work, new)
        if way == 0 or out[at] * way >= 0.0:
            break
        low, high, part = 0.0, left, left * y[at] / (y[at] - out[at])
        for _ in range(6):
            stepped(p, tables, on, y, z, late, way, u, outside, level, part, out, work, new)
            if abs(out[at]) < 1e-13:
                break
            if out[at] * way >= 0.0:
                low = part
            else:
                high = part
            rate = (out[at] - y[at]) / part
            part = part - out[at] / rate if rate != 0.0 else (low + high) / 2
            if part <= low or part >= high:
                part = (low + high) / 2
        out[at] = 0.0
        if p[TWO] == 0.0:
            out[VD] = out[VL] = 0.0
        y[:] = out
        z[:] = new
        left -= part
        way = direction(p, tables, on, y, z, late[2], u, outside, level, work, new)
        if left <= 1e-12:
            return way, rub
    y[:] = out
    z[:] = new
    return way, rub


@compiled
def seen_by_encoder(p, x, v):
    """Position and speed as the encoder's scale has them: its error is periodic in its signal period."""
    if p[ERROR_PERIOD] == 0.0:
        return x, v
    w = 2 * math.pi / p[ERROR_PERIOD]
    error, rate = 0.0, 0.0
    for k in range(int(p[ERROR_ORDERS])):
        c, s = p[ERROR + 2 * k], p[ERROR + 2 * k + 1]
        sine, cosine = math.sin((k + 1) * w * x), math.cos((k + 1) * w * x)
        error += c * cosine + s * sine
        rate += (k + 1) * w * (s * cosine - c * sine)
    return x + error, v * (1 + rate)


@compiled
def run(p, tables, on, c, sets, outside, levels, errors, substeps, out):
    """The closed loop from rest over set-points, a row a tick.

    outside: force on the carriage, N; levels: factor of the friction level; errors: of the encoder, m; out: true
    position and speed of the measured body, current, command, shown position, friction."""
    y, fresh, work = np.zeros(STATES), np.zeros(STATES), np.zeros((5, STATES))
    z, new = np.zeros((2, laws.MOST)), np.zeros((2, laws.MOST))
    memory, u, late = np.zeros(MEMORY), np.zeros(3), np.zeros(3)
    dead = int(p[DEAD])
    kept = dead // substeps + 2
    volts = np.zeros((kept, 3))
    still = np.zeros(3)
    h = c[TICK] / substeps
    depth = int(p[LAG_TIME] / h) + 4 if p[LAG] == PURE_DELAY else 1
    past = np.zeros(depth)
    y[XD] = y[XL] = sets[0, 0]
    way, rub, count = 0, 0.0, 0
    load_memory, rest, since, last_way, turned = 0.0, 0.0, 1e9, 0.0, sets[0, 0]
    on_load = p[TWO] > 0.0 and p[ENCODER_ON_LOAD] > 0.0
    rub_on_load = p[TWO] > 0.0 and p[FRICTION_ON_LOAD] > 0.0
    for k in range(sets.shape[0]):
        x, v = (y[XL], y[VL]) if on_load else (y[XD], y[VD])
        sx, sv = seen_by_encoder(p, x, v)
        sx = shown(sx + errors[k], p[INCREMENT])
        command = control(c, memory, k, sets[k, 0], sets[k, 1], sets[k, 2], sx, sx, sv, y[IA:IC + 1],
                          p[ELECTRICAL] * sx, u)
        volts[k % kept] = u
        if p[MODEL] == IDEAL:
            current = command
        else:
            current = amplitude(p, y)
        out[k, X], out[k, V], out[k, I] = x, v, current
        out[k, COMMAND], out[k, SHOWN], out[k, FRICTION_FORCE] = command, sx, rub
        xf, vf = (y[XL], y[VL]) if rub_on_load else (y[XD], y[VD])
        level = levels[k]
        if p[MEMORY_SIZE] != 0.0:
            load_memory += c[TICK] / p[MEMORY_TIME] * (abs(p[FORCE] * current) / p[MEMORY_FORCE] - load_memory)
            level *= 1 + p[MEMORY_SIZE] * load_memory
        if p[REST_SIZE] != 0.0 or on[LEVEL_AT_WAY]:
            if abs(vf) < p[REST_SPEED]:
                rest = min(rest + c[TICK], 10.0)
            else:
                rest *= math.exp(-abs(vf) * c[TICK] / p[REST_WAY])
                heading = 1.0 if vf > 0.0 else -1.0
                if heading != last_way:
                    turned, last_way = xf, heading
            since = abs(xf - turned)
            level *= 1 + p[REST_SIZE] * math.log(1 + rest / p[REST_TIME])
            if on[LEVEL_AT_WAY]:
                level *= 1 + looked_up(tables, LEVEL_AT_WAY, since / p[WAY_STEP])
        for j in range(substeps):
            then = (k * substeps + j - dead) // substeps
            acting = volts[then % kept] if then >= 0 else still
            if p[LAG] == PURE_DELAY:
                past[count % depth] = vf
                for m in range(3):
                    ago = p[LAG_TIME] / h - 0.5 * m
                    whole = int(ago)
                    a, b = max(count - whole, 0), max(count - whole - 1, 0)
                    late[m] = past[a % depth] + (ago - whole) * (past[b % depth] - past[a % depth])
                count += 1
            way, rub = advance(p, tables, on, y, z, late, way, acting, outside[k], level, h, fresh, work, new)
            vf = y[VL] if rub_on_load else y[VD]
        if not abs(y[VD]) < 1e6:
            break
    return 0


def blank():
    """Parameters and tables of an axis on which nothing acts."""
    p = np.zeros(PARAMETERS)
    p[X_STEP] = p[V_STEP] = p[SAT_STEP] = p[WAY_STEP] = 1.0
    p[REST_WAY] = p[REST_TIME] = p[MEMORY_TIME] = p[MEMORY_FORCE] = 1.0
    for at in (LAW_A, LAW_B):
        p[at + laws.STATIC] = p[at + laws.STRIBECK] = p[at + laws.LEVEL] = p[at + laws.SHAPE] = 1.0
        p[at + laws.POWER] = 2.0
    return p, np.zeros((TABLES, NODES)), np.zeros(TABLES, np.bool_)


def simulate(setup, control_settings, sets, outside=None, levels=None, errors=None, substeps=4):
    """Runs the loop; returns rows of OUTPUTS, one a tick.

    setup: (parameters, tables, flags of the tables in use); missing signals act as none."""
    p, tables, on = setup
    n = len(sets)
    out = np.zeros((n, OUTPUTS))
    outside = np.zeros(n) if outside is None else outside
    levels = np.ones(n) if levels is None else levels
    errors = np.zeros(n) if errors is None else errors
    p = p.copy()
    p[DEAD] = round(p[DEAD] / control_settings[TICK] * substeps)
    run(p, tables, on, control_settings, sets, outside, levels, errors, substeps, out)
    return out
