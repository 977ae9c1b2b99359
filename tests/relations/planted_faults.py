#!/usr/bin/env python3
"""Plants faults in the code, one at a time, and asks whether the relations find them.

    planted_faults.py WORKTREE [--build FOLDER] [--files N] [--seed S] [--jobs J] [--only K ...] [--results FILE]

WORKTREE is a second checkout whose release build in FOLDER (build/release) is up to date: it is changed, built and changed back. Every fault meets
N files (40) of the subjects that its part belongs to; files whose relations are broken without the fault do not count. Prints for every fault which
relation found it first; --results writes the list as JSON. Exits 1 where fewer than nine of ten are found.
"""

import argparse
import dataclasses
import json
import pathlib
import subprocess
import sys
import tempfile

BLOCK = 10  # files a run of relations.py, after which a broken relation ends the search
HERE = pathlib.Path(__file__).resolve().parent


@dataclasses.dataclass(frozen=True)
class Fault:
    room: str
    what: str
    file: str
    good: str
    bad: str
    subjects: tuple[str, ...]


FAULTS = [
    Fault("wire", "half the weight of an edge is missing at one vertex", "wire/planar_rod.cpp",
          "    near[r] -= f[r] + half_weight[r];", "    near[r] -= f[r];", ("push",)),
    Fault("wire", "strain energy of an edge by a factor", "wire/planar_rod.cpp",
          "return {force, p.axial_stiffness, 0.5 * force * strain}", "return {force, p.axial_stiffness, 0.6 * force * strain}", ("push",)),
    Fault("wire", "the axial damping of a moving wire gives no force", "wire/motion/rod_forces.cpp",
          "      tension += viscous;\n", "", ("motion",)),
    Fault("wire", "momentum without the share of inertia of a quasi-static wire", "wire/motion/rod_part.cpp",
          "  result.momentum *= share;\n", "", ("motion",)),
    Fault("coupling/statics", "a sign in the transverse force", "coupling/statics/planar_push.cpp",
          "pusher.motion.y() * force.x() - pusher.motion.x() * force.y()", "pusher.motion.y() * force.x() + pusher.motion.x() * force.y()",
          ("push",)),
    Fault("coupling/statics", "the weight of a wire enters the balance of forces with the wrong sign", "coupling/statics/planar_push.cpp",
          "mounts[0] + mounts[1] + force + weight", "mounts[0] + mounts[1] + force - weight", ("push",)),
    Fault("coupling/contact", "a law's energy without its constant", "coupling/contact/law_form.cpp",
          "a_ * std::pow(d, 3) / 3.0 + b_ * std::pow(d, 2) / 2.0 + c_ * d", "a_ * std::pow(d, 3) / 3.0 + b_ * std::pow(d, 2) / 2.0",
          ("motion", "bodies")),
    Fault("coupling/contact", "the viscous part of a bristle is missing", "coupling/contact/friction.cpp",
          "at.bristle + friction.bristle_time * at.sliding", "at.bristle + 0.0 * friction.bristle_time * at.sliding", ("motion", "bodies", "arms")),
    Fault("coupling/dynamics/contact", "a sign in the moment of a contact on a body", "coupling/dynamics/contact/contact_part.cpp",
          "g.R_WB.transpose() * g.arm.cross(force)", "g.R_WB.transpose() * force.cross(g.arm)", ("motion",)),
    Fault("coupling/dynamics/joints", "a bushing's force has no arm about its first frame", "coupling/dynamics/joints/bushing_part.cpp",
          "-s.on_second.moment - now.r.cross(s.on_second.force)", "-s.on_second.moment", ("bodies", "arms")),
    Fault("coupling/dynamics/joints", "a bushing's damping leaves out how its carrier turns", "coupling/dynamics/joints/bushing_part.cpp",
          "u(b.linear - a.linear - a.angular.cross(r))", "u(b.linear - a.linear)", ("bodies", "arms")),
    Fault("coupling/dynamics/joints", "the gyroscopic moment of a body with the wrong sign", "coupling/dynamics/joints/body_part.cpp",
          "inertia * at.rate.segment<3>(spin()) + w.cross(inertia * w)", "inertia * at.rate.segment<3>(spin()) - w.cross(inertia * w)", ("bodies",)),
    Fault("coupling/dynamics/run", "drag of a wire is no outer force", "coupling/dynamics/run/balance.cpp",
          "c.mass_per_length * c.length * motion_.gravity - w.drag;", "c.mass_per_length * c.length * motion_.gravity;", ("motion",)),
    Fault("coupling/dynamics/laws", "friction of a law wire without the velocity of its carriers", "coupling/dynamics/laws/law_wire_part.cpp",
          "frames[from].velocity_at(point) * (S(1.0) - share) -\n                       frames[to].velocity_at(point) * share;",
          "frames[from].velocity_at(point) * S(0.0);", ("snares", "bodies")),
    Fault("multibody", "velocity products of joints are missing", "multibody/dynamics.cpp",
          "    A += velocity_product(body, V, v);\n", "", ("arms",)),
    Fault("multibody", "a sign in the wrench of a body that turns", "multibody/dynamics.cpp",
          "body.inertia * A + cross(V, body.inertia * V)", "body.inertia * A - cross(V, body.inertia * V)", ("arms",)),
    Fault("multibody", "the damping of a gear gives no torque", "multibody/arm/arm_part.cpp",
          "j.spring.torque(mode.branch, t.deflection) + t.gear_damping * t.deflection_rate", "j.spring.torque(mode.branch, t.deflection)", ("arms",)),
    Fault("scenario", "a sensor's velocity leaves out how its reference turns", "scenario/sensors.cpp",
          "to_other * (f.linear - other.linear - other.angular.cross(apart))", "to_other * (f.linear - other.linear)", ("bodies", "arms")),
    Fault("scenario", "a sensor of tension reads another wire", "scenario/sensors.cpp",
          "coupling::end_tension(s, wire)", "coupling::end_tension(s, 0)", ("motion", "snares")),
    Fault("identification", "readings of a record by another scale than the predictions", "identification/records/record_data.cpp",
          "values.head(piece.size) / piece.scale -\n", "values.head(piece.size) / (1.1 * piece.scale) -\n", ("records",)),
    Fault("identification", "the force of the second reading by a factor", "identification/fitting/prediction.cpp",
          "    result.wire.force[i] += weight * p->force;", "    result.wire.force[i] += (i == 1 ? 0.9 : 1.0) * weight * p->force;", ("fit",)),
    Fault("study", "rows of a grid are numbered by its first key", "study/design.cpp",
          "for (std::size_t j = n; j-- > 0;) {\n        const std::uint64_t levels", "for (std::size_t j = 0; j < n; ++j) {\n        const std::uint64_t levels",
          ("sweeps",)),
    Fault("study", "the least of several values is the largest", "study/collect.cpp",
          "least = std::min(value, least.value_or(value));", "least = std::max(value, least.value_or(value));", ("sweeps",)),
]


