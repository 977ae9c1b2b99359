"""From the bench to the odds: a rope is pushed and traced, a snare of it catches a visitor 2000 times, and the bench is asked what to
push next.

The sweep draws stiffness and length of the rope as the trace leaves them, correlated, and place and drift of the visitor. What the bench leaves open
of the peak tension T is g^T V g, V the covariance of the trace and g the slope of T along the rope's numbers, in captures that differ in
nothing else. One more reading of the force, with slopes j and the noise sigma of the bench, makes of V
    V' = V - V j j^T V / (sigma^2 + j^T V j)

usage: bench_to_odds.py DATA [--cases N] [--out FOLDER] [PICTURE.png]        DATA: the folder data of snare
"""

import argparse
import pathlib
import tempfile

import numpy as np
import snare

EA, LENGTH, EI = "wire.axial_stiffness_N", "wire.length_mm", "wire.bending_stiffness_Nm2"
SIGMA = 1.0  # of the bench [N]
PLACES = [25.0, 50.0, 75.0, 97.5]  # of a push that could be next [mm]
TRAVELS = np.linspace(0.0, 10.0, 41)  # [mm]
STRONGEST = 150.0  # that the load cell bears [N]
RUNS = 12  # captures for the slopes

arguments = argparse.ArgumentParser()
arguments.add_argument("data", type=pathlib.Path)
arguments.add_argument("picture", nargs="?")
arguments.add_argument("--cases", type=int, default=2000)
arguments.add_argument("--out")
options = arguments.parse_intermixed_args()

# The bench: numbers of the rope and their covariance.
bench = options.data / "experiments/snare_rope.toml"
traced = snare.trace(bench)
numbers = [EA, LENGTH, EI]
fitted = traced["final"]["parameters"]
value = np.array([fitted[name]["value"] for name in numbers])
sigma = np.array([fitted[name]["stderr"] for name in numbers])
correlation = np.array([[1.0 if a == b else traced["final"]["correlation"][a][b] for b in numbers] for a in numbers])
V = correlation * np.outer(sigma, sigma)
print(f"traced: {traced['verdict_kind']}; " + ", ".join(f"{n} = {v:.6g} +- {s:.2g}" for n, v, s in zip(numbers, value, sigma)))

# The odds.
odds = snare.sweep(options.data / "sweeps/capture_odds.toml", set={"cases": options.cases}, out=options.out)
caught = odds["fields"]["caught"]["true"]
strong = next(iter(odds["limits"].values()))
tension = odds["fields"]["tension_N"]
print("caught: {hits} of {cases}, {share:.4f} ({interval95[0]:.4f} to {interval95[1]:.4f})".format(**caught))
print("more than 1.3 kN: {hits} of {cases}, {share:.4f} ({interval95[0]:.4f} to {interval95[1]:.4f})".format(**strong))
print("peak tension: {q50:.0f} N in the middle, nine in ten captures within {q05:.0f} to {q95:.0f} N".format(**tension))
if odds["finished"] != odds["statuses"]["done"]:
    print(f"without a result: {odds['statuses']}")

# Slopes of the peak tension along the rope's numbers, in captures of the sweep that differ in nothing else. A string does not bend.
table = odds["table"]
keys = {"axial_stiffness_N": "snares[snare].wire.axial_stiffness_N", "length_mm": "snares[snare].wire.length_mm",
        "offset_x_mm": "bodies[htv].position_mm[1]", "offset_y_mm": "bodies[htv].position_mm[2]",
        "drift_x_m_s": "bodies[htv].velocity_m_s[1]", "drift_y_m_s": "bodies[htv].velocity_m_s[2]"}


def peak(case, **shift):
    """Largest tension [N] of a case whose numbers are shifted."""
    values = {key: table[name][case] + shift.get(name, 0.0) for name, key in keys.items()}
    result = snare.simulate(options.data / "scenarios/ssrms_htv_capture.toml",
                            set={"duration_s": 5.0, "output_interval_s": 0.05, "snares[snare].wire.model": "stretched", **values})
    return max(result["outcome"]["peak_tension_N"].values())


held = [k for k in range(len(table["case"])) if table["caught"][k]][:RUNS]
slopes = []
for case in held:
    steps = {"axial_stiffness_N": 2.0 * sigma[0], "length_mm": 2.0 * sigma[1]}
    slopes.append([(peak(case, **{n: d}) - peak(case, **{n: -d})) / (2.0 * d) for n, d in steps.items()] + [0.0])
g = np.array(slopes)


def left_open(covariance):
    """Scatter of the peak tension that the bench leaves [N]."""
    return float(np.sqrt(np.mean(np.einsum("ki,ij,kj->k", g, covariance, g))))


print(f"what the bench leaves open of it: {left_open(V):.2f} N")


# What one more reading would leave.
def forces(place, numbers_now):
    """Of a push at a place at all travels [N]."""
    text = bench.read_text().split("[[series]]")[0] + f"""[[series]]
name = "next"
contact_position_mm = {place}
travel_mm = {TRAVELS[-1]}
points = {len(TRAVELS)}
"""
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(text)
        file.flush()
        return snare.push(file.name, set=dict(zip(numbers, numbers_now)))["curves"]["next"]["force_N"]


after = np.full((len(PLACES), len(TRAVELS)), np.nan)
for i, place in enumerate(PLACES):
    slope = [(forces(place, value + d) - forces(place, value - d)) / (2.0 * d.sum()) for d in np.diag(0.5 * sigma)]
    for k, force in enumerate(forces(place, value)):
        j = np.array([s[k] for s in slope])
        if force <= STRONGEST:
            after[i, k] = left_open(V - np.outer(V @ j, V @ j) / (SIGMA**2 + j @ V @ j))
i, k = np.unravel_index(np.nanargmin(after), after.shape)
print(f"next reading: at {PLACES[i]:g} mm and {TRAVELS[k]:.4g} mm of travel, leaves {after[i, k]:.2f} N")

if options.picture:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.6), constrained_layout=True)
    left.hist(np.minimum(table["tension_N"], 2000.0), bins=50, range=(0.0, 2000.0), color="0.4")
    left.axvline(1300.0, color="tab:red")
    left.set(xlabel="peak tension [N], what is more at 2000", ylabel="captures")
    for place, line in zip(PLACES, after):
        right.plot(TRAVELS, line, label=f"{place:g} mm")
    right.axhline(left_open(V), color="0.5", linestyle=":")
    right.set(xlabel="travel of one more reading [mm]", ylabel="left open of the peak tension [N]", ylim=(0.0, None))
    right.legend(title="pushed at", frameon=False)
    figure.savefig(options.picture, dpi=120)
