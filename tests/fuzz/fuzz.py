#!/usr/bin/env python3
"""Fuzzes all readers with libFuzzer: experiment, wire, scenario, arm, ring-down, record and sweep files, CSV, URDF, STL, OBJ, OFF,
laws, the bytes of checkpoints, the journal of a sweep.

    fuzz.py [--seconds 3600] [--build DIR] [--keep]

Builds two programs with Debian's clang (packages clang, libclang-rt-dev) under the address and undefined-behaviour sanitizers, which
share the seconds: small readers by themselves, and those that need the whole product, linked with the libraries of build/release (only
the readers themselves are watched there). Begins with the shipped files and tests/fuzz/corpus; the first byte of an input chooses the
reader. tests/fuzz/corpus has an archive of inputs for each reader; `--keep` adds what found something new, made as small as it goes.
Prints libFuzzer's last words; exits 1 where an input breaks a reader, which is then in DIR, and 77 where there is no clang.
"""

import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORPUS = ROOT / "tests/fuzz/corpus"
READERS = {"c": "csv", "e": "experiment", "u": "urdf", "s": "stl", "b": "obj", "f": "off", "a": "archive", "S": "scenario", "R": "record",
           "A": "arm", "W": "sweep", "D": "ringdown", "I": "wire", "J": "journal", "L": "law", "K": "checkpoint"}
SOURCES = ["tests/fuzz/readers_libfuzzer.cpp", *(str(p.relative_to(ROOT)) for p in sorted((ROOT / "base").glob("*.cpp"))), "wire/specification.cpp",
           "scenario/push_reader.cpp", "coupling/contact/mesh_file.cpp", "multibody/urdf.cpp", "multibody/urdf_checks.cpp",
           "multibody/tree.cpp", "multibody/spatial.cpp", "identification/fitting/experiment.cpp",
           "identification/fitting/parameter.cpp", "identification/fitting/parameter_set.cpp",
           "identification/fitting/construction_numbers.cpp", "identification/fitting/legs.cpp",
           "identification/fitting/unfitted_keys.cpp"]
FLAGS = ["-std=c++20", "-gline-tables-only", "-O1", "-fsanitize=fuzzer-no-link,address,undefined", "-fno-sanitize-recover=all", "-I.",
         "-isystem", "/usr/include/eigen3"]
MORE_FLAGS = ["-isystem", "/usr/include/suitesparse", "-DEIGEN_DONT_PARALLELIZE", "-DFMT_SHARED", "-DTOML_HEADER_ONLY=0",
              "-DTOML_SHARED_LIB=1", f'-DSNARE_SOURCE_DIR="{ROOT}"']
CACHE = [tool for tool in [shutil.which("ccache")] if tool]
LIBRARIES = ["-lgomp", "-lfmt", "-ltomlplusplus", "-lurdfdom_model", "-lconsole_bridge", "-ltinyxml"]


# The readers of files that name others; what they need beside is linked as it is.
FILE_SOURCES = ["tests/fuzz/files_libfuzzer.cpp", "base/csv.cpp", "base/archive.cpp", "base/toml_tree.cpp", "base/toml_reader.cpp",
                "scenario/scenario.cpp", "scenario/include.cpp", "scenario/composed_scenario.cpp", "scenario/composition.cpp", "scenario/phase_reader.cpp",
                "scenario/sensor_reader.cpp", "scenario/snare_items.cpp", "scenario/distilled_law.cpp",
                "identification/records/record_file.cpp", "study/sweep_file.cpp", "study/journal.cpp", "study/case_record.cpp",
                "study/collect.cpp", "app/motion_checkpoint.cpp"]


def libraries():
    """As the optimised command is linked, paths from the top."""
    ninja = (ROOT / "build/release/build.ninja").read_text()
    line = re.search(r"LINK_LIBRARIES = (app/libsnare_app\.a .*)", ninja).group(1)
    return [f"build/release/{p}" if p.endswith(".a") and not p.startswith("/") else p for p in line.replace("$:", ":").split()]


def is_current(made, needs):
    """Whether an object is newer than all that it was made of, as the compiler wrote it down."""
    if not made.exists() or not needs.exists():
        return False
    files = needs.read_text().split(":", 1)[1].replace("\\\n", " ").split()
    return all((ROOT / f).exists() and (ROOT / f).stat().st_mtime <= made.stat().st_mtime for f in files)


