#!/usr/bin/env python3
"""Checks that the documentation and the code speak of the same things.

usage: theory_tags.py REPOSITORY

- Every tag that a comment cites, such as `theory.md (W.12)`, is defined in the theory (docs/theory.md and
  docs/theory/), where a paragraph begins with it in bold; each exactly once.
- Every tag that is defined is cited by code. A line of the theory that begins with "Background" names
  exceptions. A range of at most eleven tags, `(W.1)-(W.9)`, cites all of them; a longer one only its ends.
- Formulas of the theory hold nothing that a hosting site would read as markdown: see `formula_problems`.
- Lines of the theory have at most 110 columns.
- Files and folders in backticks in the theory, CONTRIBUTING.md, README.md and docs/decisions/ exist.
- Links to files and headings in all *.md files lead somewhere, and every page of docs/ can be reached from
  README.md.
- A block after `<!-- test: same as FILE -->` is that file, one after `<!-- test: part of FILE -->` stands in it.

Prints one line per problem, `file:line: ...`, and exits 1 if there is any.
"""

import pathlib
import re
import sys

CODE_FOLDERS = ("base", "study", "numerics", "wire", "multibody", "coupling", "scenario", "reduction",
                "identification", "validation", "app", "benchmarks", "examples", "tests", "python")
CODE_SUFFIXES = {".hpp", ".cpp"}
NOT_OURS = {"build", "out", ".git"}
MOST_COLUMNS = 110
LONGEST_RANGE = 11
LETTERS = "NWCIRAMLGS"  # of tags

TAG = re.compile(rf"\(([{LETTERS}])\.(\d+)\)")
RANGE = re.compile(rf"\(([{LETTERS}])\.(\d+)\)-\(\1\.(\d+)\)")
DEFINITION = re.compile(rf"^\*\*\(([{LETTERS}]\.\d+)\)\*\*")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
COPY = re.compile(r"^<!-- test: (same as|part of) (\S+) -->\n```\w*\n(.*?)^```$", re.M | re.S)
NAMED = re.compile(r"`([\w.-]+(?:/[\w.-]*)+|[\w-]+\.(?:hpp|cpp|py|md|sh|cmake|txt|toml|csv))`")


def theory_pages(root: pathlib.Path) -> list[pathlib.Path]:
    return [root / "docs/theory.md"] + sorted((root / "docs/theory").glob("*.md"))


def markdown_pages(root: pathlib.Path) -> list[pathlib.Path]:
    pages = list(root.glob("*.md"))
    for folder in root.iterdir():
        if folder.is_dir() and folder.name not in NOT_OURS:
            pages += folder.rglob("*.md")
    return sorted(pages)


