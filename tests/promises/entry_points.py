"""The four entries of entries.py: the command, the Python module, the C++ library, and the command under mpirun."""

import contextlib
import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LONGEST = 60.0  # of a run [s]


def literal(value) -> str:
    """Returns a value as TOML, for --set."""
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{key}" = {literal(one)}' for key, one in value.items()) + "}"
    return json.dumps(value)


def no_constant(word):
    raise ValueError(f"{word} in JSON")


def strict_json(text: str):
    """Parses JSON; rejects NaN and infinity, which json.loads accepts."""
    return json.loads(text, parse_constant=no_constant)


@dataclasses.dataclass
class Ending:
    status: int  # exit status of the command, the same number for an exception, or minus a signal
    message: str
    document: object  # the JSON result, or None
    seconds: float
    printed: str  # standard output and standard error
    more: dict = dataclasses.field(default_factory=dict)  # further fields of python_entry.py and library_entry.cpp


class Running:
    """A process. Its output goes to files outside the folder it works in."""

    def __init__(self, entry, line, cwd, environment, streams=""):
        self.entry = entry
        self.private = tempfile.TemporaryDirectory()
        self.out, self.err, self.ending = (pathlib.Path(self.private.name) / name for name in ("out", "err", "ending.json"))
        line = [str(self.ending) if word is entry.ENDING else str(word) for word in line]
        self.began = time.monotonic()
        with open(self.out, "wb") as out, open(self.err, "wb") as err:
            if streams:  # redirections of the shell
                line = ["sh", "-c", f'exec "$@" {streams}', "sh", *line]
            self.process = subprocess.Popen(line, cwd=cwd, env=environment, stdout=out, stderr=err, stdin=subprocess.DEVNULL,
                                            start_new_session=True)

    def children(self) -> list:
        """Returns the processes that it started, for mpirun the ranks."""
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            return [int(pid) for pid in pathlib.Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()]
        return []

    def finish(self, longest=LONGEST) -> Ending:
        try:
            status = self.process.wait(timeout=longest)
        except subprocess.TimeoutExpired:
            self.process.kill()
            status = self.process.wait()
        seconds = time.monotonic() - self.began
        out, err = self.out.read_text(errors="replace"), self.err.read_text(errors="replace")
        more = json.loads(self.ending.read_text()) if self.ending.exists() else {}
        self.private.cleanup()
        return self.entry.ended(status, out, err, more, seconds)


class Entry:
    name = ""
    ENDING = object()  # placeholder in a command line for the file to which a program writes how it ended

    def lacks(self) -> str:
        """Returns why this entry is not available here, or an empty text."""
        return ""

    def verbs(self) -> list:
        raise NotImplementedError

    def writes(self, work) -> bool:
        """Returns whether it writes into a result folder."""
        raise NotImplementedError

    def line(self, verb, work, words, given, out, threads, json_too):
        raise NotImplementedError

    def ended(self, status, out, err, more, seconds) -> Ending:
        return Ending(more.get("status", status), more.get("message", err), more.get("document"), seconds, out + err, more)

    def start(self, verb, work, cwd, words=None, given=None, out="out", threads=None, json_too=True, streams="") -> Running:
        line = self.line(verb, work, work.words if words is None else words, given or {}, out, threads, json_too)
        environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", PYTHONDONTWRITEBYTECODE="1")
        if threads:
            environment["OMP_NUM_THREADS"] = str(threads)
        return Running(self, line, cwd, environment, streams)

    def run(self, *arguments, **named) -> Ending:
        return self.start(*arguments, **named).finish()


class Command(Entry):
    name = "command"

    def __init__(self, snare):
        self.snare = snare

    def verbs(self):
        text = subprocess.run([self.snare, "--help"], capture_output=True, text=True, check=True).stdout
        return re.findall(r"^  (\w+)  +\S", text.split("Subcommands:")[1], re.M)

    def writes(self, work):
        return work.out

    def line(self, verb, work, words, given, out, threads, json_too):
        line = [self.snare, verb, *(["show"] if verb == "arm" else []), *words]
        line += ["--out", out] if work.out else []
        line += ["--json"] if json_too and work.json else []
        if threads and work.json and work.out:
            line += ["--threads", str(threads)]
        for key, value in given.items():
            line += ["--set", f"{key}={literal(value)}"]
        return line

    def ended(self, status, out, err, more, seconds):
        try:
            document, more = strict_json(out), {}
        except ValueError as error:
            document, more = None, {"not_finite": [str(error)] if "in JSON" in str(error) else []}
        return Ending(status, err, document, seconds, out + err, more)


class Ranks(Command):
    name = "mpi"

    def lacks(self):
        if shutil.which("mpirun") is None:
            return "mpirun is not installed"
        return "" if (pathlib.Path(self.snare).parent / "snare_mpi.so").exists() else "this build has no MPI"

    def verbs(self):
        return ["sweep"]

    def line(self, *arguments):
        return ["mpirun", "--oversubscribe", "-n", "2", *super().line(*arguments)]


class Module(Entry):
    name = "python"
    PYTHON = "/usr/bin/python3"  # Debian's, for which the module is built

    def lacks(self):
        done = subprocess.run([self.PYTHON, "-c", "import snare"], capture_output=True, text=True)
        return f"the Python module was not built ({done.stderr.strip().splitlines()[-1]})" if done.returncode != 0 else ""

    def verbs(self):
        """Returns the functions of the package that have an argument `progress`."""
        program = ("import inspect, snare; print(*[name for name in snare.__all__ if inspect.isfunction(getattr(snare, name)) "
                   "and 'progress' in inspect.signature(getattr(snare, name)).parameters])")
        return subprocess.run([self.PYTHON, "-c", program], capture_output=True, text=True, check=True).stdout.split()

    def writes(self, work):
        return work.words[0] == "sweep.toml"

    def line(self, verb, work, words, given, out, threads, json_too):
        arguments = {"set": given} if given else {}
        if threads:
            arguments["threads"] = threads
        if self.writes(work) and out:
            arguments["out"] = out
        if json_too == "progress":
            arguments["progress"] = True
        return [self.PYTHON, "-B", HERE / "python_entry.py", verb, words[0], self.ENDING, json.dumps(arguments)]


class Library(Entry):
    name = "cpp"

    def __init__(self, program):
        self.program = program

    def lacks(self):
        return "" if pathlib.Path(self.program).exists() else f"{self.program} was not built"

    def verbs(self):
        return re.findall(r"^\[\[nodiscard\]\] nlohmann::json (\w+)\(", (ROOT / "results/snare.hpp").read_text(), re.M)

    def writes(self, work):
        return False

    def line(self, verb, work, words, given, out, threads, json_too):
        line = [self.program, verb, words[0], self.ENDING, *(["--threads", str(threads)] if threads else [])]
        for key, value in given.items():
            line += ["--set", f"{key}={literal(value)}"]
        return line


def all_entries(snare: str, library: str) -> list:
    return [Command(snare), Module(), Library(library), Ranks(snare)]


if __name__ == "__main__":
    sys.exit("run entries.py")
