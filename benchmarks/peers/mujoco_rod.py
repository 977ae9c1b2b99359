"""The cases with MuJoCo: its discrete elastic rod (one-dimensional flexcomp), integrated explicitly.

The edges have the axial stiffness of the material (`edge stiffness`), which the integrator `discrete` does not support; its inextensible edges
are soft constraints. Clamps are placed in the middle of the clamped edge, where they are of second order.
"""

import math

import mujoco
import numpy as np

import peer
import references as ref
from references import AREA, AXIAL, BENDING, DENSITY, DIAMETER, LENGTH, MASS, POISSON, PROBE, SPAN, SPEED, TRAVELS, YOUNG


CONTACT = 'solref="{} 1" solimp="0.9999 0.9999 1e-6"'  # as stiff as a step allows
DEFAULT_STEP = 2e-3


def stable_step(spacing, share=0.9):
    """Share of the longest step that follows the waves along an edge."""
    return share * spacing / math.sqrt(YOUNG / DENSITY)


def rod(edges, step, both_ends, damping=0.0, defaults=False, extra=""):
    """Model of the wire with so many edges between its clamps (or clamp and tip), the number of its points, their spacing, and the share of
    the held edge that is outside the clamp.

    defaults: step, integrator, contact and edges that do not stretch as MuJoCo has them; the clamp at the inner point of the held edge.
    """
    middle = not defaults
    beyond = 0.5 if middle else 1.0
    free = edges if both_ends else edges - 0.5 if middle else edges
    spacing = LENGTH / free
    points = edges + 1 + both_ends + (not middle)
    pins = [0, 1] + ([points - 2, points - 1] if both_ends else [])
    stretch = '<edge equality="true"/>' if defaults else f'<edge stiffness="{AXIAL / spacing}"/>'
    contact = "" if defaults else CONTACT.format(2 * step)
    option = "" if defaults else f'timestep="{step}" integrator="Euler"'
    model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <option {option} gravity="0 0 0"/>
  <size memory="100M"/>
  <worldbody>
    <flexcomp name="rod" type="grid" dim="1" count="{points} 1 1" spacing="{spacing} 1 1"
              pos="{(0.5 * (points - 1) - beyond) * spacing} 0 0" radius="{DIAMETER / 2}" mass="{DENSITY * AREA * spacing * points}">
      {stretch}
      <elasticity young="{YOUNG}" poisson="{POISSON}" damping="{damping}"/>
      <contact selfcollide="none" condim="1" {contact}/>
      <pin id="{' '.join(map(str, pins))}"/>
    </flexcomp>
    {extra}
  </worldbody>
