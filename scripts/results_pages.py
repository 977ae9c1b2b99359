#!/usr/bin/env python3
"""Writes the numbers of README.md and of pages in docs/ from the stored results in benchmarks/results/.

usage: results_pages.py [--check | --reproduce SNARE | --remake NAMES SNARE | --compare NAMES SNARE] [REPOSITORY]

A page marks what is written: everything between `<!-- numbers: NAME -->` and `<!-- end of numbers -->` is the text that the
function registered under NAME below makes of the stored results. Without --check the pages are rewritten, and the pictures that
are drawn from stored results. With --check nothing is written; each region and picture that differs is printed and the exit
status is 1.

What the command gives is made by the makers of shipped.py. --remake runs those of NAMES (separated by commas; `all` but the long ones) with the command
SNARE, stores what comes out, and rewrites the pages. --compare runs them and stores nothing: what differs from what is stored by
more than the maker's tolerance is printed and the exit status is 1; 77 where something that a maker needs is not installed.
--reproduce SNARE is --remake reproduce SNARE. The makers:

MAKERS
"""

import argparse
import csv
import json
import math
import pathlib
import re
import statistics
import sys
import tempfile
import time

import shipped
from curve_picture import curve_picture

SKIPPED = 77
REGION = re.compile(r"(<!-- numbers: ([a-z_]+) -->\n)(.*?)(<!-- end of numbers -->)", re.S)
WRITERS = {}


def region(function):
    """Registers the writer of the region that has the function's name."""
    WRITERS[function.__name__] = function
    return function


class Stored:
    """The stored results, read once each."""

    def __init__(self, folder):
        self.folder = folder
        self.read = {}

    def text(self, name):
        if name not in self.read:
            self.read[name] = (self.folder / name).read_text(encoding="utf-8")
        return self.read[name]

    def json(self, name):
        return json.loads(self.text(name))

    def lines(self, name):
        return [json.loads(line) for line in self.text(name).splitlines()]

    def rows(self, name):
        return list(csv.DictReader(self.text(name).splitlines()))

    def benchmarks(self, name):
        """Medians of a stored Google Benchmark run by name, times in seconds."""
        units = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
        result = {}
        for row in self.json(name)["benchmarks"]:
            if row["name"].endswith("_median"):
                key = re.sub(r"/(iterations:1|process_time|real_time)", "", row["name"][:-len("_median")])
                result[key] = {**row, "seconds": row["cpu_time"] * units[row["time_unit"]]}
        return result


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"


def number(value, digits=2):
    """A number with so many significant digits, without an exponent from 1e-3 to 1e6."""
    if value == 0.0:
        return "0"
    if not 1e-3 <= abs(value) < 1e6:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    places = digits - 1 - int(f"{abs(value):.{digits - 1}e}".split("e")[1])
    return f"{round(value, places):.{max(places, 0)}f}"


def percent(share):
    return f"{100.0 * share:.1f} %"


def duration(seconds):
    units = (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9))
    unit, size = next((u for u in units if seconds >= 0.9995 * u[1]), units[-1])
    return f"{number(seconds / size)} {unit}"


def minutes(seconds):
    return f"{seconds / 60:.1f} min" if seconds >= 60 else f"{seconds:.0f} s"


def when(*contexts):
    dates = sorted({c["date"][:10] for c in contexts})
    machines = sorted({c["processor"] for c in contexts})
    return f"Last measured {' and '.join(dates)}, one core of {' and '.join(machines)}, {contexts[0]['compiler']}.\n"


# ---- README.md ----


@region
def set_up(stored):
    result = stored.json("set_up.json")
    rows = [[f"`{name}`", c["packages"], f"{c['download_MB']} MB", f"{c['disk_MB']} MB"] for name, c in result["commands"].items()]
    return table(["on a minimal Debian 12", "packages", "download", "on disk"], rows)


@region
def set_up_times(stored):
    times = stored.json("set_up.json")["times"]
    before, now = times["revisions"].values()
    names = [("first result of `./run`", "./run", "first_result_s"), ("its whole call", "./run", "whole_s"),
             ("processor time of that", "./run", "processor_s"), ("a second call", "./run again", "whole_s")]
    rows = [[words, minutes(before[command][what] or before[command]["whole_s"]), minutes(now[command][what])]
            for words, command, what in names]
    return table([f"{times['date']}, {times['processors']} processors", *(f"`{r}`" for r in times["revisions"])], rows)


