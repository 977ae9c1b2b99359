"""Common part of the adapters: runs a case and prints its values and its processor time.

usage: SCRIPT CASE '{"SETTING": VALUE, ...}'
"""

import json
import sys
import time

import numpy as np
from scipy.optimize import least_squares

SHARES = (0.9, 0.95, 0.98)  # of the critical twist, at which the lowest frequency is asked


def critical(squares):
    """Twist over the critical one at which the square of the lowest frequency vanishes, by a parabola through those at SHARES."""
    roots = np.roots(np.polyfit(SHARES, squares, 2))
    return float(min((r.real for r in roots if abs(r.imag) < 1e-9), key=lambda r: abs(r - 1.0)))


def peak(speeds, interval, mass):
    """Largest force on a body, mean over 0.1 ms, from its speeds at an interval."""
    speeds = np.asarray(speeds)
    width = max(1, round(1e-4 / interval))
    return float(mass * np.max(speeds[:-width] - speeds[width:]) / (width * interval))


def frequency(values, interval):
    """Frequency of a free vibration [Hz]: a sine that decays, with a mean, by least squares from the largest of the spectrum on."""
    if not np.all(np.isfinite(values)) or np.max(np.abs(values)) > 1e3 * abs(values[0]):
        raise RuntimeError("diverges")
    values = np.asarray(values) - np.mean(values)
    time_s = interval * np.arange(len(values))
    size = 16 * len(values)
    spectrum = np.abs(np.fft.rfft(values * np.hanning(len(values)), size))
    start = np.argmax(spectrum) / (size * interval)
    scale = 1.0 / time_s[-1]

    def residual(p):
        wave = np.exp(-p[1] * scale * time_s)
        angle = 2 * np.pi * (start + p[0] * scale) * time_s
        columns = np.column_stack([wave * np.cos(angle), wave * np.sin(angle), np.ones_like(time_s)])
        return (values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]) / np.max(np.abs(values))

    return float(start + scale * least_squares(residual, [0.0, 0.0], xtol=1e-12, ftol=1e-12).x[0])


def main(functions):
    name, settings = sys.argv[1], json.loads(sys.argv[2]) if len(sys.argv) > 2 else {}
    if "warm_up" in functions:  # code that is compiled when it is first called
        functions["warm_up"]()
    seconds = []
    while not seconds or sum(seconds) < 1.0 and len(seconds) < 5:  # short runs: the median of five
        begin = time.process_time()
        result = functions[name](**settings)
        seconds.append(time.process_time() - begin)
    result.setdefault("processor_s", sorted(seconds)[len(seconds) // 2])
    print("RESULT " + json.dumps(result), flush=True)
