#!/usr/bin/env python3
"""Every public declaration of the library says what it is, and numbers say their units.

usage: docstrings.py REPOSITORY [--list]

Of the headers that are installed: a class, a struct, an enumeration, a function, or a public member function has a comment right above it (`///` or
`//`), shares that of the declaration before it (no empty line between them), or carries one behind itself (`///<`). A structure's member of type
double has a unit in brackets, or says that it has none, in its own comment, in that above it, or in that of the structure. What is known and
not yet done stands in docstrings_known.txt, `file: name` a line; what is not there and not documented is an error, and so is a line of
the list that is no longer needed. --list prints what the list would be.
"""

import pathlib
import re
import sys

ROOMS = ["base", "numerics", "study", "wire", "multibody", "coupling", "scenario", "reduction", "identification", "validation", "results"]
# Of a number: a unit in brackets, or words for one that has none.
UNIT = re.compile(r"\[[^\]]*\]|\b(share|ratio|factor|relative|coefficient|probability|dimensionless|number|degrees? of freedom|weight|exponent|in its unit|"
                  r"in the unit|SI units?|in SI|unit of|statistic|P of|radian|seconds?|significance|correlation|restitution|share of|quantile|score|"
                  r"standard (error|deviation)s?|over the)\b", re.I)
DECLARATION = re.compile(r"^(?:template ?<.*> ?)?(?:\[\[nodiscard\]\] )?(?:inline |static |constexpr |explicit |friend |extern )*"
                         r"(?:(?P<kind>class|struct|enum class|enum) (?P<type>\w+)[^;]*$|(?:[\w:<>,&*\s]+?[\s&*])(?P<function>~?\w+)\()")
DOUBLE = re.compile(r"^\s+(?:std::optional<double>|std::vector<double>|double) (\w+)\b(?! ?\()[^()]*;")
SKIPPED_WORDS = {"return", "if", "for", "while", "switch", "using", "namespace", "static_assert"}


def problems_of(text):
    """(line number, name, what is missing) of a header."""
    lines = text.splitlines()
    scopes = []  # "namespace", "struct", "class", "other" of every open brace
    public = []  # of the same: whether what follows is
    documented = False  # the run of lines without an empty one has a comment
    comment = ""
    struct_comment = ""
    statement_open = False
    for number, raw in enumerate(lines, start=1):
        line = raw.strip()
        if not line:
            documented, comment, statement_open = False, "", False
            continue
        if line.startswith("//"):
            if not documented or statement_open is False:
                comment += " " + line
            documented = True
            continue
        code = re.sub(r'"(\\.|[^"\\])*"', '""', line.split("//")[0])
        trailing = "//" in line
        if re.match(r"(public|private|protected):", code):
            public[-1] = code.startswith("public")
            documented, comment = False, ""
            continue
        at_namespace = all(s == "namespace" for s in scopes)
        in_class = scopes and scopes[-1] in ("struct", "class") and public[-1] and all(s == "namespace" for s in scopes[:-1])
        if not statement_open and not code.startswith("#"):
            match = DECLARATION.match(code)
            if at_namespace and match and code.split("(")[0].split(" ")[0] not in SKIPPED_WORDS and not code.startswith(("}", ":")):
                name = match.group("type") or match.group("function")
                if name and not documented and not trailing:
                    yield number, name, "has no comment"
                if match.group("type"):
                    struct_comment = comment
            elif in_class and match and match.group("function") and not re.search(r"\b(override|default|delete|operator)\b|^explicit|^~|^:", code):
                if not documented and not trailing:
                    yield number, match.group("function"), "has no comment"
            double = DOUBLE.match(raw)
            if double and scopes and scopes[-1] == "struct":
                said = (line.split("//", 1)[1] if trailing else "") + comment
                if not UNIT.search(said) and not UNIT.search(struct_comment):
                    yield number, double.group(1), "says no unit"
        if trailing:
            documented = True
        # Braces: what is opened is what the statement is.
        for char in code:
            if char == "{":
                head = code
                kind = "namespace" if re.match(r"(inline )?namespace\b", head) or head.startswith('extern ""') else \
                    "struct" if re.match(r"(template ?<.*> ?)?struct\b", head) else \
                    "class" if re.match(r"(template ?<.*> ?)?class\b", head) else "other"
                scopes.append(kind)
                public.append(kind != "class")
            elif char == "}" and scopes:
                scopes.pop()
                public.pop()
        statement_open = not code.endswith((";", "{", "}", ":")) and not code.startswith("#") and bool(code)


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1])
    found = {}
    headers = 0
    for room in ROOMS:
        for path in sorted((root / room).rglob("*.hpp")):
            headers += 1
            for number, name, what in problems_of(path.read_text(encoding="utf-8")):
                found[f"{path.relative_to(root).as_posix()}: {name}"] = (number, what)
    if sys.argv[2:] == ["--list"]:
        print("\n".join(found))
        return 0
    list_file = root / "tests/docs/docstrings_known.txt"
    known = set(list_file.read_text(encoding="utf-8").split("\n")) - {""} if list_file.is_file() else set()
    for name in sorted(set(found) - known):
        file, declaration = name.split(": ")
        print(f"{file}:{found[name][0]}: {declaration} {found[name][1]}")
    for name in sorted(known - set(found)):
        print(f"tests/docs/docstrings_known.txt: {name}: is documented now, take the line out")
    print(f"{headers} headers, {len(found)} declarations without a comment or a unit, {len(known)} of them known")
    return 1 if set(found) != known else 0


if __name__ == "__main__":
    sys.exit(main())
