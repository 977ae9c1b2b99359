"""The checks of entries.py: one property of one verb through one entry each. promises.toml says where a check applies.

A check takes a Trial and collects the violations in it. The first line of its docstring is its row in docs/promises.md.
"""

import contextlib
import ctypes
import fcntl
import hashlib
import html
import json
import os
import pathlib
import re
import shutil
import signal
import struct
import time

from entry_points import strict_json
from same_bytes import timeless, timeless_rows
from small_inputs import WORK

IN_OPEN, IN_CLOSE, IN_CREATE = 0x20, 0x18, 0x100  # of inotify
ANSWER = 2.0  # a second, and a second for a loaded machine [s]
AT_ONCE = 8.0  # a rejection on a loaded machine; the rejected runs would take minutes [s]
PYTHON_OUTPUTS = ["cases.journal", "histories.h5"]
TABLES = ("curves", "history", "telemetry", "table", "laws")


class Trial:
    """One verb through one entry, in a folder of its own with all the files of small_inputs.py."""

    def __init__(self, entry, verb, work, template: pathlib.Path, folder: pathlib.Path, command):
        self.entry, self.verb, self.work, self.folder, self.command = entry, verb, work, folder, command
        self.wrong = []
        shutil.copytree(template, folder, copy_function=copy)

    def expect(self, holds, what):
        if not holds:
            self.wrong.append(str(what))
        return holds

    def start(self, **named):
        return self.entry.start(self.verb, self.work, self.folder, **named)

    def run(self, **named):
        return self.entry.run(self.verb, self.work, self.folder, **named)

    def run_well(self, **named):
        ending = self.run(**named)
        self.expect(ending.status == 0, f"status {ending.status}: {short(ending.message)}")
        return ending

    def writes(self):
        return self.entry.writes(self.work)

    def outputs(self):
        return PYTHON_OUTPUTS if self.entry.name == "python" else self.work.outputs

    def few(self, tried):
        """Returns all, or the first two with mpirun, which needs seconds for every status other than 0."""
        return tried[:2] if self.entry.name == "mpi" else tried

    def clear(self):
        shutil.rmtree(self.folder / "out", ignore_errors=True)


def copy(source, target):
    """Copies small files and links large ones, which nothing writes into."""
    if os.path.getsize(source) > 100_000:
        os.link(source, target)
    else:
        shutil.copyfile(source, target)


def short(text):
    return " | ".join(str(text).strip().splitlines())[-300:]


def tree(folder):
    """Returns the SHA-256 of every file below a folder, and None for every folder."""
    return {str(p.relative_to(folder)): None if p.is_dir() else hashlib.sha256(p.read_bytes()).hexdigest() for p in folder.rglob("*")}


def differences(one, other):
    return sorted(name for name in one.keys() | other.keys() if one.get(name, "") != other.get(name, ""))


class Watch:
    """Records events of files in folders (inotify)."""

    def __init__(self, folders, event):
        self.event = event
        libc = ctypes.CDLL(None, use_errno=True)
        self.descriptor = libc.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
        for folder in folders:
            # The kernel merges equal events in a row. The close events keep two opens of a file apart.
            libc.inotify_add_watch(self.descriptor, str(folder).encode(), event | IN_CLOSE)

    def names(self):
        """Returns the names of the files since the last call, one an event."""
        names = []
        with contextlib.suppress(BlockingIOError):
            while True:
                data, at = os.read(self.descriptor, 1 << 16), 0
                while at < len(data):
                    _, mask, _, size = struct.unpack_from("iIII", data, at)
                    if mask & self.event:
                        names.append(data[at + 16:at + 16 + size].rstrip(b"\0").decode())
                    at += 16 + size
        return names

    def close(self):
        os.close(self.descriptor)


def written(folder):
    """Returns name and content of the files of results without clock times. Pages print times: their content is left out."""
    result = {}
    for file in sorted(folder.rglob("*")):
        name = str(file.relative_to(folder))
        if not file.is_file() or file.suffix in (".journal", ".part"):  # written as cases end, with times
            continue
        if file.suffix == ".json":
            result[name] = json.dumps(timeless(json.loads(file.read_text())), sort_keys=True)
        elif file.name == "scores.csv":
            result[name] = timeless_rows(file.name, file.read_text())
        else:
            result[name] = "" if file.suffix == ".html" else hashlib.sha256(file.read_bytes()).hexdigest()
    return result


