#!/usr/bin/env bash
# Title: A MuJoCo joint with dry friction never sticks: it creeps at a speed proportional to the load.
# Version: MuJoCo 4.0.0
# Guess: frictionloss is Coulomb friction: below 1 N m of load, a joint with 1 N m of friction stands still.
# Seen: With 0.5 N m the link turns by 5.4 degrees a minute; the speed is proportional to the load and equal
#   for four integrators and two step sizes. A smaller time constant in solreffriction divides the speed.
# Hurts: Anyone who holds a pose by brakes or gear friction, measures stiction from a hold, or identifies
#   friction from slow motion: the model is a stiff viscous damper below its limit.
# Documented: The manual says that friction constraints are soft and lists the parameters; the creep of a
#   held joint is not quantified.
# Instead: Set solreffriction and solimpfriction until the creep over the hold is below the tolerance, or
#   lock the joint with an equality constraint while it is held; report the residual speed.

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

XML = """<mujoco><option timestep="{step}" gravity="0 0 0" integrator="{name}"/><worldbody><body>
<joint type="hinge" axis="0 1 0" frictionloss="1" {extra}/>
<geom type="capsule" fromto="0 0 0 1 0 0" size=".02" mass="1"/></body></worldbody></mujoco>"""


def creep(load, name="implicitfast", step=1e-3, extra=""):
    """Returns the speed in degrees a minute, after one second of settling, and the friction torque."""
    model = mujoco.MjModel.from_xml_string(XML.format(name=name, step=step, extra=extra))
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = load
    for _ in range(round(1 / step)):
        mujoco.mj_step(model, data)
    start = data.qpos[0]
    for _ in range(round(5 / step)):
        mujoco.mj_step(model, data)
    return np.degrees(data.qpos[0] - start) * 12, data.qfrc_constraint[0]


print("MuJoCo", mujoco.__version__, "- joint friction 1 N m")
speed = {load: creep(load)[0] for load in (0.1, 0.5, 0.9)}
for load, value in speed.items():
    print(f"load {load} N m: creeps at {value:.3f} degrees a minute")
assert 4.5 < speed[0.5] < 6.5
assert abs(speed[0.9] / speed[0.1] - 9) < 0.1
for name in ("Euler", "RK4", "discrete"):
    value, torque = creep(0.5, name)
    print(f"{name}: {value:.3f} degrees a minute, friction torque {torque:.4f} N m")
    assert abs(value / speed[0.5] - 1) < 0.01 and abs(torque + 0.5) < 1e-6
fine = creep(0.5, step=2.5e-4)[0]
print(f"a quarter of the step: {fine:.3f} degrees a minute")
assert abs(fine / speed[0.5] - 1) < 0.01
stiff = creep(0.5, extra='solreffriction="0.002 1" solimpfriction="0.9999 0.9999 0.001"')[0]
print(f"with solreffriction 0.002 and solimpfriction 0.9999: {stiff:.5f} degrees a minute")
assert 0 < stiff < speed[0.5] / 100
EOF
