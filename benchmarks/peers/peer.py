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


def main(functions):
    name, settings = sys.argv[1], json.loads(sys.argv[2]) if len(sys.argv) > 2 else {}
    repeats = settings.pop("repeats", 1)
    seconds = []
    for _ in range(repeats):
        begin = time.process_time()
        result = functions[name](**settings)
        seconds.append(time.process_time() - begin)
    result["processor_s"] = sorted(seconds)[len(seconds) // 2]
    print("RESULT " + json.dumps(result), flush=True)
