"""What is shipped and comes out of the command: made again, stored, or compared with what is stored.

A maker runs the command (or an example) in a folder of its own and returns the stored files by their path in the repository. results_pages.py calls the
makers by name: `--remake` stores what they return, `--compare` holds it against what is stored, each within the tolerance of its maker.
"""

import csv
import io
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import tomllib

NUMBER = re.compile(r"(?<![\w#.])[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.]*\w)")
COLOUR = re.compile(r"#[0-9a-fA-F]{6}\b|\bcurrentColor\b")
TIMES = re.compile(r"(^|[._])(version|wall_s|seconds)$")
MOST_LINES = 20  # of differences that are printed
MAKERS = {}


class Skipped(Exception):
    """What a maker needs is not installed."""


# Pictures without numbers: their SVG is their source.
DRAWN_BY_HAND = {f"docs/drawings/{name}.svg" for name in ("arm_frames", "clamp_half_cell", "contact_frame", "rod_stencil")}


class Maker:
    """Makes files again. relative: largest difference of a number over its size; absolute: that is passed over; pixels: mean difference
    of pictures, of 0 to 1; named: tolerances (relative, absolute) of numbers by a pattern of their key in a JSON file,
    of their line in a text; long: it takes minutes or
    a browser, and is made and compared only where it is named."""

    def __init__(self, function, files, relative, absolute, pixels, named, long):
        self.function, self.files, self.long = function, files, long
        self.relative, self.absolute, self.pixels, self.named = relative, absolute, pixels, named
        self.what = function.__doc__.splitlines()[0]

    def tolerance(self, name):
        """Relative and absolute, of the number of this key or of the numbers of this line."""
        return next((t for pattern, t in self.named if re.search(pattern, name)), (self.relative, self.absolute))


def maker(*files, relative=1e-3, absolute=1e-9, pixels=0.01, named=(), long=False):
    """Registers a function as the maker of files, by their path in the repository."""
    def register(function):
        MAKERS[function.__name__] = Maker(function, files, relative, absolute, pixels, named, long)
        return function
    return register


def results(name):
    return f"benchmarks/results/{name}"


def gallery(name):
    return f"docs/gallery/{name}"


def run(command, root, python=None):
    """Standard output and error of a command that succeeds. python: the folder of the module."""
    environment = {**os.environ, "MPLBACKEND": "agg", "PYTHONDONTWRITEBYTECODE": "1", "SNARE_SOURCE_DIR": str(root)}
    if python:
        environment["PYTHONPATH"] = str(python)
    done = subprocess.run([str(word) for word in command], cwd=root, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(str(word) for word in command)} ended with status {done.returncode}:\n{done.stderr}")
    return done.stdout + done.stderr


# ---- comparison ----


def flat(value, key=""):
    """(key, leaf) of a JSON document."""
    if isinstance(value, dict):
        for name, one in value.items():
            yield from flat(one, f"{key}.{name}" if key else name)
    elif isinstance(value, list):
        for k, one in enumerate(value):
            yield from flat(one, f"{key}[{k}]")
        yield f"{key}.length", len(value)
    else:
        yield key, value


def close(a, b, relative, absolute):
    return abs(a - b) <= absolute + relative * max(abs(a), abs(b))


def json_differences(stored, made, maker_):
    """Lines: keys of which the values differ."""
    old, new = dict(flat(stored)), dict(flat(made))
    found = [f"{key} is {'not stored' if key in new else 'stored and not made'}" for key in sorted(old.keys() ^ new.keys())]
    for key in sorted(old.keys() & new.keys()):
        if TIMES.search(key):
            continue
        a, b = old[key], new[key]
        if all(isinstance(x, (int, float)) and not isinstance(x, bool) for x in (a, b)):
            if close(a, b, *maker_.tolerance(key)):
                continue
        elif isinstance(a, str) and isinstance(b, str):
            if not text_differences(a, b, maker_):
                continue
        elif a == b and type(a) is type(b):
            continue
        found.append(f"{key}: stored {a}, made {b}")
    return found


