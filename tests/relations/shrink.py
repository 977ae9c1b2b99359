"""The smallest file that still shows a fault."""

import time


def places(table, path=()):
    """Every key and list item, the outer ones first."""
    entries = table.items() if isinstance(table, dict) else enumerate(table)
    here = [(path + (k,), v) for k, v in entries]
    deeper = [p for q, v in here if isinstance(v, (dict, list)) for p in places(v, q)]
    return [q for q, _ in here] + deeper


def at(table, path):
    for k in path:
        table = table[k]
    return table


def simpler(value):
    """Numbers that are easier to read, the simplest first."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return []
    if isinstance(value, int):
        return [v for v in (2, value // 2 - value // 2 % 4) if 0 < v < value]
    found = [0.0, 1.0, float(f"{value:.0e}"), float(f"{value:.1e}"), float(f"{value:.2e}")]
    return [v for v in dict.fromkeys(found) if v != value and len(repr(v)) < len(repr(value))]


def smaller(case):
    """Each case that lacks one thing, or has a simpler number."""
    for path in places(case.main):
        other = case.changed()
        holder = at(other.main, path[:-1])
        if isinstance(holder, list) and not isinstance(holder[0], (dict, str)):
            continue
        del holder[path[-1]]
        yield other
    for path in places(case.main):
        for value in simpler(at(case.main, path)):
            other = case.changed()
            at(other.main, path[:-1])[path[-1]] = value
            yield other


def shrink(case, still, seconds):
    """As long as one of the smaller cases is still broken, that one."""
    end = time.monotonic() + seconds
    while True:
        for other in smaller(case):
            if time.monotonic() > end:
                return case
            if still(other):
                case = other
                break
        else:
            return case
