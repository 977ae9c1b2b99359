"""The mass matrix of `snare arm show --json` beside Pinocchio's and MuJoCo's: on the shipped arms, and on 30 random ones with turned
inertias, branches, sliding and endless joints.

Needs the packages pin and mujoco of the Python index, in the Python of the tests or in a folder that SNARE_PEER_PACKAGES names;
skipped, saying so, where there is neither.
"""

import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import setting
import numpy as np

setting.add_peer_packages()
try:
    import pinocchio
except ImportError:
    pinocchio = None
try:
    import mujoco
except ImportError:
    mujoco = None
if pinocchio is None and mujoco is None:
    print("skipped: neither pin nor mujoco is installed")
    sys.exit(setting.SKIPPED)

ARMS = setting.SOURCE / "data/arms"
COMMON = """law = "linear"
stiffness_Nm_rad = 1e4
damping_Nms_rad = 1.0
motor_inertia_kg_m2 = 1.0
drive = "locked"
"""


def shown(path, *arguments):
    done = subprocess.run([setting.COMMAND, "arm", "show", str(path), "--json", *arguments], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def by_pinocchio(urdf, angles):
    """Mass matrix with the joints in the order of `angles`, a dictionary."""
    model = pinocchio.buildModelFromXML(urdf)
    q = pinocchio.neutral(model)
    for name, value in angles.items():
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 2:  # endless: cosine and sine
            q[joint.idx_q], q[joint.idx_q + 1] = math.cos(value), math.sin(value)
        else:
            q[joint.idx_q] = value
    data = model.createData()
    pinocchio.crba(model, data, q)
    matrix = np.triu(data.M) + np.triu(data.M, 1).T
    order = [model.joints[model.getJointId(name)].idx_v for name in angles]
    return matrix[np.ix_(order, order)]


def by_mujoco(urdf, angles):
    spec = mujoco.MjSpec.from_string(urdf)
    model = spec.compile()
    data = mujoco.MjData(model)
    for name, value in angles.items():
        data.qpos[model.joint(name).qposadr[0]] = value
    mujoco.mj_forward(model, data)
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix)
    order = [model.joint(name).dofadr[0] for name in angles]
    return matrix[np.ix_(order, order)]


READERS = {name: reader for name, reader, there in (("pinocchio", by_pinocchio, pinocchio), ("mujoco", by_mujoco, mujoco)) if there}


def random_urdf(seed):
    """A tree of 3 to 7 links on a base, each on an earlier one."""
    rng = random.Random(seed)
    vector = lambda size: " ".join(repr(rng.uniform(-size, size)) for _ in range(3))
    parts, joints = ['<link name="base"/>'], []
    for k in range(rng.randint(3, 7)):
        mass = rng.uniform(0.5, 50.0)
        # Principal moments of a block of three edges, which keep the triangle inequality.
        a, b, c = (rng.uniform(0.05, 1.0) ** 2 for _ in range(3))
        ixx, iyy, izz = mass * (b + c) / 12, mass * (a + c) / 12, mass * (a + b) / 12
        kind = rng.choice(["revolute", "continuous", "prismatic"])
        limit = "" if kind == "continuous" else '<limit lower="-3" upper="3" effort="10" velocity="1"/>'
        parent = "base" if k == 0 else f"link{rng.randrange(k)}"
        parts.append(f'<link name="link{k}"><inertial><origin xyz="{vector(0.5)}" rpy="{vector(3.0)}"/><mass value="{mass!r}"/>'
                     f'<inertia ixx="{ixx!r}" ixy="0" ixz="0" iyy="{iyy!r}" iyz="0" izz="{izz!r}"/></inertial></link>')
        parts.append(f'<joint name="joint{k}" type="{kind}"><origin xyz="{vector(1.0)}" rpy="{vector(3.0)}"/><parent link="{parent}"/>'
                     f'<child link="link{k}"/><axis xyz="{vector(1.0)}"/>{limit}</joint>')
        joints.append(f"joint{k}")
    return f'<?xml version="1.0"?><robot name="random">{"".join(parts)}</robot>', rng


class Readers(unittest.TestCase):
    def check(self, matrix, urdf, angles, what):
        wanted = np.array(matrix)
        scale = np.sqrt(np.outer(np.diag(wanted), np.diag(wanted)))
        for name, reader in READERS.items():
            error = np.abs((reader(urdf, angles) - wanted) / scale).max()
            self.assertLess(error, 1e-9, (what, name))

    def test_shipped_arms(self):
        for name in ("bench_arm", "jemrms_like", "shaft_slide", "ssrms_like", "test_robot"):
            urdf = (ARMS / f"{name}.urdf").read_text()
            arm = shown(ARMS / f"{name}.urdf")
            self.check(arm["mass_matrix"]["rows"], urdf, {joint: 0.0 for joint in arm["mass_matrix"]["joints"]}, name)
        for name, pose in (("jemrms_like", "10,-20,30,40,-50,60"), ("ssrms_like", "10,-20,30,40,-50,60,-70"), ("bench_arm", "12")):
            arm = shown(ARMS / f"{name}.toml", "--pose", pose)
            angles = {one["joint"]: math.radians(one["angle_deg"]) for one in arm["joints"]}
            order = {joint: angles[joint] for joint in arm["mass_matrix"]["joints"]}
            self.check(arm["mass_matrix"]["rows"], (ARMS / f"{name}.urdf").read_text(), order, name)

    def test_random_arms(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for seed in range(30):
                urdf, rng = random_urdf(seed)
                (folder / "arm.urdf").write_text(urdf)
                (folder / "arm.toml").write_text('schema = "snare-arm/1"\ntitle = "random"\nurdf = "arm.urdf"\ntip = "link0"\n[every_joint]\n' + COMMON)
                joints = shown(folder / "arm.toml")["joints"]
                degrees = [rng.uniform(-170.0, 170.0) for _ in joints]
                arm = shown(folder / "arm.toml", "--pose=" + ",".join(map(repr, degrees)))
                angles = {one["joint"]: math.radians(d) for one, d in zip(arm["joints"], degrees)}
                matrix = arm["mass_matrix"]
                self.check(matrix["rows"], urdf, {joint: angles[joint] for joint in matrix["joints"]}, seed)

    @unittest.skipIf(mujoco is None, "mujoco is not installed")
    def test_a_payload_as_a_free_body_of_mujoco(self):
        spec = mujoco.MjSpec.from_file(str(ARMS / "payload_abiko.urdf"))
        spec.compiler.fusestatic = False
        spec.worldbody.first_body().add_freejoint()
        model = spec.compile()
        self.assertEqual(model.nv, 6)
        total = shown(ARMS / "payload_abiko.urdf")["mass_kg"]
        self.assertAlmostEqual(model.body_subtreemass[1], total, delta=1e-9 * total)


if __name__ == "__main__":
    setting.main()
