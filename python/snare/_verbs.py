"""The verbs."""

from __future__ import annotations

import contextlib
import json
import operator
import os
import sys
from typing import Any, Callable, List, Mapping, Optional, Tuple, Union

from snare import _core
from snare._results import Result, table

File = Union[str, os.PathLike]
Progress = Union[None, bool, Callable[[str], Any]]


class SolverError(RuntimeError):
    """The solver could not go on to the end. ``result`` is what was reached, or None."""

    def __init__(self, message: str, result: Optional[Result] = None) -> None:
        super().__init__(message)
        self.result = result


def _literal(value: Any) -> str:
    """A Python value as a TOML literal."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(key)} = {_literal(one)}" for key, one in value.items()) + "}"
    if hasattr(value, "tolist"):  # NumPy's numbers and arrays
        return _literal(value.tolist())
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_literal(one) for one in value) + "]"
    if isinstance(value, (int, float)):
        return repr(value)
    raise TypeError(f"a value of `set` is {value!r}, must be a number, text, bool, list or dictionary")


def _pairs(given: Optional[Mapping[str, Any]]) -> List[Tuple[str, str]]:
    if given is None:
        return []
    if not isinstance(given, Mapping):
        raise TypeError(f"set = {given!r}, must be a dictionary of keys and values")
    for key in given:
        if not isinstance(key, str):
            raise TypeError(f"a key of `set` is {key!r}, must be a text")
    return [(key, _literal(value)) for key, value in given.items()]


def _print(text: str) -> None:
    """Prints progress. If standard error is closed or full, the text is lost and the work continues."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError, ValueError):
            print(text, file=sys.stderr, flush=True)


def _watcher(progress: Progress) -> Optional[Callable[[str], Any]]:
    if progress is None or progress is False:
        return None
    if progress is True:
        return _print
    if not callable(progress):
        raise TypeError(f"progress = {progress!r}, must be True, None or a function of a text")
    return progress


def _path(given: Any, name: str) -> File:
    if not isinstance(given, (str, os.PathLike)):
        raise TypeError(f"{name} = {given!r}, must be the path of a file: text or os.PathLike")
    return given


def _call(verb: Callable[..., Any], file: File, name: str, set: Optional[Mapping[str, Any]], threads: int,
          progress: Progress, *more: Any) -> Any:
    """A verb of the compiled part, with arguments of the kinds that it takes. name: of the argument ``file``."""
    if isinstance(threads, bool) or not hasattr(threads, "__index__"):
        raise TypeError(f"threads = {threads!r}, must be a whole number")
    if not 0 <= operator.index(threads) <= 1024:
        raise ValueError(f"threads = {threads}, must be from 0 to 1024")
    return verb(_path(file, name), _pairs(set), operator.index(threads), _watcher(progress), *more)


def _with_curves(answer: Tuple[Optional[Result], Any]) -> Result:
    """The document with its curves; raises where there is none."""
    document, curves = answer
    if document is None:
        raise SolverError(curves)
    document["curves"] = table(curves)
    return document


def push(experiment: File, *, set: Optional[Mapping[str, Any]] = None, threads: int = 0,
         progress: Progress = None) -> Result:
    """Predict the force-displacement curves of the declared model.

    experiment: experiment file (docs/experiment_file.md). set: keys of the file to override, as ``--set`` does:
    ``{"wire.length_mm": 181.0, "series[s40].points": 50}``, in the units of the file. threads: 0, one a processor; the result
    does not depend on it. progress: True prints to standard error, a function is called with a line of text.

    Returns ``series`` (a summary of each), ``warnings``, and ``curves``: by series, columns of one length: ``displacement_m``,
    ``force_N``, ``tension_left_N``, ``contact_arc_m``, ... (docs/curves_csv.md), ``measured_N`` and ``residual_N`` where there are
    readings.
    Raises InputError for a wrong file, SolverError where a curve did not reach its end; its ``result`` has what was reached.
    """
    result = _with_curves(_call(_core.push, experiment, "experiment", set, threads, progress))
    stopped = [f"series {one['series']}: {one['stopped']}" for one in result["series"] if one["stopped"]]
    if stopped:
        raise SolverError("\n".join(stopped), result)
    return result


