#!/usr/bin/env python3
"""Writes the manual page and the shells' completions from what the command says of itself.

usage: command_help.py SNARE [--check]

SNARE is the built command. Writes docs/command/snare.1, snare.bash and _snare (zsh); --check compares and writes nothing, as a test does.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs/command"
# Words that an argument may be, where it is no file; the help has them in words.
WHATS = re.compile(r"([\w]+(?:, [\w]+)* or [\w]+)$")
# Endings of the files that a verb's arguments are, where they are not toml alone.
ENDINGS = {"arm": ["toml", "urdf"], "export": ["json", "xml"]}
OPTION = re.compile(r"^  (-[^ ]+(?: [^ ].*?)?)(?:  +(.*))?$")
STATUSES = [("0", "done"), ("1", "anything else"), ("2", "the input is wrong: the message has file, line, key, value and what is allowed; nothing is written"),
            ("3", "the solver could not finish, or was interrupted; what it reached is kept"), ("4", "validate found a row out of its limit")]


def help_of(snare, *verb):
    """What the help of a verb says: sentence, usage, arguments, options, verbs below it, example."""
    text = subprocess.run([snare, *verb, "--help"], check=True, capture_output=True, text=True).stdout
    lines = text.splitlines()
    said = {"what": lines[0], "usage": "", "arguments": [], "options": [], "verbs": [], "example": ""}
    part = ""
    for line in lines[1:]:
        if line.startswith("Usage: "):
            said["usage"] = re.sub(r"^Usage: \S+", "snare", line)
        elif line.startswith("Example: "):
            said["example"] = line.removeprefix("Example: ")
        elif line and not line.startswith(" "):
            part = line.rstrip(":")
        elif part == "Subcommands" and line.strip():
            name, what = line.strip().split(None, 1)
            said["verbs"].append((name, what))
        elif part == "Positionals" and line.strip():
            match = re.match(r"  (\S+) TEXT(?: REQUIRED)?\s*(.*)$", line)
            if match:
                said["arguments"].append([match.group(1), match.group(2)])
            else:
                said["arguments"][-1][1] += line.strip()
        elif part == "Options" and line.strip():
            match = OPTION.match(line)
            if match:
                said["options"].append([match.group(1), match.group(2) or ""])
            else:
                said["options"][-1][1] += line.strip()
    return said


def commands(snare):
    """(words, help) of every verb, with those below another."""
    top = help_of(snare)
    found = [([], top)]
    for name, _ in top["verbs"]:
        said = help_of(snare, name)
        if not said["verbs"]:
            found.append(([name], said))
        for below, _ in said["verbs"]:
            found.append(([name, below], help_of(snare, name, below)))
    return found


def names(option):
    """-h, --help of an option's head, and what it takes."""
    head, _, takes = option.partition(" ")
    takes = re.sub(r":.*", "", takes)
    return head.split(","), takes


def escaped(text):
    return text.replace("\\", "\\\\").replace("-", "\\-").replace("\n.", "\n\\&.")


def manual(found, version):
    top = found[0][1]
    out = [f'.TH SNARE 1 "" "snare {version}" "User commands"', ".SH NAME", "snare \\- the mechanics of loose wires under a pin", ".SH SYNOPSIS",
           ".B snare", ".I VERB", "[\\fIOPTIONS\\fR] [\\fIFILE\\fR]", ".SH DESCRIPTION",
           "Computes what a loose elastic wire does when something pushes on it, compares that with readings, finds the effect that a declared model lacks, and",
           "distils laws for simulators. Every verb reads a file and writes a folder of results: tables, JSON, and a page that opens without a network.",
           ".SH VERBS"]
    for words, said in found[1:]:
        out += [".SS " + " ".join(words), escaped(said["what"]) + ".", ".PP", ".nf", escaped(said["usage"]), ".fi"]
        for name, what in said["arguments"]:
            out += [".TP", f".I {escaped(name)}", escaped(what)]
        for option, what in said["options"]:
            (*short, long), takes = names(option)
            title = ", ".join(f"\\fB{escaped(o)}\\fR" for o in [*short, long])
            default = re.search(r"=(\S+)$", option)
            kind = re.sub(r"=.*", "", takes).replace(" REQUIRED", "")
            out += [".TP", title + (f" \\fI{kind}\\fR" if kind else ""),
                    escaped(what) + (f" (default: {escaped(default.group(1))})" if default else "") + (" (required)" if "REQUIRED" in option else "")]
        if said["example"]:
            out += [".PP", "Example:", ".PP", ".nf", ".RS", escaped(said["example"]), ".RE", ".fi"]
    out += [".SH OPTIONS"]
    for option, what in top["options"]:
        out += [".TP", ", ".join(f"\\fB{escaped(o)}\\fR" for o in names(option)[0]), escaped(what)]
    out += [".SH EXIT STATUS"]
    for status, what in STATUSES:
        out += [".TP", f".B {status}", what]
    out += [".SH FILES", "Formats, units and theory: the pages beside README.md in the package's documentation, and the JSON Schemas in the folder",
            ".I schemas", "of its data.", ".SH SEE ALSO", ".BR mpirun (1),", ".BR paraview (1)"]
    return "\n".join(out) + "\n"


