#!/usr/bin/env bash
# Title: The torque regressor of Pinocchio leaves out the armature that rnea includes, so identified link
#   inertias are wrong.
# Version: Pinocchio 4.1.0
# Guess: computeJointTorqueRegressor times the parameters of the links equals rnea of the same model,
#   whatever the model contains.
# Seen: Two links with an armature of 0.3 kg m^2 each: the two torques differ by 1.7 N m rms of 6.3. A
#   least-squares fit to noise-free rnea torques gives the last link 0.134 kg m^2 about its joint for 0.0325
#   and leaves 1.0 N m rms.
# Hurts: Anyone who identifies the inertia of a geared arm or its payload with the regressor: the rotor
#   inertia, which dominates, is spread over the links.
# Documented: The page of the function says that the model is linear in the inertial parameters; it does not
#   mention the armature.
# Instead: Subtract armature times acceleration from the torques, or append the joint accelerations as
#   further columns and identify the armature together with the links.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  pin==4.1.0 libpinocchio==4.1.0 coal==3.0.3 libcoal==3.0.3 eigenpy==3.13.0 numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import numpy as np
import pinocchio as pin

LINK = """<link name="{name}"><inertial><origin xyz="{centre} 0 0"/><mass value="{mass}"/>
<inertia ixx="0.002" iyy="{inertia}" izz="{inertia}" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>
<origin xyz="{offset} 0 0"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="99" velocity="9"/></joint>"""
URDF = '<robot name="r"><link name="w"/>' + LINK.format(name="a", centre=0.2, mass=2, inertia=0.03)
URDF += LINK.format(name="b", centre=0.15, mass=1, inertia=0.01)
URDF += JOINT.format(name="j", parent="w", child="a", offset=0) + JOINT.format(
    name="k", parent="a", child="b", offset=0.4) + "</robot>"

model = pin.buildModelFromXML(URDF)
model.armature = np.array([0.3, 0.3])
data = model.createData()
true = np.concatenate([model.inertias[i].toDynamicParameters() for i in (1, 2)])
random = np.random.default_rng(0)
rows, torques, accelerations = [], [], []
for _ in range(200):
    q, v, a = random.uniform(-1, 1, (3, 2)) * [[1], [3], [10]]
    rows.append(pin.computeJointTorqueRegressor(model, data, q, v, a).copy())
    torques.append(pin.rnea(model, data, q, v, a).copy())
    accelerations.append(np.diag(a))
rows, torques, accelerations = np.vstack(rows), np.concatenate(torques), np.vstack(accelerations)


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


print("Pinocchio", pin.__version__)
difference = rms(rows @ true - torques)
print(f"rms torque {rms(torques):.3f} N m, rms of regressor times parameters minus rnea {difference:.3f} N m")
assert 1.4 < difference < 2.0
exact = rms(rows @ true + accelerations @ model.armature - torques)
print(f"after adding armature times acceleration: {exact:.1e} N m")
assert exact < 1e-10
fitted = np.linalg.lstsq(rows, torques, rcond=None)[0]
residual = rms(rows @ fitted - torques)
print(f"inertia of the last link about its joint: fitted {fitted[16]:.4f}, true {true[16]:.4f} kg m^2, "
      f"residual {residual:.3f} N m")
assert fitted[16] / true[16] > 3 and residual > 0.5
wide = np.linalg.lstsq(np.hstack([rows, accelerations]), torques, rcond=None)[0]
residual = rms(np.hstack([rows, accelerations]) @ wide - torques)
print(f"with the accelerations as further columns: inertia {wide[16]:.4f} kg m^2, armature {wide[21]:.4f}, "
      f"residual {residual:.1e} N m")
assert residual < 1e-10 and abs(wide[16] - true[16]) < 1e-6 and abs(wide[21] - 0.3) < 1e-6
EOF
