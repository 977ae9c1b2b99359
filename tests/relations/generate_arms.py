"""Arms drawn joint by joint: laws of their springs, friction and drives of their motors, fixed or free bases, something at the tip."""

from cases import Case, Draw


def link(draw, name, length, heavy=True):
    mass = draw.log(1.0, 50.0)
    inertia = [float(f"{mass * (0.05 + 0.1 * length)**2 * draw.uniform(0.8, 1.2):.4g}") for _ in range(3)]
    inside = (
        (
            f'<inertial><origin xyz="{0.5 * length:.4g} {draw.between(-0.02, 0.02)} 0"/><mass value="{mass}"/>'
            f'<inertia ixx="{inertia[0]}" ixy="0" ixz="0" iyy="{inertia[1]}" iyz="0" izz="{inertia[2]}"/></inertial>'
        )
        if heavy
        else ""
    )
    return f'<link name="{name}">{inside}</link>'


def joint(draw, number, parent, child, length):
    kind = draw.choice(["revolute", "revolute", "revolute", "continuous", "prismatic"])
    axis = draw.choice(["1 0 0", "0 1 0", "0 0 1", "0 0.6 0.8"])
    limit = '<limit lower="-3" upper="3" effort="1000" velocity="10"/>' if kind != "continuous" else ""
    return (
        f'<joint name="j{number}" type="{kind}"><origin xyz="{length:.4g} 0 {0.1 * (number % 2)}" rpy="{draw.between(-0.5, 0.5)} 0 {draw.between(-0.5, 0.5)}"/>'
        f'<parent link="{parent}"/><child link="{child}"/><axis xyz="{axis}"/>{limit}</joint>'
    )


def spring(draw):
    table = {"motor_inertia_kg_m2": draw.log(0.1, 10.0)}
    kind = draw.random()
    if kind < 0.65:
        table |= {
            "law": "linear",
            "stiffness_Nm_rad": draw.log(1e3, 1e5),
            "damping_Nms_rad": draw.choice([0.0, draw.log(1.0, 50.0)]),
        }
    elif kind < 0.8:
        table |= {
            "law": "backlash",
            "stiffness_Nm_rad": draw.log(1e3, 1e5),
            "damping_Nms_rad": draw.log(1.0, 50.0),
            "half_gap_deg": draw.log(0.005, 0.1),
        }
    else:
        table |= {
            "law": "piecewise",
            "from_deg": [0.0, 0.05, 0.2],
            "stiffness_Nm_deg": [draw.log(5.0, 50.0), draw.log(50.0, 500.0), draw.log(500.0, 900.0)],
            "damping_Nms_deg": [draw.log(0.5, 5.0), draw.log(0.5, 5.0), draw.log(0.5, 5.0)],
        }
    table["drive"] = draw.choice(["locked", "limp", "servo"])
    if table["drive"] == "servo":
        table |= {"proportional_Nm_rad": draw.log(100.0, 1e4), "derivative_Nms_rad": draw.log(10.0, 500.0), "limit_Nm": 1e4}
    for name, value in (
        ("viscous_Nms_rad", draw.log(0.1, 20.0)),
        ("coulomb_Nm", draw.log(0.05, 5.0)),
        ("quadratic_Nms2_rad2", draw.log(0.01, 1.0)),
    ):
        if draw.maybe(0.3):
            table[name] = value
    return table


def generate(seed):
    draw = Draw(seed)
    number = draw.choice([1, 2, 2, 3])
    free = draw.maybe(0.3)
    lengths = [draw.between(0.2, 1.0) for _ in range(number + 1)]
    parts = [link(draw, "base", 0.2, free)]
    for k in range(number):
        parts += [
            link(draw, f"l{k}", lengths[k + 1]),
            joint(draw, k, "base" if k == 0 else f"l{k - 1}", f"l{k}", lengths[k] if k else 0.0),
        ]
    urdf = '<?xml version="1.0"?>\n<robot name="drawn">\n' + "\n".join(parts) + "\n</robot>\n"
    arm = {"schema": "snare-arm/1", "title": str(seed), "urdf": "arm.urdf", "tip": f"l{number - 1}"}
    if free:
        arm["base"] = {"kind": "free"}
    arm["joint"] = {f"j{k}": spring(draw) for k in range(number)}
    if draw.maybe(0.2):
        arm["link"] = {"l0": {"bending_compliance_rad_Nm": draw.log(1e-6, 1e-4)}}
    arm["pose"] = [{"name": "start", "angles_deg": [draw.between(-60.0, 60.0) for _ in range(number)]}]
    main = {
        "schema": "snare-scenario/2",
        "title": str(seed),
        "duration_s": 0.4,
        "output_interval_s": 0.01,
        "output": {"checkpoint_interval_s": 10.0},
        "arms": [{"name": "rms", "file": "arm.toml", "pose": "start", "base_frame": "world", "base_mm": draw.vector(200.0)}],
    }
    if draw.maybe(0.6):
        main["arms"][0]["rates_deg_s"] = [draw.between(-20.0, 20.0) for _ in range(number)]
    if draw.maybe(0.4):
        main["gravity"] = {"vector_m_s2": draw.vector(9.81)}
    if draw.maybe(0.5):
        main["loads"] = [
            {
                "name": "push",
                "frame": "rms::tip",
                "axes": draw.choice(["frame", "world"]),
                "force_N": draw.vector(20.0),
                "begin_s": 0.05,
                "duration_s": 0.1,
                "shape": "half_sine",
            }
        ]
    if draw.maybe(0.4):
        main["drives"] = [
            {
                "joint": f"rms::j{draw.randrange(number)}",
                "mode": "servo",
                "proportional_Nm_rad": draw.log(100.0, 1e4),
                "derivative_Nms_rad": draw.log(10.0, 500.0),
                "limit_Nm": 1e4,
                "by_deg": draw.between(-10.0, 10.0),
                "duration_s": 0.3,
            }
        ]
        if 'type="prismatic"' in urdf:
            del main["drives"]
    if draw.maybe(0.4):
        mass = draw.log(1.0, 100.0)
        main["bodies"] = [
            {
                "name": "load",
                "frame": "rms::tip",
                "mass_kg": mass,
                "inertia_kg_m2": [float(f"{mass * 0.02 * draw.uniform(0.8, 1.2):.4g}") for _ in range(3)],
                "position_mm": draw.vector(100.0),
            }
        ]
        main["welds"] = [{"name": "grip", "body": "load", "frame": "rms::tip"}]
    return Case("simulate", main, arm__toml=arm, arm__urdf=urdf)