def kill_all(running):
    """Kills a run and its children: the ranks of mpirun have sessions of their own."""
    with contextlib.suppress(ProcessLookupError):
        for child in running.children():
            os.kill(child, signal.SIGKILL)
    time.sleep(0.05)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(running.process.pid, signal.SIGKILL)


def lines_of(journal):
    return journal.read_bytes().count(b"\n") if journal.exists() else 0


def wait_for_cases(running, journal, cases):
    """Waits until a journal has more than so many lines, the run has ended, or 20 s have passed."""
    end = time.monotonic() + 20.0
    while time.monotonic() < end and lines_of(journal) <= cases and running.process.poll() is None:
        time.sleep(0.005)


# Statuses


def wrong_input(t):
    """Rejects wrong input with status 2 (`InputError` in Python and C++), names the mistake, and writes nothing."""
    before = tree(t.folder)
    (t.folder / "damaged").write_text('schema = "snare-\n[[[')
    before["damaged"] = tree(t.folder)["damaged"]
    tried = list(t.work.mistakes)
    if t.verb not in ("new", "export", "validate"):
        tried.append((t.work.words, {"nonsense.key": 1}, "nonsense"))
    if t.verb not in ("new", "validate"):
        rest = t.work.words[1:]
        tried += [(["missing.toml", *rest], {}, "missing.toml"), (["damaged", *rest], {}, "damaged"), (["references", *rest], {}, "references")]
    for words, given, named in t.few(tried):
        ending = t.run(words=words, given=given, out="new/folder")
        what = f"{' '.join(words)} {given or ''}"
        t.expect(ending.status == 2, f"{what}: status {ending.status} ({short(ending.message)})")
        t.expect(named in ending.message, f"{what}: {named} is not named in: {short(ending.message)}")
        after = tree(t.folder)
        if not t.expect(after == before, f"{what}: left {differences(before, after)}"):
            shutil.rmtree(t.folder / "new", ignore_errors=True)


def stopped_solver(t):
    """Ends with status 3 (`SolverError`, `SolverStopped`) and a reason when a solver fails."""
    words, given = t.work.stopped
    ending = t.run(words=words, given=given)
    t.expect(ending.status == 3, f"status {ending.status}: {short(ending.message)}")
    t.expect(len(ending.message.strip()) > 10, f"the reason is only: {ending.message!r}")


def partial_result_is_kept(t):
    """Keeps the results computed before a solver failed: in the folder, or as the `result` of the exception."""
    words, given = t.work.stopped
    ending = t.run(words=words, given=given)
    if t.entry.name == "python" and not t.writes():
        t.expect(ending.more.get("reached"), "SolverError has no result")
    else:
        t.expect((t.folder / "out").is_dir() and any((t.folder / "out").iterdir()), "the folder is empty")


def finite(t):
    """Returns no NaN and no infinity. In the tables of Python, NaN marks a cell that is empty in the file."""
    ending = t.run_well()
    t.expect(not ending.more.get("not_finite"), f"not finite: {ending.more.get('not_finite')}")
    if not t.writes():
        return
    for file in (t.folder / "out").rglob("*"):
        if file.suffix == ".json":
            try:
                strict_json(file.read_text())
            except ValueError as error:
                t.expect(False, f"{file.name}: {error}")
        elif file.suffix == ".csv":
            cells = [cell for line in file.read_text().splitlines() for cell in line.split(",")]
            t.expect(not [c for c in cells if re.fullmatch(r"[+-]?(nan|inf|infinity)", c, re.I)], f"{file.name} has a cell that is no number")


def wrong_kinds(t):
    """Rejects arguments of the wrong type with TypeError or ValueError."""
    ending = t.entry.run("wrong_kinds", t.work, t.folder, words=[t.verb])
    t.expect(ending.status == 0, short(ending.message))


# Interruption


