"""Records of a body on a spring, in closed form with noise."""

import math

from cases import Case, Draw


def generate(seed):
    draw = Draw(seed)
    mass, stiffness = draw.log(0.5, 50.0), 0.0
    turns = draw.between(20.0, 60.0)  # [rad/s]
    stiffness = float(f"{mass * turns**2:.4g}")
    damping = float(f"{mass * draw.between(1.0, 6.0):.4g}")
    speed = draw.between(0.1, 0.5)
    sigma = float(f"{1e3 * speed / turns * draw.log(0.003, 0.03):.3g}")
    decay = 0.5 * damping / mass
    omega = math.sqrt(stiffness / mass - decay**2)
    main = {
        "schema": "snare-record/1",
        "title": str(seed),
        "scenario": "scenario.toml",
        "records": [],
        "fit": {"free": ["bushings[spring].translational_stiffness_N_m", "bushings[spring].translational_damping_Ns_m"]},
    }
    files = {
        "scenario__toml": {
            "schema": "snare-scenario/2",
            "title": str(seed),
            "duration_s": 1.0,
            "output_interval_s": 0.01,
            "bodies": [{"name": "b", "mass_kg": mass, "inertia_kg_m2": [1.0, 1.0, 1.0], "velocity_m_s": [speed, 0.0, 0.0]}],
            "bushings": [
                {
                    "name": "spring",
                    "frame": "world",
                    "other_frame": "b",
                    "translational_stiffness_N_m": float(f"{stiffness * draw.between(0.9, 1.1):.4g}"),
                    "rotational_stiffness_Nm_rad": 100.0,
                    "translational_damping_Ns_m": float(f"{damping * draw.between(0.6, 1.5):.4g}"),
                }
            ],
            "sensors": [{"name": "place", "kind": "position", "frame": "b"}],
        }
    }
    for k in range(draw.choice([1, 2])):
        factor = 1.0 if k == 0 else draw.between(0.5, 2.0)
        step = draw.choice([0.01, 0.013])
        times = [step * i for i in range(draw.choice([40, 60]))]
        rows = [
            f"{t:.6g},{1e3 * factor * speed / omega * math.exp(-decay * t) * math.sin(omega * t) + draw.gauss(0.0, sigma):.8g}"
            for t in times
        ]
        files[f"r{k}__csv"] = "time_s,x\n" + "\n".join(rows) + "\n"
        one = {"name": f"r{k}", "file": f"r{k}.csv", "columns": {"x": "place_x_mm"}, "sigma": sigma}
        if k:
            one["set"] = {"bodies[b].velocity_m_s": [factor * speed, 0.0, 0.0]}
        main["records"].append(one)
    return Case("fit", main, **files)
