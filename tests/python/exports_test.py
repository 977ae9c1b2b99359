"""Exports of `snare distil` where they go: two laws in one program of C and C++, Modelica, a lookup table."""

import json
import pathlib
import subprocess
import tempfile
import unittest
import warnings

import mo_reader
import setting
import snare
import numpy as np

PLACES = [(0.001, 0.04, 4.9e-4), (0.0023, 0.061, 4.0e-4), (0.0004, 0.12, 5.5e-4), (-0.001, 0.04, 4.9e-4)]
LAWS = ["quadratic", "power", "stretched_wire", "tensioned_wire"]


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        warnings.simplefilter("ignore", snare.OutsideRange)
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        wire = setting.small_wire(cls.out)
        for name, radius in (("left_wire", 6), ("right_wire", 4)):
            setting.run_command("distil", str(wire), "--out", str(cls.out / name), "--set", f'exports.name="{name}"',
                                "--set", f"pusher.radius_mm={radius}", "--set", "pusher.friction=0.2",
                                "--set", "laws.positions_mm=[52.5]", "--set", "laws.displacement_offsets_mm=[0.0]")
        cls.laws = {name: snare.Law(cls.out / name / "law.json") for name in ("left_wire", "right_wire")}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def expected(self):
        """Of both wires: the table at all places, and the simple laws at a travel of 2 mm."""
        values = []
        for name, law in self.laws.items():
            values += [0.0 if d < 0 else float(law.force(d, s, e)) for d, s, e in PLACES]
            content = json.loads((self.out / name / "law.json").read_text())
            simple = {one["name"]: one for one in content["cases"][0]["positions"][0]["laws"]}
            a, b, c = (simple["quadratic"]["parameters"][n]["value"] for n in "ABC")
            values.append((a * 0.002 + b) * 0.002 + c)
        return values

    def test_two_laws_in_one_program(self):
        def calls(own, law_own):
            lines = [f'  printf("%.17g\\n", {own}force({d!r}, {s!r}, {e!r}));' for d, s, e in PLACES]
            return "\n".join([*lines, f'  printf("%.17g\\n", {law_own}quadratic_s52_5(0.002));'])

        both = ("left_wire", "right_wire")
        main = "\n".join(calls(f"{n}_", f"{n}_") for n in both)
        headers = "".join(f'#include "{n}/law.h"\n' for n in both)
        (self.out / "main.c").write_text(f"#include <stdio.h>\n{headers}int main(void) {{\n{main}\n  return 0;\n}}\n")
        (self.out / "main.cpp").write_text(f"#include <cstdio>\n{headers}int main() {{\n{main}\n}}\n")
        inline = "\n".join(calls(f"{n}::", f"{n}::") for n in both)
        (self.out / "inline.cpp").write_text(
            "#include <cstdio>\n" + headers.replace("law.h", "law.hpp") + f"int main() {{\n{inline}\n}}\n")
        warnings = ["-Wall", "-Wextra", "-Werror", "-Wmissing-declarations"]

        def build(*command):
            subprocess.run([*command], cwd=self.out, check=True)

        for n in both:
            # The header declares what the source defines, and nothing else is seen outside.
            build("gcc", "-std=c99", *warnings, "-Wmissing-prototypes", "-include", f"{n}/law.h", "-c", f"{n}/law.c", "-o", f"{n}.o")
            seen = subprocess.run(["nm", "--defined-only", "--extern-only", f"{n}.o"], cwd=self.out, check=True,
                                  capture_output=True, text=True).stdout.split("\n")
            self.assertTrue(all(line.split()[-1].startswith(f"{n}_") for line in seen if line), seen)
        build("gcc", "-std=c99", *warnings, "main.c", "left_wire.o", "right_wire.o", "-lm", "-o", "of_c")
        build("g++", "-std=c++17", *warnings, "main.cpp", "left_wire.o", "right_wire.o", "-o", "of_cpp")
        build("g++", "-std=c++17", *warnings, "inline.cpp", "-o", "inline")
        for program in ("of_c", "of_cpp", "inline"):
            printed = subprocess.run([self.out / program], check=True, capture_output=True, text=True).stdout
            np.testing.assert_allclose([float(v) for v in printed.split()], self.expected(), rtol=1e-12, atol=1e-12)

    def test_the_example_in_c_stops_where_the_work_of_the_wire_is_the_kinetic_energy(self):
        out = self.out / "example"
        out.mkdir()
        wire = setting.small_wire(out, "\n[table]\npoints = [12, 4, 3]\nmost_points = [12, 4, 3]\n")
        setting.run_command("distil", str(wire), "--out", str(out), "--set", 'exports.name="wire"')
        subprocess.run(["gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-DSLACK=0.49e-3", "-I", str(out),
                        str(setting.SOURCE / "examples/use_law.c"), str(out / "law.c"), "-lm", "-o", str(out / "run")], check=True)
        said = subprocess.run([out / "run"], check=True, capture_output=True, text=True).stdout
        deepest, back = (float(line.split(": ")[1].split()[0]) for line in said.strip().splitlines())
        self.assertAlmostEqual(deepest, 2.6581, delta=0.005)  # of the full wire: tests/examples
        self.assertAlmostEqual(back, 1.0, delta=1e-4)

    def test_modelica_says_what_the_library_says(self):
        values = []
        for name in self.laws:
            package = mo_reader.load((self.out / name / "law.mo").read_text())
            self.assertEqual(package["package"], name)
            values += [package["force"](*place) for place in PLACES]
            values.append(package["quadratic_s52_5"](0.002))
            exported = {}
            exec((self.out / name / "law.py").read_text(), exported)
            for law in LAWS:
                self.assertAlmostEqual(package[f"{law}_s52_5"](0.0021), exported[f"{law}_s52_5"](0.0021), places=9)
            for place in PLACES[:3]:
                self.assertAlmostEqual(package["force_unloading"](*place), exported["force_unloading"](*place), places=9)
            self.assertTrue(package["in_range"](*PLACES[0]))
            self.assertFalse(package["in_range"](1.0, *PLACES[0][1:]))
        np.testing.assert_allclose(values, self.expected(), rtol=1e-12, atol=1e-12)

    def test_lookup_table_is_as_near_as_it_says(self):
        for name, law in self.laws.items():
            content = json.loads((self.out / name / "law.json").read_text())["cases"][0]
            stated = content["exports"]["simulink"]["largest_error_N"]
            self.assertLessEqual(stated, content["table"]["error"]["bound_N"])
            numbers = np.genfromtxt(self.out / name / "law_simulink.csv", delimiter=",")
            travel, position, force = numbers[1:, 0], numbers[0, 1:], numbers[1:, 1:]
            self.assertTrue(np.isnan(numbers[0, 0]))  # the empty cell
            self.assertTrue(np.all(np.diff(travel) > 0) and np.all(np.diff(position) > 0))
            self.assertAlmostEqual(position[-1], law.span - position[0], places=12)  # left and right are alike
            random = np.random.default_rng(7)
            d, s = random.uniform(travel[0], travel[-1], 400), random.uniform(position[0], position[-1], 400)
            along = [np.interp(s, position, row) for row in force]
            linear = np.array([np.interp(d[k], travel, [row[k] for row in along]) for k in range(400)])
            error = np.abs(linear - law.force(d, s, content["wire"]["length_mm"] * 1e-3 - content["wire"]["span_mm"] * 1e-3))
            self.assertLess(error.max(), 1.05 * stated)
            self.assertGreater(error.max(), 0.1 * stated)

    def test_names_are_names(self):
        for name, words in (("3rd", "must be a letter"), ("package", "must be no word of C"), ("a-b", "must be a letter")):
            done = subprocess.run([setting.COMMAND, "distil", str(self.out / "wire.toml"), "--out", str(self.out / "no"),
                                   "--set", f'exports.name="{name}"'], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn(f'exports.name = "{name}", {words}', done.stderr)


if __name__ == "__main__":
    setting.main()
