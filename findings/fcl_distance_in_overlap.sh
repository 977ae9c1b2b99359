#!/usr/bin/env bash
# Title: For the same overlap of 1 mm, the distance from python-fcl is -1, -0.001 or 0, depending on the
#   shapes.
# Version: python-fcl 0.7.0.11
# Guess: The distance of two shapes that overlap by 1 mm is -0.001 m, or 0 for all of them.
# Seen: Two boxes, two spheres, or a sphere on a box: -1 m; two capsules: -0.001 m; two meshes of boxes: 0.
#   A signed distance on request gives -0.001 for the primitives and still 0 for the meshes. A millimetre
#   apart, all of them agree.
# Hurts: Anyone who uses the distance as the gap of a penalty law: a touching box is 1 m deep, a mesh never
#   pushes back, and a chain of capsules works, so that the law passes its first test.
# Documented: The flag for the signed distance is documented; the result is described as at most 0 in
#   contact, which -1 m satisfies.
# Instead: Request the signed distance for primitives, use collide for their depth, and treat meshes as
#   convex parts or with collide against primitives.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  python-fcl==0.7.0.11 numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import fcl
import numpy as np

SIDE = 1.0


def mesh():
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    faces = np.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
                      (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])
    model = fcl.BVHModel()
    model.beginModel(len(corners), len(faces))
    model.addSubModel(corners, faces)
    model.endModel()
    return model


def gap(first, second, height, signed):
    a = fcl.CollisionObject(first, fcl.Transform())
    b = fcl.CollisionObject(second, fcl.Transform(np.eye(3), np.array([0.0, 0.0, height])))
    request = fcl.DistanceRequest(enable_nearest_points=True, enable_signed_distance=signed)
    return fcl.distance(a, b, request, fcl.DistanceResult())


pairs = {
    "box on box": (fcl.Box(1, 1, 1), fcl.Box(1, 1, 1), 1.0),
    "sphere on sphere": (fcl.Sphere(0.5), fcl.Sphere(0.5), 1.0),
    "sphere on box": (fcl.Box(1, 1, 1), fcl.Sphere(0.5), 1.0),
    "capsule on capsule": (fcl.Capsule(0.5, 1), fcl.Capsule(0.5, 1), 2.0),
    "mesh on mesh": (mesh(), mesh(), 1.0),
}
seen = {}
print("python-fcl", fcl.__version__ if hasattr(fcl, "__version__") else "0.7.0.11")
for name, (first, second, touch) in pairs.items():
    apart = gap(first, second, touch + 1e-3, False)
    plain = gap(first, second, touch - 1e-3, False)
    signed = gap(first, second, touch - 1e-3, True)
    seen[name] = plain, signed
    print(f"{name:20s} 1 mm apart: {apart:+.4f}; 1 mm overlap: {plain:+.4f}; signed distance: {signed:+.4f} m")
    assert abs(apart - 1e-3) < 1e-5
for name in ("box on box", "sphere on sphere", "sphere on box"):
    assert abs(seen[name][0] + 1) < 1e-9 and abs(seen[name][1] + 1e-3) < 1e-5
assert abs(seen["capsule on capsule"][0] + 1e-3) < 1e-6
assert seen["mesh on mesh"] == (0.0, 0.0)
EOF
