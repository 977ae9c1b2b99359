#!/usr/bin/env bash
# Title: With the SAP contact of Drake, a contact stiffer than a limit set by the time step is as soft as
#   that limit.
# Version: Drake 1.51.1
# Guess: A resting ball sinks by its weight over the stiffness that is declared; a hundred times the
#   stiffness, a hundredth of the depth.
# Seen: Ball of 1 kg, step 10 ms: 1e6 and 1e8 N/m on both bodies sink by the same 0.868 mm with SAP, 44 and
#   4424 times too deep. The approximation "lagged" sinks by 2 m g / k for both. A step of 1 ms still gives
#   0.084 mm for both, 4 and 428 times too deep.
# Hurts: Anyone who measures contact stiffness, indentation or a pinched wire in a discrete plant: a study
#   over the stiffness shows convergence to a hard contact where none was computed.
# Documented: Yes, in the description of the near-rigid regime of SAP; the declared stiffness is replaced
#   without a message.
# Instead: Use the approximation "lagged" or "similar" where compliance matters, or reduce the step until
#   depth times stiffness equals the force. Two equal stiffnesses act in series: half of each.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  drake==1.51.1 numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import logging

import numpy as np
from pydrake.geometry import AddContactMaterial, HalfSpace, ProximityProperties, Sphere
from pydrake.math import RigidTransform
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction, DiscreteContactApproximation
from pydrake.multibody.tree import SpatialInertia, UnitInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

logging.getLogger("drake").setLevel(logging.ERROR)
APPROXIMATION = {"SAP": DiscreteContactApproximation.kSap, "lagged": DiscreteContactApproximation.kLagged}


def depth(name, stiffness, step):
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, step)
    plant.set_discrete_contact_approximation(APPROXIMATION[name])
    ball = plant.AddRigidBody("ball", SpatialInertia(1.0, np.zeros(3), UnitInertia.SolidSphere(0.05)))
    for body, shape in ((plant.world_body(), HalfSpace()), (ball, Sphere(0.05))):
        material = ProximityProperties()
        AddContactMaterial(dissipation=1.0, point_stiffness=stiffness, friction=CoulombFriction(0.5, 0.5),
                           properties=material)
        plant.RegisterCollisionGeometry(body, RigidTransform(), shape, body.name() + "_shape", material)
    plant.Finalize()
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetFreeBodyPose(context, ball, RigidTransform([0, 0, 0.05]))
    simulator.AdvanceTo(2.0)
    return 0.05 - plant.EvalBodyPoseInWorld(context, ball).translation()[2]


print("Drake 1.51.1 - ball of 1 kg; two equal stiffnesses in series sink by 2 m g / k")
seen = {}
for step in (1e-2, 1e-3):
    for stiffness in (1e6, 1e8):
        for name in APPROXIMATION:
            value = seen[name, stiffness, step] = depth(name, stiffness, step)
            print(f"step {step:.0e} s, k {stiffness:.0e} N/m, {name:6s}: depth {1e3 * value:.6f} mm, "
                  f"{value * stiffness / (2 * 9.81):.2f} times 2 m g / k")
for step in (1e-2, 1e-3):
    for stiffness in (1e6, 1e8):
        assert abs(seen["lagged", stiffness, step] * stiffness / (2 * 9.81) - 1) < 0.02
assert abs(seen["SAP", 1e6, 1e-2] / seen["SAP", 1e8, 1e-2] - 1) < 0.01
assert 0.7e-3 < seen["SAP", 1e8, 1e-2] < 1.1e-3
assert 0.06e-3 < seen["SAP", 1e8, 1e-3] < 0.11e-3 and abs(seen["SAP", 1e6, 1e-3] / seen["SAP", 1e8, 1e-3] - 1) < 0.01
EOF
