"""Programs, cases, and for each program and case: a ladder of settings, the defaults, and a mesh or step halved twice."""

CASES = {
    "push": "a cylinder of 6 mm pushes the loose wire at 65 mm, 20 forces to 4 mm; error of the curve over its largest force",
    "impact": "8.9 kg at 0.1 m/s meet the middle, 0.3 s; the larger error of peak force and impulse",
    "tip": "cantilever under F L^2 = 4 EI at its tip; error of the tip's place over the length",
    "frequency": "first frequency of the cantilever",
    "twist": "twist at which the straight wire between clamps leaves its axis",
}

PROGRAMS = {
    "snare": {"environment": "rods", "script": "snare_wire.py", "version": None, "what": "discrete elastic rods; static paths, motion by IDA"},
    "EXUDYN": {"environment": "rods", "script": "exudyn_cable.py", "version": "1.13.6", "what": "ANCF cable of the plane; for the twist geometrically exact beams"},
    "MuJoCo": {"environment": "rods", "script": "mujoco_rod.py", "version": "4.0.0", "what": "flexcomp of one dimension with edge stiffness, for the twist bodies joined by balls; explicit steps"},
    "PyElastica": {"environment": "rods", "script": "elastica_rod.py", "version": "1.0.0", "what": "Cosserat rod, explicit steps"},
    "dismech-newton": {"environment": "dismech", "script": "dismech_rod.py", "version": "0.1.0.post4", "what": "implicit discrete elastic rods, on the CPU"},
    "Newton": {"environment": "newton", "script": "newton_rod.py", "version": "1.8.0", "what": "rod of capsules by VBD, on the CPU"},
}


def each(key, values, **others):
    return [{key: value, **others} for value in values]


RUNS = {
    "snare": {
        "push": {"ladder": [{}] + each("elements", (64, 128, 512)), "defaults": {}, "order": each("elements", (256, 512, 1024), extrapolate=False)},
        "impact": {"ladder": [{}] + each("elements", (12, 20)) + each("elements", (12, 40), model="quasi_static"), "defaults": {},
                   "order": each("elements", (60, 120, 240), formulation="vertices")},
        "tip": {"ladder": [{}] + each("elements", (8, 12, 20)), "defaults": {}, "order": each("elements", (10, 20, 40), formulation="vertices")},
        "frequency": {"ladder": [{}] + each("elements", (10, 20, 30)), "defaults": {}, "order": each("elements", (10, 20, 40))},
        "twist": {"ladder": [{}] + each("elements", (80, 160)) + each("elements", (80, 100), formulation="vertices"), "defaults": {},
                  "order": each("elements", (40, 80, 160))},
    },
    "EXUDYN": {
        "push": {"ladder": [{"elements": n, "segments": s, "stiffness": k} for n, s, k in
                            ((40, 8, 1e9), (80, 4, 1e9), (80, 8, 1e10), (100, 8, 1e10), (120, 8, 1e10))],
                 "defaults": {"elements": 40, "segments": 3, "defaults": True}, "order": each("elements", (30, 60, 120), segments=8, stiffness=1e10)},
        "impact": {"ladder": [{"elements": n, "step": h} for n, h in ((30, 5e-4), (30, 2e-4), (40, 2e-4), (60, 1e-4), (80, 1e-4))]
                             + [{"elements": n, "step": h, "spectral_radius": 0.3} for n, h in ((20, 1e-3), (24, 5e-4), (30, 5e-4), (40, 2e-4))],
                   "defaults": {"elements": 40, "step": 3e-3, "segments": 3, "modified": False},
                   "order": [{"elements": n, "step": h} for n, h in ((20, 4e-4), (40, 2e-4), (80, 1e-4))]},
        "tip": {"ladder": each("elements", (8, 16, 32)), "defaults": {"elements": 40, "steps": 1}, "order": each("elements", (4, 8, 16))},
        "frequency": {"ladder": each("elements", (4, 8)), "defaults": {"elements": 40}, "order": each("elements", (4, 8, 16))},
        "twist": {"ladder": each("elements", (16, 32, 64)), "defaults": {"elements": 40}, "order": each("elements", (16, 32, 64))},
    },
    "MuJoCo": {
        "push": {"ladder": each("edges", (20, 40, 80)), "defaults": {"defaults": True}, "order": each("edges", (20, 40, 80))},
        "impact": {"ladder": each("edges", (20, 40, 80)), "defaults": {"defaults": True}, "order": each("edges", (20, 40, 80))},
        "tip": {"ladder": each("edges", (10, 20, 30, 40)), "defaults": {"edges": 40, "defaults": True}, "order": each("edges", (10, 20, 40))},
        "frequency": {"ladder": each("edges", (10, 20, 40)), "defaults": {"edges": 40, "defaults": True}, "order": each("edges", (10, 20, 40))},
        "twist": {"ladder": each("edges", (10, 16, 20)), "defaults": {"edges": 40, "defaults": True}, "order": each("edges", (5, 10, 20))},
    },
    "PyElastica": {
        "push": {"ladder": each("elements", (20, 40, 80)), "defaults": {"defaults": True}, "order": each("elements", (20, 40, 80))},
        "impact": {"ladder": each("elements", (20, 40), damper=50.0), "defaults": {"defaults": True}, "order": []},
        "tip": {"ladder": each("elements", (10, 20, 40)), "defaults": {"elements": 40, "defaults": True}, "order": each("elements", (10, 20, 40))},
        "frequency": {"ladder": each("elements", (10, 20, 40)), "defaults": {"elements": 40, "defaults": True}, "order": each("elements", (10, 20, 40))},
        "twist": {"ladder": each("elements", (20, 40)), "defaults": None, "order": []},
    },
    "dismech-newton": {
        "tip": {"ladder": each("edges", (10, 20, 40)), "defaults": {"edges": 40, "iterations": 10, "exact": False}, "order": each("edges", (10, 20, 40))},
        "frequency": {"ladder": [{"edges": n, "step": h} for n, h in ((10, 2e-4), (20, 2e-4), (20, 5e-4), (40, 2e-4))],
                      "defaults": {"edges": 40, "iterations": 10, "exact": False, "theta": 1.0},
                      "order": [{"edges": n, "step": h} for n, h in ((10, 2e-4), (20, 2e-4), (40, 2e-4))]},
        "twist": {"ladder": each("edges", (40, 80)), "defaults": {"edges": 40, "iterations": 10, "exact": False, "theta": 1.0}, "order": []},
    },
    "Newton": {
        "tip": {"ladder": [{"segments": 10}, {"segments": 10, "iterations": 400}], "defaults": {"segments": 40, "defaults": True}, "order": []},
        "frequency": {"ladder": [{"segments": 10, "until": 0.1}], "defaults": {"segments": 40, "until": 0.1, "defaults": True}, "order": []},
    },
}

# Reasons for cases without an adapter.
CANNOT = {
    ("dismech-newton", "push"): "no adapter: the solver reports no contact force",
    ("dismech-newton", "impact"): "no adapter: bodies are obstacles that move as prescribed",
    ("Newton", "push"): "no adapter: the cantilever does not converge",
    ("Newton", "impact"): "no adapter: the cantilever does not converge",
    ("Newton", "twist"): "no adapter: the cantilever does not converge",
}

# Experiments of cosseratbench at its own resolution, with snare and with the solvers that it includes.
COSSERAT = {"version": "0.3.0", "experiments": ("cantilever", "catenary", "pendulum", "capstan", "crossing", "twist", "pile"),
            "solvers": ("snare", "mujoco", "pyelastica"), "limit_s": 100}
