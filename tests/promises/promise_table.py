#!/usr/bin/env python3
"""Writes the tables of docs/promises.md from promises.toml beside it.

    promise_table.py [--check]

--check compares and writes nothing; tests/docs/promises.py calls it. The first table has the promises and the tests that hold them, the second
one the checks of entries.py by entry. The text around the tables is kept.
"""

import dataclasses
import pathlib
import re
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
TABLE = HERE / "promises.toml"
PAGE = HERE.parents[1] / "docs/promises.md"
ENTRIES = {"command": "command", "python": "Python", "cpp": "C++", "mpi": "MPI"}
# Verbs by entry. The page is written without a build; entries.py fails if an entry has other verbs.
VERBS = {
    "command": ["reproduce", "push", "fit", "trace", "distil", "compare", "simulate", "ringdown", "sweep", "benchmark", "validate", "arm",
                "new", "export"],
    "python": ["compare", "distil", "fit", "push", "simulate", "sweep", "trace"],
    "cpp": ["push", "fit", "trace", "distil", "simulate"],
    "mpi": ["sweep"],
}


@dataclasses.dataclass
class Check:
    promise: str  # its id
    name: str
    only: dict
    without: dict

    def reason(self, entry: str, verb: str) -> str:
        """Returns why it is not run, or an empty text."""
        given = self.without.get(entry, "")
        if entry in self.only and verb in self.only[entry]:
            return ""
        if isinstance(given, str):
            return given
        return given.get(verb, given.get("others", ""))

    def faults(self):
        """Yields contradictions to the entries and their verbs."""
        for entry in {*self.only, *self.without}:
            if entry not in ENTRIES:
                yield f"{self.name}: there is no entry {entry}"
                continue
            given = self.without.get(entry, "")
            listed = self.only.get(entry, []) + [verb for verb in (given if isinstance(given, dict) else ()) if verb != "others"]
            for verb in listed:
                if verb not in VERBS[entry]:
                    yield f"{self.name}: {entry} has no verb {verb}"
            for verb in VERBS[entry] if entry in self.only else ():
                if verb not in self.only[entry] and not self.reason(entry, verb):
                    yield f"{self.name}: {verb} of {entry} has neither a check nor a reason"


def promises() -> list:
    return tomllib.loads(TABLE.read_text(encoding="utf-8"))["promise"]


def checks() -> list:
    return [Check(one["id"], check["name"], check.get("only", {}), check.get("not", {})) for one in promises() for check in one.get("check", [])]


def cell(check: Check, entry: str) -> str:
    """Returns the verbs for which a check is run through an entry, or the reason why it is not."""
    run = [verb for verb in VERBS[entry] if not check.reason(entry, verb)]
    if not run:
        given = check.without[entry]
        return "no: " + (given if isinstance(given, str) else next(iter(given.values())))
    left = [verb for verb in VERBS[entry] if verb not in run]
    if not left:
        return "yes" if len(VERBS[entry]) == 1 else "every verb"
    names = ", ".join(f"`{verb}`" for verb in run)
    if len(run) <= len(left):
        return names
    return "every verb but " + ", ".join(f"`{verb}`" for verb in left)


def tables(says: dict) -> list:
    """Returns both tables. says: the sentence of a check by its name."""
    first = ["| promise | held by |", "|---|---|", *(f"| {one['promise']} | {one['held_by']} |" for one in promises())]
    second = ["| check | " + " | ".join(ENTRIES.values()) + " |", "|---" * (len(ENTRIES) + 1) + "|"]
    for check in checks():
        second.append(f"| {says[check.name]} | " + " | ".join(cell(check, entry) for entry in ENTRIES) + " |")
    return ["\n".join(first), "\n".join(second)]


def sentences() -> dict:
    """Returns the first line of each check's docstring by the name of the check."""
    text = (HERE / "entry_checks.py").read_text(encoding="utf-8")
    return dict(re.findall(r'^def (\w+)\(t\):\n    """(.*?)"""', text, re.M))


def page(text: str) -> str:
    """Returns the page with new tables."""
    for table in tables(sentences()):
        head = re.escape(table.split("\n")[0].split(" | ")[0])
        text, found = re.subn(rf"^{head} \|.*\n(?:\|.*\n)*", lambda _, table=table: table + "\n", text, count=1, flags=re.M)
        if not found:
            raise SystemExit(f"{PAGE.name} has no table that begins with {table.split(' | ')[0]!r}")
    return text


def faults() -> list:
    """Returns the faults of promises.toml and of the page."""
    said = sentences()
    wrong = [fault for check in checks() for fault in check.faults()]
    wrong += [f"{check.name} is not a check of entry_checks.py" for check in checks() if check.name not in said]
    wrong += [f"{name} is a check without a promise" for name in said if name not in {check.name for check in checks()}]
    ids = [one["id"] for one in promises()]
    wrong += [f"the id {one} is used twice" for one in sorted(set(ids)) if ids.count(one) > 1]
    if not wrong and page(PAGE.read_text(encoding="utf-8")) != PAGE.read_text(encoding="utf-8"):
        wrong.append("is not what tests/promises/promise_table.py writes from promises.toml: run it")
    return wrong


def main() -> int:
    if sys.argv[1:] == ["--check"]:
        for fault in faults():
            print(f"{PAGE.name}: {fault}")
        return 1 if faults() else 0
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