def relations(snare, subject, a, folder, first=0, files=0):
    """Broken relations by file, of some files of one subject: {file: [relation, ...]}; "has a result" where the file itself has none."""
    journal = folder / "journal.jsonl"
    journal.unlink(missing_ok=True)
    numbers = {"--files": files or a.files, "--first": first, "--seed": a.seed, "--jobs": a.jobs, "--shrink": 0, "--journal": journal, "--keep": folder / "kept"}
    words = [str(word) for pair in numbers.items() for word in pair]
    subprocess.run([sys.executable, "-B", HERE / "relations.py", snare, *words, "--subject", subject], capture_output=True, check=False)
    entries = map(json.loads, journal.read_text(encoding="utf-8").splitlines())
    found = {entry["file"]: [b["relation"] for b in entry["broken"]] + (["has a result"] if "why" in entry else []) for entry in entries}
    return {file: broken for file, broken in found.items() if broken}


def build(worktree, folder):
    done = subprocess.run(["ninja", "-C", folder, "snare"], cwd=worktree, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"the build ended with status {done.returncode}:\n{done.stdout[-2000:]}")


def try_fault(fault, a, sound, folder):
    """Which subject, relation and file show a fault; none."""
    file = a.worktree / fault.file
    text = file.read_text(encoding="utf-8")
    if text.count(fault.good) != 1:
        raise SystemExit(f"{fault.file}: the line to change is there {text.count(fault.good)} times: {fault.good}")
    try:
        file.write_text(text.replace(fault.good, fault.bad), encoding="utf-8")
        build(a.worktree, a.build)
        for subject in fault.subjects:
            for first in range(0, a.files, BLOCK):
                for name, broken in relations(a.build / "snare", subject, a, folder, first, BLOCK).items():
                    new = [r for r in broken if r not in sound[subject].get(name, [])]
                    if new:
                        return {"file": name, "relation": new[0]}
    finally:
        file.write_text(text, encoding="utf-8")
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worktree", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path)
    parser.add_argument("--files", type=int, default=40)
    parser.add_argument("--seed", default="planted")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", type=int, nargs="*")
    parser.add_argument("--results", type=pathlib.Path)
    a = parser.parse_args()
    a.worktree = a.worktree.resolve()
    a.build = (a.build or a.worktree / "build/release").resolve()
    chosen = [f for k, f in enumerate(FAULTS, 1) if not a.only or k in a.only]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        build(a.worktree, a.build)
        sound = {s: relations(a.build / "snare", s, a, folder) for s in sorted({s for f in chosen for s in f.subjects})}
        for fault in chosen:
            found = try_fault(fault, a, sound, folder)
            rows.append({"room": fault.room, "fault": fault.what, "found": found})
            print(f"{fault.room}: {fault.what}: {found['relation'] + ', ' + found['file'] if found else 'not found'}", flush=True)
    count = sum(row["found"] is not None for row in rows)
    print(f"{count} of {len(rows)} found")
    if a.results:
        a.results.write_text(json.dumps({"files_a_subject": a.files, "found": count, "of": len(rows), "faults": rows}, indent=1) + "\n", encoding="utf-8")
    return 0 if count >= 0.9 * len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