@region
def accuracy_and_speed(stored):
    push, motion, distil, trace = (stored.benchmarks(f) for f in ("push.json", "motion.json", "distil.json", "trace.json"))
    static, impact = push["OutwardCurveExtrapolated/256"], motion["case_h/elements:40/higher_order:1/quasi_static:0"]
    lookup, wire = distil["TableForce"], distil["FullWireForce"]
    longest = max(row["seconds"] for name, row in trace.items() if name.startswith("whole_trace"))
    captures = {(r["model"], r["elements"], r["formulation"]): r for r in stored.json("capture_speed.json")["runs"]}
    capture = captures["full", 40, "higher_order"]
    return table(
        ["on one core", "relative error", "time", "fastest other program"],
        [["static curve of 20 points, start included", number(static["force_error"], 1), duration(static["seconds"]),
          fastest_other(stored, "push")],
         ["impact on the wire, 0.3 s of motion", number(abs(impact["peak_force_error"]), 1),
          duration(impact["motion_seconds"]), fastest_other(stored, "impact")],
         ["force from a distilled table", f"{number(distil['DefaultTable/1']['bound_share'], 1)} of the largest force",
          f"{duration(lookup['seconds'])} (full wire {duration(wire['seconds'])})", ""],
         ["capture of a 16 t visitor, one minute of motion", "", duration(60.0 / capture["real_time_factor"]), ""],
         ["trace, two cores", "", f"up to {duration(longest)}", ""]])


def fastest_other(stored, case):
    """Of the programs that reach an error of 1e-3: "EXUDYN, 8e-4, 140 ms"."""
    programs = stored.json("peers.json")["cases"][case]
    good = [(found["best"]["processor_s"], name, found["best"]["error"]) for name, found in programs.items()
            if name != "snare" and found.get("best") and found["best"]["error"] <= 1e-3]
    seconds, name, error = min(good)
    return f"{name}, {number(error, 1)}, {duration(seconds)}"


# ---- docs/results/published_test.md ----


@region
def first_result(stored):
    return "```text\n" + stored.text("reproduce.txt") + "```\n"


@region
def published_made(stored):
    result = stored.json("reproduce.json")
    part = " The run was interrupted after the tracing: other ranges of the fits are not stored." if result["interrupted"] else ""
    return f"Made by `snare` {result['version']}.{part}\n"


@region
def published_headline(stored):
    return stored.json("reproduce.json")["published"]["headline"] + "\n"


@region
def published_map(stored):
    entries = stored.json("../../data/published/published_static_map.json")["map"]
    entries.sort(key=lambda e: -e["probability"][0])
    rows = [[e["meaning"], number(e["probability"][0], 2), number(e["probability"][1], 2), number(e["range_mm"], 3), e["readings"],
             "" if e["p"] is None else number(e["p"], 2), number(e["more_compliance_um_N"], 2)] for e in entries[:12]]
    return table(["what differs from the declared test", "probability", "ranges even", "range [mm]", "readings", "p",
                  "more compliance along the wire [um/N]"], rows)


@region
def published_curves(stored):
    result = stored.json("reproduce.json")
    names = [m["name"] for m in result["models"]]
    labels = {m["name"]: m["label"] for m in result["models"]}
    rows = [[f"{number(s['contact_position_mm'])} mm"] + [number(s["rmse_N"][n]) for n in names] + [number(s["sigma_N"])]
            for s in result["series"]]
    return table(["position"] + [f"{labels[n]}, rms distance [N]" for n in names] + ["published scatter [N]"], rows)


@region
def published_parameters(stored):
    result = stored.json("reproduce.json")
    fitted = next(m for m in result["models"] if m["name"] == "best_fit")["parameters"]
    declared = next(m for m in result["models"] if m["name"] == "declared")["parameters"]
    rows = []
    for key, value in fitted.items():
        spread = "" if value["stderr"] is None else f" +- {number(value['stderr'], 1)}"
        rows.append([f"`{key}`", number(declared[key]["value"], 3) if key in declared else "0",
                     number(value["value"], 3) + spread, value["unit"]])
    return table(["number", "declared", "fitted", "unit"], rows)


@region
def traced_wire(stored):
    leading = stored.json("reproduce.json")["leading"]
    values = "; ".join(f"`{key}` {number(value, 3)}" for key, value in sorted(leading["recomputed"]["values"].items()))
    return (f"`snare reproduce` writes the wire and the mounts of the leading explanation, {leading['meaning']}, as `traced.toml`; "
            f"`data/wires/traced_published.toml` is a copy. Fitted to {leading['readings']} readings up to {number(leading['range_mm'], 3)} mm "
            f"(p = {number(leading['recomputed']['p'], 2)}): {values}.\n")


# ---- docs/results/tracing.md ----


def sizes_table(result):
    rows = []
    for size in sorted(result["sizes"], key=int):
        s = result["sizes"][size]
        rows.append([size, int(s["sets"]), percent(s["right_class"]), percent(s["right_class_at_least"]),
                     percent(s["decided_right"]) + f" of {int(s['decided'])}" if "decided" in s else "",
                     number(s["mean_class_size_slips_as_one"]), percent(s["base_numbers_covered"])])
    text = table(["size of the effect", "sets", "right class", "at least (95 %)", "decided answers that are right", "members of a class",
                  "95 % intervals that hold"], rows)
    return (text + f"\n{round(result['false_alarms'] * result['sets_without_effect'])} of {int(result['sets_without_effect'])} sets "
            f"without an effect were falsely attributed one.\n")