def fit(experiment: File, *, set: Optional[Mapping[str, Any]] = None, threads: int = 0,
        progress: Progress = None) -> Result:
    """Calibrate the free numbers of the declared model. Arguments as of ``push``.

    Returns fit.json (docs/trace_json.md) with ``curves``, which have ``measured_N``, ``base_N`` and ``final_N``. The numbers are
    in ``fit["parameters"]``, by key: value, stderr, lower95, upper95 and unit.
    Of records in time (docs/record_file.md) ``curves`` has by record and sensor the columns ``time_s``, ``measured``, ``declared``,
    ``base`` and ``final`` in the sensor's ``unit``.
    Raises InputError, and SolverError where the model cannot be fitted.
    """
    return _with_curves(_call(_core.fit, experiment, "experiment", set, threads, progress))


def trace(experiment: File, *, set: Optional[Mapping[str, Any]] = None, threads: int = 0,
          progress: Progress = None) -> Result:
    """Find what the declared model lacks. Arguments as of ``push``.

    Returns trace.json (docs/trace_json.md) with ``curves`` as of ``fit``: ``verdict``, ``selected``, ``candidates``, ``classes``,
    ``base`` and ``final`` (``rmse_N``, ``parameters``), ``next_experiment``, ...
    Raises InputError, and SolverError where the base model cannot be fitted.
    """
    return _with_curves(_call(_core.trace, experiment, "experiment", set, threads, progress))


def distil(wire: File, *, set: Optional[Mapping[str, Any]] = None, threads: int = 0,
           progress: Progress = None) -> Result:
    """Reduce a wire to a table of its force and to simple laws, with their errors.

    wire: wire file (docs/wire_file.md); the other arguments as of ``push``.
    Returns law.json (docs/law_json.md) with ``laws``, a list of Law, one a case.
    Raises InputError, and SolverError where a curve of the full wire could not be computed.
    """
    document, laws = _call(_core.distil, wire, "wire", set, threads, progress)
    if document is None:
        raise SolverError(laws)
    document["laws"] = laws
    return document


def simulate(scenario: File, *, set: Optional[Mapping[str, Any]] = None, threads: int = 0,
             progress: Progress = None) -> Result:
    """Run a scenario in motion.

    scenario: scenario file (docs/scenario_file.md); the other arguments as of ``push``.
    Returns summary.json (docs/summary_json.md) with ``history``: columns of one length, ``time_s`` first (by model where the
    scenario runs several), and ``telemetry`` where there are sensors: NaN at times at which one does not read.
    Raises InputError, and SolverError where a run did not reach its end; its ``result`` has what was reached.
    """
    document, history, telemetry = _call(_core.simulate, scenario, "scenario", set, threads, progress)
    document["history"] = table(history)
    if telemetry:
        document["telemetry"] = table(telemetry)
    stopped = _unfinished(document)
    if stopped:
        raise SolverError("\n".join(stopped), document)
    return document


def _unfinished(value: Any) -> List[str]:
    """Messages of the runs of a summary that have not finished."""
    if isinstance(value, dict):
        if value.get("finished") is False:
            return [str(value.get("message"))]
        return [message for one in value.values() for message in _unfinished(one)]
    if isinstance(value, list):
        return [message for one in value for message in _unfinished(one)]
    return []


def compare(case: File, *, set: Optional[Mapping[str, Any]] = None, threads: int = 0,
            progress: Progress = None) -> Result:
    """Run the same case with every model of the wire: accuracy and cost side by side.

    case: experiment, wire or scenario file; the other arguments as of ``push``.
    Returns compare.json (docs/law_json.md), with a list: ``cases`` of pushes, ``models`` of a scenario; numbers are in the units that
    their names end in. Raises InputError; what a model could not do stands in the result.
    """
    return _call(_core.compare, case, "case", set, threads, progress)


def sweep(study: File, *, set: Optional[Mapping[str, Any]] = None, threads: int = 0, progress: Progress = None,
          out: Union[None, str, os.PathLike] = None) -> Result:
    """Run many cases of one file: grids, designs, distributions, sensitivities, odds.

    study: sweep file (docs/sweep_file.md); set: keys of it to override. out: a folder for the journal of finished cases, from
    which the same call goes on after an interrupt or a crash; without one they are lost then. A sweep with ``[histories]`` must have
    one. The folder is held while the sweep runs; a folder that another run holds is rejected. The other arguments as of ``push``.

    Returns summary.json (docs/sweep_file.md) with ``table``: columns of one length, a row a finished case: ``case`` (from 1),
    ``status``, ``reason``, the variables and the collected fields, in the units of the files; and ``histories``, the path of
    histories.h5 in ``out``, where the sweep keeps histories and every case was run.
    Raises InputError; a case that has no result stands in ``table`` with its reason.
    """
    summary, cases = _call(_core.sweep, study, "study", set, threads, progress, "" if out is None else _path(out, "out"))
    summary["table"] = cases
    return summary
