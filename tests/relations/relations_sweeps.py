"""What must hold of sweeps: a case is what its verb makes of it alone, whatever stands beside it."""

import itertools

from cases import Broken, Case, Undecided, different


def table(run, case):
    """Collected values by those of the varied keys."""
    keys = [v["key"] for v in case.main["vary"]]
    fields = list(case.main["collect"])
    if any(word != "done" for word in run["status"]):
        raise Undecided("a case has no result")
    return {tuple(float(run[k][i]) for k in keys): [float(run[f][i]) for f in fields] for i in range(len(run.rows))}


def same_table(one, two):
    different("cases", [len(one)], [len(two)], 0)
    for key, values in one.items():
        different("collected", values, two[key], 0.0, f" of {key}")


def order_of_keys(case, run):
    other = case.changed()
    other.main["vary"].reverse()
    back = {key[::-1]: v for key, v in table(run(other), other).items()}
    same_table(table(run(case), case), back)


def order_of_values(case, run):
    other = case.changed()
    for v in other.main["vary"]:
        v["values"].reverse()
    same_table(table(run(case), case), table(run(other), other))


def as_a_file(case, run):
    """The same cases from a table."""
    other = case.changed()
    one = table(run(case), case)
    other.main["design"] = "file"
    other.main["table"] = "cases.csv"
    names = [f"k{k}" for k in range(len(case.main["vary"]))]
    other.main["vary"] = [{"key": v["key"], "column": n} for v, n in zip(case.main["vary"], names)]
    other.files["cases__csv"] = ",".join(names) + "\n" + "".join(",".join(map(repr, key)) + "\n" for key in one)
    same_table(one, table(run(other), other))


def set_for_all(case, run):
    """What [set] says is what a key of one value varies."""
    other = case.changed()
    first = other.main["vary"].pop(0)
    other.main["set"] = {first["key"]: first["values"][0]}
    one = {key[1:]: v for key, v in table(run(case), case).items() if key[0] == first["values"][0]}
    same_table(one, table(run(other), other))


def a_case_alone(case, run):
    """The last case as a file of its own."""
    one = table(run(case), case)
    inner = case.files["inner__toml"]
    alone = Case(case.main["verb"], inner).changed()
    for v in case.main["vary"]:
        put(alone.main, v["key"], v["values"][-1])
    found = run(alone)
    values = one[tuple(v["values"][-1] for v in case.main["vary"])]
    if case.main["verb"] == "push":
        different("collected", values, [max(found["force_N"])], 0.0)
    else:
        b = next(b for b in found.answer["bodies"] if b["body"] == "b0")
        different("collected", values, [b["position_after_mm"][0], found.answer["energy_J"]["kinetic"]], 0.0)


def rows_of_a_grid(case, run):
    """The last key changes fastest."""
    found = run(case)
    for k, row in enumerate(itertools.product(*(v["values"] for v in case.main["vary"]))):
        different("vary", list(row), [float(found[v["key"]][k]) for v in case.main["vary"]], 0.0, f" in row {k}")


def taken_of_all(case, run):
    """Least, mean and largest of several values ascend; the sum is count times mean."""
    other = case.changed()
    field = "bodies[*].position_after_mm[1]"
    if case.main["verb"] == "push":
        field = "series[*].largest_force_N"
        first = other.files["inner__toml"]["series"][0]
        other.files["inner__toml"]["series"].append({**first, "name": "beside", "contact_position_mm": 0.9 * first["contact_position_mm"]})
    other.main["collect"] = {word: f"{word} {field}" for word in ("min", "max", "sum", "mean", "count")}
    found = run(other)
    for k, status in enumerate(found["status"]):
        if status != "done":
            continue
        least, largest, total, mean, count = (float(found[word][k]) for word in ("min", "max", "sum", "mean", "count"))
        different("sum", [total], [count * mean], 1e-9 * abs(total))
        room = 1e-9 * max(abs(least), abs(largest))
        if not least - room <= mean <= largest + room:
            raise Broken("mean", f"mean: {mean:.9g} of {least:.9g} to {largest:.9g}, in row {k}")


def put(main, key, value):
    words = key.replace("]", "").replace("[", ".").split(".")
    at = main
    for word, after in zip(words, words[1:] + [None]):
        if isinstance(at, list) and at and isinstance(at[0], dict):
            word = next(k for k, t in enumerate(at) if t["name"] == word)
        elif isinstance(at, list):
            word = int(word) - 1
        if after is None:
            at[word] = value
        else:
            at = at[word]


RELATIONS = [order_of_keys, order_of_values, as_a_file, set_for_all, a_case_alone, rows_of_a_grid, taken_of_all]