@region
def blind_sizes(stored):
    return sizes_table(stored.json("blind.json"))


@region
def blind_geometry(stored):
    return sizes_table(stored.json("blind_geometry.json"))


@region
def blind_pairs(stored):
    sizes = stored.json("blind_pairs.json")["sizes"]
    return table(["size of each effect", "pairs", "both named", "at least (95 %)"],
                 [[size, int(s["pairs"]), percent(s["pairs_both_named"]), percent(s["pairs_both_named_at_least"])]
                  for size, s in sorted(sizes.items(), key=lambda item: int(item[0]))])


@region
def blind_null(stored):
    parts = stored.json("null.json")["parts"]
    return table(["noise, readings a series", "sets", "falsely attributed an effect", "zero in doubt", "sigma within 20 %"],
                 [[name, p["sets"], p["false_culprits"], p["zeros_in_doubt"], percent(p["share_with_sigma_within_20_percent"])]
                  for name, p in sorted(parts.items(), key=lambda i: (i[0].split()[0], int(i[0].split()[1])))])


@region
def blind_records(stored):
    result = stored.json("blind_records.json")
    rows = [("right class, size 5", "right_class_5_sigma"), ("right class, size 10", "right_class_10_sigma"),
            ("right class, size 30", "right_class_30_sigma"), ("false attributions without an effect", "false_alarms"),
            ("cause outside the catalogue, size 30: not explained", "outside_not_explained_30_sigma"),
            ("95 % intervals of fitted numbers that hold", "intervals_of_fitted_numbers"),
            ("95 % intervals of effects that hold", "intervals_of_effects")]
    return table(["what", "of", "share", "95 % bounds"],
                 [[what, result[key]["of"], percent(result[key]["share"]),
                   " to ".join(percent(b) for b in result[key]["bounds_95"])] for what, key in rows])


# ---- docs/results/captures.md ----


@region
def random_captures(stored):
    rows = []
    for model, file in (("strings", "random_captures.jsonl"), ("quasi-static wires", "random_captures_wires.jsonl"),
                        ("full wires", "random_captures_full.jsonl")):
        runs = stored.lines(file)
        rows.append([model, len(runs), sum(r["status"] == 0 for r in runs), sum(bool(r["caught"]) for r in runs),
                     number(max(r["peak_tension_N"] for r in runs), 3), duration(statistics.median(r["wall_s"] for r in runs))])
    return table(["wires as", "starts", "finished", "caught", "largest tension [N]", "median time of a run"], rows)


@region
def capture_speed(stored):
    words = {"stretched": "string", "quasi_static": "quasi-static wire", "full": "full wire", "higher_order": "higher order",
             "vertices": "vertices"}
    return table(["wires as", "elements", "discretisation", "times real time", "while holding", "steps"],
                 [[words[r["model"]], r["elements"], words[r["formulation"]], number(r["real_time_factor"]), number(r["holding"]),
                   r["steps"]] for r in stored.json("capture_speed.json")["runs"]])


@region
def string_speed(stored):
    runs = {(r["model"], r["elements"], r["formulation"]): r for r in stored.json("capture_speed.json")["runs"]}
    string = runs["stretched", 40, "higher_order"]
    rows = [[words, number(string["real_time_factor"] / runs[model, 40, "higher_order"]["real_time_factor"]),
             number(string["holding"] / runs[model, 40, "higher_order"]["holding"])]
            for words, model in (("quasi-static wires", "quasi_static"), ("full wires", "full"))]
    return table(["strings are faster than", "whole minute, times", "while holding, times"], rows)


def by_drift(stored, file):
    result = {}
    for row in stored.rows(file):
        if row["status"] == "done":
            result.setdefault(float(row["drift_m_s"]), []).append(row)
    return result


@region
def capture_envelope(stored):
    strings, wires = (by_drift(stored, f) for f in ("htv_envelope.csv", "htv_envelope_wires.csv"))

    def caught(rows):
        return f"{sum(r['caught'] == '1' for r in rows)} of {len(rows)}" if rows else ""

    return table(["drift [m/s]", "strings: caught", "largest tension [N]", "quasi-static wires: caught", "largest tension [N]"],
                 [[number(drift), caught(rows), number(max(float(r["tension_N"]) for r in rows), 3), caught(wires.get(drift, [])),
                   number(max(float(r["tension_N"]) for r in wires[drift]), 3)] for drift, rows in sorted(strings.items())])


# ---- docs/results/sweeps.md ----


@region
def pin_offsets(stored):
    rows = stored.rows("pin_offsets.csv")
    done = [r for r in rows if r["status"] == "done"]
    centre = next(r for r in done if float(r["x_mm"]) == 0.0 and float(r["y_mm"]) == 0.0)
    return table(["cases", "rejected: initial overlap", "peak tension, pin centred [N]", "largest peak tension [N]"],
                 [[len(rows), sum(r["status"] == "refused" for r in rows), number(float(centre["peak_N"]), 3),
                   number(max(float(r["peak_N"]) for r in done), 3)]])