def text_differences(stored, made, maker_):
    """Lines that differ in more than their numbers, or of which a number differs by more than the tolerance. Colours may differ."""
    found = []
    old, new = stored.splitlines(), made.splitlines()
    if len(old) != len(new):
        return [f"{len(old)} lines stored, {len(new)} made"]
    for k, (a, b) in enumerate(zip(old, new), 1):
        if a == b:
            continue
        words, others = (NUMBER.sub("0", COLOUR.sub("colour", x)) for x in (a, b))
        relative, absolute = maker_.tolerance(a)
        pairs = zip(NUMBER.findall(a), NUMBER.findall(b))
        if words != others or not all(close(float(x), float(y), relative, absolute + last_place(x, y)) for x, y in pairs):
            found.append(f"line {k}: stored `{a}`, made `{b}`")
    return found


def last_place(*numbers):
    """One in the last printed place of numbers with few digits, by which a rounding differs; 0 of those with six digits or more."""
    places = []
    for text in numbers:
        digits, _, exponent = text.lower().partition("e")
        if len(re.sub(r"\D", "", digits).lstrip("0")) < 6:
            places.append(10.0 ** (int(exponent or 0) - len(digits.partition(".")[2])))
    return max(places, default=0.0) if "." in "".join(numbers) else 0.0


def picture_differences(stored, made, maker_):
    try:
        import matplotlib.image
    except ImportError:
        raise Skipped("pictures are compared by matplotlib: apt-get install python3-matplotlib")
    old, new = (matplotlib.image.imread(io.BytesIO(data), format="png")[..., :3] for data in (stored, made))
    if old.shape != new.shape:
        return [f"{old.shape[1]} x {old.shape[0]} stored, {new.shape[1]} x {new.shape[0]} made"]
    mean = float(abs(old - new).mean())
    return [f"pictures differ by {mean:.4f} in the mean, at most {maker_.pixels}"] if mean > maker_.pixels else []


def csv_differences(stored, made, maker_):
    """Rows by their place; a cell is a number or a text, and its tolerance is that of its column."""
    old, new = (list(csv.reader(text.splitlines())) for text in (stored, made))
    if len(old) != len(new) or old[0] != new[0]:
        return [f"{len(old)} rows {old[0]} stored, {len(new)} rows {new[0]} made"]
    found = []
    for k, (a, b) in enumerate(zip(old, new)):
        for name, x, y in zip(old[0], a, b):
            if x != y and text_differences(f"{name}={x}", f"{name}={y}", maker_):
                found.append(f"row {k}, {name}: stored {x}, made {y}")
    return found


def differences(path, stored, made, maker_):
    """Lines that say how what is stored under a path (bytes) differs from what was made."""
    if stored is None:
        return ["is not stored"]
    if stored == made:
        return []
    if path.endswith(".png"):
        return picture_differences(stored, made, maker_)
    old, new = stored.decode(), made.decode()
    if path.endswith(".json"):
        return json_differences(json.loads(old), json.loads(new), maker_)
    if path.endswith(".jsonl"):
        return [f"line {k}: {d}" for k, (a, b) in enumerate(zip(old.splitlines(), new.splitlines()), 1)
                for d in json_differences(json.loads(a), json.loads(b), maker_)]
    return (csv_differences if path.endswith(".csv") else text_differences)(old, new, maker_)


# ---- the published test ----


def with_chosen_tables(made, stored):
    """A made wire file, and the end of the stored one from the first table on that a tracing does not give."""
    found = [m for m in re.finditer(r"^\[(\w+)\]$", stored, re.M) if f"\n[{m.group(1)}]\n" not in made]
    return made + ("\n" + stored[found[0].start():] if found else "")


TRACED = "data/wires/traced_published.toml"
MAP = "data/published/published_static_map.json"


