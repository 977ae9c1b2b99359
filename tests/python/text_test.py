"""Text of a user's file in what is written and said: data wherever it stands, never code."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import mo_reader
import setting
import tables

CONTROLS = "".join(f"{chr(k)}raise SystemExit('ran {k}')" for k in [*range(0x20), 0x7F, 0x85, 0x9B, 0x2028, 0x2029, 0x202E, 0xFFFE, 0xFFFF])
TITLES = [
    CONTROLS,
    "coding: no-such-encoding",
    "-*- coding: utf-16 -*- é */ int broken( /*/ a quote \" and ' and \\\"; end snare_law; package other \" \"\"\" ''' ${x} %s {} @name@ \\",
    "--> <mujoco model=\"other\"/> <!-- - -- --- & <b> ]]> -! SPLINE/9\n, X=1,2,3,4\n, Y=1,2,3,4\nEND & in a trigraph ??/",
]


def toml_string(text):
    return '"' + "".join(c if c.isascii() and c.isalnum() else f"\\U{ord(c):08x}" for c in text) + '"'


class Text(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)
        self.wire = setting.small_wire(self.out, "\n[table]\npoints = [5, 3, 2]\nmost_points = [5, 3, 2]\n[solver]\nelements = 16\n")

    def distil(self, wire, *arguments):
        subprocess.run([setting.COMMAND, "distil", wire, "--out", self.out / "o", "--quiet", "--set", "laws.positions_mm=[52.5]", "--set",
                        "laws.displacement_offsets_mm=[0.0]", *arguments],
                       check=True)
        return self.out / "o"

    def check_exports(self, out, title):
        def done(*command):
            run = subprocess.run(command, cwd=out, capture_output=True, text=True)
            self.assertEqual((run.returncode, run.stdout), (0, ""), (title, run.stderr))

        done("gcc", "-std=c99", "-trigraphs", "-Wall", "-Wextra", "-Werror", "-include", "law.h", "-c", "law.c", "-o", "law.o")
        (out / "main.cpp").write_text('#include "law.hpp"\nint main() { return snare_law::force(1e-3, 0.05, 0.49e-3) > 0.0 ? 0 : 1; }\n')
        done("g++", "-std=c++17", "-trigraphs", "-Wall", "-Wextra", "-Werror", "main.cpp", "-o", "main")
        done("./main")
        done(sys.executable, "-B", "-W", "error", "-c", "import law; assert law.force(1e-3, 0.05, 0.49e-3) > 0.0")
        root = xml.etree.ElementTree.fromstring((out / "law_mujoco.xml").read_bytes())
        self.assertEqual((root.tag, len(root.findall(".//worldbody//joint"))), ("mujoco", 1), title)
        package = mo_reader.load((out / "law.mo").read_text())
        self.assertGreater(package["force"](1e-3, 0.05, 0.49e-3), 0.0)
        self.assertEqual(sorted(tables.adams_splines((out / "law_adams.adm").read_text())), [1, 2], title)
        for name in ("law.c", "law.h", "law.hpp", "law.py", "law.mo", "law_mujoco.xml", "law_mujoco_linear.xml", "law_adams.adm", "law_simulink.csv", "report.html"):
            written = (out / name).read_bytes().decode()  # UTF-8
            self.assertFalse([c for c in written if ord(c) < 0x20 and c not in "\t\n" or 0x7F <= ord(c) < 0xA0 or ord(c) in (0x2028, 0x202E, 0xFFFE)],
                             (title, name))

    def test_a_title_is_no_code_in_any_export(self):
        for title in TITLES:
            out = self.distil(self.wire, "--set", f"title={toml_string(title)}")
            self.check_exports(out, title)
            self.assertEqual(json.loads((out / "law.json").read_text())["title"], title)  # data stay what they are

    def test_nor_is_the_name_of_a_file(self):
        text = "".join(line for line in self.wire.read_text().splitlines(True) if not line.startswith("title"))
        named = self.out / "x\rraise SystemExit('ran')\x1b[31m*\\--.toml"
        named.write_text(text)
        self.check_exports(self.distil(named), named.name)

    def test_escape_sequences_do_not_reach_a_terminal(self):
        escape = "\x1b]0;owned\x07\x1b[31m"
        wrong = self.out / "wrong.toml"
        wrong.write_text(self.wire.read_text().replace("[wire]", f"[wire]\n{toml_string(escape)} = 1", 1))
        for arguments in (["distil", wrong], ["distil", self.wire, "--set", f"wire.{escape}=1"], ["distil", self.wire, "--set", escape],
                          ["distil", self.out / escape], [escape], ["distil", f"--{escape}"], ["arm", "show", self.out / escape]):
            out = [] if arguments[0] == "arm" else ["--out", self.out / "no"]  # `arm show` writes nothing
            run = subprocess.run([setting.COMMAND, *arguments, *out], capture_output=True, text=True)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertNotIn("\x1b", run.stderr + run.stdout, arguments)
            self.assertIn("\\x1b", run.stderr, arguments)

    def test_a_printed_command_is_the_command_for_any_shell(self):
        folder = self.out / "it's $(touch ran) \"a\" ; b"
        folder.mkdir()
        tables = self.wire.read_text().replace("snare-wire/1", "snare-experiment/1").split("[ranges]")[0]
        (folder / "case.toml").write_text(tables + '[[series]]\nname = "it"\ncontact_position_mm = 60.0\ntravel_mm = 0.5\npoints = 2\n'
                                          '[solver]\nelements = 16\n')
        (folder / "sweep.toml").write_text('schema = "snare-sweep/1"\ncase = "case.toml"\ndesign = "latin_hypercube"\ncases = 2\n'
                                           '[set]\ntitle = "don\'t; echo \\"x\\""\n'
                                           '[[vary]]\nkey = "wire.length_mm"\nuniform = [175.4, 175.6]\n'
                                           '[collect]\nforce = "series[it].largest_force_N"\n[[limits]]\nof = "force"\nabove = 5.0\n')
        sweep = subprocess.run([setting.COMMAND, "sweep", folder / "sweep.toml", "--out", self.out / "s", "--quiet"], capture_output=True, text=True)
        self.assertEqual(sweep.returncode, 0, sweep.stderr)
        commands = [one["command"] for one in json.loads((self.out / "s/summary.json").read_text())["worst"]]
        self.assertTrue(commands)
        for command in commands:
            run = subprocess.run(["sh", "-c", f'snare() {{ "{setting.COMMAND}" "$@" --quiet --out "{self.out}/w"; }}; {command}'],
                                 cwd=self.out, capture_output=True, text=True)
            self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""), command)
        self.assertFalse((self.out / "ran").exists())


if __name__ == "__main__":
    setting.main()