@region
def push_sensitivity(stored):
    fields = stored.json("push_sensitivity.json")["fields"]
    variables = sorted({v for f in fields.values() for v in f["sobol"]["variables"]})
    return table(["share of the variance"] + [f"`{f}`" for f in fields],
                 [[f"`{v}`"] + [number(f["sobol"]["variables"][v]["total"]) if v in f["sobol"]["variables"] else ""
                                for f in fields.values()] for v in variables])


@region
def rigidizing(stored):
    rows = [r for r in stored.rows("rigidizing.csv") if r["status"] == "done"]
    return table(["visitor [kg]", "contact stiffness [N/m]", "contact damping [N s/m]", "peak at the fixture [N]", "pull [N]"],
                 [[number(float(r["mass_kg"]), 3), number(float(r["stiffness_N_m"]), 3), number(float(r["damping_Ns_m"]), 3),
                   number(float(r["contact_N"]), 3), number(float(r["pull_N"]), 3)] for r in rows])


@region
def sweep_throughput(stored):
    return table(["threads", "captures a second", "efficiency"],
                 [[r["threads"], number(stored.json("sweep_throughput.json")["cases"] / r["seconds"]), number(r["efficiency"])]
                  for r in stored.json("sweep_throughput.json")["runs"]])


# ---- docs/how_to/run_a_capture.md ----


def slope(rows, varied, field):
    """d ln field / d ln varied, of the rows with the smallest and the largest value of varied; the other variables are the same."""
    ends = [sorted(rows, key=lambda r: float(r[varied]))[i] for i in (0, -1)]
    low, high = ([math.log(float(row[name])) for name in (field, varied)] for row in ends)
    return (high[0] - low[0]) / (high[1] - low[1])


def signed_zero(value):
    """Three decimals, zero without a sign."""
    return f"{round(value, 3) + 0.0:.3f}"


@region
def held_modes(stored):
    varied = {"by K_GF, turn": "K_GF_turn", "by K_GF, shift": "K_GF_shift", "by EA": "EA", "by the joints": "K_joint"}
    modes = {"shoulder, visitor with it": "shoulder_roll_Hz", "wrist roll": "wrist_roll_Hz", "ring on its motor": "ring_Hz",
             "fixture shifts in its bushing": "fixture_shift_Hz", "fixture rolls in its bushing": "fixture_turn_Hz"}
    base, *others = stored.rows("htv_modes.csv")
    changed = {name: [r for r in others if r[name] != base[name]] for name in varied.values()}
    return table(["8 s into the shipped capture, strings", "frequency"] + list(varied),
                 [[label, f"{number(float(base[field]), 4)} Hz"] + [signed_zero(slope(changed[name], name, field)) for name in varied.values()]
                  for label, field in modes.items()])


@region
def held_roll(stored):
    rows = stored.rows("htv_roll.csv")
    joints = sorted({float(r["K_joint"]) for r in rows})
    at = [sorted((r for r in rows if float(r["K_joint"]) == k), key=lambda r: float(r["K_GF"])) for k in joints]
    return table(["joints, N m/rad"] + [number(k, 1) for k in joints],
                 [["roll, Hz"] + [f"{float(three[1]['roll_Hz']):.3f}" for three in at],
                  ["d ln f/d ln K_GF"] + [signed_zero(slope(three, "K_GF", "roll_Hz")) for three in at]])


class Offset:
    """A row of htv_order.csv: where the shaft stands, wires and times in the order in which they become tight."""

    def __init__(self, row):
        x, y = float(row["x_mm"]), float(row["y_mm"])
        self.radius, self.azimuth = round(math.hypot(x, y)), round(math.degrees(math.atan2(y, x))) % 360
        self.touch, self.tight = (sorted((float(row[f"{what}_{k}_s"]), k) for k in (1, 2, 3)) for what in ("touch", "tight"))

    def order(self, times):
        return " ".join(str(k) for _, k in times)


def offsets(stored):
    """The row of the middle, and the others."""
    middle, *others = sorted((Offset(r) for r in stored.rows("htv_order.csv")), key=lambda o: (o.radius, o.azimuth))
    return middle, others


@region
def wire_order(stored):
    azimuths = {}
    for one in offsets(stored)[1]:
        azimuths.setdefault(f"{one.order(one.touch)}, {one.order(one.tight)}", set()).add(one.azimuth)
    return table(["shaft at, degrees", "wires as they touch", "as they become tight"],
                 [[", ".join(str(a) for a in sorted(degrees)), *orders.split(", ")]
                  for orders, degrees in sorted(azimuths.items(), key=lambda item: min(item[1]))])