def values(said):
    """Words that the argument of a verb may be; none: it is a file, with these endings."""
    for name, what in said["arguments"]:
        words = WHATS.search(what)
        if name.isupper() and words and not name.endswith(".toml") and name != "FILE":
            return re.split(r", | or ", words.group(1))
    return []


def endings(words, said):
    return [] if not said["arguments"] or values(said) else ENDINGS.get(words[0], ["toml"])


def flags(said):
    return [o for option, _ in said["options"] for o in names(option)[0]]


def bash(found):
    verbs = [name for name, _ in found[0][1]["verbs"]]
    out = ["# Completion of snare for bash; made by scripts/command_help.py from the command's help.", "_snare() {",
           '  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb=${COMP_WORDS[1]} ending words files=""',
           "  COMPREPLY=()", "  if ((COMP_CWORD == 1)); then",
           f'    mapfile -t COMPREPLY < <(compgen -W "{" ".join(verbs + flags(found[0][1]))}" -- "$current")', "    return", "  fi",
           '  case $before in', '    --out) mapfile -t COMPREPLY < <(compgen -d -- "$current"); return ;;',
           '    --set | --threads | --pose | --case | --body | --axis | --*-mm) return ;;', "  esac", "  case $verb in"]
    for verb in verbs:
        those = [(words, said) for words, said in found[1:] if words[0] == verb]
        words, said = those[0]
        if len(words) > 1:
            out += [f"    {verb})", f'      ((COMP_CWORD == 2)) && words="{" ".join(w[1] for w, _ in those)}" || {{', f'        words="{" ".join(flags(said))}"',
                    f'        files="{" ".join(endings(words, said))}"', "      } ;;"]
        else:
            out += [f"    {verb})", f'      words="{" ".join(values(said) + flags(said))}"', f'      files="{" ".join(endings(words, said))}" ;;']
    out += ["    *) return ;;", "  esac", '  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")',
            "  [[ $current == -* || -z $files ]] && return", "  compopt -o filenames 2>/dev/null",
            '  for ending in $files; do', '    mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X "!*.$ending" -- "$current")', "  done",
            '  mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$current")', "}", "complete -F _snare snare"]
    return "\n".join(out) + "\n"


def quoted(text):
    return text.replace("\\", "\\\\").replace("'", "'\\''").replace("[", "\\[").replace("]", "\\]").replace(":", "\\:")


def zsh_arguments(words, said):
    out = []
    for option, what in said["options"]:
        all_names, takes = names(option)
        value = ""
        if takes:
            value = ":folder:_directories" if all_names[-1] == "--out" else f":{takes.split('=')[0].lower().replace(' required', '')}:"
        repeat = "*" if "repeatable" in what else ""
        for one in all_names:
            out.append(f"'{repeat}{one}[{quoted(what)}]{value}'")
    if values(said):
        out.append(f"':what:({' '.join(values(said))})'")
    elif endings(words, said):
        out.append(f"':file:_files -g \"*.({'|'.join(endings(words, said))})\"'")
    return " ".join(out)


def zsh(found):
    out = ["#compdef snare", "# Completion of snare for zsh; made by scripts/command_help.py from the command's help.", "_snare() {", "  local -a verbs", "  verbs=("]
    out += [f"    '{quoted(name)}:{quoted(what)}'" for name, what in found[0][1]["verbs"]]
    out += ["  )", "  if ((CURRENT == 2)); then", "    _describe verb verbs", f"    _arguments {zsh_arguments([], found[0][1])}", "    return", "  fi",
            "  local verb=$words[2]", "  shift words", "  ((CURRENT--))", "  case $verb in"]
    for name, _ in found[0][1]["verbs"]:
        those = [(words, said) for words, said in found[1:] if words[0] == name]
        words, said = those[0]
        if len(words) > 1:
            out += [f"    {name})", "      if ((CURRENT == 2)); then", f"        _values what {' '.join(w[1] for w, _ in those)}", "        return", "      fi",
                    "      shift words", "      ((CURRENT--))", f"      _arguments {zsh_arguments(words, said)} ;;"]
        else:
            out.append(f"    {name}) _arguments {zsh_arguments(words, said)} ;;")
    out += ["  esac", "}", 'if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _snare "$@"; else compdef _snare snare; fi']
    return "\n".join(out) + "\n"


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    snare = sys.argv[1]
    found = commands(snare)
    version = subprocess.run([snare, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]
    wanted = {"snare.1": manual(found, version), "snare.bash": bash(found), "_snare": zsh(found)}
    stale = False
    for name, text in wanted.items():
        path = FOLDER / name
        if sys.argv[2:] == ["--check"]:
            if not path.is_file() or path.read_text(encoding="utf-8") != text:
                print(f"docs/command/{name} is not what the command's help says: run scripts/command_help.py SNARE")
                stale = True
        else:
            path.write_text(text, encoding="utf-8")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
