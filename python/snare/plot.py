"""The usual pictures in a line each, with matplotlib, which nothing else needs.

Every function draws into ``axes``, or into new ones, and returns the axes::

    import snare, snare.plot
    snare.plot.curves(snare.push("my_push.toml")).figure.savefig("push.png")
"""

from __future__ import annotations

from typing import Any, Optional, Sequence

import numpy as np

from snare._core import Law
from snare._results import Result


def _axes(axes: Optional[Any]) -> Any:
    if axes is not None:
        return axes
    from matplotlib import pyplot

    return pyplot.subplots(layout="constrained")[1]


def curves(result: Result, axes: Optional[Any] = None) -> Any:
    """Force [N] against travel [mm] of every series of ``push``, ``fit`` or ``trace``: the last model as a line, the declared or
    base model dashed where there is one, readings as points.

    result: of such a verb; its ``curves`` are, by series, columns of one length in SI units."""
    axes = _axes(axes)
    for k, (name, columns) in enumerate(result["curves"].items()):
        travel, colour = 1e3 * columns["displacement_m"], f"C{k}"
        final = columns.get("final_N", columns["force_N"])
        axes.plot(travel, final, color=colour, label=name)
        if "base_N" in columns:
            axes.plot(travel, columns["base_N"], "--", color=colour)
        if "measured_N" in columns:
            axes.plot(travel, columns["measured_N"], ".", color=colour)
    axes.set_xlabel("travel [mm]")
    axes.set_ylabel("force [N]")
    axes.legend()
    return axes


def residuals(result: Result, axes: Optional[Any] = None) -> Any:
    """Measured less computed force [N] against travel [mm] of every series with readings. Arguments as of ``curves``."""
    axes = _axes(axes)
    for name, columns in result["curves"].items():
        if "measured_N" in columns:
            final = columns.get("final_N", columns["force_N"])
            axes.plot(1e3 * columns["displacement_m"], columns["measured_N"] - final, ".-", label=name)
    axes.axhline(0.0, color="0.7", zorder=0)
    axes.set_xlabel("travel [mm]")
    axes.set_ylabel("measured less computed [N]")
    axes.legend()
    return axes


def law(one: Law, positions: Optional[Sequence[float]] = None, axes: Optional[Any] = None) -> Any:
    """The table's force [N] against travel [mm] at some positions [m], at the nominal slack: with the band of its stated error, and
    the simple laws dashed.

    one: a Law. positions: a list of numbers [m], in the law's range; those of the simple laws, where None."""
    axes = _axes(axes)
    if positions is None:
        positions = sorted({simple.position for simple in one.simple})
    travel = np.linspace(*one.travel, 201)
    for k, position in enumerate(positions):
        force = one.force(travel, position)
        axes.plot(1e3 * travel, force, color=f"C{k}", label=f"s = {1e3 * position:.4g} mm")
        axes.fill_between(1e3 * travel, force - one.bound, force + one.bound, color=f"C{k}", alpha=0.2, linewidth=0)
        for simple in one.simple:
            if simple.position == position:
                inside = travel[(travel >= simple.travel[0]) & (travel <= simple.travel[1])]
                axes.plot(1e3 * inside, simple.force(inside), "--", color=f"C{k}", linewidth=0.7)
    axes.set_xlabel("travel [mm]")
    axes.set_ylabel("force [N]")
    axes.legend()
    return axes


def history(result: Result, *columns: str, axes: Optional[Any] = None) -> Any:
    """Columns of a history [SI units] against time [s]; all forces of contact where none are named.

    result: of ``simulate``; its ``history`` has columns of one length. columns: their names, as ``"wire tension_N"``; each is drawn
    over the others, so that they had better have one unit."""
    axes = _axes(axes)
    run = result["history"]
    for column in columns or [name for name in run if name.endswith("normal_N")]:
        axes.plot(run["time_s"], run[column], label=column)
    axes.set_xlabel("time [s]")
    axes.legend()
    return axes


def indices(result: Result, field: Optional[str] = None, axes: Optional[Any] = None) -> Any:
    """Shares [-] of a field's variance that are due to each variable of a ``sweep`` with ``design = "sensitivity"``: of each by itself and
    with the others, as bars with their 95 % intervals.

    result: of ``sweep``; its ``fields`` have such shares, lists of two for an interval. field: name of a collected one; the first that has
    shares, where None. Raises ValueError where there is none."""
    fields = {name: one["sobol"]["variables"] for name, one in result["fields"].items() if one.get("sobol", {}).get("variables")}
    if not fields or field not in (None, *fields):
        raise ValueError(f"field = {field!r}, must be one with Sobol indices: {', '.join(fields) or 'this sweep has none'}")
    name = field if field is not None else next(iter(fields))
    axes = _axes(axes)
    places = np.arange(len(fields[name]))
    for k, (index, label) in enumerate((("first", "by itself"), ("total", "with others"))):
        share = np.array([one[index] for one in fields[name].values()], dtype=float)
        ends = np.array([one[f"{index}_interval95"] for one in fields[name].values()], dtype=float)
        axes.bar(places + 0.4 * k - 0.2, share, 0.36, label=label, color=f"C{k}")
        axes.errorbar(places + 0.4 * k - 0.2, share, np.abs(ends.T - share), fmt="none", ecolor="0.2", capsize=3)
    axes.set_xticks(places, list(fields[name]))
    axes.set_ylabel(f"share of the variance of {name} [-]")
    axes.legend()
    return axes