@maker(MAP, relative=1e-2, absolute=1e-2, long=True)
def published_map(snare, root, folder):
    """The map of hypotheses about the published static test, which `snare reproduce` reads; 25 minutes of one core."""
    program = pathlib.Path(snare).parent / "benchmarks/published_map_benchmark"
    if not program.is_file():
        raise Skipped(f"{program} was not built")
    run([program, "--replicates", "99", "--out", folder / "map.json"], root)
    return {MAP: (folder / "map.json").read_text(encoding="utf-8")}


@maker(results("published.json"), relative=0.5, absolute=0.03, long=True)
def published(snare, root, folder):
    """P of published fits of sets that their own wire made, which should be uniform; six minutes of one core."""
    program = pathlib.Path(snare).parent / "benchmarks/published_benchmark"
    if not program.is_file():
        raise Skipped(f"{program} was not built")
    run([program, "--sets", "500", "--readings", "6,8,12,20,40", "--out", folder / "published.json"], root)
    return {results("published.json"): (folder / "published.json").read_text(encoding="utf-8")}


@maker(results("reproduce.json"), results("reproduce.txt"), TRACED,
       relative=2e-3, absolute=1e-6, named=((r"(^|\.)p$", (0.0, 0.02)), (r"chi2|deviance", (1e-2, 1e-2)), (r"stderr$", (1e-2, 1e-6)),
              (r"length_mm", (2e-5, 0.0)), (r"(_N|rmse_N\.\w+)(\[\d+\])?$", (2e-3, 2e-3))))
def reproduce(snare, root, folder):
    """The published static test: summary, first lines on the console, the traced wire.

    P is that of a bootstrap of 299 rows or more: 0.02 is some six of them. Fitted numbers are known to some per cent and fits end within a hundredth of that;
    the length to 3.5 micrometres, a tenth of its standard error and half a per cent of the slack.
    """
    printed = run([snare, "reproduce", "--out", folder], root)
    result = json.loads((folder / "reproduce.json").read_text(encoding="utf-8"))
    kept = {key: result[key] for key in ("schema", "version", "interrupted", "models", "summary_statistics", "published", "leading")}
    kept["trace"] = {key: result["trace"][key] for key in ("verdict", "verdict_kind", "explained", "selected")}
    last = result["models"][-1]["name"]
    kept["series"] = [{"name": s["name"], "contact_position_mm": s["contact_position_mm"], "sigma_N": s["published"]["sigma_N"],
                       "rmse_N": {name: m["rmse_N"] for name, m in s["models"].items()}, "displacement_mm": s["displacement_mm"],
                       "published_N": s["published_N"], "computed_N": s["models"][last]["force_N"]} for s in result["series"]]
    lines = [line for line in printed.splitlines() if not line.startswith("warning: ")]
    head = [i for i, line in enumerate(lines) if line.startswith("rms distance")][0]
    traced = with_chosen_tables((folder / "traced.toml").read_text(encoding="utf-8"), (root / TRACED).read_text(encoding="utf-8"))
    return {results("reproduce.json"): json.dumps(kept, indent=1, sort_keys=True) + "\n",
            results("reproduce.txt"): "\n".join(lines[head:head + 4]) + "\n", TRACED: traced}


# ---- sweeps ----


def sweep(snare, root, folder, name, stored=None, changes=()):
    """cases.csv of a shipped sweep, or another of its files. changes: of the file, KEY=VALUE."""
    overrides = [word for change in changes for word in ("--set", change)]
    run([snare, "sweep", f"data/sweeps/{name}.toml", "--out", folder, "--quiet", *overrides], root)
    return (folder / (stored or "cases.csv")).read_text(encoding="utf-8").replace("data/sweeps/../", "data/")


def map_of(folder, title):
    """The map of a sweep's page that has this title, as a file of its own."""
    page = (folder / "report.html").read_text(encoding="utf-8")
    for found in re.findall(r"<svg\b.*?</svg>", page, re.S):
        if f">{title}</text>" in found:
            return found.replace("currentColor", "#333333") + "\n"
    raise SystemExit(f"{folder}/report.html: no map is called {title}")