def interrupt(t):
    """Answers SIGINT within a second (status 3, KeyboardInterrupt, `SolverStopped`) and marks partial results as partial."""
    words, given = t.work.long
    running = t.start(words=words, given=given)
    # Python and mpirun start slowly.
    time.sleep({"command": 0.5, "cpp": 0.8, "python": 1.0, "mpi": 1.5}[t.entry.name])
    if not t.expect(running.process.poll() is None, "the long run has ended by itself"):
        t.expect(False, short(running.finish().message))
        return
    sent = time.monotonic()
    running.process.send_signal(signal.SIGINT)
    while t.entry.name == "python" and not running.ending.exists() and time.monotonic() < sent + 10.0:
        time.sleep(0.01)  # after KeyboardInterrupt the interpreter waits up to 5 s for unfinished work before it exits
    if t.entry.name == "python":
        took = time.monotonic() - sent
        ending = running.finish(0.5)
    else:
        ending = running.finish(10.0)
        took = time.monotonic() - sent
    t.expect(took < ANSWER, f"answered after {took:.1f} s")
    t.expect(ending.status == (1 if t.entry.name == "mpi" else 3), f"status {ending.status}: {short(ending.message)}")  # of mpirun
    said = {"mpi": "finished and kept", "cpp": "stopped on request|interrupted"}.get(t.entry.name, "interrupted")
    t.expect(re.search(said, ending.message), f"the message is: {short(ending.message)}")
    t.expect(t.verb != "sweep" or "nothing" not in ending.message, f"it says that nothing is kept: {short(ending.message)}")
    out = t.folder / "out"
    if t.entry.name in ("command", "mpi"):
        if t.work.json:
            t.expect(ending.document is not None and ending.document.get("interrupted") is True, "standard output does not say \"interrupted\": true")
        for file in out.rglob("*.json") if out.exists() else ():
            t.expect(json.loads(file.read_text())["interrupted"] is True, f"{file.name} does not say that it is a part")
        for file in out.rglob("*.html") if out.exists() else ():
            t.expect("was interrupted" in file.read_text(), f"{file.name} does not say that it is a part")
    left = [f.name for f in out.rglob(".*") if not f.name.startswith(".histories")] if out.exists() else []
    t.expect(not left, f"left {left}")


def interrupted_sweep_is_kept(t):
    """Keeps the finished cases of an interrupted sweep; the same call resumes it."""
    cases = 4000 if t.entry.name == "mpi" else 600  # mpirun hands a signal on after half a second
    running = t.start(given={"cases": cases})
    journal = t.folder / "out/cases.journal"
    wait_for_cases(running, journal, 20)
    running.process.send_signal(signal.SIGINT)
    ending = running.finish()
    t.expect(ending.status in (1, 3), f"status {ending.status}: {short(ending.message)}")
    kept = journal.read_bytes().splitlines()[1:]
    t.expect(20 <= len(kept) < cases, f"{len(kept)} cases are kept")
    again = t.run_well(given={"cases": cases})
    lines = journal.read_bytes().splitlines()[1:]
    t.expect(lines[:len(kept)] == kept and len({one.split()[0] for one in lines}) == len(lines) == cases,
             "the cases that were kept were run again, or cases are lost")
    t.expect(again.document is not None and again.document["finished"] == cases, "not every case is finished")


# Folders


def names_taken(t):
    """Rejects, before computing, a folder that is a file and a folder in which a directory has the name of a result."""
    (t.folder / "file").write_text("in the way")
    words, given = t.work.long if t.work.long else (t.work.words, {})
    (t.folder / "taken" / t.outputs()[0]).mkdir(parents=True)
    before = tree(t.folder)
    for out, statuses in (("file", (2,)), ("file/below", (2,)), ("taken", (1, 2))):
        ending = t.run(words=words, given=given, out=out)
        t.expect(ending.status in statuses, f"--out {out}: status {ending.status} ({short(ending.message)})")
        t.expect(ending.seconds < AT_ONCE, f"--out {out}: refused after {ending.seconds:.1f} s")
        after = tree(t.folder)
        t.expect(after == before, f"--out {out}: left {differences(before, after)}")


@contextlib.contextmanager
def held(file, words):
    """Holds a lock on a file as another run would."""
    with open(file, "w", encoding="utf-8") as lock:
        lock.write(words)
        lock.flush()
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield


def folder_of_another(t):
    """Rejects a folder that another run holds, names that run, and writes nothing; leaves its own folder unlocked."""
    (t.folder / "out").mkdir()
    with held(t.folder / "out/.snare.lock", "snare push other.toml (process 12)\n"):
        before = tree(t.folder)
        ending = t.run()
        t.expect(ending.status == 2, f"status {ending.status} ({short(ending.message)})")
        t.expect("snare push other.toml (process 12)" in ending.message, f"the other run is not named: {short(ending.message)}")
        after = tree(t.folder)
        t.expect(after == before, f"left {differences(before, after)}")
    if t.verb != "validate":
        t.clear() if t.verb == "new" else None
        t.run_well()
        t.expect(not (t.folder / "out/.snare.lock").exists(), "its lock is left")


