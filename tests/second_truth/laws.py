"""Contact laws of friction, written over displacement: what a contact becomes after the way d at the speed v.

All are rate-independent in presliding, so that a step of any length follows its closed form or an exponential rule of
second order; no step is too long for a stiff contact. g is the steady level (N), s0 the stiffness (N/m), z the state.

Sources: Dahl 1968; Canudas de Wit, Olsson, Astrom, Lischinsky 1995 (LuGre); Dupont, Hayward, Armstrong, Altpeter 2002
(elasto-plastic); Al-Bender, Lampaert, Swevers 2005 (Maxwell-slip elements with a common steady curve); Wen 1976
(Bouc-Wen); exponential rule: Hochbruck, Ostermann 2010, section 2.
"""

import math

import paths  # noqa: F401
from fast import compiled

NONE, COULOMB, LUGRE, DAHL, ELASTO, BOUC_WEN, MAXWELL = range(7)
# A law: kind; Coulomb level; static over Coulomb; Stribeck speed and exponent; stiffness; damping; shape (exponent of
# Dahl and Bouc-Wen, break-away share of elasto-plastic); second shape (gamma of Bouc-Wen); elements; then pairs.
KIND, LEVEL, STATIC, STRIBECK, POWER, STIFFNESS, DAMPING, SHAPE, SHAPE2, ELEMENTS, FIRST = range(11)
MOST = 10
LAW = FIRST + 2 * MOST


@compiled
def steady(p, at, v, factor):
    """Steady level g(v) in N without the viscous part."""
    level = p[at + LEVEL] * factor
    if p[at + STATIC] == 1.0:
        return level
    return level * (1 + (p[at + STATIC] - 1) * math.exp(-(abs(v) / p[at + STRIBECK]) ** p[at + POWER]))


@compiled
def slope(p, at, z, way, zss, z_elastic):
    """dz/dx of a bristle that moves in the direction `way`, and its derivative with z."""
    kind = p[at + KIND]
    if kind == ELASTO:
        a = abs(z)
        if z * way <= 0.0 or a <= z_elastic:
            return 1.0, 0.0
        if a >= zss:
            return 1 - way * z / zss, -way / zss
        width = zss - z_elastic
        angle = math.pi * (a - (zss + z_elastic) / 2) / width
        alpha = 0.5 * math.sin(angle) + 0.5
        rate = 0.5 * math.cos(angle) * math.pi / width
        return 1 - alpha * a / zss, -way * (alpha + a * rate) / zss
    u = way * z / zss
    if kind == BOUC_WEN:
        n, gamma = p[at + SHAPE], p[at + SHAPE2]
        weight = 1.0 if u > 0.0 else 2 * gamma - 1
        size = abs(u)
        return 1 - weight * size ** n, -weight * n * size ** (n - 1) * (way if u > 0.0 else -way) / zss
    n = p[at + SHAPE]
    if kind == LUGRE or n == 1.0:
        return 1 - u, -way / zss
    left = 1 - u
    return math.copysign(abs(left) ** n, left), -n * way / zss * abs(left) ** (n - 1)


@compiled
def moved(p, at, z, d, zss, z_elastic):
    """z after the way d: exponential Rosenbrock rule, exact for LuGre, Dahl with exponent 1, in four parts at most."""
    if d == 0.0:
        return z
    way = 1.0 if d > 0.0 else -1.0
    linear = p[at + KIND] == LUGRE or (p[at + KIND] == DAHL and p[at + SHAPE] == 1.0) or (
        p[at + KIND] == ELASTO and z * way >= zss)
    parts = 1 if linear or abs(d) < 1e-3 * zss else (4 if abs(d) > 0.02 * zss else 2)
    part = d / parts
    for _ in range(parts):
        f, j = slope(p, at, z, way, zss, z_elastic)
        q = j * part
        z += part * f * (math.expm1(q) / q if abs(q) > 1e-8 else 1.0 + q / 2)
    limit = 1.0001 * zss if p[at + KIND] != LUGRE else 1e300
    return min(max(z, -limit), limit) if p[at + STATIC] == 1.0 else z


@compiled
def contact(p, at, z, row, d, v, mean, g, new):
    """Force of the contact at the speed v after the way d from the states z[row]; writes the new states into new[row].

    mean: the level over the way, at its mean speed; g: the level at v."""
    kind = p[at + KIND]
    if kind == MAXWELL:
        total, scale = 0.0, g / p[at + LEVEL]
        for k in range(int(p[at + ELEMENTS])):
            stiffness, most = p[at + FIRST + 2 * k], p[at + FIRST + 2 * k + 1] * scale
            f = min(max(stiffness * (z[row, k] + d), -most), most)
            new[row, k] = f / stiffness
            total += f
        return total
    s0 = p[at + STIFFNESS]
    zss = mean / s0
    z_elastic = p[at + SHAPE] * p[at + LEVEL] / s0 * min(1.0, mean / p[at + LEVEL]) if kind == ELASTO else 0.0
    moved_z = moved(p, at, z[row, 0], d, zss, z_elastic)
    new[row, 0] = moved_z
    force = s0 * moved_z
    if p[at + DAMPING] > 0.0:
        way = 1.0 if v > 0.0 else (-1.0 if v < 0.0 else 0.0)
        force += p[at + DAMPING] * v * slope(p, at, moved_z, way, g / s0, z_elastic)[0]
    return force


def along(p, at, x, v, level=1.0):
    """Friction of a contact law over rows of position and speed (numpy), without the viscous part, in N."""
    return _along(p, at, x, v, level)


@compiled
def _along(p, at, x, v, level):
    import_rows = x.shape[0]
    out = x * 0.0
    z = x[:2 * MOST].copy().reshape(2, MOST) * 0.0
    for k in range(import_rows):
        d = x[k] - x[k - 1] if k else 0.0
        g = steady(p, at, v[k], level)
        mean = steady(p, at, 0.5 * (v[k] + v[k - 1]), level) if k else g
        out[k] = contact(p, at, z, 0, d, v[k], mean, g, z)
    return out
