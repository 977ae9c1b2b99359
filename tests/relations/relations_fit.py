"""What must hold between fits: numbers within a share of their standard errors, and the standard errors themselves."""

import math

from cases import Broken, Undecided, different, toml


def numbers(run, must=True):
    found = run.answer["fit"]["parameters"]
    if must and (not found or any(p["value"] is None for p in found.values())):
        raise Undecided("no number")
    return found


def weighed(run):
    """How the readings of a push were weighed: as replicates, as correlated ones, which some splits of the same readings show and others do not."""
    noise = run.answer.get("noise") or {}
    return noise.get("source"), noise.get("correlation_readings") is None


def same_fit(one, two, factor=None, errors=1.0, share=0.03, spread=0.03):
    """Each number of the second fit is `factor` times that of the first, its standard error `errors` times as large besides, to `spread` of itself."""
    first, second = numbers(one), numbers(two)
    if weighed(one) != weighed(two):
        share, spread = max(share, 1.0), max(spread, 2.0)
    for name, p in first.items():
        f = (factor or {}).get(name, 1.0)
        q = second[name]
        error = p["stderr"]
        if error is None or q["stderr"] is None:
            if (error is None) != (q["stderr"] is None):
                raise Broken("stderr", f"{name}: standard error {error} and {q['stderr']}")
            continue
        different("value", p["value"], q["value"] / f, share * error + 1e-9 * abs(p["value"]))
        different("stderr", error * errors, q["stderr"] / f, spread * error * errors)


def order_of_series(case, run):
    if len(case.main["series"]) < 2:
        raise Undecided("one series")
    other = case.changed()
    other.main["series"].reverse()
    same_fit(run(case), run(other), share=1e-3)


def names_of_series(case, run):
    other = case.changed()
    for k, s in enumerate(other.main["series"]):
        s["name"] = f"z{9 - k}"
    same_fit(run(case), run(other), share=1e-6)


def order_of_free(case, run):
    if len(case.main["fit"]["free"]) < 2:
        raise Undecided("one number")
    other = case.changed()
    other.main["fit"]["free"].reverse()
    same_fit(run(case), run(other))


def start_values(case, run):
    other = case.changed()
    name = case.main["fit"]["free"][0].split(".")[1]
    if "wire.length_mm" in case.main["fit"]["free"]:
        raise Undecided("another start has another length of rest")
    other.main["wire"][name] *= 1.7
    one, two = run(case), run(other)
    same_fit(one, two)


def duplicated(case, run):
    """Every series twice: the same numbers, their errors less by the root of two."""
    other = case.changed()
    other.main["series"] += [{**s, "name": s["name"] + "b"} for s in case.main["series"]]
    one, two = run(case), run(other)
    same_fit(one, two, errors=math.sqrt(0.5))


def split_series(case, run):
    """The even and the odd readings of every series, as two series."""
    other = case.changed()
    other.main["series"] = []
    for s in case.main["series"]:
        name = s["file"].replace(".", "__")
        head, *rows = case.files[name].splitlines()
        for k, part in enumerate((rows[::2], rows[1::2])):
            if len(part) < 5:
                raise Undecided("few readings")
            other.files[f"{name[:-5]}_{k}__csv"] = "\n".join([head, *part]) + "\n"
            other.main["series"].append({**s, "name": f"{s['name']}_{k}", "file": f"{s['file'][:-4]}_{k}.csv"})
    same_fit(run(case), run(other))


def backwards(case, run):
    """What is elastic does not know in which order it was read."""
    other = case.changed()
    for name, text in case.files.items():
        head, *rows = text.splitlines()
        other.files[name] = "\n".join([head, *rows[::-1]]) + "\n"
    same_fit(run(case), run(other))


def scaled_column(case, run):
    """The force in kN, under another name, with commas for points."""
    other = case.changed()
    for name, text in case.files.items():
        head, *rows = text.splitlines()
        pairs = [row.split(",") for row in rows]
        other.files[name] = "Extension;Load\n" + "".join(f"{d};{float(f) / 1000.0!r}\n".replace(".", ",") for d, f in pairs)
    for s in other.main["series"]:
        s["columns"] = {"Extension": "displacement_mm", "Load": "force_N"}
        s["scale"] = {"Load": 1000.0}
    same_fit(run(case), run(other), share=1e-3)


def forces_times_ten(case, run):
    other = case.changed()
    for name, text in case.files.items():
        head, *rows = text.splitlines()
        other.files[name] = "\n".join([head, *(f"{d},{10.0 * float(f)!r}" for d, f in (row.split(",") for row in rows))]) + "\n"
    for k in ("axial_stiffness_N", "bending_stiffness_Nm2"):
        if k in other.main["wire"]:
            other.main["wire"][k] *= 10.0
    for s in other.main["series"]:
        s["force_sigma_N"] *= 10.0
    same_fit(
        run(case),
        run(other),
        factor={"wire.axial_stiffness_N": 10.0, "wire.bending_stiffness_Nm2": 10.0, "reading.force_offset_N": 10.0},
    )


def the_other_end_first(case, run):
    other = case.changed()
    for s in other.main["series"]:
        s["contact_position_mm"] = case.main["mount"]["span_mm"] - s["contact_position_mm"]
    same_fit(run(case), run(other))


def leaves_the_noise(case, run):
    """The readings are those of a closed form with the declared noise."""
    one = run(case)
    numbers(one)
    chi2 = one.answer["fit"]["chi2_dof"]
    if not 0.2 < chi2 < 3.0:
        raise Broken("chi2_dof", f"chi2_dof: {chi2:.4g}")


def residual_is_difference(case, run):
    """curves.csv has what fit.json tells."""
    one = run(case)
    shift = numbers(one).get("reading.force_offset_N", {"value": 0.0})["value"]
    rest = one["measured_N"] - one["force_N"] - shift
    different("residual_N", one["residual_N"], rest, 1e-6 * max(abs(one["measured_N"])))


RELATIONS = [
    order_of_series,
    names_of_series,
    order_of_free,
    start_values,
    duplicated,
    split_series,
    backwards,
    scaled_column,
    forces_times_ten,
    the_other_end_first,
    leaves_the_noise,
    residual_is_difference,
]
