#!/usr/bin/env bash
# Title: PyBullet divides the reported contact force by the number of substeps.
# Version: PyBullet 3.2.7
# Guess: getContactPoints gives the normal force in newtons: the weight of a resting ball, whatever the
#   number of substeps.
# Seen: A ball of 9.81 N: 9.81 N without substeps, 4.905 N with 2 and 0.981 N with 10. External forces and
#   the joint force sensor are not affected, so only the contact force is wrong.
# Hurts: Anyone who refines the step by numSubSteps to resolve a grip or an impact and reads forces: they
#   fall as 1/n while the motion is right, which looks like convergence to a softer contact.
# Documented: Not found in the manual. The numbers fit the impulse of one substep divided by the length of
#   the whole step.
# Instead: Call stepSimulation with a shorter fixedTimeStep and no substeps, or multiply the reported force
#   by numSubSteps; check against a resting weight.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  pybullet==3.2.7 numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import pybullet as bullet


def resting_ball(substeps, step=0.01):
    bullet.resetSimulation()
    bullet.setGravity(0, 0, -9.81)
    bullet.setPhysicsEngineParameter(fixedTimeStep=step, numSubSteps=substeps)
    floor = bullet.createMultiBody(0, bullet.createCollisionShape(bullet.GEOM_PLANE))
    shape = bullet.createCollisionShape(bullet.GEOM_SPHERE, radius=0.02)
    ball = bullet.createMultiBody(1.0, shape, -1, [0, 0, 0.02])
    for _ in range(round(2 / step)):
        bullet.stepSimulation()
    height = bullet.getBasePositionAndOrientation(ball)[0][2]
    return sum(point[9] for point in bullet.getContactPoints(ball, floor)), height


def joint_sensor(substeps):
    """Returns the force in the fixed joint of a hanging mass of 1 kg."""
    bullet.resetSimulation()
    bullet.setGravity(0, 0, -9.81)
    bullet.setPhysicsEngineParameter(fixedTimeStep=0.01, numSubSteps=substeps)
    shape = bullet.createCollisionShape(bullet.GEOM_SPHERE, radius=0.02)
    arm = bullet.createMultiBody(
        0, shape, linkMasses=[1], linkCollisionShapeIndices=[shape], linkVisualShapeIndices=[-1],
        linkPositions=[[0, 0, 0]], linkOrientations=[[0, 0, 0, 1]], linkInertialFramePositions=[[0, 0, 0]],
        linkInertialFrameOrientations=[[0, 0, 0, 1]], linkParentIndices=[0], linkJointTypes=[bullet.JOINT_FIXED],
        linkJointAxis=[[1, 0, 0]])
    bullet.enableJointForceTorqueSensor(arm, 0)
    for _ in range(50):
        bullet.stepSimulation()
    return bullet.getJointState(arm, 0)[2][2]


bullet.connect(bullet.DIRECT)
print("PyBullet 3.2.7 - weight 9.81 N")
for substeps in (0, 1, 2, 5, 10):
    force, height = resting_ball(substeps)
    sensor = joint_sensor(substeps)
    print(f"substeps {substeps:2d}: contact force {force:.4f} N, joint sensor {sensor:.4f} N, height {height:.5f} m")
    assert abs(force * max(substeps, 1) / 9.81 - 1) < 0.01
    assert abs(sensor / 9.81 - 1) < 0.01 and abs(height - 0.02) < 1e-3
force, _ = resting_ball(0, step=0.001)
print(f"step of 1 ms without substeps: contact force {force:.4f} N")
assert abs(force / 9.81 - 1) < 0.01
EOF
