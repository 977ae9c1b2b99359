"""What must hold between fits of records."""

import math

from cases import Undecided
from relations_fit import leaves_the_noise, same_fit


def order_of_records(case, run):
    if len(case.main["records"]) < 2:
        raise Undecided("one record")
    other = case.changed()
    other.main["records"].reverse()
    same_fit(run(case), run(other))


def names_of_records(case, run):
    other = case.changed()
    for k, r in enumerate(other.main["records"]):
        r["name"] = f"z{9 - k}"
    same_fit(run(case), run(other), share=1e-3)


def order_of_free(case, run):
    other = case.changed()
    other.main["fit"]["free"].reverse()
    same_fit(run(case), run(other))


def duplicated(case, run):
    other = case.changed()
    other.main["records"] += [{**r, "name": r["name"] + "b"} for r in case.main["records"]]
    same_fit(
        run(case), run(other), errors=math.sqrt(0.5), spread=2.0
    )  # the order of the noise is chosen by what the readings show, twice


def start_values(case, run):
    other = case.changed()
    spring = other.files["scenario__toml"]["bushings"][0]
    for name, factor in (("translational_damping_Ns_m", 1.5), ("translational_stiffness_N_m", 1.05)):
        spring[name] *= factor if f"bushings[spring].{name}" in case.main["fit"]["free"] else 1.0
    same_fit(run(case), run(other), share=0.1)


def in_metres(case, run):
    other = case.changed()
    for name, text in case.files.items():
        if name.endswith("csv"):
            head, *rows = text.splitlines()
            other.files[name] = "\n".join([head, *(f"{t},{1e-3 * float(x)!r}" for t, x in (row.split(",") for row in rows))]) + "\n"
    for r in other.main["records"]:
        r["scale"] = {"x": 1000.0}
    same_fit(run(case), run(other))


def split_record(case, run):
    """The even and the odd readings as two records."""
    other = case.changed()
    other.main["records"] = []
    for r in case.main["records"]:
        name = r["file"].replace(".", "__")
        head, *rows = case.files[name].splitlines()
        for k, part in enumerate((rows[::2], rows[1::2])):
            other.files[f"{name[:-5]}_{k}__csv"] = "\n".join([head, *part]) + "\n"
            other.main["records"].append({**r, "name": f"{r['name']}_{k}", "file": f"{r['file'][:-4]}_{k}.csv"})
    same_fit(run(case), run(other), share=1.0, spread=2.0)  # every second reading has another noise in time


def twice_the_output_rate(case, run):
    """How often a sensor reads in the computed motion is nothing of the record."""
    other = case.changed()
    other.files["scenario__toml"]["output_interval_s"] *= 0.25
    same_fit(run(case), run(other), share=0.2)


def another_clock(case, run):
    other = case.changed()
    for name, text in case.files.items():
        if name.endswith("csv"):
            head, *rows = text.splitlines()
            other.files[name] = "\n".join([head, *(f"{float(t) + 8.0!r},{x}" for t, x in (row.split(",") for row in rows))]) + "\n"
    for r in other.main["records"]:
        r["clock_s"] = 8.0
    same_fit(run(case), run(other))


def masses_times_four(case, run):
    """A body four times as heavy on springs four times as stiff."""
    other = case.changed()
    s = other.files["scenario__toml"]
    s["bodies"][0]["mass_kg"] *= 4.0
    s["bodies"][0]["inertia_kg_m2"] = [4.0 * i for i in s["bodies"][0]["inertia_kg_m2"]]
    for k in ("translational_stiffness_N_m", "rotational_stiffness_Nm_rad", "translational_damping_Ns_m"):
        s["bushings"][0][k] *= 4.0
    same_fit(run(case), run(other), factor={k: 4.0 for k in case.main["fit"]["free"]})


def the_other_way(case, run):
    """x turned round."""
    other = case.changed()
    for name, text in case.files.items():
        if name.endswith("csv"):
            head, *rows = text.splitlines()
            other.files[name] = "\n".join([head, *(f"{t},{-float(x)!r}" for t, x in (row.split(",") for row in rows))]) + "\n"
    for v in [
        other.files["scenario__toml"]["bodies"][0]["velocity_m_s"],
        *(r["set"]["bodies[b].velocity_m_s"] for r in other.main["records"] if "set" in r),
    ]:
        v[0] = -v[0]
    same_fit(run(case), run(other))


RELATIONS = [
    order_of_records,
    names_of_records,
    order_of_free,
    duplicated,
    start_values,
    in_metres,
    split_record,
    twice_the_output_rate,
    another_clock,
    masses_times_four,
    the_other_way,
    leaves_the_noise,
]
