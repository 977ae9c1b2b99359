#!/usr/bin/env bash
# Title: Between two meshes, Coal reports contacts a metre deep with sideways normals where boxes overlap by
#   1 mm.
# Version: Coal 3.0.3
# Guess: For two meshed boxes the deepest contact is about the depth of the boxes, and the normals are those
#   of the touching faces.
# Seen: An overlap of 1 mm of two boxes of 1 m: the primitives give one contact, -0.001 m, along z. The
#   meshes give 52 contacts with depths down to -1.0 m; 28 are deeper than 1.1 mm and all of these have
#   normals in x or y. The distance of the meshes is 0. A mesh against a sphere is right.
# Hurts: Anyone who loads links as meshes and feeds all contacts, or the deepest one, to a contact law: the
#   force is up to a thousand times too large and pushes sideways.
# Documented: Maintainers say that the depth of a mesh contact holds for the pair of triangles alone; the
#   depth is reported without a mark.
# Instead: Use convex hulls (or a convex decomposition) in place of meshes, or pair a mesh with primitives.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  coal==3.0.3 libcoal==3.0.3 eigenpy==3.13.0 numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import coal
import numpy as np

CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
FACES = np.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
                  (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])


def mesh():
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(FACES), len(CORNERS))
    model.addVertices(CORNERS)
    model.addTriangles(FACES)
    model.endModel()
    return model


def hull():
    model = mesh()
    model.buildConvexRepresentation(False)
    return model.convex


def contacts(first, second, height):
    place = coal.Transform3s()
    place.setTranslation(np.array([0.0, 0.0, height]))
    request, result = coal.CollisionRequest(), coal.CollisionResult()
    request.num_max_contacts = 200
    coal.collide(first, coal.Transform3s(), second, place, request, result)
    found = [result.getContact(i) for i in range(result.numContacts())]
    depth = np.array([c.penetration_depth for c in found])
    tilt = np.array([abs(c.normal[2]) for c in found])
    distance = coal.distance(first, coal.Transform3s(), second, place, coal.DistanceRequest(), coal.DistanceResult())
    return depth, tilt, distance


print("Coal", coal.__version__, "- overlap 1 mm along z")
seen = {}
for name, first, second in (("box on box", coal.Box(1, 1, 1), coal.Box(1, 1, 1)), ("mesh on mesh", mesh(), mesh()),
                            ("hull on hull", hull(), hull()), ("sphere on mesh", mesh(), coal.Sphere(0.5))):
    depth, tilt, distance = seen[name] = contacts(first, second, 0.999)
    deep = np.abs(depth) > 0.0011
    print(f"{name:15s} {len(depth):3d} contacts, deepest {depth.min():+.4f} m, distance {distance:+.4f} m, "
          f"deeper than 1.1 mm: {deep.sum()}, of these sideways: {(deep & (tilt < 0.1)).sum()}")
for name in ("box on box", "hull on hull", "sphere on mesh"):
    assert np.all(np.abs(seen[name][0] + 1e-3) < 1e-5) and np.all(seen[name][1] > 0.99)
    assert abs(seen[name][2] + 1e-3) < 1e-5
depth, tilt, distance = seen["mesh on mesh"]
assert depth.min() < -0.9 and distance == 0
assert np.any((np.abs(depth) > 0.5) & (tilt < 0.1))
EOF