def build(clang, folder, name, sources, linked):
    def compiled(source):
        made, needs = source.with_suffix(".o"), source.with_suffix(".d")
        if not is_current(made, needs):
            subprocess.run([*CACHE, clang, *FLAGS, *MORE_FLAGS, "-MD", "-MF", str(needs), "-c", str(source), "-o", str(made)], cwd=ROOT, check=True)
        return str(made)

    # Sources of a folder are joined, as the product's are: headers take most of the time to compile each.
    by_folder = {}
    for source in sources:
        by_folder.setdefault(os.path.dirname(source), []).append(source)
    joined = []
    for place, members in by_folder.items():
        file = folder / f"{name}_{place.replace('/', '_')}.cpp"
        text = "".join(f'#include "{source}"\n' for source in members)
        if not file.exists() or file.read_text() != text:
            file.write_text(text)
        joined.append(file)

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        objects = list(pool.map(compiled, joined))
    program = folder / name
    # Where the libraries' sources are joined, what is asked of one brings in its neighbours, which are here already: the first counts.
    subprocess.run([clang, "-fsanitize=fuzzer,address,undefined", "-Wl,--allow-multiple-definition", *objects, *linked, "-o",
                    str(program)], cwd=ROOT, check=True)
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
    for letter, files in [(b"S", [*(ROOT / "data/scenarios").glob("*.toml"), ROOT / "tests/ranges/composed.toml"]),
                          (b"R", [ROOT / "tests/ranges/record.toml"]), (b"A", (ROOT / "data/arms").glob("*.toml")),
                          (b"W", [ROOT / "tests/ranges/sweep.toml", *(ROOT / "data/sweeps").glob("*.toml")]),
                          (b"D", (ROOT / "data/experiments").glob("ringdown.toml")), (b"I", (ROOT / "data/wires").glob("*.toml"))]:
        for file in files:
            yield letter + file.read_bytes()
    yield b"Jsnare-journal/1 identity\n"
    yield b"L{}"
    yield b"K" + struct.pack("<QQ?", 0, 0, False)
    yield b"a" + struct.pack("<Q2sQQQ3sQQQ3dQQ2d", 2, b"ab", 1, 1, 3, b"abc", 1, 3, 1, 1.0, 2.0, 3.0, 2, 1, 1.0, 2.0)


def unpack(folder):
    """Writes the inputs of every archive of the corpus into an empty folder."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for archive in sorted(CORPUS.glob("*.zip")):
        with zipfile.ZipFile(archive) as packed:
            packed.extractall(folder)


def pack(folder):
    """Writes an archive for each reader from the inputs of a folder. The same inputs give the same bytes."""
    inputs = {}
    for file in sorted(folder.iterdir()):
        inputs.setdefault(READERS[chr(file.read_bytes()[0])], []).append(file)
    for reader, files in inputs.items():
        with zipfile.ZipFile(CORPUS / f"{reader}.zip", "w", zipfile.ZIP_DEFLATED, compresslevel=9) as packed:
            for file in files:
                packed.writestr(zipfile.ZipInfo(file.name), file.read_bytes(), zipfile.ZIP_DEFLATED)


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
    effects = [str(p.relative_to(ROOT)) for p in sorted((ROOT / "identification/effects").glob("*.cpp"))]
    small = build(clang, folder, "readers_fuzzer", SOURCES + effects, LIBRARIES)
    whole = build(clang, folder, "files_fuzzer", FILE_SOURCES, libraries())
    given = folder / "seeds"
    shutil.rmtree(given, ignore_errors=True)
    given.mkdir()
    for number, seed in enumerate(seeds()):
        (given / str(number)).write_bytes(seed)
    kept = folder / "corpus"
    unpack(kept)
    # Libraries that are not watched hand over containers of which the sanitizer knows nothing; what glog keeps is no leak.
    environment = {**os.environ, "ASAN_OPTIONS": "detect_container_overflow=0:detect_leaks=0"}
    failed = 0
    for program in (small, whole):
        run = subprocess.run([str(program), str(found), str(given), str(kept), "-max_len=20000", "-timeout=30",
                              "-rss_limit_mb=4000", f"-max_total_time={options.seconds // 2}", "-print_final_stats=1",
                              f"-artifact_prefix={folder}/"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
                             env=environment if program == whole else None)
        words = run.stdout.decode(errors="replace").splitlines()
        print(program.name, "\n".join(words[-12:] if run.returncode == 0 else words[-60:]), sep="\n", flush=True)
        failed += run.returncode != 0
        if options.keep and run.returncode == 0:
            subprocess.run([str(program), "-merge=1", "-max_len=2000", str(kept), str(found)], check=True,
                           stderr=subprocess.DEVNULL, env=environment)
            pack(kept)
            print(len(list(kept.iterdir())), "inputs are kept")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