</mujoco>""")
    return model, points, spacing, beyond


def vertices(model, points):
    """Addresses in qpos of the first slide of every free point."""
    joints = {}
    for k in range(points):
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, f"rod_{k}")
        if body >= 0:
            joints[k] = model.jnt_qposadr[model.body_jntadr[body]]
    return joints


def buckle(model, data, points, spacing, beyond):
    """Moves the right clamp to the span and the points to a shape of the right length."""
    model.flex_vert[-2:, 0] += SPAN - LENGTH
    share, x, y, _ = ref.buckled()
    for k, address in vertices(model, points).items():
        s = (k - beyond) * spacing
        data.qpos[address] = np.interp(s / LENGTH, share, x) - s
        data.qpos[address + 1] = np.interp(s / LENGTH, share, y)
    mujoco.mj_forward(model, data)


def damp(model, rate):
    """Drag in proportion to mass."""
    for j in range(model.njnt):
        if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_SLIDE:
            dof = model.jnt_dofadr[j]
            model.dof_damping[dof] = rate * model.dof_M0[dof]


def check(data):
    """Raises if MuJoCo has reset a diverged state, which it only counts as a warning."""
    bad = [data.warning[w].number for w in (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)]
    if any(bad):
        raise RuntimeError("diverges")


def contact_force(model, data):
    total = np.zeros(3)
    force = np.zeros(6)
    for i in range(data.ncon):
        mujoco.mj_contactForce(model, data, i, force)
        total += data.contact[i].frame.reshape(3, 3).T @ force[:3]
    return abs(total[1])


def push(edges=40, share=0.9, hold=0.012, rate=2500.0, defaults=False, position=0.065, travels=TRAVELS):
    step = DEFAULT_STEP if defaults else stable_step(LENGTH / edges, share)
    extra = (f'<body name="pusher" mocap="true" pos="{position} -0.1 0"><geom type="capsule" size="{PROBE - DIAMETER / 2} 0.02" condim="1" '
             f'{"" if defaults else CONTACT.format(2 * step)}/></body>')
    model, points, spacing, beyond = rod(edges, step, True, defaults=defaults, extra=extra)
    data = mujoco.MjData(model)
    buckle(model, data, points, spacing, beyond)
    damp(model, rate)
    mujoco.mj_step(model, data, nstep=round(hold / step))
    level = ref.chain_touch(data.flexvert_xpos, position)
    at = 0.0
    forces = []
    for travel in travels:
        chunks = 100
        for c in range(chunks):
            data.mocap_pos[0] = [position, level + at + (travel - at) * (c + 1) / chunks, 0.0]
            mujoco.mj_step(model, data, nstep=max(1, round(0.002 / step / chunks)))
        at = travel
        mujoco.mj_step(model, data, nstep=round(hold / step))
        forces.append(float(contact_force(model, data)))
    check(data)
    return {"force_N": forces, "step_s": step, "first_touch_m": level}


def impact(edges=40, share=0.9, damping=0.0, defaults=False, until=0.3):
    step = DEFAULT_STEP if defaults else stable_step(LENGTH / edges, share)
    extra = (f'<body name="body" pos="{0.5 * SPAN} -0.1 0"><joint type="slide" axis="0 1 0"/><inertial pos="0 0 0" mass="{MASS}" '
             f'diaginertia="0.16 0.16 0.16"/><geom type="capsule" size="{PROBE - DIAMETER / 2} 0.02" condim="1" '
             f'{"" if defaults else CONTACT.format(2 * step)}/></body>')
    model, points, spacing, beyond = rod(edges, step, True, damping=damping, defaults=defaults, extra=extra)
    data = mujoco.MjData(model)
    slide = model.jnt_qposadr[model.body_jntadr[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "body")]]
    data.qpos[slide] = -0.1
    buckle(model, data, points, spacing, beyond)
    damp(model, 2500.0)
    mujoco.mj_step(model, data, nstep=round(0.012 / step))
    damp(model, 0.0)
    data.qvel[:] = 0.0
    data.qpos[slide] = ref.chain_touch(data.flexvert_xpos, 0.5 * SPAN) - 1e-4 + 0.1
    data.qvel[slide] = SPEED
    window = max(1, round(1e-4 / step))
    speeds = [SPEED]
    for _ in range(round(until / step / window)):
        mujoco.mj_step(model, data, nstep=window)
        speeds.append(float(data.qvel[slide]))
    check(data)
    return {"peak_N": peer.peak(speeds, window * step, MASS), "impulse_Ns": MASS * (SPEED - speeds[-1]), "damped": False, "step_s": step}


def tip(edges=20, share=0.9, load=4.0, rate=400.0, until=0.15, defaults=False):
    step = DEFAULT_STEP if defaults else stable_step(LENGTH / edges, share)
    model, points, spacing, _ = rod(edges, step, False, defaults=defaults)
    data = mujoco.MjData(model)
    damp(model, rate)
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, f"rod_{points - 1}")
    data.xfrc_applied[body, 1] = load * BENDING / LENGTH**2
    mujoco.mj_step(model, data, nstep=round(until / step))
    check(data)
    place = data.flexvert_xpos[-1]
    return {"tip": [float(place[0]) / LENGTH, float(place[1]) / LENGTH], "step_s": step}


def frequency(edges=20, share=0.9, until=0.2, defaults=False):
    """Of a small free vibration, begun in the first mode of the continuous wire."""
    step = DEFAULT_STEP if defaults else stable_step(LENGTH / edges, share)
    model, points, spacing, beyond = rod(edges, step, False, defaults=defaults)
    if not defaults:  # the tip's point has the mass of half an edge
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, f"rod_{points - 1}")
        model.body_mass[body] *= 0.5
    data = mujoco.MjData(model)
    if not defaults:
        mujoco.mj_setConst(model, data)
    for k, address in vertices(model, points).items():
        data.qpos[address + 1] = 1e-4 * LENGTH * ref.first_mode((k - beyond) * spacing / LENGTH)
    last = vertices(model, points)[points - 1] + 1
    window = max(1, round(1e-4 / step))
    tips = [float(data.qpos[last])]
    for _ in range(round(until / step / window)):
        mujoco.mj_step(model, data, nstep=window)
        tips.append(float(data.qpos[last]))
    check(data)
    return {"frequency_Hz": peer.frequency(tips, window * step), "step_s": step}


def ball_chain(edges, step, angle, turning, weld):
    """Model of the straight wire between clamps: edges joined by balls, of which the first is held in its middle and the last is welded in its middle
    to a clamp that slides along x and is turned by an angle. turning: factor of the rotational inertia about the wire; weld: attributes of the weld.
    """
    spacing = LENGTH / edges
    mass = DENSITY * AREA * spacing
    polar = min(turning * mass * DIAMETER**2 / 8, mass * spacing**2 / 6)
    shape = f'mass="{mass}" diaginertia="{polar} {mass * spacing**2 / 12} {mass * spacing**2 / 12}"'
    links = "".join(f'<body name="edge_{k}" pos="{spacing} 0 0"><joint name="ball_{k}" type="ball" stiffness="{BENDING / spacing}"/>'
                    f'<inertial pos="{spacing / 2} 0 0" {shape}/>' for k in range(1, edges + 1)) + "</body>" * edges
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <option timestep="{step}" integrator="Euler" gravity="0 0 0"><flag contact="disable"/></option>
  <size memory="100M"/>
  <worldbody>
    <body name="edge_0" pos="{-spacing / 2} 0 0">{links}</body>
    <body name="clamp" pos="{LENGTH} 0 0" quat="{math.cos(angle / 2)} {math.sin(angle / 2)} 0 0">
      <joint type="slide" axis="1 0 0"/><inertial pos="0 0 0" {shape}/>
    </body>
  </worldbody>
  <equality><weld body1="edge_{edges}" body2="clamp" anchor="0 0 0" relpose="{spacing / 2} 0 0 1 0 0 0" {weld}/></equality>
</mujoco>""")