@region
def wire_order_times(stored):
    middle, others = offsets(stored)
    rows = [["0"] + [f"{time:.3f}" for time, _ in middle.tight]]
    for radius in sorted({o.radius for o in others}):
        ring = [o for o in others if o.radius == radius]
        spans = [[o.tight[k][0] for o in ring] for k in range(3)]
        rows.append([radius] + [f"{min(span):.3f} to {max(span):.3f}" for span in spans])
    thirds = [[o for o in others if (o.radius, o.azimuth % 120) == key] for key in sorted({(o.radius, o.azimuth % 120) for o in others})]
    moved = [max(max(o.tight[k][0] for o in three) - min(o.tight[k][0] for o in three) for three in thirds) for k in range(3)]
    return (table(["shaft off the middle [mm]", "first wire tight [s]", "second [s]", "last [s]"], rows) +
            f"\nTurning the offset by 120 degrees renumbers the wires. It moves the first time by {number(1e3 * moved[0], 1)} ms at most,\n"
            f"the second by {number(1e3 * moved[1])} ms and the last by {number(1e3 * moved[2])} ms.\n")


@region
def capture_mesh(stored):
    runs = stored.json("capture_mesh.json")
    wires = sorted(next(iter(runs.values()))["tight_s"])

    def span(what, wire):
        values = [run[what][wire] for run in runs.values()]
        return max(values) - min(values), max(values)

    times = max(span(what, wire)[0] for what in ("first_touch_s", "tight_s") for wire in wires)
    shares = [number(100.0 * span("peak_tension_N", wire)[0] / span("peak_tension_N", wire)[1]) for wire in wires]
    *meshes, last = runs
    return (f"With {', '.join(meshes)} and {last} elements a wire the times of the shipped capture lie within {number(1e3 * times)} ms,\n"
            f"its peak tensions within {', '.join(shares[:-1])} and {shares[-1]} %.\n")


@region
def rigidized(stored):
    runs = stored.json("rigidized.json")
    lines = {"plate meets end effector": lambda r: f"{r['touch_s']:.3f} s", "peak contact force": lambda r: f"{number(r['contact_N'], 3)} N",
             "largest pull of the carriage": lambda r: f"{number(r['pull_N'], 3)} N",
             "shoulder pitch": lambda r: f"{number(r['shoulder_Nm'], 3)} N m",
             "in contact 5 s later": lambda r: "yes" if r["in_contact_at_end"] else "no"}
    return table([""] + [r["title"] for r in runs], [[label] + [cell(r) for r in runs] for label, cell in lines.items()])


@region
def attachment_swings(stored):
    result = stored.json("attachment_swings.json")
    head = ["attachment turns at [N m/rad]", f"rate about x, half its range from {number(result['from_s'], 1)} s on [deg/s]", "about y [deg/s]"]
    return table(head, [[re.sub(r"e\+?0*", "e", f"{r['stiffness_Nm_rad']:g}"), number(r["x_deg_s"], 3), number(r["y_deg_s"], 3)]
                        for r in result["runs"]])


# ---- docs/how_to/from_bench_to_odds.md ----

# Numbers with which data/experiments/snare_rope_*.csv were made.
MADE_WITH = {"wire.axial_stiffness_N": 46.8e3, "wire.length_mm": 200.13, "wire.bending_stiffness_Nm2": 0.0056}


@region
def traced_rope(stored):
    fitted = stored.json("snare_rope.json")["parameters"]
    rows = []
    for key, truth in MADE_WITH.items():
        values = [truth] + [fitted[key][k] for k in ("value", "lower95", "upper95")]
        made, value, low, high = (number(x, 5 if key.endswith("_mm") else 3) for x in values)
        rows.append([f"`{key}`", made, value, number(fitted[key]["stderr"]), f"{low} to {high}", fitted[key]["unit"]])
    return table(["number", "readings made with", "traced", "standard error", "95 % interval", "unit"], rows)


def share_of(hits):
    return f"{number(hits['share'])} ({' to '.join(number(b) for b in hits['interval95'])})"


@region
def capture_odds(stored):
    result = stored.json("capture_odds.json")
    caught, (limit, strong), tension = result["caught"], next(iter(result["limits"].items())), result["tension_N"]
    return table(["of 2000 captures", "", "share (95 % interval)"],
                 [["refused: initial overlap of shaft and wall", result["statuses"].get("refused", 0), ""],
                  ["caught", caught["hits"], f"{caught['share']:.3f} ({caught['interval95'][0]:.3f} to {caught['interval95'][1]:.3f})"],
                  [limit, strong["hits"], share_of(strong)],
                  ["median of the peak tension [N]", number(tension["q50"], 3), ""],
                  ["nine in ten peak tensions [N]", f"{number(tension['q05'], 3)} to {number(tension['q95'], 3)}", ""]])


@region
def next_reading(stored):
    result = stored.json("next_reading.json")
    return (f"The bench leaves {number(result['left_open_N'])} N of the peak tension open. The most informative next reading is at "
            f"{number(result['place_mm'])} mm and {number(result['travel_mm'])} mm of travel; it leaves {number(result['left_after_N'])} N.\n")


