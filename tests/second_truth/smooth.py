"""Random smooth functions, none of which is an element of a dictionary.

Source: random Fourier features of a Gaussian process, Rahimi, Recht 2007; Rasmussen, Williams 2006, chapter 4.
"""

import numpy as np


def process(rng, length, features=24):
    """A draw of a Gaussian process of zero mean and unit variance with a length scale, as a function of an array."""
    omega = rng.normal(0.0, 1.0 / length, features)
    phase = rng.uniform(0.0, 2 * np.pi, features)
    weight = rng.normal(0.0, 1.0, features) * np.sqrt(2.0 / features)
    return lambda u: np.cos(np.multiply.outer(np.asarray(u, float), omega) + phase) @ weight


def monotone(rng, length):
    """A random function that rises from 0 at u = 0 to 1 at u = 1, as a function of an array within 0..1."""
    slope = process(rng, length)
    nodes = np.linspace(0.0, 1.0, 400)
    way = np.concatenate([[0.0], np.cumsum(np.exp(1.2 * slope(nodes[:-1])))])
    rate = rng.uniform(0.5, 4.0)
    bend = (1 - np.exp(-rate * way / way[-1])) / (1 - np.exp(-rate))
    return lambda u: np.interp(u, nodes, bend)


def harmonics(rng, most):
    """Amplitudes (cosine, sine) of 1 to `most` harmonics with a random decay; the sum of squares is 1."""
    count = int(rng.integers(1, most + 1))
    decay = rng.uniform(0.25, 0.9)
    size = decay ** np.arange(count) * np.exp(0.3 * rng.normal(size=count))
    phase = rng.uniform(0.0, 2 * np.pi, count)
    size /= np.sqrt(np.sum(size**2))
    return np.column_stack([size * np.cos(phase), size * np.sin(phase)])


def wave(parts, angle):
    """Sum of the harmonics at an angle in rad (array)."""
    orders = np.arange(1, len(parts) + 1)
    turned = np.multiply.outer(np.asarray(angle, float), orders)
    return np.cos(turned) @ parts[:, 0] + np.sin(turned) @ parts[:, 1]