def holds_its_folder(t):
    """Holds its folder: other verbs are rejected there until the run ends."""
    words, given = t.work.long
    running = t.start(words=words, given=given)
    end = time.monotonic() + 10.0
    try:
        while time.monotonic() < end and not list((t.folder / "out").glob("[.c]*")):
            time.sleep(0.02)
        time.sleep(0.3)
        push = t.command.run("push", WORK["push"], t.folder)
        t.expect(push.status == 2, f"`snare push` into the folder of its run: status {push.status}")
    finally:
        kill_all(running)
        running.finish()
    push = t.command.run("push", WORK["push"], t.folder)
    t.expect(push.status == 0, f"after its end: status {push.status} ({short(push.message)})")


def journal_of_another(t):
    """Rejects the journal of a sweep that another run holds, and writes nothing."""
    (t.folder / "out").mkdir()
    with held(t.folder / "out/cases.journal", ""):
        before = tree(t.folder)
        ending = t.run()
        t.expect(ending.status == 2, f"status {ending.status} ({short(ending.message)})")
        t.expect("another run" in ending.message, f"the reason is: {short(ending.message)}")
        after = tree(t.folder)
        t.expect(after == before, f"left {differences(before, after)}")


def leftovers_are_removed(t):
    """Removes the temporary files of killed runs, and no other files."""
    (t.folder / "out").mkdir()
    name = t.outputs()[-1] if t.entry.name == "python" else t.outputs()[0]
    gone, running, mine = f".{name}.99999999-0.tmp", f".{name}.{os.getpid()}-0.tmp", ".mine.tmp"
    others = [mine] if name == "histories.h5" else [running, mine]  # histories belong to the run that holds the journal
    for one in (gone, *others):
        (t.folder / "out" / one).write_text("half")
    t.run_well()
    t.expect(not (t.folder / "out" / gone).exists(), f"{gone} is left")
    for one in others:
        t.expect((t.folder / "out" / one).exists(), f"{one} was removed")


# Inputs


def inputs_named(t):
    """Names every input, and no other file, with its SHA-256."""
    ending = t.run_well()
    said = {pathlib.Path(one["file"]).name: one["sha256"] for one in (ending.document or {}).get("inputs", [])}
    files = {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in t.folder.rglob("*") if file.name in t.work.named}
    t.expect(said == files, f"it names {sorted(said)}, it has read {sorted(files)}" if set(said) != set(files) else "another SHA-256")


def inputs_read_once(t):
    """Opens every input once."""
    watch = Watch([t.folder, t.folder / "references"], IN_OPEN)
    t.run_well()
    names = watch.names()
    watch.close()
    times = (1, 2) if t.entry.name == "mpi" else (1,)  # by each rank, which may be at the same moment
    for name in t.work.named:
        t.expect(names.count(name) in times, f"{name} is opened {names.count(name)} times")


def inputs_not_replaced(t):
    """Overwrites no input: rejects a folder in which a result would replace one, with status 2."""
    for name in t.few(t.outputs()):
        t.clear()
        (t.folder / "out").mkdir()
        for one in t.work.named[1:]:
            file = next(t.folder.rglob(one))
            shutil.copyfile(file, t.folder / "out" / one)
        place = t.folder / "out" / name
        shutil.copyfile(t.folder / t.work.words[0], place)
        before = tree(t.folder)
        ending = t.run(words=[f"out/{name}", *t.work.words[1:]])
        t.expect(ending.status == 2, f"an input of the name {name}: status {ending.status} ({short(ending.message)})")
        after = tree(t.folder)
        t.expect(after == before, f"an input of the name {name}: changed {differences(before, after)}")


# Streams and files


def streams(t):
    """Loses no result when a standard stream is full or closed; a result that was requested on such a stream fails with status 1."""
    silent = "progress" if t.entry.name == "python" else False
    first = t.run_well(json_too=silent, out="whole")
    whole = written(t.folder / "whole") if t.writes() else None
    slow = t.entry.name == "command" and first.seconds > 0.5
    for redirection in (">&- 2>&- <&-", ">/dev/full 2>/dev/full") if slow else ("2>/dev/full", "2>&-", ">&- 2>&- <&-", ">/dev/full"):
        t.clear()
        ending = t.run(json_too=silent, streams=redirection)
        t.expect(ending.status == 0, f"{redirection}: status {ending.status} ({short(ending.message)})")
        if "2>&-" in redirection:
            t.expect(t.entry.name != "python" or ending.printed == "", f"{redirection}: progress goes to standard output: {short(ending.printed)}")
        if whole is not None and (t.folder / "out").exists():
            got = written(t.folder / "out")
            # A starter set and a law name the folder that they go to.
            equal = got.keys() == whole.keys() if t.verb in ("new", "export") else got == whole
            t.expect(equal, f"{redirection}: {differences(got, whole)} differ")
    if t.entry.name == "command" and t.work.json:
        for redirection in (">/dev/full",) if slow else (">&-", ">/dev/full"):
            ending = t.run(streams=redirection)
            t.expect(ending.status == 1, f"--json {redirection}: status {ending.status}")