# ---- docs/record_file.md ----


def with_interval(value, digits):
    low, high = (number(value[k], digits) for k in ("lower", "upper"))
    return f"{number(value['value'], digits)} [{low}, {high}] {value['unit']}"


@region
def flights(stored):
    result = stored.json("flights.json")
    rows = []
    for name, label in (("flight", "full wires, fitted by strings"), ("flight_rods", "rods, by equations that share no code")):
        fits = result[name]
        fitted = {key.rpartition(".")[2]: value for key, value in fits["gauss_newton"]["parameters"].items()}
        wire = next(value for key, value in fits["gauss_newton"]["parameters"].items() if ".wire." in key)
        rows.append([f"`data/records/{name}.toml`: {label}", with_interval(fitted["rotational_stiffness_Nm_rad"], 4),
                     with_interval(fitted["rate_deg_s"], 4), with_interval(wire, 4),
                     ", ".join(number(s, 3) for s in fits["gauss_newton"]["heldout_sigmas"]),
                     ", ".join(str(fits[fit]["simulations"]) for fit in ("gauss_newton", "nelder_mead"))])
    return table(["file", "fixture's attachment, made with 9.3e7 N m/rad", "ring, made with 55 deg/s", "wire, made with 60,000 N or 600,000 N/m",
                  "second flight, not fitted [standard deviations]", "simulations, Gauss-Newton, Nelder-Mead"], rows)


@region
def flight_families(stored):
    fits = stored.json("flights.json")
    strings, honda, newton = fits["flight"]["gauss_newton"], fits["flight_rods"]["honda"], fits["flight_rods"]["gauss_newton"]
    rods = strings["families"]["rods"]
    ring, attachment = "phases[close].drives[1].rate_deg_s", "bushings[gf].rotational_stiffness_Nm_rad"
    rates = [number(fit["parameters"][ring]["value"], 4) for fit in (rods, honda)]
    return (f"Rods instead of strings for the full wires find the attachment, too ({number(rods['parameters'][attachment]['value'], 4)} N m/rad),\n"
            f"but do not fit: chi squared is {number(rods['chi2_dof'])} a reading, that of strings {number(strings['chi2_dof'])}.\n"
            f"With the rods' stiffness of Table 4 held the ring's rate is {rates[0]} deg/s (`fit.families` of `flight.toml`, in `warnings`).\n"
            f"Honda's rule ends the simplex on rods after {honda['simulations']} simulations, at {rates[1]} deg/s and "
            f"{number(honda['chi2_dof'] / newton['chi2_dof'], 3)} times the least sum of squares.\n")


# Traced records by file: description, fitted numbers, held-out or watched data.
TRACED_RECORDS = {"emps": ("25,000 readings of a drive", "inertia, viscous friction", "position under its own control"),
                  "flight_attachment": ("two flights of a visitor on an arm, a minute of rates", "stiffness of the joints", "second flight"),
                  "air_table": ("the force of two impacts whose impulse is right and whose peak is wrong", "time of the touch", "second impact"),
                  "pendulum": ("a free swing in six parts", "inertia, viscous bearing", "parts 5 and 6")}


def before_and_after(errors, unit):
    words = [number(errors[key], 3) for key in ("before", "helped" if "helped" in errors else "after")]
    return f"{', '.join(words)} {unit}"


def named_effects(trace):
    if not trace["selected_places"]:
        return "nothing; helpful: " + ", ".join(f"`{place.split()[0]}`" for place in trace["helped"])
    values = "; ".join(with_interval(value, 4) for value in trace["added"].values())
    return ", ".join(f"`{place.split()[0]}`" for place in trace["selected_places"]) + f": {values}"


@region
def air_table_bench(stored):
    made = stored.json("air_table_bench.json")
    names = {"declared": "the declared wire and bench", "leading": f"the declared wire on the leading bench (`mount = {{ {made['leading_mount']} }}`)",
             "published_law": "the published quadratic"}
    return table(["by", "peak [N]", "impulse [N s]", "contact [ms]"],
                 [[what, number(made[name]["peak_N"], 3), number(made[name]["impulse_Ns"], 3), number(1e3 * made[name]["duration_s"], 3)]
                  for name, what in names.items()])


def traced_by_file(stored):
    return {**stored.json("traced_records.json"), "air_table": stored.json("traced_air_table.json")}


@region
def traced_records(stored):
    traces = traced_by_file(stored)
    rows = []
    for name, (what, fitted, other) in TRACED_RECORDS.items():
        trace = traces[name]
        rows.append([f"`data/records/{name}.toml`, {what}", fitted, named_effects(trace), before_and_after(trace["errors"], trace["unit"]),
                     f"{other}: {before_and_after(trace['heldout'], trace['heldout_unit'])}"])
    return table(["file", "fitted", "named", "error before, after", "not fitted, before, after"], rows)


