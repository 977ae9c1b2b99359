#!/usr/bin/env bash
# Title: The rotor inertia and gear ratio of a Pinocchio model act in no dynamics function, and neither do
#   the damping and friction it reads.
# Version: Pinocchio 4.1.0
# Guess: rotorInertia and rotorGearRatio add inertia times ratio squared to the mass matrix; damping and
#   friction that the model stores act in aba and rnea.
# Seen: A rotor of 1e-3 kg m^2 behind a gear of 100 should add 10 kg m^2 to 0.27; crba, aba and rnea give
#   0.27. The field armature alone is used and gives 10.27. Damping 2 and friction 1 are stored; at 1 rad/s
#   the torque from rnea and the acceleration from aba are 0.
# Hurts: Anyone who swings, damps or drives an arm with a model read by Pinocchio: a flexible or geared arm
#   has too little inertia and no loss, and a released joint never comes to rest.
# Documented: Partly: maintainers advise adding joint damping to the torque by hand; for the rotor fields no
#   note was found.
# Instead: Set model.armature to inertia times ratio squared, subtract damping times velocity and the
#   friction from the torque before aba, and add them after rnea.

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

URDF = """<robot name="r"><link name="base"/><link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="1"/>
<inertia ixx="0.001" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
<limit lower="-3" upper="3" effort="10" velocity="3"/><dynamics damping="2" friction="1"/></joint></robot>"""

model = pin.buildModelFromXML(URDF)
model.gravity = pin.Motion.Zero()
data = model.createData()
zero, one = np.zeros(1), np.ones(1)
print("Pinocchio", pin.__version__)
print(f"stored: damping {model.damping}, friction {model.upperDryFrictionLimit}")
assert model.damping[0] == 2 and model.upperDryFrictionLimit[0] == 1

acceleration = pin.aba(model, data, zero, one, zero)[0]
torque = pin.rnea(model, data, zero, one, zero)[0]
print(f"at 1 rad/s: aba gives {acceleration:.3g} rad/s^2 without torque, rnea {torque:.3g} N m (guess -11.1 and 3)")
assert abs(acceleration) < 1e-12 and abs(torque) < 1e-12

plain = pin.crba(model, data, zero)[0, 0]
model.rotorInertia, model.rotorGearRatio = np.array([1e-3]), np.array([100.0])
rotor = pin.crba(model, data, zero)[0, 0]
response = 1 / pin.aba(model, data, zero, zero, one)[0]
inverse = pin.rnea(model, data, zero, zero, one)[0]
print(f"inertia {plain:.3f}; with a rotor of 1e-3 behind a gear of 100: crba {rotor:.3f}, aba {response:.3f}, "
      f"rnea {inverse:.3f} (guess 10.27)")
assert max(abs(plain - 0.27), abs(rotor - 0.27), abs(response - 0.27), abs(inverse - 0.27)) < 1e-9

model.armature = np.array([1e-3 * 100.0**2])
armature = pin.crba(model, data, zero)[0, 0]
response = 1 / pin.aba(model, data, zero, zero, one)[0]
print(f"with armature 10: crba {armature:.3f}, aba {response:.3f}")
assert abs(armature - 10.27) < 1e-9 and abs(response - 10.27) < 1e-9

# a swing with rnea as the loss-free model: the speed after two seconds of damping by hand, and without
speed_model, speed_hand = 1.0, 1.0
model.armature = zero
for _ in range(2000):
    speed_model += 1e-3 * pin.aba(model, data, zero, np.array([speed_model]), zero)[0]
    speed_hand += 1e-3 * pin.aba(model, data, zero, np.array([speed_hand]), -model.damping * speed_hand)[0]
print(f"after 2 s: {speed_model:.3f} rad/s as read, {speed_hand:.1e} rad/s with the damping of the file applied")
assert speed_model > 0.999 and speed_hand < 1e-5
EOF
