#!/usr/bin/env bash
# Title: A MuJoCo accelerometer on a strongly damped slide reads twice the rate at which the velocity
#   changes.
# Version: MuJoCo 4.0.0
# Guess: Within one step of an explicit or implicit scheme, the acceleration that the sensor and qacc give,
#   times the step, is the change of velocity.
# Seen: 10 g, damping 5 N s/m, step 2 ms: the velocity falls by 250 m/s^2, the accelerometer and qacc read
#   500 m/s^2 with Euler, implicit and implicitfast. The integrator discrete reads 250; with RK4 the
#   velocity falls by 312 m/s^2 and the accelerometer reads 500.
# Hurts: Anyone who integrates accelerometer data, checks force = mass times acceleration on a gripper pad,
#   a light carriage or a fingertip, or fits damping from qacc: the factor is 1 + c h / m.
# Documented: Partly: the manual says that these integrators change the velocity by a modified mass matrix.
#   The sensor page does not mention it.
# Instead: Use finite differences of qvel for what the body did, keep c h / m well below 1, or choose the
#   integrator discrete, whose acceleration agrees with its velocity.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  mujoco==4.0.0 mujoco-core==4.0.0 numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import mujoco
import numpy as np

MASS, DAMPING, STEP = 0.01, 5.0, 2e-3
XML = """<mujoco><option timestep="{step}" gravity="0 0 0" integrator="{name}"/><worldbody><body>
<joint type="slide" axis="1 0 0" damping="5"/><geom size=".02" mass=".01"/><site name="s"/></body></worldbody>
<sensor><accelerometer site="s"/></sensor></mujoco>"""


def one_step(name, step):
    model = mujoco.MjModel.from_xml_string(XML.format(name=name, step=step))
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    mujoco.mj_step(model, data)
    return (data.qvel[0] - 1) / step, data.sensordata[0], data.qacc[0]


print("MuJoCo", mujoco.__version__, "- c h / m =", DAMPING * STEP / MASS)
seen = {}
for name in ("Euler", "implicit", "implicitfast", "discrete", "RK4"):
    seen[name] = change, sensor, acceleration = one_step(name, STEP)
    print(f"{name:13s} change of velocity {change:8.2f}, accelerometer {sensor:8.2f}, qacc {acceleration:8.2f} m/s^2")
for name in ("Euler", "implicit", "implicitfast"):
    change, sensor, acceleration = seen[name]
    assert abs(sensor / change - 2) < 0.01 and abs(acceleration / change - 2) < 0.01
change, sensor, acceleration = seen["discrete"]
assert abs(sensor / change - 1) < 1e-6 and abs(acceleration / change - 1) < 1e-6
change, sensor, acceleration = seen["RK4"]
assert abs(sensor / change - 1.6) < 0.01 and abs(acceleration / change - 1) < 1e-6
change, sensor, _ = one_step("implicitfast", STEP / 20)
print(f"implicitfast with a twentieth of the step: ratio {sensor / change:.3f}")
assert abs(sensor / change - 1.05) < 0.005
EOF
