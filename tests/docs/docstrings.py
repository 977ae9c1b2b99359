#!/usr/bin/env python3
"""Every public declaration of the library says what it is, and numbers say their units.

usage: docstrings.py REPOSITORY

Of the headers that are installed: a class, a struct, an enumeration, a function, or a public member function has a comment right above it (`///` or
`//`), shares that of the declaration before it (no empty line between them), or carries one behind itself (`///<`). A structure's member of type
double has a unit in brackets, or says that it has none, in its own comment, in that above it, or in that of the structure.

A function, public member function or constructor that takes or returns a double, a vector of them, or a vector or matrix of Eigen says units too: its
comment (or the one that it shares, as above) has a unit in brackets, [N m] or [-] for none, or one of the words of NUMBER_WORDS, which say that
there is none or whose it is; or an argument's name ends in a unit (`time_s`); or the comment of its class, or the one at the top of its file, says
so for all of it, by one of the words of ALL_WORDS. An index or a range in brackets is no unit. What overrides, is defaulted or deleted, or is
defined again below its declaration needs nothing. That every argument has its own unit said, the test cannot see.
"""

import pathlib
import re
import sys

ROOMS = ["base", "numerics", "study", "wire", "multibody", "coupling", "scenario", "reduction", "identification", "validation", "results", "papers"]
# Of a structure's number: a unit in brackets, or words for one that has none.
UNIT = re.compile(r"\[[^\]]*\]|\b(share|ratio|factor|relative|coefficient|probability|dimensionless|number|degrees? of freedom|weight|exponent|in its unit|"
                  r"in the unit|SI units?|in SI|unit of|statistic|P of|radian|seconds?|significance|correlation|restitution|share of|quantile|score|"
                  r"standard (error|deviation)s?|over the)\b", re.I)
# Of a function's: a bracket that begins with a unit (not `x[i]`, not a range) ...
UNIT_BRACKET = re.compile(r"(?<![\w\])])\[(?:(?:[mu]?m|km|[kmun]?N|kg|g|[mun]?s|h|rad|deg|k?Hz|k?J|k?W|[kMG]?Pa|K|V|A|bytes?)(?!\w)|1/|[-1%][\],])[^\]]*\]?")
# ... or words that say that there is none, or whose it is.
NUMBER_WORDS = re.compile(r"\b(dimensionless|shares?|ratio|factor|fraction|relative|probabilit(y|ies)|coefficients? of (friction|restitution|variation)|"
                          r"unit (vectors?|quaternion|tangents?|normals?|direction|length|cube|interval)|rotation matri(x|ces)|radians?|seconds?|"
                          r"standard (errors?|deviations?)|quantile|significance|correlations?|in (its|their|the|a) ([\w']+ )?units?|"
                          r"units? (of|as)|of any unit|(same|whatever|any|own|no|in|their) units?|P of|statistics?|degrees? of freedom)\b", re.I)
# Words that say it for all of a class or file.
ALL_WORDS = re.compile(r"\b(SI units?|in SI|dimensionless|of any unit|in their units|whatever units?)\b", re.I)
UNIT_SUFFIX = re.compile(r"\b\w+_(?:m|mm|N|Nm|s|ms|rad|deg|Hz|kg|J|Pa|GPa|seconds)\s*(?:[,)=]|\[)|\bseconds\s*[,)=]")
FLOATING = re.compile(r"\bdouble\b|\bEigen::(?!Index\b|Dynamic\b)\w+|\b(?:VectorView|Vector3|Vector6|Matrix6X?|CellVector|CellMatrix|Dual|ContactLaw)\b")
DECLARATION = re.compile(r"^(?:template ?<.*> ?)?(?:\[\[nodiscard\]\] )?(?:inline |static |constexpr |explicit |friend |extern )*"
                         r"(?:(?P<kind>class|struct|enum class|enum) (?P<type>\w+)[^;]*$|(?:[\w:<>,&*\s]+?[\s&*])(?P<function>~?\w+)\()")
CONSTRUCTOR = re.compile(r"^(?:explicit |constexpr )*(?P<function>\w+)\(")
DOUBLE = re.compile(r"^\s+(?:std::optional<double>|std::vector<double>|double) (\w+)\b(?! ?\()[^()]*;")
SKIPPED_WORDS = {"return", "if", "for", "while", "switch", "using", "namespace", "static_assert"}


def without_strings(line):
    return re.sub(r'"(\\.|[^"\\])*"', '""', line.split("//")[0])


def declaration_at(lines, index):
    """The text of the function that is declared from lines[index] on, up to the end of its arguments, and what is said behind it."""
    text, said, depth, begun = "", "", 0, False
    for raw in lines[index:index + 20]:
        if "//" in raw:
            said += " " + raw.split("//", 1)[1]
        for char in without_strings(raw).strip() + " ":
            if begun and depth == 0:
                break
            text += char
            depth += {"(": 1, ")": -1}.get(char, 0)
            begun = begun or char == "("
        if begun and depth == 0:
            break
    return " ".join(text.split()), said


