#!/usr/bin/env python3
"""Calls one verb of the Python module for entries.py and writes how the call ended, like library_entry.cpp.

    python_entry.py VERB FILE ENDING [ARGUMENTS]

ENDING is the JSON file to write. ARGUMENTS are keyword arguments of the verb, as a JSON object. `status` is 2 for InputError, 3 for SolverError
and KeyboardInterrupt, 1 for any other exception. `reached`: the SolverError has a result. `tables`: arrays in addition to the command's
document. If VERB is "wrong_kinds", FILE is the name of a verb, and `message` lists the arguments of a wrong type that it accepted.
"""

import json
import math
import sys

import numpy as np

import snare

TABLES = ("curves", "history", "telemetry", "table", "laws")


def plain(value):
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    if isinstance(value, np.generic):
        return value.item()
    return value if isinstance(value, (str, int, float, bool, type(None))) else repr(value)


def places(value, wrong, place=""):
    """Returns the places of the numbers for which `wrong` is true."""
    if isinstance(value, dict):
        return [one for key, inner in value.items() for one in places(inner, wrong, f"{place}.{key}")]
    if isinstance(value, list):
        return [one for k, inner in enumerate(value) for one in places(inner, wrong, f"{place}.{k}")]
    return [place] if isinstance(value, float) and wrong(value) else []


def ending(verb, file, arguments):
    try:
        result = plain(getattr(snare, verb)(file, **arguments))
    except snare.InputError as error:
        return {"status": 2, "message": str(error), "problems": plain(error.problems)}
    except snare.SolverError as error:
        return {"status": 3, "message": str(error), "reached": error.result is not None}
    except KeyboardInterrupt:
        return {"status": 3, "message": "interrupted"}
    except Exception as error:
        return {"status": 1, "message": f"{type(error).__name__}: {error}"}
    document = {key: value for key, value in result.items() if key not in TABLES}
    tables = {key: value for key, value in result.items() if key in TABLES}
    # NaN in a table marks a cell that is empty in the file.
    return {"status": 0, "message": "", "document": document, "tables": tables,
            "not_finite": places(document, lambda x: not math.isfinite(x)) + places(tables, math.isinf)}


def wrong_kinds(verb):
    call = getattr(snare, verb)
    wrong = [((5,), {}), ((None,), {}), (("x.toml",), {"set": 5}), (("x.toml",), {"set": {5: 5}}), (("x.toml",), {"set": {"a": None}}),
             (("x.toml",), {"progress": 5}), (("x.toml",), {"threads": 1.5}), (("x.toml",), {"threads": -1}), (("x.toml",), {"threads": 1025}),
             (("x.toml",), {"threads": True}), (("x.toml",), {"set": {"a\nb": "c"}}), ((b"x.toml",), {}), (("a\0b",), {}),
             (("x.toml",), {"set": {"a": float("nan")}}), (("x.toml",), {"nothing": 1})]
    if verb == "sweep":
        wrong.append((("x.toml",), {"out": 5}))
    taken = []
    for given, named in wrong:
        try:
            call(*given, **named)
            taken.append(f"{given} {named} was taken")
        except (TypeError, ValueError):  # InputError is a ValueError
            pass
        except Exception as error:
            taken.append(f"{given} {named}: {type(error).__name__}: {error}")
    return {"status": 1 if taken else 0, "message": "; ".join(taken)}


def main():
    verb, file, place = sys.argv[1:4]
    arguments = json.loads(sys.argv[4]) if len(sys.argv) > 4 else {}
    result = wrong_kinds(file) if verb == "wrong_kinds" else ending(verb, file, arguments)
    with open(place, "w", encoding="utf-8") as written:
        json.dump(result, written)
    return result["status"]


if __name__ == "__main__":
    sys.exit(main())