def prints_nothing(t):
    """Prints nothing."""
    ending = t.run_well()
    t.expect(ending.printed == "", f"printed {short(ending.printed)}")
    words, given = (t.work.stopped or t.work.mistakes[0][:2])
    ending = t.run(words=words, given=given)
    t.expect(ending.printed == "", f"printed {short(ending.printed)}")


def killed_while_writing(t):
    """Leaves only complete files when it is killed while writing; the same call then succeeds."""
    out = t.folder / "out"
    given = {"cases": 60} if t.verb == "sweep" else {}
    t.run_well(given=given, out="whole")
    whole = written(t.folder / "whole")
    for moment, delay in ((0, 0.0), (1, 0.001)):
        t.clear()
        out.mkdir()
        watch = Watch([out], IN_CREATE)
        running = t.start(given=given)
        seen = 0
        while running.process.poll() is None:
            seen += sum(name.endswith(".tmp") for name in watch.names())
            if seen > moment:
                time.sleep(delay)
                kill_all(running)
            time.sleep(0.0002)
        watch.close()
        running.finish()
        try:
            left = written(out)
        except ValueError as error:
            t.expect(False, f"half a file: {error}")
            continue
        for name, content in left.items():
            if name.endswith(".html"):
                t.expect((out / name).read_text().rstrip().endswith("</html>"), f"half a {name}")
            elif not pathlib.Path(name).name.startswith("."):
                t.expect(content == whole.get(name) or t.verb in ("new", "export"), f"half a {name}")  # their files contain the folder's name
    if t.verb == "new":
        t.clear()
    t.run_well(given=given)
    temporary = [f.name for f in out.rglob(".*.tmp")]
    t.expect(not temporary, f"left {temporary}")


def killed_sweep_resumes(t):
    """Resumes a killed sweep: no case is lost or run twice, and the files have the same bytes."""
    given = {"cases": 300}
    journal = t.folder / "out/cases.journal"
    whole = t.run_well(given=given, out="whole")
    for wanted in (15, 120):
        running = t.start(given=given)
        wait_for_cases(running, journal, wanted)
        kill_all(running)
        running.finish()
    again = t.run_well(given=given)
    lines = [line.split()[0] for line in journal.read_bytes().splitlines()[1:]]
    t.expect(len(lines) == len(set(lines)) == 300, f"{len(lines)} lines of {len(set(lines))} cases")
    one, other = (written(t.folder / name) for name in ("whole", "out"))
    t.expect(one == other, f"{differences(one, other)} differ")
    t.expect(same(whole, again), "another result")


def ticks_of_threads(pid):
    """Returns the processor time of every thread of a process [ticks]."""
    ticks = {}
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            ticks[int(task.name)] = int((task / "stat").read_text().rsplit(")", 1)[1].split()[11])
    return ticks


def fault_in_busiest_thread(pid):
    """Sends SIGSEGV to the thread that uses the most processor time now: the one that runs cases. A rank has another for its messages."""
    with contextlib.suppress(FileNotFoundError, ProcessLookupError, ValueError):
        before = ticks_of_threads(pid)
        time.sleep(0.15)
        worked = {thread: ticks - before.get(thread, 0) for thread, ticks in ticks_of_threads(pid).items()}
        tgkill = 234 if os.uname().machine == "x86_64" else 131
        ctypes.CDLL(None).syscall(tgkill, pid, max(worked, key=worked.get), int(signal.SIGSEGV))


def fault_is_named(t):
    """Names the case that ended the process by a fault; the same call resumes without that case."""
    given = {"cases": 4000 if t.entry.name == "mpi" else 600}
    journal = t.folder / "out/cases.journal"
    said = ""
    for _ in range(5 if t.entry.name == "mpi" else 8):  # the signal may arrive between two cases
        running = t.start(given=given, threads=1)
        wait_for_cases(running, journal, lines_of(journal) + 10)
        ranks = running.children()
        fault_in_busiest_thread(ranks[-1] if t.entry.name == "mpi" and ranks else running.process.pid)
        said = running.finish().printed
        if " ended the process by SIGSEGV" in said:
            break
    number = re.search(r"case (\d+) ended the process by SIGSEGV", said)
    if t.expect(number, f"no case is named: {short(said)}"):
        lines = journal.read_bytes()
        t.expect(b"crashed" in lines, "the journal does not have it")
        again = t.run_well(given=given)
        t.expect((again.document or {}).get("statuses", {}).get("crashed") == 1, "it was run again")