# Steps of a motion follow last digits: peaks of captures differ by up to half a per cent between machines, times by a millisecond; blows of
# the shaft on the housing by a twentieth with the tolerances of sweeps, and what still moves at the end by a millimetre a second.
CAPTURE = dict(relative=1e-2, absolute=1e-3, named=((r"^knock_N", (0.1, 1.0)), (r"^speed_m_s", (2e-2, 1e-3))))


# Nothing floats here: peaks follow last digits by less than a thousandth, and the page prints three digits.
@maker(results("pin_offsets.csv"), gallery("pin_offsets.svg"), relative=2e-3, absolute=1e-3)
def pin_offsets(snare, root, folder):
    """A pin off the axis of a snare: cases and map."""
    return {results("pin_offsets.csv"): sweep(snare, root, folder, "pin_offsets"),
            gallery("pin_offsets.svg"): map_of(folder, "mean of peak_N")}


@maker(results("rigidizing.csv"), **CAPTURE)
def rigidizing(snare, root, folder):
    """The blow at the end of the pull: cases."""
    return {results("rigidizing.csv"): sweep(snare, root, folder, "rigidizing")}


@maker(results("push_sensitivity.json"), relative=1e-3, absolute=1e-4, long=True)
def push_sensitivity(snare, root, folder):
    """What the force of a push depends on: Sobol indices."""
    return {results("push_sensitivity.json"): sweep(snare, root, folder, "push_sensitivity", "summary.json")}


@maker(results("htv_envelope.csv"), gallery("htv_envelope.svg"), **CAPTURE, long=True)
def htv_envelope(snare, root, folder):
    """The envelope of a capture, strings: cases and map."""
    return {results("htv_envelope.csv"): sweep(snare, root, folder, "htv_envelope"),
            gallery("htv_envelope.svg"): map_of(folder, "mean of tension_N")}


@maker(results("htv_envelope_wires.csv"), gallery("htv_envelope_wires.svg"), long=True, **CAPTURE)
def htv_envelope_wires(snare, root, folder):
    """The envelope of a capture, quasi-static wires: cases and map; takes a quarter of an hour."""
    return {results("htv_envelope_wires.csv"): sweep(snare, root, folder, "htv_envelope_wires"),
            gallery("htv_envelope_wires.svg"): map_of(folder, "share of cases with caught")}


@maker(results("htv_order.csv"), **CAPTURE, long=True)
def htv_order(snare, root, folder):
    """Which wire touches first, by the place of the shaft: cases."""
    return {results("htv_order.csv"): sweep(snare, root, folder, "htv_order")}


@maker(results("htv_modes.csv"))
def htv_modes(snare, root, folder):
    """Frequencies of a held visitor by bushing, rope and joints: cases."""
    return {results("htv_modes.csv"): sweep(snare, root, folder, "htv_modes")}


@maker(results("htv_roll.csv"))
def htv_roll(snare, root, folder):
    """Frequencies of a rigidized visitor by bushing and joints: cases."""
    return {results("htv_roll.csv"): sweep(snare, root, folder, "htv_roll")}


@maker(results("capture_odds.json"), relative=1e-2, absolute=1e-3, named=((r"hits$", (0.0, 3.0)), (r"share$|interval95", (0.0, 2e-3))), long=True)
def capture_odds(snare, root, folder):
    """The odds of 2000 captures by a traced rope: outcomes and peak tensions; takes minutes."""
    summary = json.loads(sweep(snare, root, folder, "capture_odds", "summary.json"))
    return stored_json("capture_odds.json", {
        "statuses": summary["statuses"], "caught": summary["fields"]["caught"]["true"], "limits": summary["limits"],
        "tension_N": {q: summary["fields"]["tension_N"][q] for q in ("q05", "q50", "q95")}})


# ---- single captures ----


def simulated(snare, root, folder, name, *changes):
    """summary.json of a shipped scenario. changes: of the file, KEY=VALUE."""
    overrides = [word for change in changes for word in ("--set", change)]
    run([snare, "simulate", f"data/scenarios/{name}.toml", "--out", folder, "--quiet", *overrides], root)
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def stored_json(name, value):
    return {results(name): json.dumps(value, indent=1, sort_keys=True) + "\n"}


