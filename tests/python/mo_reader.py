"""The functions of a Modelica package as Python ones: of the language what distilled laws are written in."""

import re


class Array(list):
    """Counted from one."""

    def __getitem__(self, at):
        if not 1 <= at <= len(self):
            raise IndexError(at)
        return super().__getitem__(at - 1)

    def __setitem__(self, at, value):
        if not 1 <= at <= len(self):
            raise IndexError(at)
        super().__setitem__(at - 1, value)


def expression(text: str) -> str:
    return re.sub(r"\{([^{}]*)\}", r"Array([\1])", text.replace("^", "**"))


def statement(line: str) -> tuple[int, str, int]:
    """Indent of the line, the line in Python, indent of what follows it."""
    if re.fullmatch(r"end (if|for|while);", line):
        return -1, "pass", 0
    if line == "else":
        return -1, "else:", 1
    if match := re.fullmatch(r"if (.*) then", line):
        return 0, f"if {expression(match[1])}:", 1
    if match := re.fullmatch(r"while (.*) loop", line):
        return 0, f"while {expression(match[1])}:", 1
    if match := re.fullmatch(r"for (\w+) in (\w+):(\w+) loop", line):
        return 0, f"for {match[1]} in range({match[2]}, {match[3]} + 1):", 1
    if match := re.fullmatch(r'assert\((.*), (".*")\);', line):
        return 0, f"assert {expression(match[1])}, {match[2]}", 0
    if match := re.fullmatch(r"(\w+(?:\[[^\]]*\])?) := (.*);", line):
        return 0, f"{match[1]} = {expression(match[2])}", 0
    raise SyntaxError(line)


def function(name: str, body: str) -> str:
    declarations, algorithm = body.split("  algorithm\n")
    inputs = re.findall(r"input \w+ (\w+)", declarations)
    outputs = re.findall(r"output \w+ (\w+)", declarations)
    lines = [f"def {name}({', '.join(inputs)}):"]
    lines += [f"    {n} = Array([0.0] * {count})" for n, count in re.findall(r"\w+ (\w+)\[(\d)\]", declarations)]
    depth = 1
    for line in algorithm.strip().splitlines():
        before, text, after = statement(line.strip())
        depth += before
        if text == "pass":
            continue
        lines.append("    " * depth + text)
        depth += after
    return "\n".join([*lines, f"    return {', '.join(outputs)}"])


def load(text: str) -> dict:
    """Its functions and constants by their names."""
    opening = re.match(r"package (\w+) ", text)
    if not opening or not text.endswith(f"end {opening[1]};\n"):
        raise SyntaxError("a package ends as it begins")
    names = {"Array": Array, "abs": abs, "sqrt": lambda x: x**0.5, "div": lambda a, b: int(a // b), "mod": lambda a, b: a % b,
             "size": lambda array, _: len(array)}
    for name, count, values in re.findall(r"  constant Real (\w+)\[(\d+)\] = \{([^}]*)\};", text):
        numbers = Array(float(v) for v in values.split(","))
        if len(numbers) != int(count):
            raise SyntaxError(f"{name} has {len(numbers)} numbers")
        names[name] = numbers
    for match in re.finditer(r'  function (\w+) "[^\n]*"\n(.*?)  end \1;\n', text, re.DOTALL):
        exec(function(match[1], match[2]), names)
    names["package"] = opening[1]
    return names
