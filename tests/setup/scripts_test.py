"""What ./run says and does before the command starts, with stubs of apt-get, dpkg-query, cmake and ninja.

    scripts_test.py REPOSITORY
"""

import os
import pathlib
import pty
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(sys.argv.pop() if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])

# Each stub appends its call to $LOG. Packages are installed once apt-get install was called without --print-uris.
STUBS = {
    "dpkg-query": """[ -f "$STATE/installed" ] || exit 1
for package in "$@"; do case $package in -*) ;; *) echo "installed $package" ;; esac; done""",
    "apt-get": """case " $* " in
  *" --print-uris "*) echo "1 upgraded, 159 newly installed, 0 to remove and 5 not upgraded."
     echo "Need to get 120 MB/141 MB of archives."; echo "After this operation, 727 MB of additional disk space will be used." ;;
  *" install "*) echo "dlstatus:1:50.0:Retrieving"; echo "pmstatus:g++:75.5:Unpacking"; touch "$STATE/installed" ;;
esac""",
    "sudo": """[ "$1" = -n ] && shift; [ -f "$STATE/no_sudo" ] && exit 1; exec "$@\"""",
    "cmake": """case $1 in
  --fresh) mkdir -p build/release; touch build/release/build.ninja ;;
  --build) [ -f "$2/$4" ] && { echo "ninja: no work to do."; exit 0; }
     [ -f "$STATE/no_$4" ] && { echo "FAILED: $4"; exit 1; }
     echo "[1/2] Building CXX object wire/mesh.cpp.o"; echo "a warning of the compiler"; echo "[2/2] Linking CXX executable snare"
     if [ "$4" = snare_first ]; then say='echo "command first" | tee -a "$STATE/log"'; else say='echo "command $*"'; fi
     printf '#!/bin/sh\\n%s\\nexit ${STATUS:-0}\\n' "$say" > "$2/$4"; chmod +x "$2/$4"
     (cd "$2" && touch a1.cpp.o a2.cpp.o a3.cpp.o a4.cpp.o)
     echo line >> "$2/.ninja_log" ;;
esac""",
    "ninja": "for i in 1 2 3 4 5 6 7 8 9 10; do echo \"g++ -o a$i.cpp.o -c a$i.cpp\"; done",
}


class Scripts(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        root = self.folder / "clone"
        (root / "build/debian/usr/include/idas").mkdir(parents=True)  # SUNDIALS is there
        (root / "build/debian/usr/include/idas/idas.h").touch()
        shutil.copy(ROOT / "run", root)
        shutil.copy(ROOT / "CMakePresets.json", root)
        shutil.copytree(ROOT / "scripts", root / "scripts")
        tools = self.folder / "tools"
        tools.mkdir()
        for name, text in STUBS.items():
            (tools / name).write_text(f'#!/bin/sh\necho "{name} $*" >> "$STATE/log"\n{text}\n')
            (tools / name).chmod(0o755)
        for path in [self.folder, *self.folder.rglob("*")]:
            path.chmod(0o777)
        self.run_script = root / "run"
        self.environment = {"PATH": f"{tools}:/usr/bin:/bin", "STATE": str(self.folder), "CMAKE_BUILD_PARALLEL_LEVEL": "2"}

    def run_it(self, *arguments, prefix=(), **more):
        return subprocess.run([*prefix, self.run_script, *arguments], env={**self.environment, **more}, capture_output=True,
                              text=True)

    def calls(self):
        log = self.folder / "log"
        return log.read_text() if log.exists() else ""

    def test_a_first_call_says_what_it_installs_and_builds_before_it_does(self):
        run = self.run_it()
        self.assertEqual((run.returncode, run.stdout), (0, "command first\n"), run.stderr)
        lines = run.stderr.splitlines()
        self.assertTrue(lines[0].startswith("Installing the Debian packages "), run.stderr)
        self.assertIn("160 packages, 120 MB to download, 727 MB on disk", lines[1])
        self.assertRegex(lines[2], r"^Building .*/build/release: 10 compilations by 2 processors, some \d+ minutes")
        self.assertEqual(lines[3], "a warning of the compiler")
        self.assertIn("Now the rest of the command is built.", run.stderr)
        self.assertEqual(lines[-1], f"For `import snare` in Python run: {self.run_script.parent}/scripts/install_python.sh")
        self.assertNotIn("step [", run.stderr)
        # The first result comes before the rest is built.
        calls = self.calls()
        self.assertLess(calls.index("--target snare_first"), calls.index("command first"))
        self.assertLess(calls.index("command first"), calls.index("--target snare\n"))
        self.assertNotIn(" clang ", self.calls())
        self.assertLess(self.calls().index("--print-uris"), self.calls().index("install -y --no"))

    def test_a_second_call_does_no_set_up_and_says_nothing(self):
        self.run_it()
        before = self.calls()
        start = time.monotonic()
        run = self.run_it("push", "my.toml")
        self.assertLess(time.monotonic() - start, 1.0)  # the promise; some 50 ms with the stubs
        self.assertEqual((run.stdout, run.stderr), ("command push my.toml\n", ""))
        again = self.calls()[len(before):]
        self.assertNotIn("apt-get", again)
        self.assertNotIn("--fresh", again)

    def test_quiet_and_the_exit_status_are_the_commands(self):
        run = self.run_it("push", "my.toml", "--quiet", STATUS="3")
        self.assertEqual((run.returncode, run.stdout), (3, "command push my.toml --quiet\n"))
        self.assertNotIn("import snare", run.stderr)
        again = self.run_it(STATUS="4")
        self.assertEqual((again.returncode, again.stdout), (4, "command reproduce --out out/reproduce\n"))

    def test_the_status_of_the_first_result_is_kept(self):
        self.assertEqual(self.run_it(STATUS="4").returncode, 4)

    def test_where_the_first_program_cannot_be_built_the_command_makes_the_result(self):
        (self.folder / "no_snare_first").touch()
        run = self.run_it()
        self.assertEqual((run.returncode, run.stdout), (0, "command reproduce --out out/reproduce\n"), run.stderr)

    def test_without_root_it_names_the_packages_and_stops(self):
        (self.folder / "no_sudo").touch()
        prefix = ("setpriv", "--reuid=65534", "--clear-groups") if os.geteuid() == 0 else ()
        run = self.run_it(prefix=prefix)
        self.assertEqual((run.returncode, run.stdout), (1, ""))
        self.assertEqual(run.stderr.count("These Debian packages are missing: cmake g++ "), 1, run.stderr)
        self.assertIn("apt-get update && apt-get install -y --no-install-recommends cmake g++ ", run.stderr)
        self.assertNotIn("cmake --", self.calls())
        self.assertNotIn("install -y --no", self.calls())

    def test_progress_is_for_terminals(self):
        reader, writer = pty.openpty()
        process = subprocess.Popen([self.run_script], env=self.environment, stdout=subprocess.DEVNULL, stderr=writer)
        process.wait()
        os.close(writer)
        text = ""
        try:
            while part := os.read(reader, 65536):
                text += part.decode()
        except OSError:  # the end of a terminal that nobody writes to any more
            pass
        for part in ("downloaded 50 %", "installed 75 %", "step [1/2]", "a warning of the compiler", "import snare"):
            self.assertIn(part, text)
        os.close(reader)


if __name__ == "__main__":
    unittest.main(verbosity=2)
