#!/usr/bin/env bash
# Title: Pinocchio interpolates a free-flying body along a screw: half-way between two poses it is 207 mm
#   off the line, while a translation joint with a spherical joint stays on it.
# Version: Pinocchio 4.1.0
# Guess: interpolate moves the position of a free-flyer on the straight line and turns its orientation at
#   constant rate.
# Seen: From the origin to 1 m in x with a turn of 90 degrees about z, the middle is (0.5, -0.207, 0). With
#   a turn of 170 degrees it is 0.458 m off. The distances differ too: 1.924 and 1.862 at 90 degrees.
# Hurts: Anyone who plans or checks the path of a captured body, an end effector or a floating base between
#   key poses: clearance is checked along another path than the one meant.
# Documented: Implicitly: the operation is that of the Lie group SE(3). The path of the origin is not
#   described.
# Instead: Interpolate translation and rotation separately, or model the body with a translation joint
#   followed by a spherical joint.

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


def free_flyer(angle):
    model = pin.Model()
    model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "body")
    return middle(model, angle)


def translation_and_ball(angle):
    model = pin.Model()
    slide = model.addJoint(0, pin.JointModelTranslation(), pin.SE3.Identity(), "slide")
    model.addJoint(slide, pin.JointModelSpherical(), pin.SE3.Identity(), "ball")
    return middle(model, angle)


def middle(model, angle):
    start = pin.neutral(model)
    end = start.copy()
    end[0] = 1.0
    end[3:] = pin.Quaternion(pin.utils.rotate("z", angle)).coeffs()
    half = pin.interpolate(model, start, end, 0.5)
    turned = 2 * np.arctan2(half[5], half[6])
    return half[:3], turned, pin.distance(model, start, end)


print("Pinocchio", pin.__version__)
offsets = {}
for degrees in (1, 90, 170):
    angle = np.radians(degrees)
    position, turned, length = free_flyer(angle)
    other, turned_other, length_other = translation_and_ball(angle)
    offsets[degrees] = position[1]
    print(f"turn of {degrees:3d} degrees: middle of the free-flyer {np.round(position, 4)}, length {length:.4f}; "
          f"of translation and ball {np.round(other, 4)}, length {length_other:.4f}")
    assert abs(turned - angle / 2) < 1e-9 and abs(turned_other - angle / 2) < 1e-9
    assert np.allclose(other, [0.5, 0, 0], atol=1e-12)
    assert abs(position[1] + 0.5 * np.tan(angle / 4)) < 1e-6  # sagitta of the arc
assert abs(offsets[90] + 0.2071) < 1e-3 and abs(offsets[170] + 0.4582) < 1e-3
EOF