def changed_sweep_is_rejected(t):
    """Rejects the folder of a sweep whose input has changed, and writes nothing."""
    t.run_well()
    push = t.folder / "push.toml"
    push.write_text(push.read_text().replace("diameter_mm = 1.5", "diameter_mm = 1.4"))
    before = tree(t.folder)
    ending = t.run()
    t.expect(ending.status == 2, f"status {ending.status} ({short(ending.message)})")
    t.expect("cases.journal" in ending.message, f"the reason is: {short(ending.message)}")
    after = tree(t.folder)
    t.expect(after == before, f"changed {differences(before, after)}")


# Results


def plain_result(ending):
    """Returns the document and the tables as text, without clock times and paths."""
    document = timeless(ending.document)
    if isinstance(document, dict):
        document.pop("histories", None)
    return json.dumps([document, ending.more.get("tables")], sort_keys=True)


def same(one, other):
    return plain_result(one) == plain_result(other)


def same_bytes(t):
    """Gives the same bytes with one thread, two threads and two ranks."""
    one = (t.command if t.entry.name == "mpi" else t.entry).run(t.verb, t.work, t.folder, threads=1, out="one")
    two = t.run(threads=2, out="two")
    t.expect(one.status == two.status == 0, f"statuses {one.status}, {two.status}: {short(one.message)} {short(two.message)}")
    if t.work.json or not t.writes():
        t.expect(same(one, two), "another result")
    if t.writes():
        files = [{name: text for name, text in written(t.folder / name).items()} for name in ("one", "two")]
        # Exported models contain the folder's name.
        if t.verb != "export":
            t.expect(files[0] == files[1], f"{differences(*files)} differ")
        t.expect(files[0].keys() == files[1].keys() and files[0], "other files")


def same_as_command(t):
    """Returns the document of the command to the last bit, clock times aside."""
    theirs = t.command.run(t.verb, t.work, t.folder, out="theirs")
    ours = t.run_well()
    one, other = timeless(theirs.document), timeless(ours.document)
    if not isinstance(one, dict) or not isinstance(other, dict):
        t.expect(False, "one of them has no document")
        return
    for document in (one, other):
        document.pop("histories", None)  # a path
    parts = sorted(key for key in one.keys() | other.keys() if one.get(key, "not there") != other.get(key, "not there"))
    t.expect(not parts, "; ".join(f"{key}: " + (f"only of the {'command' if key in one else t.entry.name}" if (key in one) != (key in other)
                                                else "differs") for key in parts))
    if t.verb in ("push", "fit", "trace", "simulate", "sweep") and t.entry.name == "python":
        for table in {"simulate": ["history"], "sweep": ["table"]}.get(t.verb, ["curves"]):
            t.expect(ours.more["tables"].get(table), f"{table} is empty")


def warnings(t):
    """Warns of wires that cannot exist or would break: in the document, and for the command on the console and the page."""
    ending = t.run_well(given=t.work.warned)
    said = (ending.document or {}).get("warnings", [])
    t.expect(any(t.work.warning in one for one in said), f"its warnings are {said}")
    if t.entry.name == "command":
        t.expect(re.search("warning: .*" + re.escape(t.work.warning), ending.message), "not on the console")
        page = html.unescape((t.folder / "out/report.html").read_text()) if (t.folder / "out/report.html").exists() else ""
        t.expect(t.work.warning in page, "not on the page")


CHECKS = {function.__name__: function for function in (
    wrong_input, stopped_solver, partial_result_is_kept, finite, wrong_kinds, interrupt, interrupted_sweep_is_kept, names_taken, folder_of_another,
    holds_its_folder, journal_of_another, leftovers_are_removed, inputs_named, inputs_read_once, inputs_not_replaced, streams, prints_nothing,
    killed_while_writing, killed_sweep_resumes, fault_is_named, changed_sweep_is_rejected, same_bytes, same_as_command, warnings)}

if __name__ == "__main__":
    print(*CHECKS, sep="\n")
