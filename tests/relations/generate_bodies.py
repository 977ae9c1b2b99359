"""Bodies alone: bushings, welds, loads, contacts by laws, driven bodies, planes."""

from cases import Case, Draw
from generate_motion import body, friction

LAWS = ("spring_dashpot", "power", "step_damped")


def law(draw, model):
    if model == "spring_dashpot":
        return {"k_N_m": draw.log(1e3, 1e5), "c_Ns_m": draw.choice([0.0, draw.log(0.1, 30.0)])}
    if model == "power":
        return {"k": draw.log(1e5, 1e7), "p": draw.choice([1.0, 1.5, 2.0]), "c": draw.choice([0.0, draw.log(1e3, 1e6)])}
    return {
        "k": draw.log(1e4, 1e6),
        "p": draw.choice([1.0, 1.5]),
        "c_Ns_m": draw.log(0.1, 30.0),
        "full_depth_mm": draw.between(0.05, 1.0),
    }


def generate(seed):
    draw = Draw(seed)
    main = {
        "schema": "snare-scenario/2",
        "title": str(seed),
        "duration_s": draw.choice([0.2, 0.5]),
        "output_interval_s": 0.01,
        "output": {"checkpoint_interval_s": 10.0},
    }
    number = draw.choice([1, 2, 2, 3])
    main["bodies"] = [
        body(draw, f"b{k}", [200.0 * k, draw.between(-20.0, 20.0), draw.between(-20.0, 20.0)], 30.0, draw.vector(0.5))
        for k in range(number)
    ]
    if draw.maybe(0.4):
        main["gravity"] = {"vector_m_s2": draw.vector(9.81)}
    if draw.maybe(0.6):
        main["bushings"] = [bushing(draw, k, number) for k in range(draw.choice([1, 2]))]
    if number > 1 and draw.maybe(0.25):
        main["welds"] = [{"name": "glue", "body": "b1", "frame": "b0"}]
        for name in ("spin_rad_s", "rotation_deg"):
            main["bodies"][1].pop(name, None)
        main["bodies"][0].pop("spin_rad_s", None)
        main["bodies"][1]["velocity_m_s"] = list(main["bodies"][0]["velocity_m_s"])
    if draw.maybe(0.4):
        main["loads"] = [load(draw, k, number) for k in range(draw.choice([1, 2]))]
    if draw.maybe(0.5):
        touching(draw, main, number)
    if draw.maybe(0.2):
        main["frames"] = [{"name": "corner", "frame": "b0", "position_mm": draw.vector(50.0), "rotation_deg": draw.vector(90.0)}]
        if "loads" in main:
            main["loads"][0]["frame"] = "corner"
    return Case("simulate", main)


def bushing(draw, k, number):
    other = draw.choice(["world", f"b{number - 1}", f"b{number - 1}"]) if number > 1 else "world"
    stiff = draw.log(50.0, 1e5)
    table = {
        "name": f"spring{k}",
        "frame": other,
        "other_frame": "b0",
        "translational_stiffness_N_m": draw.choice([stiff, [stiff, 2.0 * stiff, 0.0]]),
        "rotational_stiffness_Nm_rad": draw.log(0.5, 100.0),
    }
    if draw.maybe(0.6):
        table |= {"translational_damping_Ns_m": draw.log(0.1, 30.0), "rotational_damping_Nms_rad": draw.log(1e-3, 0.1)}
    return table


def load(draw, k, number):
    table = {
        "name": f"push{k}",
        "frame": f"b{draw.randrange(number)}",
        "axes": draw.choice(["frame", "world"]),
        "force_N": draw.vector(5.0),
    }
    if draw.maybe(0.5):
        table["moment_Nm"] = draw.vector(0.02)
    if draw.maybe(0.5):
        table["position_mm"] = draw.vector(20.0)
    if draw.maybe(0.6):
        table |= draw.choice(
            [
                {"begin_s": 0.03, "duration_s": 0.05, "shape": "half_sine"},
                {"begin_s": 0.02, "duration_s": 0.1, "ramp_s": 0.02},
                {"duration_s": 0.02, "ramp_s": 0.005, "pulses": 3, "every_s": 0.05},
            ]
        )
    return table


def touching(draw, main, number):
    """A ball that falls on a plane, on another ball or on a driven one."""
    model = draw.choice(LAWS)
    ball = {"name": "ball", "frame": "b0", "kind": "sphere", "radius_mm": 30.0}
    other = draw.choice(["plane", "driven"] + (["ball"] if number > 1 else []))
    main["shapes"] = [ball]
    b = main["bodies"]
    if other == "plane":
        main["shapes"].append(
            {
                "name": "other",
                "frame": "world",
                "kind": "plane",
                "position_mm": [0.0, 0.0, b[0]["position_mm"][2] - 33.0],
                "rotation_deg": [draw.between(-20, 20), 0.0, 0.0],
            }
        )
        b[0]["velocity_m_s"][2] = -abs(b[0]["velocity_m_s"][2]) - 0.1
    elif other == "driven":
        at = b[0]["position_mm"]
        b.append(
            {
                "name": "ram",
                "driven": True,
                "position_mm": [at[0] - 55.0, at[1], at[2]],
                "velocity_m_s": [draw.between(0.05, 0.5), 0.0, 0.0],
            }
        )
        main["shapes"].append({"name": "other", "frame": "ram", "kind": "sphere", "radius_mm": 20.0})
    else:
        b[1]["position_mm"] = [b[0]["position_mm"][0] + 62.0, b[0]["position_mm"][1] + 5.0, b[0]["position_mm"][2]]
        b[0]["velocity_m_s"][0] = abs(b[0]["velocity_m_s"][0]) + b[1]["velocity_m_s"][0] + 0.1
        main["shapes"].append({"name": "other", "frame": "b1", "kind": "sphere", "radius_mm": 30.0})
    shape, one = draw.choice([("other", "ball"), ("ball", "other")]) if other != "plane" else ("other", "ball")
    main["contacts"] = [{"name": "touch", "shape": shape, "other_shape": one, "model": model, **law(draw, model), **friction(draw)}]
    if "welds" in main and other == "ball":
        del main["welds"]
