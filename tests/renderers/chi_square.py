"""Whether samples follow a density."""

import math

import numpy as np

FEWEST = 5  # expected in a bin; bins of fewer are pooled


def survival(statistic: float, freedom: int) -> float:
    """Chance of a chi-square value at least as large (Wilson and Hilferty 1931), to 0.001 from freedom 10 on."""
    spread = 2 / (9 * freedom)
    return 0.5 * math.erfc(((statistic / freedom) ** (1 / 3) - (1 - spread)) / math.sqrt(2 * spread))


def significance(observed: np.ndarray, expected: np.ndarray) -> float:
    """Chance of counts as far from the expected ones, where the density is right."""
    order = np.argsort(expected.ravel())
    observed, expected = observed.ravel()[order], expected.ravel()[order]
    pooled = int(np.searchsorted(expected, FEWEST))
    # The pool itself may need a few of the next bins.
    while expected[:pooled].sum() < FEWEST and pooled > 0:
        pooled += 1
    if pooled > 0:
        observed = np.append(observed[pooled:], observed[:pooled].sum())
        expected = np.append(expected[pooled:], expected[:pooled].sum())
    statistic = float(((observed - expected) ** 2 / expected).sum())
    return survival(statistic, len(expected) - 1)


def sidak(level: float, tests: int) -> float:
    """Level of each of so many tests that makes `level` the chance that any fails."""
    return 1 - (1 - level) ** (1 / tests)
