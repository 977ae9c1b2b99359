#!/usr/bin/env bash
# Title: The second derivative of a Hertz contact law max(gap, 0)^1.5 is NaN wherever there is no contact,
#   in CasADi and in JAX; the first is right.
# Version: CasADi 3.8.2, JAX 0.10.2
# Guess: Out of contact, force, stiffness and all further derivatives are zero; a law whose gradient has
#   been checked is safe for second-order methods.
# Seen: At a gap of 1 mm: force 0, first derivative 0, second derivative NaN in both. One such contact makes
#   the Hessian of the sum over all contacts NaN. CasADi if_else and a guarded base in JAX give 0; a guard
#   around the power in JAX gives NaN already in the gradient.
# Hurts: Anyone who optimises grasps, trajectories or contact parameters with exact Hessians, or
#   differentiates a tangent stiffness: the solver fails at points without contact, where nothing happens.
# Documented: The guard of both branches is in the list of common pitfalls of JAX; that a clipped power
#   passes the gradient test and fails in the Hessian is not.
# Instead: Clip to a base that is positive where the law is not used, then select the result; in CasADi use
#   if_else. Test the Hessian out of contact.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  casadi==3.8.2 jax==0.10.2 jaxlib==0.10.2 numpy==2.4.6 scipy==1.17.1
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import casadi
import jax
import jax.numpy as jnp
import numpy as np

jax.config.update("jax_enable_x64", True)
print("CasADi", casadi.__version__, "and JAX", jax.__version__)


def clipped(depth):
    return jnp.maximum(depth, 0.0) ** 1.5


def guarded_result(depth):
    return jnp.where(depth > 0, depth**1.5, 0.0)


def guarded_base(depth):
    return jnp.where(depth > 0, jnp.where(depth > 0, depth, 1.0) ** 1.5, 0.0)


seen = {}
for name, law in (("clipped", clipped), ("guarded result", guarded_result), ("guarded base", guarded_base)):
    for depth in (-1e-3, 1e-3):
        slope = jax.grad(law)
        seen["JAX", name, depth] = tuple(float(f(jnp.asarray(depth))) for f in (law, slope, jax.grad(slope)))
x = casadi.SX.sym("x")
for name, law in (("clipped", casadi.fmax(x, 0) ** 1.5), ("if_else", casadi.if_else(x > 0, x**1.5, 0))):
    slope = casadi.gradient(law, x)
    function = casadi.Function("law", [x], [law, slope, casadi.gradient(slope, x)])
    for depth in (-1e-3, 1e-3):
        seen["CasADi", name, depth] = tuple(float(value) for value in function(depth))
for (tool, name, depth), values in seen.items():
    print(f"{tool:7s}{name:15s} depth {1e3 * depth:+.0f} mm: force {values[0]:.3e}, "
          f"derivatives {values[1]:.3e}, {values[2]:.3e}")
for tool in ("JAX", "CasADi"):
    force, first, second = seen[tool, "clipped", -1e-3]
    assert force == 0 and first == 0 and np.isnan(second)
assert np.isnan(seen["JAX", "guarded result", -1e-3][1])
assert seen["JAX", "guarded base", -1e-3] == (0, 0, 0) and seen["CasADi", "if_else", -1e-3] == (0, 0, 0)
for key, values in seen.items():
    if key[2] > 0:
        assert np.allclose(values, (1e-3**1.5, 1.5 * 1e-3**0.5, 0.75 * 1e-3**-0.5))

# ten contacts on one rigid body with one degree of freedom; one of them is open
depths = casadi.DM([1e-3] * 9 + [-1e-4])
total = casadi.sum1(casadi.fmax(x + depths, 0) ** 1.5)
curvature = float(casadi.Function("h", [x], [casadi.hessian(total, x)[0]])(0))
print("second derivative of the sum over nine closed contacts and one open contact:", curvature)
assert np.isnan(curvature)
EOF
