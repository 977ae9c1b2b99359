#!/usr/bin/env python3
"""The manual page and the completions say what the command's help says, and complete.

usage: command_help_test.py REPOSITORY SNARE
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT, SNARE = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
FOLDER = ROOT / "docs/command"


def completed(*words, folder="/"):
    """What bash would offer for the last of these words."""
    script = f"""source {FOLDER}/snare.bash
COMP_WORDS=({' '.join(repr(w) for w in words)}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _snare; printf '%s\\n' "${{COMPREPLY[@]}}" """
    run = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, check=True)
    return set(run.stdout.split())


class CommandHelp(unittest.TestCase):
    def test_they_are_what_the_help_says(self):
        run = subprocess.run([sys.executable, "-B", str(ROOT / "scripts/command_help.py"), SNARE, "--check"], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stdout), (0, ""), run.stderr)

    def test_bash_completes_verbs_options_and_files(self):
        self.assertEqual(completed("snare", "si"), {"simulate"})
        self.assertEqual(completed("snare", "sweep", "--c"), {"--case"})
        self.assertEqual(completed("snare", "new", "c"), {"capture"})
        self.assertEqual(completed("snare", "arm", "s"), {"show"})
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.toml", "a.csv", "a.urdf"):
                (pathlib.Path(folder) / name).touch()
            (pathlib.Path(folder) / "apart").mkdir()
            self.assertEqual(completed("snare", "push", "a", folder=folder), {"a.toml", "apart"})
            self.assertEqual(completed("snare", "arm", "show", "a", folder=folder), {"a.toml", "a.urdf", "apart"})
            self.assertEqual(completed("snare", "push", "--out", "a", folder=folder), {"apart"})

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_reads_its_file(self):
        script = f"autoload -Uz compinit; compinit -u -D; source {FOLDER}/_snare; whence -w _snare; print $_comps[snare]"
        run = subprocess.run(["zsh", "-f", "-c", script], capture_output=True, text=True)
        self.assertEqual((run.stdout.split(), run.stderr), (["_snare:", "function", "_snare"], ""))

    @unittest.skipUnless(shutil.which("man"), "man is not installed")
    def test_the_page_is_shown_without_complaint(self):
        run = subprocess.run(["man", "--warnings", "-l", str(FOLDER / "snare.1")], capture_output=True, text=True, env={"PATH": "/usr/bin:/bin", "MANWIDTH": "100"})
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertIn("EXIT STATUS", run.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