@maker(results("capture_mesh.json"), **CAPTURE)
def capture_mesh(snare, root, folder):
    """The shipped capture with 30, 40 and 60 elements a wire: times and peak tensions."""
    made = {}
    for elements in (30, 40, 60):
        outcome = simulated(snare, root, folder / str(elements), "ssrms_htv_capture", f"snares[snare].wire.elements={elements}")["outcome"]
        made[str(elements)] = {name: outcome[name] for name in ("first_touch_s", "tight_s", "peak_tension_N")}
    return stored_json("capture_mesh.json", made)


# A scenario that rigidizes, and its changes, by the title of its column.
RIGIDIZED = {"ball joint, 2e4 N/m": ("ssrms_rigidize",),
             "quasi-static wires, 40 elements": ("ssrms_rigidize_wires",),
             "60 elements": ("ssrms_rigidize_wires", "snares[snare].wire.elements=60"),
             "full wires, 40 elements": ("ssrms_rigidize_wires", 'snares[snare].wire.model="full"')}


@maker(results("rigidized.json"), **CAPTURE, long=True)
def rigidized(snare, root, folder):
    """Rigidizing by a ball joint and by computed wires: contact of the plate, pull, torque of the shoulder."""
    made = []
    for k, (title, scenario) in enumerate(RIGIDIZED.items()):
        summary = simulated(snare, root, folder / str(k), *scenario)
        outcome = summary["outcome"]
        touch = next(e for e in summary["events"] if e["what"] == "touch" and e["contact"] == "plate on face")
        made.append({"title": title, "touch_s": touch["time_s"], "contact_N": outcome["peak_force_N"]["plate on face"],
                     "pull_N": outcome["peak_torque_Nm"]["snare::carriage"], "shoulder_Nm": outcome["peak_torque_Nm"]["rms::shoulder_pitch"],
                     "in_contact_at_end": summary["sensors"]["contact_force_N"]["last"] > 0.0})
    return stored_json("rigidized.json", made)


SWINGS_FROM_S = 3.0  # the arm is limp


def swing(telemetry, column):
    """Half the range of a column while the arm is limp."""
    rows = csv.DictReader(telemetry.read_text(encoding="utf-8").splitlines())
    values = [float(row[column]) for row in rows if float(row["time_s"]) >= SWINGS_FROM_S]
    return 0.5 * (max(values) - min(values))


# A stick or a slip at another step changes a swing by some per cent.
@maker(results("attachment_swings.json"), relative=5e-2)
def attachment_swings(snare, root, folder):
    """Swings of the captured visitor's rates with a soft and with a stiff attachment of the arm."""
    made = []
    for k, stiffness in enumerate((1.25e6, 1e11)):
        simulated(snare, root, folder / str(k), "ssrms_htv_attachment", "duration_s=30", 'snares[ee::snare].wire.model="stretched"',
                  f"bushings[attachment].rotational_stiffness_Nm_rad={stiffness}")
        made.append({"stiffness_Nm_rad": stiffness, **{f"{axis}_deg_s": swing(folder / str(k) / "telemetry.csv", f"rates_{axis}_deg_s")
                                                       for axis in "xy"}})
    return stored_json("attachment_swings.json", {"from_s": SWINGS_FROM_S, "runs": made})


# ---- the bench and records in time ----


@maker(results("snare_rope.json"), relative=2e-3, absolute=1e-6)
def snare_rope(snare, root, folder):
    """The trace of the rope on the bench: its numbers."""
    run([snare, "trace", "data/experiments/snare_rope.toml", "--out", folder, "--quiet"], root)
    result = json.loads((folder / "trace.json").read_text(encoding="utf-8"))
    parameters = {key: {name: value[name] for name in ("value", "stderr", "lower95", "upper95", "unit")}
                  for key, value in result["final"]["parameters"].items()}
    return stored_json("snare_rope.json", {"verdict_kind": result["verdict_kind"], "parameters": parameters})


