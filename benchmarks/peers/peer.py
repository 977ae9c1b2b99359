"""What the scripts of all programs have in common: a case in, its values and its processor time out.

usage: SCRIPT CASE '{"SETTING": VALUE, ...}'
"""

import json
import sys
import time

import numpy as np

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
    """Frequency of a free vibration [Hz]: a sine with its phase, its decay and a mean by least squares, begun from the largest of the spectrum."""
    values = np.asarray(values) - np.mean(values)
    time_s = interval * np.arange(len(values))
    padded = np.abs(np.fft.rfft(values * np.hanning(len(values)), 16 * len(values)))
    start = np.argmax(padded) / (16 * len(values) * interval)

    def misfit(f):
        columns = np.column_stack([np.cos(2 * np.pi * f * time_s), np.sin(2 * np.pi * f * time_s), time_s * np.cos(2 * np.pi * f * time_s),
                                   time_s * np.sin(2 * np.pi * f * time_s), np.ones_like(time_s)])
        return np.linalg.norm(values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0])

    width = 1 / (len(values) * interval)
    for _ in range(60):
        candidates = start + width * np.array([-0.5, 0.0, 0.5])
        start = candidates[np.argmin([misfit(f) for f in candidates])]
        width *= 0.7
    return float(start)


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
