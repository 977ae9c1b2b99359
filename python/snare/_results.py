"""Results as Python has them, from the compiled part or from the files that the command has written."""

from __future__ import annotations

import csv
import json
import math
import os
import pathlib
from typing import Any, Dict, List, Mapping, Union

import numpy as np

Columns = Dict[str, np.ndarray]
Result = Dict[str, Any]

# Units of columns in files, with those that Python gets and their size.
_UNITS = {"mm": ("m", 1e-3), "deg": ("rad", math.pi / 180.0)}
# The document of a verb, and the tables beside it.
_DOCUMENTS = ("trace.json", "fit.json", "law.json", "compare.json", "summary.json", "reproduce.json", "ringdown.json",
              "validation.json")
_TABLES = {"curves": "curves", "history": "history", "telemetry": "telemetry", "cases": "table"}


def in_si(columns: Mapping[str, Any]) -> Dict[str, Any]:
    """Columns in SI units: "displacement_mm" becomes "displacement_m". Texts stay as they are."""
    result: Dict[str, Any] = {}
    for name, values in columns.items():
        stem, _, unit = name.rpartition("_")
        if stem and unit in _UNITS and isinstance(values, np.ndarray):
            unit, size = _UNITS[unit]
            result[f"{stem}_{unit}"] = values * size
        else:
            result[name] = values
    return result


def split(columns: Mapping[str, Any], by: str) -> Dict[str, Columns]:
    """The rows of each value of a column of texts, in the order in which they come."""
    parts: Dict[str, Columns] = {}
    names = np.asarray(columns[by], dtype=object)
    for name in dict.fromkeys(columns[by]):
        rows = names == name
        parts[name] = {key: np.asarray(values)[rows] for key, values in columns.items() if key != by}
    return parts


def table(columns: Mapping[str, Any]) -> Dict[str, Any]:
    """A table of results in SI units, by series or model where it has several."""
    result = in_si(columns)
    if "record" in result and "sensor" in result:
        return {record: {sensor: {**one, "unit": str(one["unit"][0])} for sensor, one in split(rows, "sensor").items()}
                for record, rows in split(result, "record").items()}
    for by in ("series", "model"):
        if by in result:
            return split(result, by) if len(result[by]) else {}
    return result


def _number(text: str) -> float:
    return float(text) if text else math.nan


def _read_csv(path: pathlib.Path) -> Dict[str, Any]:
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    if not rows:
        raise ValueError(f"{path}: has no header")
    for number, row in enumerate(rows[1:], 1):
        if len(row) != len(rows[0]):
            raise ValueError(f"{path}: row {number} has {len(row)} cells, must have {len(rows[0])}")
    cells = {name: [row[k] for row in rows[1:]] for k, name in enumerate(rows[0])}
    columns: Dict[str, Any] = {}
    for name, texts in cells.items():
        try:
            columns[name] = np.array([_number(text) for text in texts], dtype=float)
        except ValueError:
            columns[name] = texts
    for by in ("series", "model", "record", "sensor", "unit", "status", "reason"):  # texts, also where all of them look like numbers
        if by in cells:
            columns[by] = cells[by]
    return columns


def _arrays(value: Any) -> Any:
    """A parsed JSON document with arrays for lists of numbers."""
    if isinstance(value, dict):
        return {key: _arrays(one) for key, one in value.items()}
    if isinstance(value, list):
        if value and all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in value):
            return np.array(value, dtype=int if all(isinstance(one, int) for one in value) else float)
        return [_arrays(one) for one in value]
    return value


def load(path: Union[str, os.PathLike]) -> Result:
    """What the command has written, as the verbs return it.

    path: a folder of results (``--out``), a JSON document or a CSV table of one.
    Returns of a folder its document with ``curves``, ``history``, ``telemetry`` and ``table`` (of a sweep) where it has them, and ``laws``
    for a law.json; of a JSON document a dictionary, lists of numbers as arrays; of a table its columns of one length. Tables are in SI
    units, documents in the units that their names end in. Raises FileNotFoundError where there is nothing of the kind, ValueError where a
    file is none of these.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"path = {path!r}, must be the path of a file or folder: text or os.PathLike")
    path = pathlib.Path(path)
    if path.is_dir():
        result: Result = {}
        for name in _DOCUMENTS:
            if (path / name).is_file():
                result = load(path / name)
                break
        for name, key in _TABLES.items():
            if (path / f"{name}.csv").is_file():
                result[key] = table(_read_csv(path / f"{name}.csv"))
        if not result:
            raise FileNotFoundError(f"{path}: no results of snare in this folder")
        return result
    if path.suffix == ".csv":
        return table(_read_csv(path))
    with open(path, encoding="utf-8") as file:
        try:
            document = json.load(file)
        except (ValueError, RecursionError) as error:
            raise ValueError(f"{path}: is no document of snare: {error}") from None
    if not isinstance(document, dict):
        raise ValueError(f"{path}: is no document of snare")
    result = _arrays(document)
    if document.get("schema") == "snare-law/1":
        from snare._core import Law

        cases = document.get("cases")
        laws: List[Law] = [Law(path, case) for case in range(len(cases) if isinstance(cases, list) and cases else 1)]
        result["laws"] = laws
    return result