# The fits of a record file and their settings.
FITS = {"gauss_newton": (), "nelder_mead": ('fit.method="nelder_mead"',), "honda": ('fit.method="nelder_mead"', "fit.simplex_change=0.01")}


def fitted(snare, root, folder, name, changes):
    """Numbers of the fit of a shipped record file, errors of the records held out, simulations."""
    overrides = [word for change in changes for word in ("--set", change)]
    run([snare, "fit", f"data/records/{name}.toml", "--out", folder, "--quiet", *overrides], root)
    result = json.loads((folder / "fit.json").read_text(encoding="utf-8"))

    def numbers(model):
        return {"chi2_dof": model["chi2_dof"], "parameters": {key: {n: value[n] for n in ("value", "lower", "upper", "unit")}
                                                              for key, value in model["parameters"].items()}}

    return {**numbers(result["fit"]), "families": {family["name"]: numbers(family) for family in result["families"]},
            "heldout_sigmas": [c["rmse"] / c["sigma"] for c in result["heldout"]["fit"]], "simulations": result["simulations"]["base_fit"]}


# Fits end within some hundredths of a standard error, by a number of steps that last digits change.
@maker(results("flights.json"), relative=2e-3, named=((r"simulations$", (0.3, 5.0)), (r"(lower|upper)$", (1e-2, 0.0))), long=True)
def flights(snare, root, folder):
    """Fits of the recorded flights by Gauss-Newton and by a simplex; takes minutes."""
    made = {name: {fit: fitted(snare, root, folder / name / fit, name, FITS[fit]) for fit in fits}
            for name, fits in (("flight", ("gauss_newton", "nelder_mead")), ("flight_rods", FITS))}
    return stored_json("flights.json", made)


def error_of(channels, model, prefix="rmse"):
    """Error of the only channel in its unit, or of several over their standard deviations."""
    return channels[0]["rmse"] if len(channels) == 1 else next(model[key] for key in model if key.startswith(prefix))


def traced_record(snare, root, folder, name):
    """What the trace of a shipped record file names, and its errors before and after."""
    run([snare, "trace", f"data/records/{name}.toml", "--out", folder / name, "--quiet"], root)
    result = json.loads((folder / name / "trace.json").read_text(encoding="utf-8"))
    base, final, partial, heldout = (result[key] for key in ("base", "final", "partial", "heldout"))
    several = len(base["channels"]) > 1
    errors = {"before": error_of(base["channels"], base), "after": error_of(final["channels"], final)}
    others = {"before": error_of(heldout["base"], heldout, "rmse_base"), "after": error_of(heldout["final"], heldout, "rmse_final")}
    if partial["effects"]:
        errors["helped"] = error_of(partial["model"]["channels"], partial["model"])
        others["helped"] = error_of(partial["heldout"], partial)
    kept = {"verdict_kind": result["verdict_kind"], "selected_places": result["selected_places"], "helped": partial["effects"],
            "errors": errors, "heldout": others, "noise": result["noise"], "share_left": result["remaining"]["share_of_excess"],
            "unit": "standard deviations" if several else base["channels"][0]["unit"],
            "heldout_unit": "standard deviations" if several else heldout["base"][0]["unit"]}
    if not several:
        kept["relative"] = {"before": base["channels"][0]["relative"], "after": final["channels"][0]["relative"]}
    kept["added"] = {key: {n: value[n] for n in ("value", "lower", "upper", "unit")}
                     for key, value in final["parameters"].items() if key not in base["parameters"]}
    return kept


@maker(results("traced_air_table.json"), relative=2e-3)
def traced_air_table(snare, root, folder):
    """The trace of the recorded impacts on an air table."""
    return stored_json("traced_air_table.json", traced_record(snare, root, folder, "air_table"))