def heading_of(lines):
    """The comment at the top of a file, before its first declaration."""
    said = ""
    for raw in lines:
        line = raw.strip()
        if line.startswith("//"):
            said += " " + line
        elif line and not line.startswith("#"):
            break
    return said


def declaration_text(lines, start):
    """What stands from a line to the end of its declaration, or to the body."""
    return re.split(r"[;{]", " ".join(line.split("//")[0] for line in lines[start:start + 4]))[0].strip()


def says_units(signature, comment, of_all):
    comment = re.sub(r"\s*///\s*|\s+", " ", comment)
    return bool(UNIT_BRACKET.search(comment) or NUMBER_WORDS.search(comment) or ALL_WORDS.search(comment) or UNIT_SUFFIX.search(signature) or
                any(ALL_WORDS.search(text) for text in of_all))


def problems_of(text):
    """(line number, name, what is missing) of a header."""
    lines = text.splitlines()
    heading = heading_of(lines)
    scopes = []  # "namespace", "struct", "class", "other" of every open brace
    public = []  # of the same: whether what follows is
    documented = False  # the run of lines without an empty one has a comment
    comment = ""
    own = ""  # the comment of the declaration, or of the one whose comment it shares
    comment_open = False  # the line before was of that comment
    type_name, struct_comment = "", ""
    declared = set()
    statement_open = False
    for number, raw in enumerate(lines, start=1):
        line = raw.strip()
        if not line:
            documented, comment, own, comment_open, statement_open = False, "", "", False, False
            continue
        if line.startswith("//"):
            if not statement_open:
                comment += " " + line
                own = own + " " + line if comment_open else line
                comment_open = True
            documented = True
            continue
        code = without_strings(line)
        trailing = "//" in line
        if re.match(r"template ?<.*>$", code.strip()):  # what it is a template of is on the next line
            comment_open = False
            continue
        if re.match(r"(public|private|protected):", code):
            public[-1] = code.startswith("public")
            documented, comment, own, comment_open = False, "", "", False
            continue
        at_namespace = all(s == "namespace" for s in scopes)
        in_class = scopes and scopes[-1] in ("struct", "class") and public[-1] and all(s == "namespace" for s in scopes[:-1])
        if not statement_open and not code.startswith("#"):
            match = DECLARATION.match(code)
            function = match and match.group("function")
            if at_namespace and match and code.split("(")[0].split(" ")[0] not in SKIPPED_WORDS and not code.startswith(("}", ":")):
                name = match.group("type") or function
                signature, behind = declaration_at(lines, number - 1) if function else ("", "")
                if function:
                    plain = re.sub(r"\[\[nodiscard\]\] |\binline |\bconstexpr | = [^,)]+", "", signature)
                    if plain in declared:  # defined below its declaration
                        name = None
                    declared.add(plain)
                if name and not documented and not trailing:
                    yield number, name, "has no comment"
                elif name and FLOATING.search(signature) and not says_units(signature, own + behind, [heading]):
                    yield number, name, "says no unit"
                if match.group("type"):
                    type_name, struct_comment = match.group("type"), comment
            elif in_class and not re.search(r"\b(override|final|default|delete)\b|^~|^:", declaration_text(lines, number - 1)):
                constructor = CONSTRUCTOR.match(code)
                is_constructor = constructor and constructor.group("function") == type_name
                if function and not is_constructor and not re.search(r"\boperator\b|^explicit", code) and not documented and not trailing:
                    yield number, function, "has no comment"
                elif function or is_constructor:
                    name = type_name if is_constructor else function
                    signature, behind = declaration_at(lines, number - 1)
                    overrides = re.search(r"\b(override|final)\b", " ".join(lines[number - 1:number + 3]).split(";")[0].split("{")[0])
                    if FLOATING.search(signature) and not overrides and not says_units(signature, own + behind + (struct_comment if is_constructor else ""),
                                                                                         [heading, struct_comment]):
                        yield number, name, "says no unit"
            double = DOUBLE.match(raw)
            if double and scopes and scopes[-1] == "struct":
                said = (line.split("//", 1)[1] if trailing else "") + comment
                if not UNIT.search(said) and not UNIT.search(struct_comment):
                    yield number, double.group(1), "says no unit"
        comment_open = False
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
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1])
    headers, missing = 0, 0
    for room in ROOMS:
        for path in sorted((root / room).rglob("*.hpp")):
            headers += 1
            for number, name, what in problems_of(path.read_text(encoding="utf-8")):
                print(f"{path.relative_to(root).as_posix()}:{number}: {name} {what}")
                missing += 1
    print(f"{headers} headers, {missing} declarations without a comment or a unit")
    return 1 if missing or not headers else 0


if __name__ == "__main__":
    sys.exit(main())
