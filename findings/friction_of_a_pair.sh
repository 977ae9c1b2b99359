#!/usr/bin/env bash
# Title: One pair of friction coefficients, 0.2 and 0.8, slides five times harder in MuJoCo than in
#   PyBullet.
# Version: MuJoCo 4.0.0, PyBullet 3.2.7
# Guess: Engines combine the coefficients of two surfaces in about the same way; if both are 0.4, the
#   friction coefficient is 0.4.
# Seen: For 0.2 on 0.8 the effective coefficient is 0.80 in MuJoCo (the larger one) and 0.16 in PyBullet
#   (the product). For 0.4 on 0.4 it is 0.40 and 0.16.
# Hurts: Anyone who carries a gripper, a snare on a pin, or measured friction from one engine to another: a
#   measured pair coefficient written on both bodies is squared in PyBullet, and a slippery pad on a default
#   floor is not slippery in MuJoCo.
# Documented: The rule is stated in the manual of MuJoCo; it was not found in the guide of PyBullet.
# Instead: Give the measured pair coefficient explicitly: a contact pair in MuJoCo; in PyBullet, the
#   coefficient on one body and 1 on the other. Test on an incline before trusting a grip.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  mujoco==4.0.0 mujoco-core==4.0.0 pybullet==3.2.7 numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import mujoco
import numpy as np
import pybullet as bullet

TILT = np.radians(45.0)
GRAVITY = 9.81 * np.sin(TILT), 0.0, -9.81 * np.cos(TILT)


def coefficient(acceleration):
    """Returns the friction coefficient from the acceleration of a block that slides down the incline."""
    return np.tan(TILT) - acceleration / (9.81 * np.cos(TILT))


def in_mujoco(floor, block):
    model = mujoco.MjModel.from_xml_string(f"""<mujoco>
<option timestep="1e-3" cone="elliptic" impratio="100" gravity="{GRAVITY[0]} 0 {GRAVITY[2]}"/><worldbody>
<geom type="plane" size="9 9 .1" friction="{floor} 0 0"/><body pos="0 0 .02"><freejoint/>
<geom type="box" size=".1 .1 .02" mass="1" friction="{block} 0 0"/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    for _ in range(1000):
        mujoco.mj_step(model, data)
    speed = data.qvel[0]
    for _ in range(1000):
        mujoco.mj_step(model, data)
    return coefficient(data.qvel[0] - speed)


def in_bullet(floor, block):
    bullet.resetSimulation()
    bullet.setGravity(*GRAVITY)
    bullet.setPhysicsEngineParameter(fixedTimeStep=1e-3)
    plane = bullet.createMultiBody(0, bullet.createCollisionShape(bullet.GEOM_PLANE))
    shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=[0.1, 0.1, 0.02])
    box = bullet.createMultiBody(1, shape, -1, [0, 0, 0.02])
    bullet.changeDynamics(plane, -1, lateralFriction=floor)
    bullet.changeDynamics(box, -1, lateralFriction=block, linearDamping=0, angularDamping=0)
    for _ in range(1000):
        bullet.stepSimulation()
    speed = bullet.getBaseVelocity(box)[0][0]
    for _ in range(1000):
        bullet.stepSimulation()
    return coefficient(bullet.getBaseVelocity(box)[0][0] - speed)


bullet.connect(bullet.DIRECT)
print("MuJoCo", mujoco.__version__, "and PyBullet 3.2.7, block on an incline of 45 degrees")
for floor, block in ((0.2, 0.8), (0.8, 0.2), (0.4, 0.4)):
    first, second = in_mujoco(floor, block), in_bullet(floor, block)
    print(f"floor {floor}, block {block}: effective coefficient {first:.3f} in MuJoCo, {second:.3f} in PyBullet")
    assert abs(first - max(floor, block)) < 0.02 and abs(second - floor * block) < 0.01
EOF