@maker(results("traced_records.json"), relative=1e-2, long=True)
def traced_records(snare, root, folder):
    """Traces of the recorded drive, flights and pendulum; takes minutes."""
    if not (root.parent / "shared/data/emps/emps.csv").is_file():
        raise Skipped("the readings of drive and pendulum are not in ../shared/data")
    made = {name: traced_record(snare, root, folder, name) for name in ("emps", "flight_attachment", "pendulum")}
    return stored_json("traced_records.json", made)


# ---- the air table by the bench of the published fits ----

BEFORE_THE_WIRE = "bodies[target].position_mm=[40.0, -97.0, 0.0]"  # the wire stands out further where its mounts give


@maker(results("air_table_bench.json"), relative=2e-3)
def air_table_bench(snare, root, folder):
    """The impact on the air table by the declared bench, by the leading one of the published fits, and by the published law."""
    traced = tomllib.loads((root / TRACED).read_text(encoding="utf-8"))["mount"]
    mount = ", ".join(f"{key} = {value:.6g}" for key, value in traced.items() if "stiffness" in key)
    changes = {"declared": (), "leading": (f"wires[wire].mount={{{mount}}}",), "published_law": ('wires[wire].model="quadratic"',)}
    made = {"leading_mount": mount}
    for name, change in changes.items():
        words = [word for one in (BEFORE_THE_WIRE, *change) for word in ("--set", one)]
        run([snare, "simulate", "data/scenarios/air_table.toml", "--out", folder / name, "--quiet", *words], root)
        contact = json.loads((folder / name / "summary.json").read_text(encoding="utf-8"))["contacts"][0]
        made[name] = {"peak_N": contact["peak_force_N"], "impulse_Ns": math.hypot(*contact["impulse_Ns"]),
                      "duration_s": contact["last_lift_off_s"] - contact["first_touch_s"]}
    return stored_json("air_table_bench.json", made)


# ---- the impact of docs/results/speed.md ----

COUNTERS = ("peak_force_error", "impulse_error", "quasi_static_peak_N", "undamped_quasi_static_peak_N", "steps", "jacobians", "energy_error", "momentum_error")


# Errors are of 1e-5 to 5e-2; other last digits change steps by a twentieth, the impulse by 1e-4 and the peak by 3e-4.
@maker(results("motion.json"), relative=1e-3, absolute=1e-9,
       named=((r"impulse_error$", (0.0, 1e-4)), (r"peak_force_error$", (0.0, 3e-4)), (r"(steps|jacobians)$", (0.05, 5.0)),
              (r"(energy|momentum)_error$", (0.0, 1e-3))), long=True)
def impact(snare, root, folder):
    """Errors of peak and impulse and the steps of the head-on impact, by motion_benchmark; its times stay as they were stored."""
    program = snare.parent / "benchmarks/motion_benchmark"
    if not program.is_file():
        raise Skipped(f"{program.name} was not built")
    out = folder / "motion.json"
    run([program, "--benchmark_filter=^case_h/", f"--benchmark_out={out}", "--benchmark_out_format=json"], root)
    measured = {row["name"]: row for row in json.loads(out.read_text(encoding="utf-8"))["benchmarks"]}
    stored = json.loads((root / results("motion.json")).read_text(encoding="utf-8"))
    for row in stored["benchmarks"]:
        new = measured.get(row["name"].removesuffix("_median"))
        if new and row.get("aggregate_name") == "median":
            row.update({name: new[name] for name in COUNTERS if name in row})
    return {results("motion.json"): json.dumps(stored, indent=1) + "\n"}


# ---- pictures ----


def module_of(snare):
    """The folder of the Python module that was built with the command."""
    python = snare.parent / "python"
    if not list(python.glob("snare/_core*.so")):
        raise Skipped("the Python module was not built")
    return python


# The picture of an example and its arguments.
EXAMPLES = {"python_trace": ["trace_csv.py", "data/starter/experiment.toml"],
            "use_law": ["use_law.py", "data/wires/traced_published.toml"],
            "three_point_bending": ["three_point_bending.py"],
            "sphere_meets_wires": ["sphere_meets_wires.py", "data/scenarios/ball_into_net.toml"],
            "capture_forces": ["capture.py", "data/scenarios/ssrms_htv_capture.toml"],
            "sweep_indices": ["sweep.py"]}