@region
def drive_left(stored):
    drive = stored.json("traced_records.json")["emps"]
    before, after = (percent(drive["relative"][key]) for key in ("before", "after"))
    return (f"The drive's error is {before} of the force before and {after} after (published: 17, 4.1, 3.1 %). The named effects explain "
            f"{percent(1.0 - drive['share_left'])} of the excess over the noise.\nThe noise of the filtered readings is estimated as "
            f"{number(drive['noise']['sigma_N'])} N, from the median of their second differences, which the reversals of the force do not enter.\n")


# ---- docs/results/speed.md ----


@region
def speed_made(stored):
    return when(*(stored.json(f)["context"] for f in ("push.json", "motion.json", "distil.json", "trace.json", "arm.json")))


@region
def push_speed(stored):
    rows = stored.benchmarks("push.json")
    return table(["elements of the finest mesh", "relative error of the force", "time"],
                 [[n, number(rows[f"OutwardCurveExtrapolated/{n}"]["force_error"], 1),
                   duration(rows[f"OutwardCurveExtrapolated/{n}"]["seconds"])] for n in (64, 128, 256, 512)])


@region
def motion_speed(stored):
    rows = []
    for name, row in stored.benchmarks("motion.json").items():
        match = re.fullmatch(r"case_h/elements:(\d+)/higher_order:(\d)/quasi_static:(\d)", name)
        if match:
            elements, higher, quasi = (int(g) for g in match.groups())
            rows.append([quasi, higher, elements,
                         ["quasi-static" if quasi else "full", "higher order" if higher else "vertices", elements,
                          number(row["peak_force_error"], 1), number(row["impulse_error"], 1), int(row["steps"]),
                          duration(row["motion_seconds"])]])
    return table(["wire", "discretisation", "elements", "error of the peak", "error of the impulse", "steps", "time"],
                 [row[-1] for row in sorted(rows)])


@region
def law_speed(stored):
    rows = stored.benchmarks("distil.json")
    names = [("exported quadratic law", "ExportedLawForce"), ("table, in a program that links the library", "TableForce"),
             ("exported table", "ExportedTableForce"), ("full wire", "FullWireForce")]
    text = table(["one force by", "time"], [[label, duration(rows[name]["seconds"])] for label, name in names])
    distilling = rows["DefaultTable/1"]
    return text + (f"\nThe default table is distilled from {int(distilling['curves'])} curves in {duration(distilling['seconds'])} of "
                   f"one core; its stated bound is {number(distilling['bound_share'], 1)} of the largest force.\n")


@region
def trace_speed(stored):
    return table(["cause in the readings", "time of the trace"],
                 [[f"`{name.split('/')[1]}`", duration(row["seconds"])] for name, row in stored.benchmarks("trace.json").items()
                  if name.startswith("whole_trace")])


@region
def peers_made(stored):
    result = stored.json("peers.json")
    programs = ", ".join(f"{name} {p['version'].removeprefix('snare ')} ({p['what']})" for name, p in result["programs"].items())
    start = f" A command of snare takes {duration(result['snare_start_s'])} for a motion of a microsecond." if result["snare_start_s"] else ""
    return f"Last measured {result['date'][:10]}, one core of {result['processor']}: {programs}.{start}\n"


def peer_run(run):
    """Cells of error and time of a run, or the reason for a missing result."""
    if run is None:
        return ["", ""]
    return [number(run["error"], 1), duration(run["processor_s"])] if "error" in run else [run["reason"], ""]


@region
def peer_cases(stored):
    text = ""
    words = {"push": "Static push", "impact": "Impact", "tip": "Large deflection of a cantilever", "frequency": "First frequency of a cantilever",
             "twist": "Critical twist"}
    for case, programs in stored.json("peers.json")["cases"].items():
        rows = []
        for name, found in programs.items():
            if "cannot" in found:
                rows.append([name, found["cannot"], "", "", "", ""])
                continue
            best = peer_run(found["best"]) if found["best"] else ["; ".join(found["reasons"]), ""]
            rows.append([name, *best, *peer_run(found["defaults"]), number(found["order"], 2) if found["order"] else "none"])
        text += f"**{words[case]}**\n\n" + table(["program", "error", "time", "by default: error", "time", "order"], rows) + "\n"
    return text.rstrip("\n") + "\n"


@region
def peer_experiments(stored):
    rows = []
    for experiment, solvers in stored.json("peers.json")["cosseratbench"]["experiments"].items():
        for metric in next((s["metrics"] for s in solvers.values() if "metrics" in s), {"": None}):
            if metric == "settling_residual":
                continue
            cells = []
            for s in solvers.values():
                value = s.get("metrics", {}).get(metric)
                cells.append(s.get("reason", "") if value is None else f"{number(value, 2)} in {duration(s['processor_s'])}")
            rows.append([experiment, f"`{metric}`" if metric else "", *cells])
    return table(["experiment", "measure", "snare", "MuJoCo 3.17.0", "PyElastica 1.0.0"], rows)


