#!/usr/bin/env python3
"""Fuzzes all readers with libFuzzer: experiment files, CSV, URDF, STL, OBJ, OFF, the bytes of checkpoints.

    fuzz.py [--seconds 3600] [--build DIR] [--keep]

Builds with Debian's clang (packages clang, libclang-rt-dev) under the address and undefined-behaviour sanitizers. Begins with the
shipped files and tests/fuzz/corpus; the first byte of an input chooses the reader. `--keep` writes what found something new, made
as small as it goes, into tests/fuzz/corpus. Prints libFuzzer's last words; exits 1 where an input breaks a reader, which is then in
DIR, and 77 where there is no clang.
"""

import argparse
import concurrent.futures
import pathlib
import shutil
import struct
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = ["tests/fuzz/readers_libfuzzer.cpp", "base/errors.cpp", "base/range.cpp", "base/files.cpp", "base/csv.cpp",
           "base/archive.cpp", "base/toml_tree.cpp", "base/toml_reader.cpp", "wire/specification.cpp",
           "scenario/push_reader.cpp", "coupling/contact/mesh_file.cpp", "multibody/urdf.cpp", "multibody/urdf_checks.cpp",
           "multibody/tree.cpp", "multibody/spatial.cpp", "identification/fitting/experiment.cpp",
           "identification/fitting/parameter.cpp", "identification/fitting/parameter_set.cpp",
           "identification/fitting/construction_numbers.cpp"]
FLAGS = ["-std=c++20", "-g", "-O1", "-fsanitize=fuzzer-no-link,address,undefined", "-fno-sanitize-recover=all", "-I.",
         "-isystem", "/usr/include/eigen3"]
LIBRARIES = ["-lfmt", "-lurdfdom_model", "-lconsole_bridge", "-ltinyxml"]


def build(clang, folder):
    sources = SOURCES + [str(p.relative_to(ROOT)) for p in sorted((ROOT / "identification/effects").glob("*.cpp"))]

    def compiled(source):
        made = folder / (source.replace("/", "_") + ".o")
        if not made.exists() or made.stat().st_mtime < (ROOT / source).stat().st_mtime:
            subprocess.run([clang, *FLAGS, "-c", source, "-o", str(made)], cwd=ROOT, check=True)
        return str(made)

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        objects = list(pool.map(compiled, sources))
    program = folder / "readers_fuzzer"
    subprocess.run([clang, "-fsanitize=fuzzer,address,undefined", *objects, *LIBRARIES, "-o", str(program)], check=True)
    return program


def seeds():
    """Shipped files and small ones of the formats that no shipped file has, each behind the letter of its reader."""
    for file in [*(ROOT / "data/experiments").glob("*.toml"), *(ROOT / "tests/ranges").glob("*.toml")]:
        yield b"e" + file.read_bytes()
    for file in (ROOT / "data/published").glob("*.csv"):
        yield b"c" + file.read_bytes()[:4000]
    yield b"cdisplacement_mm,force_N,time_s\n0,0,0\n0.1,\"0.5\",1 # more\n"
    for file in (ROOT / "data/arms").glob("*.urdf"):
        yield b"u" + file.read_bytes()
    yield (b"ssolid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
           b"endsolid a\n")
    yield b"s" + bytes(80) + struct.pack("<I12fH", 1, *([0.0] * 3), 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    yield b"bv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf 1/1/1 2//2 -1\n"
    yield b"fOFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n4 0 1 2 3\n"
    yield b"a" + struct.pack("<Q2sQQQ3sQQQ3dQQ2d", 2, b"ab", 1, 1, 3, b"abc", 1, 3, 1, 1.0, 2.0, 3.0, 2, 1, 1.0, 2.0)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=int, default=3600)
    parser.add_argument("--build", default=str(ROOT / "build/fuzz"))
    parser.add_argument("--keep", action="store_true")
    options = parser.parse_args()
    clang = shutil.which("clang++")
    if clang is None:
        print("no clang++: apt-get install clang libclang-rt-dev")
        return 77
    folder = pathlib.Path(options.build)
    found = folder / "found"
    found.mkdir(parents=True, exist_ok=True)
    program = build(clang, folder)
    given = folder / "seeds"
    shutil.rmtree(given, ignore_errors=True)
    given.mkdir()
    for number, seed in enumerate(seeds()):
        (given / str(number)).write_bytes(seed)
    kept = ROOT / "tests/fuzz/corpus"
    kept.mkdir(exist_ok=True)
    run = subprocess.run([str(program), str(found), str(given), str(kept), "-max_len=20000", "-timeout=20",
                          "-rss_limit_mb=4000", f"-max_total_time={options.seconds}", "-print_final_stats=1",
                          f"-artifact_prefix={folder}/"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    words = run.stdout.decode(errors="replace").splitlines()
    print("\n".join(words[-12:] if run.returncode == 0 else words[-60:]))
    if options.keep and run.returncode == 0:
        subprocess.run([str(program), "-merge=1", "-max_len=2000", str(kept), str(found)], check=True,
                       stderr=subprocess.DEVNULL)
        print(len(list(kept.iterdir())), "inputs are kept")
    return 1 if run.returncode != 0 else 0


if __name__ == "__main__":
    sys.exit(main())
