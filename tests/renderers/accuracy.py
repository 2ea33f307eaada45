"""How far a file's f_r is from the model's, as formats are judged by."""

import numpy as np

PERCENTILES = (50, 95, 99)


def error_percentiles(f: np.ndarray, exact: np.ndarray) -> np.ndarray:
    """Percent, at PERCENTILES, of [pair][channel]; the channel that is worst at each counts.

    Relative, with a floor of 0.001 of the channel's mean.
    """
    error = np.abs(f - exact) / (np.abs(exact) + 0.001 * exact.mean(axis=0))
    return 100 * np.percentile(error, PERCENTILES, axis=0).max(axis=1)


def judge(test, name: str, errors: np.ndarray, limits):
    """Prints the errors at PERCENTILES, and fails the test where one is larger than its limit."""
    shown = ", ".join(f"{error:.3f} % at {percentile}" for error, percentile in zip(errors, PERCENTILES))
    print(f"{name}: percentiles of the error: {shown}", flush=True)
    for limit, error, percentile in zip(limits, errors, PERCENTILES):
        test.assertLessEqual(error, limit, f"{name}: percentile {percentile}")