def twist(edges=20, share=0.5, until=0.2, turning=100.0, defaults=False):
    """Frequencies of the straight wire, twisted evenly between its clamps. A flex of one dimension has points alone, without torsion, so that this is a
    chain of bodies joined by balls with the stiffness EI over an edge about all axes; the moment at which the wire buckles does not depend on GJ.
    The enlarged rotational inertia about the wire leaves where the frequencies vanish."""
    spacing = LENGTH / edges
    about = 2 / spacing * math.sqrt(BENDING / (DENSITY * AREA * DIAMETER**2 / 8 * turning))  # fastest turning about the wire [rad/s]
    zigzag = math.sqrt(48 * BENDING / (DENSITY * AREA)) / spacing**2
    step = DEFAULT_STEP if defaults else share * 2 / max(about, zigzag)
    weld = "" if defaults else CONTACT.format(2 * step)
    squares = []
    for part in peer.SHARES:
        angle = part * ref.GREENHILL / BENDING * LENGTH
        model = ball_chain(edges, step, angle, 1.0 if defaults else turning, weld)
        data = mujoco.MjData(model)
        slopes = [1e-5 * math.pi * math.sin(2 * math.pi * k / edges) for k in range(edges + 1)]  # of 1e-5 L sin^2(pi x/L) in the middles of the edges
        for k in range(1, edges + 1):
            turned = angle * (k - 1) / edges  # of the edge before
            bend = np.array([0.0, math.sin(turned), math.cos(turned)]) * (slopes[k] - slopes[k - 1])
            quaternion = np.zeros(4)
            mujoco.mju_mulQuat(quaternion, np.array([1.0, *(bend / 2)]), np.array([math.cos(angle / edges / 2), math.sin(angle / edges / 2), 0.0, 0.0]))
            data.joint(f"ball_{k}").qpos[:] = quaternion / np.linalg.norm(quaternion)
        mujoco.mj_forward(model, data)
        middle = model.body(f"edge_{edges // 2}").id
        window = max(1, round(2e-4 / step))
        track = [float(data.xipos[middle][1])]
        for _ in range(round(until / step / window)):
            mujoco.mj_step(model, data, nstep=window)
            track.append(float(data.xipos[middle][1]))
        check(data)
        squares.append(peer.frequency(track, window * step)**2)
    return {"critical": peer.critical(squares), "step_s": step}


if __name__ == "__main__":
    peer.main(globals())