def lines_of(path: pathlib.Path, root: pathlib.Path):
    """Yields (file:line, line)."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        yield f"{path.relative_to(root).as_posix()}:{number}", line


def cited_in(line: str) -> set[str]:
    """Tags that a line cites, with those inside short ranges."""
    tags = {f"{letter}.{number}" for letter, number in TAG.findall(line)}
    for letter, first, last in RANGE.findall(line):
        if int(last) - int(first) < LONGEST_RANGE:
            tags |= {f"{letter}.{number}" for number in range(int(first), int(last) + 1)}
    return tags


def tag_problems(root: pathlib.Path) -> list[str]:
    found, defined, background = [], {}, set()
    for path in theory_pages(root):
        for where, line in lines_of(path, root):
            match = DEFINITION.match(line)
            if match:
                if match.group(1) in defined:
                    found.append(f"{where}: ({match.group(1)}) is defined a second time")
                defined.setdefault(match.group(1), where)
            if line.startswith("Background"):
                background |= cited_in(line)
    cited = {}
    for folder in CODE_FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in CODE_SUFFIXES:
                for where, line in lines_of(path, root):
                    for tag in cited_in(line):
                        cited.setdefault(tag, where)
                    # A range may leave numbers out; what is named itself must exist.
                    for letter, number in TAG.findall(line):
                        if f"{letter}.{number}" not in defined:
                            found.append(f"{where}: ({letter}.{number}) is not defined in the theory")
    for path in theory_pages(root):
        for where, line in lines_of(path, root):
            for letter, number in TAG.findall(line):
                if f"{letter}.{number}" not in defined:
                    found.append(f"{where}: ({letter}.{number}) is not defined in the theory")
    for tag in sorted(set(defined) - set(cited) - background):
        found.append(f"{defined[tag]}: ({tag}) is cited by no code; cite it, or name it as background")
    for tag in sorted(background & set(cited)):
        found.append(f"{cited[tag]}: cites ({tag}), which the theory names as background")
    return found


def formula_problems(formula: str) -> list[str]:
    """What in a formula a hosting site would read as markdown, or not show at all."""
    found = []
    if re.search(r"\\[^A-Za-z]", formula):
        found.append("a backslash before a sign loses it: write a word, such as \\quad, \\lbrace, \\cr")
    if re.search(r"[<>*~`]", formula):
        found.append("<, >, *, ~ or ` is markdown: write \\lt, \\gt, \\ast")
    if re.search(r"(?:^|[^A-Za-z0-9])_", formula):
        found.append("an underscore must stand behind a letter or a digit, or it begins emphasis")
    if re.search(r"\]\(", formula):
        found.append("]( is a link")
    if re.search(r"^\s*(?:[-+#] |=+$|\d+[.)] )", formula, re.MULTILINE):
        found.append("a line begins like a list or a heading: put the sign at the end of the line before")
    return found


def text_problems(root: pathlib.Path) -> list[str]:
    found = []
    for path in theory_pages(root):
        display = None  # lines of the formula that stands alone
        for where, line in lines_of(path, root):
            if len(line) > MOST_COLUMNS:
                found.append(f"{where}: {len(line)} columns, at most {MOST_COLUMNS}")
            if line == "$$":
                if display is not None:
                    found += [f"{where}: {text}" for text in formula_problems("\n".join(display))]
                display = [] if display is None else None
            elif display is not None:
                display.append(line)
            else:
                parts = re.sub(r"`[^`]*`", "", line).split("$")
                if len(parts) % 2 == 0:
                    found.append(f"{where}: a formula within a line must end on it")
                found += [f"{where}: {text}" for formula in parts[1::2] for text in formula_problems(formula)]
        if display is not None:
            found.append(f"{where}: a formula is not closed")
    return found


def name_problems(root: pathlib.Path) -> list[str]:
    """Files and folders in backticks that are not there. Generated ones begin with `out/` or `build/`."""
    found = []
    names = None
    pages = theory_pages(root) + [root / "CONTRIBUTING.md", root / "README.md"]
    for path in pages + sorted((root / "docs/decisions").glob("*.md")):
        for where, line in lines_of(path, root):
            for name in NAMED.findall(line):
                if name.split("/")[0] in NOT_OURS or "/" not in name and path.name == "README.md":
                    continue
                if "/" not in name:  # a file of any folder
                    if names is None:
                        names = {p.name for folder in root.iterdir() if folder.name not in NOT_OURS
                                 for p in [folder, *folder.rglob("*")]}
                    if name in names or name in PRODUCED:
                        continue
                elif (root / name).exists():
                    continue
                found.append(f"{where}: `{name}` does not exist")
    return found


# What programs write.
PRODUCED = {"report.html", "curves.csv", "law.json", "table.csv", "law.hpp", "law.c", "law.py",
            "history.csv"}


def anchor(heading: str) -> str:
    """The anchor that hosting sites give a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors(path: pathlib.Path) -> set[str]:
    lines = path.read_text(encoding="utf-8").splitlines()
    return {anchor(line.lstrip("#")) for line in lines if line.startswith("#")}


def link_problems(root: pathlib.Path) -> list[str]:
    found, links = [], {}
    for path in markdown_pages(root):
        links[path] = set()
        for where, line in lines_of(path, root):
            for target in LINK.findall(re.sub(r"`[^`]*`|\$[^$]*\$", "", line)):
                if re.match(r"[a-z]+:", target):
                    continue
                file, _, heading = target.partition("#")
                other = (path.parent / file).resolve() if file else path
                if not other.exists():
                    found.append(f"{where}: the link to {target} leads nowhere")
                elif heading and heading not in anchors(other):
                    found.append(f"{where}: {file or 'this page'} has no heading #{heading}")
                else:
                    links[path].add(other)
                    if other.is_dir():
                        links[path] |= set(other.glob("*.md"))
    reached, way = set(), [root / "README.md"]
    while way:
        path = way.pop()
        if path not in reached:
            reached.add(path)
            way += links.get(path, set())
    for path in sorted(set((root / "docs").rglob("*.md")) - reached):
        found.append(f"{path.relative_to(root).as_posix()}:1: no link leads here from README.md")
    return found


def copy_problems(root: pathlib.Path) -> list[str]:
    """Blocks that say they are a file, or a part of one, and are not."""
    found = []
    for page in markdown_pages(root):
        for kind, file, block in COPY.findall(page.read_text(encoding="utf-8")):
            text = (root / file).read_text(encoding="utf-8") if (root / file).exists() else ""
            if not (block == text if kind == "same as" else block and block in text):
                found.append(f"{page.relative_to(root).as_posix()}:1: a block is not {kind} {file}")
    return found


def problems(root: pathlib.Path) -> list[str]:
    return (tag_problems(root) + text_problems(root) + name_problems(root) + link_problems(root)
            + copy_problems(root))


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    found = problems(pathlib.Path(sys.argv[1]).resolve())
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
