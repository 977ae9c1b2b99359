#!/usr/bin/env python3
"""Every public function of the Python package says what it takes and gives, with units and shapes.

usage: python_docstrings.py REPOSITORY

Public is what `__all__` of the package names, and every name without an underscore of a module without one (`snare.plot`). A function has a
docstring that
- names every argument, as `name:` or ``name``, or takes them over by "rguments as of ``other``" (but for those that `other` has not);
- says what comes back, by "Returns", or by "returns" in the heading of its module for all of it;
- says units: one in brackets ([N], [SI units]), a name that ends in one (``time_s``), or by the words of UNIT_WORDS;
- says shapes or kinds: by the words of SHAPE_WORDS.
The last two may be taken over by "as of ``other``" too. A class has a docstring. The compiled part (Law, SimpleLaw) is looked at by
tests/python/stub_test.py, in the module itself, by the same rules for units and shapes.
"""

import ast
import pathlib
import re
import sys

UNIT = re.compile(r"\[(?:[mu]?m|N|N/m|s|J|rad|deg|SI units|-)[\],]|``\w+_(?:N|m|s|rad|mm|deg|N_m)``")
UNIT_WORDS = re.compile(r"\b(in SI|SI units?|units? of the files?|the sensor's ``unit``|their units?|in J|units of)\b")
SHAPE_WORDS = re.compile(r"\b(arrays?|lists?|shapes?|columns? of one length|one length|a number|dictionar(y|ies)|rows?|by series|by model)\b")
AS_OF = re.compile(r"[Aa]rguments as\s+of\s+``(\w+)``")
OVER = re.compile(r"\bas\s+of\s+``(\w+)``|\bas the verbs return it\b")
# Arguments that every reader knows: where a picture goes.
PLAIN = {"self", "axes"}


def says_units(text):
    return bool(UNIT.search(text) or UNIT_WORDS.search(text))


def says_shapes(text):
    return bool(SHAPE_WORDS.search(text))


def lacks(name, arguments, text, others, heading=""):
    """What the docstring `text` of a function does not say. others: of the other functions, name -> (arguments, docstring)."""
    if not text:
        yield f"{name} has no docstring"
        return
    taken = AS_OF.search(text)
    known = set(others[taken.group(1)][0]) if taken and taken.group(1) in others else set()
    for argument in arguments:
        if argument not in PLAIN | known and not re.search(rf"\b{argument}:|``{argument}``", text):
            yield f"{name} does not say what {argument} is"
    if not re.search(r"\bReturns\b", text) and not re.search(r"\breturns\b", heading):
        yield f"{name} does not say what it returns"
    over = [others[m.group(1)][1] for m in OVER.finditer(text) if m.group(1) in others]
    if OVER.search(text) and "as the verbs return it" in " ".join(text.split()):
        over += [doc for _, doc in others.values()]
    if not any(says_units(one) for one in [text] + over):
        yield f"{name} says no unit"
    if not any(says_shapes(one) for one in [text] + over):
        yield f"{name} says no shape"


def arguments_of(node):
    given = node.args
    return [one.arg for one in given.posonlyargs + given.args + ([given.vararg] if given.vararg else []) + given.kwonlyargs]


def problems_of(sources):
    """sources: name of a file -> its text; one of them is __init__.py."""
    trees = {name: ast.parse(text) for name, text in sources.items()}
    exported = set()
    for node in trees["__init__.py"].body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__":
            exported = set(ast.literal_eval(node.value))
    found = []  # (file, line, node, heading)
    for name, tree in trees.items():
        for node in tree.body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and (
                    node.name in exported or not name.startswith("_") and not node.name.startswith("_")):
                found.append((name, node, ast.get_docstring(tree) or ""))
    others = {node.name: (arguments_of(node), ast.get_docstring(node) or "") for _, node, _ in found if isinstance(node, ast.FunctionDef)}
    for name, node, heading in found:
        if isinstance(node, ast.ClassDef):
            if not ast.get_docstring(node):
                yield name, node.lineno, f"{node.name} has no docstring"
            continue
        rest = {key: value for key, value in others.items() if key != node.name}
        for what in lacks(node.name, arguments_of(node), ast.get_docstring(node), rest, heading):
            yield name, node.lineno, what


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    folder = pathlib.Path(sys.argv[1]) / "python/snare"
    sources = {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.py"))}
    missing = list(problems_of(sources))
    for name, line, what in missing:
        print(f"python/snare/{name}:{line}: {what}")
    print(f"{len(sources)} files, {len(missing)} things unsaid")
    return 1 if missing or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