@region
def python_speed(stored):
    result = stored.json("python.json")
    return table(["from Python", "time over that of C++ or of the command"],
                 [["force of a law at a million points", number(result["law_force"]["ratio_of_medians"], 3)],
                  ["a push", number(result["push"]["call_over_command"], 3)]])


@region
def memory_use(stored):
    return table(["what", "seconds", "memory [MB]"],
                 [[what, number(m["seconds"]), m["memory_MB"]] for what, m in stored.json("memory.json").items()])


def pages(root):
    """README.md and the pages under docs/ that have a region."""
    found = [root / "README.md"] + sorted((root / "docs").rglob("*.md"))
    return [page for page in found if REGION.search(page.read_text(encoding="utf-8"))]


def written(text, stored, name):
    """The page with each region as the stored results have it."""
    def replace(match):
        if match.group(2) not in WRITERS:
            raise SystemExit(f"{name}: no writer is called {match.group(2)}; there are {', '.join(WRITERS)}")
        return match.group(1) + WRITERS[match.group(2)](stored) + match.group(4)

    return REGION.sub(replace, text)


def pictures(stored):
    """Pictures that are drawn from stored results, by their path."""
    return {"docs/gallery/reproduce.svg": curve_picture(stored.json("reproduce.json"))}


def update_picture(root, path, made, check):
    """Draws a picture again, or says that it would change; whether it would."""
    file = root / path
    if file.is_file() and file.read_text(encoding="utf-8") == made:
        return False
    if check:
        print(f"{path}: differs from the stored results")
    else:
        file.write_text(made, encoding="utf-8")
        print(path)
    return True


def chosen(names):
    if names == "all":
        return [name for name, maker in shipped.MAKERS.items() if not maker.long]
    unknown = [name for name in names.split(",") if name not in shipped.MAKERS]
    if unknown:
        raise SystemExit(f"no maker is called {', '.join(unknown)}; there are {', '.join(shipped.MAKERS)}")
    return names.split(",")


def remake(names, snare, root, keep):
    """Runs makers and stores their output, or with keep prints how it differs from the stored one. Returns the status of the script."""
    status = 0
    for name in chosen(names):
        maker = shipped.MAKERS[name]
        begin = time.monotonic()
        try:
            with tempfile.TemporaryDirectory() as folder:
                made = maker.function(snare, root, pathlib.Path(folder))
            assert set(made) == set(maker.files), f"{name} makes {sorted(made)}"
            for path, content in made.items():
                content = content if isinstance(content, bytes) else content.encode()
                old = (root / path).read_bytes() if (root / path).is_file() else None
                found = shipped.differences(path, old, content, maker)
                for line in found[:shipped.MOST_LINES]:
                    print(f"{path}: {line}")
                if len(found) > shipped.MOST_LINES:
                    print(f"{path}: and {len(found) - shipped.MOST_LINES} more")
                if found and keep:
                    status = 1
                # Output that differs by less than the tolerance is not stored, so that only changes are changes.
                elif found:
                    (root / path).write_bytes(content)
                    print(f"{path}: stored")
        except shipped.Skipped as reason:
            print(f"{name}: skipped: {reason}")
            status = status or SKIPPED
        print(f"{name}: {time.monotonic() - begin:.0f} s", flush=True)
    return status


def update(page, stored, check, root):
    """Rewrites a page, or prints what would change; whether it would."""
    text = page.read_text(encoding="utf-8")
    new = written(text, stored, page.name)
    if new == text:
        return False
    if not check:
        page.write_text(new, encoding="utf-8")
        print(page.relative_to(root))
        return True
    for (_, name, old, _), (_, _, made, _) in zip(REGION.findall(text), REGION.findall(new)):
        if old != made:
            print(f"{page.relative_to(root)}: the region {name} differs from the stored results, which give:\n{made}")
    return True


def main():
    about = __doc__.replace("MAKERS", "\n".join(f"  {name:18} {m.what}" for name, m in shipped.MAKERS.items()))
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--reproduce", metavar="SNARE")
    parser.add_argument("--remake", nargs=2, metavar=("NAMES", "SNARE"))
    parser.add_argument("--compare", nargs=2, metavar=("NAMES", "SNARE"))
    parser.add_argument("repository", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).parents[1])
    options = parser.parse_args()
    root = options.repository.resolve()
    wanted = options.remake or options.compare or (["reproduce", options.reproduce] if options.reproduce else None)
    status = 0
    if wanted:
        status = remake(wanted[0], pathlib.Path(wanted[1]).resolve(), root, keep=bool(options.compare))
        if options.compare:
            return status
    stored = Stored(root / "benchmarks/results")
    stale = sum(update(page, stored, options.check, root) for page in pages(root))
    stale += sum(update_picture(root, path, made, options.check) for path, made in pictures(stored).items())
    return 1 if options.check and stale else status


if __name__ == "__main__":
    sys.exit(main())