def picture_of(snare, root, folder, name, program, *arguments):
    target = folder / f"{name}.png"
    run(["/usr/bin/python3", root / "examples" / program, *arguments, target], root, module_of(snare))
    return {gallery(f"{name}.png"): target.read_bytes()}


@maker(*(gallery(f"{name}.png") for name in EXAMPLES), long=True)
def examples(snare, root, folder):
    """Pictures that the examples in Python draw."""
    made = {}
    for name, arguments in EXAMPLES.items():
        made.update(picture_of(snare, root, folder, name, *arguments))
    return made


READING = {"left_open_N": r"leaves open of it: ([\d.]+) N", "place_mm": r"next reading: at ([\d.]+) mm", "travel_mm": r"and ([\d.]+) mm of travel",
           "left_after_N": r"of travel, leaves ([\d.]+) N"}


@maker(gallery("bench_to_odds.png"), results("next_reading.json"), relative=2e-2, long=True)
def bench_to_odds(snare, root, folder):
    """The value of one more bench reading for the odds of 2000 captures: picture and numbers; takes minutes."""
    picture = folder / "odds.png"
    printed = run(["/usr/bin/python3", root / "examples/bench_to_odds.py", "data", picture], root, module_of(snare))
    numbers = {name: float(re.search(pattern, printed)[1]) for name, pattern in READING.items()}
    return {gallery("bench_to_odds.png"): picture.read_bytes(), **stored_json("next_reading.json", numbers)}


def screenshot(page, target, width, height, options=("--disable-gpu",)):
    chromium = shutil.which("chromium")
    if chromium is None:
        raise Skipped("chromium is not installed")
    run([chromium, "--headless", "--no-sandbox", "--hide-scrollbars", *options, "--force-device-scale-factor=1",
         f"--user-data-dir={page.parent / 'profile'}", "--virtual-time-budget=5000", f"--screenshot={target}", f"--window-size={width},{height}",
         page.as_uri()], page.parent)


@maker(gallery("fit.png"), pixels=0.02, long=True)
def fit_page(snare, root, folder):
    """The page of a fit, in a browser."""
    run([snare, "fit", root / "examples/push.toml", "--out", folder, "--quiet"], root)
    screenshot(folder / "report.html", folder / "fit.png", 1280, 1600)
    return {gallery("fit.png"): (folder / "fit.png").read_bytes()}


# Shows the scene of a page alone: the wires at the time of its last mark.
SCENE_ALONE = """<style>body > * { display: none } figure.scene { display: block; position: fixed; inset: 0; margin: 0; z-index: 9; background: #fff }
figure.scene > *:not(.stage) { display: none } figure.scene .stage { width: 100vw }</style>
<script>addEventListener('load', () => setTimeout(() => {
  const scene = document.querySelector('figure.scene'); document.body.append(scene); dispatchEvent(new Event('resize'));
  scene.querySelectorAll('.marks button')[scene.querySelectorAll('.marks button').length - 1].click(); scene.querySelector('.near').click();
}, 200));</script>"""


@maker(gallery("capture.png"), pixels=0.03, long=True)
def capture_page(snare, root, folder):
    """The three wires tight around the shaft, from the page of the shipped capture, in a browser with WebGL."""
    run([snare, "simulate", root / "data/scenarios/ssrms_htv_capture.toml", "--set", 'snares[snare].wire.model="stretched"', "--out", folder, "--quiet"],
        root)
    page = folder / "report.html"
    text = page.read_text(encoding="utf-8")
    page.write_text(text.replace("</head>", SCENE_ALONE + "</head>", 1), encoding="utf-8")
    screenshot(page, folder / "capture.png", 640, 397, ("--use-angle=swiftshader", "--enable-unsafe-swiftshader"))
    return {gallery("capture.png"): (folder / "capture.png").read_bytes()}
