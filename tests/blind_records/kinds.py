"""The kinds of blind records: what each machine is declared to be, which of its numbers are fitted, and what may be inside that is not declared.

A number that is fitted is declared up to a tenth off. An effect has the label that the tracing gives it, the number of plants.py (or of a
sensor) that it changes, and a first guess of its size, as a share of that number or, where the number is zero without it, in its own unit.
"""

from dataclasses import dataclass, field

import numpy as np

import plants

RECORDS = ("first", "second")


@dataclass
class Effect:
    label: str            # "name (place)" as in selected_places
    number: str           # of the plant, or "COLUMN:delay" of a sensor, "*:delay" of all
    guess: float
    share: bool = False   # the change is a share of the number


@dataclass
class Kind:
    plant: object
    truth: dict                                  # numbers of the plant without any effect
    free: dict                                   # key of the files: number of the plant
    sigma: dict                                  # by column: noise of one reading, in the unit of the column
    interval: float                              # between readings [s]
    effects: list
    files: object                                # numbers -> {name: text}
    outside: list = field(default_factory=list)  # in no catalogue: Effect with the column where it shows as label
    set: dict = field(default_factory=dict)      # by record: keys of the scenario


def sensor(column, what, guess):
    return Effect(f"sensor_{what} ({column})", f"{column}:{what}", guess)


TOOL = '<link name="tool"/><joint name="grip" type="fixed"><parent link="beam"/><child link="tool"/><origin xyz="1 0 0" rpy="0 0 0"/></joint>'


def urdf(mass, com, inertia, axis, more=""):
    return f"""<robot name="machine"><link name="stand"/><link name="beam"><inertial><origin xyz="{com}" rpy="0 0 0"/><mass value="{mass}"/>
<inertia ixx="{inertia}" ixy="0" ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"/></inertial></link>
<joint name="hinge" type="continuous"><parent link="stand"/><child link="beam"/><axis xyz="{axis}"/></joint>{more}</robot>
"""


def arm(lines):
    return 'schema = "snare-arm/1"\ntitle = "a joint"\nsource = "made up"\nurdf = "arm.urdf"\ntip = "beam"\n' + lines


SOLVER = """[solver]
max_order = 5
relative_tolerance        = 1e-8
body_angle_tolerance_rad  = 1e-9
body_spin_tolerance_rad_s = 1e-8
"""


def scenario(duration, interval, lines):
    return (f'schema = "snare-scenario/2"\ntitle = "declared"\nduration_s = {duration}\noutput_interval_s = {interval}\n' + lines + SOLVER)


def sensors(*items):
    return "".join(f'[[sensors]]\nname = "{name}"\nkind = "{kind}"\n{where}\n' for name, kind, where in items)


def swing_files(p):
    return {"arm.urdf": urdf(0.1478, "0 0 0.1476", p["inertia"], "0 1 0"),
            "arm.toml": arm(f"""[link.beam]
inertia_kg_m2 = [2e-3, {p["inertia"]!r}, 2e-3]
[joint.hinge]
law = "linear"
stiffness_Nm_rad = 1e3
damping_Nms_rad = 1e-2
motor_inertia_kg_m2 = 1e-6
viscous_Nms_rad = {p["viscous"]!r}
drive = "limp"
[[pose]]
name = "zero"
angles_deg = [0.0]
"""),
            "scenario.toml": scenario(4.0, 0.01, """[gravity]
vector_m_s2 = [0.0, 0.0, -9.81]
[[arms]]
name = "arm"
file = "arm.toml"
angles_deg = [90.0]
rates_deg_s = [0.0]
""" + sensors(("encoder", "joint_angle", 'joint = "arm::hinge"')))}


SWING = Kind(
    plant=plants.swing,
    truth={"inertia": 1.1e-3, "viscous": 6e-4, "coulomb": 0.0, "quadratic": 0.0, "offset": 0.0, "viscous_asymmetry": 0.0},
    free={"arms[arm].link.beam.inertia_kg_m2[2]": "inertia", "arms[arm].joint.hinge.viscous_Nms_rad": "viscous"},
    sigma={"encoder_deg": 0.05}, interval=0.01, files=swing_files,
    set={"second": {"arms[arm].angles_deg[1]": 120.0}},
    effects=[Effect("joint_coulomb_friction (arm::hinge)", "coulomb", 2e-5),
             Effect("joint_quadratic_drag (arm::hinge)", "quadratic", 1e-5),
             sensor("encoder_deg", "gain", 1e-3), sensor("encoder_deg", "drift", 0.01), sensor("encoder_deg", "bias", 0.02)])


def step_files(p):
    return {"arm.urdf": urdf(10.0, "0 0 0", p["link"], "0 0 1", TOOL),
            "arm.toml": arm(f"""[link.beam]
inertia_kg_m2 = [{p["link"]!r}, {p["link"]!r}, {p["link"]!r}]
[joint.hinge]
law = "linear"
stiffness_Nm_rad = {p["stiffness"]!r}
damping_Nms_rad = {p["damping"]!r}
motor_inertia_kg_m2 = {p["motor"]!r}
viscous_Nms_rad = {p["viscous"]!r}
drive = "servo"
proportional_Nm_rad = {p["proportional"]!r}
derivative_Nms_rad = 150.0
limit_Nm = 1e6
[[pose]]
name = "zero"
angles_deg = [0.0]
"""),
            "scenario.toml": scenario(2.0, 0.005, f"""[[arms]]
name = "arm"
file = "arm.toml"
pose = "zero"
[[phases]]
name = "go"
at_s = {p["begin"]!r}
[[phases.drives]]
joint = "arm::hinge"
mode = "servo"
to_deg = 5.0
rate_deg_s = {p["course_rate"]!r}
ramp_s = 0.05
""" + sensors(("motor", "motor_angle", 'joint = "arm::hinge"'), ("link", "joint_angle", 'joint = "arm::hinge"')))}


STEP = Kind(
    plant=plants.step,
    truth={"link": 3.0, "stiffness": 2000.0, "damping": 6.0, "motor": 1.0, "viscous": 5.0, "proportional": 4000.0, "begin": 0.2, "course_rate": 20.0,
           "gap": 0.0, "coulomb": 0.0, "flex": 0.0},
    free={"arms[arm].joint.hinge.stiffness_Nm_rad": "stiffness", "arms[arm].joint.hinge.viscous_Nms_rad": "viscous"},
    sigma={"motor_deg": 0.003, "link_deg": 0.003}, interval=0.005, files=step_files,
    set={"second": {"phases[go].drives[1].to_deg": -7.0}},
    effects=[Effect("joint_damping (arm::hinge)", "damping", 0.02, True),
             Effect("joint_backlash (arm::hinge)", "gap", 2e-3),
             Effect("motor_inertia (arm::hinge)", "motor", 0.01, True),
             Effect("servo_gain (arm::hinge)", "proportional", 0.01, True),
             Effect("ring_delay (go)", "begin", 1e-4 / 0.2, True),
             Effect("ring_rate (go.1)", "course_rate", 1e-3, True),
             Effect("joint_coulomb_friction (arm::hinge)", "coulomb", 0.2),
             Effect("link_flexibility (arm::beam)", "flex", 1e-5)])


def drive_files(p):
    files = {"arm.urdf": urdf(5.0, "0 0 0", 0.5, "0 0 1"),
             "arm.toml": arm(f"""[joint.hinge]
law = "linear"
stiffness_Nm_rad = 1e6
damping_Nms_rad = 500.0
motor_inertia_kg_m2 = {p["motor"]!r}
viscous_Nms_rad = {p["viscous"]!r}
drive = "limp"
[[pose]]
name = "zero"
angles_deg = [0.0]
"""),
             "scenario.toml": scenario(3.0, 0.01, """[[arms]]
name = "arm"
file = "arm.toml"
pose = "zero"
[[drives]]
joint = "arm::hinge"
mode = "torque"
torque_file = "torque_first.csv"
""" + sensors(("speed", "motor_rate", 'joint = "arm::hinge"')))}
    for record in RECORDS:
        times, torques = plants.drive_torque(record)
        files[f"torque_{record}.csv"] = "time_s,torque_Nm\n" + "".join(f"{t!r},{m!r}\n" for t, m in zip(times.tolist(), torques.tolist()))
    return files


DRIVE = Kind(
    plant=plants.drive,
    truth={"motor": 2.0, "viscous": 1.5, "coulomb": 0.0, "quadratic": 0.0, "offset": 0.0, "viscous_asymmetry": 0.0},
    free={"arms[arm].joint.hinge.motor_inertia_kg_m2": "motor", "arms[arm].joint.hinge.viscous_Nms_rad": "viscous"},
    sigma={"speed_deg_s": 0.3}, interval=0.01, files=drive_files,
    set={"second": {"drives[1].torque_file": "torque_second.csv"}},
    effects=[Effect("joint_coulomb_friction (arm::hinge)", "coulomb", 0.02),
             Effect("joint_friction_asymmetry (arm::hinge)", "offset", 0.02),
             Effect("joint_viscous_asymmetry (arm::hinge)", "viscous_asymmetry", 0.02),
             Effect("joint_quadratic_drag (arm::hinge)", "quadratic", 0.02),
             sensor("speed_deg_s", "lag", 1e-3), sensor("speed_deg_s", "delay", 1e-3)])


def payload_files(p):
    return {"scenario.toml": scenario(3.0, 0.01, f"""[[frames]]
name = "wall"
frame = "world"
[[bodies]]
name = "payload"
mass_kg = {p["mass"]!r}
inertia_kg_m2 = [{p["inertia"]!r}, {p["inertia"]!r}, {p["inertia"]!r}]
position_mm = [0.0, 0.0, 0.0]
velocity_m_s = [0.0, 0.0, 0.0]
spin_rad_s = [0.0, 0.0, 0.0]
[[bushings]]
name = "fixture"
frame = "wall"
other_frame = "payload"
translational_stiffness_N_m = {p["translational"]!r}
rotational_stiffness_Nm_rad = {p["rotational"]!r}
translational_damping_Ns_m = {p["translational_damping"]!r}
rotational_damping_Nms_rad = {p["rotational_damping"]!r}
[[loads]]
name = "push"
frame = "payload"
axes = "world"
force_N = [40.0, 0.0, 0.0]
moment_Nm = [0.0, 0.0, 5.0]
begin_s = 0.1
duration_s = 0.3
ramp_s = 0.05
""" + sensors(("place", "position", 'frame = "payload"'), ("gyro", "rate", 'frame = "payload"')))}


PAYLOAD = Kind(
    plant=plants.payload,
    truth={"mass": 20.0, "inertia": 2.0, "translational": 8000.0, "rotational": 500.0, "translational_damping": 40.0, "rotational_damping": 4.0,
           "start_velocity": 0.0, "start_spin": 0.0, "extra": 0.0, "aside": 0.0},
    free={"bushings[fixture].translational_stiffness_N_m": "translational", "bushings[fixture].rotational_stiffness_Nm_rad": "rotational"},
    sigma={"place_x_mm": 0.1, "gyro_z_deg_s": 0.3}, interval=0.01, files=payload_files,
    set={"second": {"loads[push].force_N[1]": -25.0, "loads[push].moment_Nm[3]": 8.0}},
    effects=[Effect("bushing_damping (fixture.rotational_damping_Nms_rad)", "rotational_damping", 0.02, True),
             Effect("bushing_damping (fixture.translational_damping_Ns_m)", "translational_damping", 0.02, True),
             Effect("body_mass (payload)", "mass", 0.02, True),
             Effect("body_inertia (payload)", "inertia", 0.02, True),
             Effect("body_start_velocity (payload)", "start_velocity", 1e-3),
             Effect("body_start_spin (payload)", "start_spin", 1e-3),
             Effect("body_centre_of_mass (payload)", "aside", 1e-3)],
    outside=[Effect("place_x_mm", "extra", 0.01)])


def flight_files(p):
    loads = ""
    for record, pulses in (("first", [(0, 2.0, 1.2), (1, 6.0, -1.5), (2, 10.0, 1.0), (0, 13.0, -1.0)]),
                           ("second", [(1, 2.0, 1.4), (2, 5.0, -1.2), (0, 9.0, 1.1), (1, 14.0, -1.1)])):
        times = {0.0: [0.0, 0.0, 0.0], 40.0: [0.0, 0.0, 0.0]}
        for axis, begin, size in pulses:
            for t, share in ((begin, 0.0), (begin + 0.1, 1.0), (begin + 0.9, 1.0), (begin + 1.0, 0.0)):
                times.setdefault(t, [0.0, 0.0, 0.0])[axis] = share * size
        loads += f"#{record}\n" + "time_s,mx_Nm,my_Nm,mz_Nm\n" + "".join(f"{t!r},{m[0]!r},{m[1]!r},{m[2]!r}\n" for t, m in sorted(times.items()))
    first, second = [part.split("\n", 1)[1] for part in loads.split("#")[1:]]
    return {"pulses_first.csv": first, "pulses_second.csv": second,
            "scenario.toml": scenario(20.0, 0.1, f"""[[bodies]]
name = "craft"
mass_kg = 300.0
inertia_kg_m2 = [{p["ix"]!r}, {p["iy"]!r}, {p["iz"]!r}]
position_mm = [0.0, 0.0, 0.0]
velocity_m_s = [0.0, 0.0, 0.0]
spin_rad_s = {[float(v) for v in np.array([1.0, -0.6, 2.0]) * plants.DEG]}
[[loads]]
name = "thrusters"
frame = "craft"
axes = "frame"
file = "pulses_first.csv"
""" + sensors(("gyro", "rate", 'frame = "craft"')))}


FLIGHT = Kind(
    plant=plants.flight,
    truth={"ix": 90.0, "iy": 120.0, "iz": 70.0, "spin_x": 0.0, "slosh": 0.0, "leak": 0.0},
    free={f"bodies[craft].inertia_kg_m2[{k + 1}]": f"i{axis}" for k, axis in enumerate("xyz")},
    sigma={f"gyro_{axis}_deg_s": 0.01 for axis in "xyz"}, interval=0.1, files=flight_files,
    set={"second": {"loads[thrusters].file": "pulses_second.csv", "bodies[craft].spin_rad_s": [float(v) for v in np.array([-1.5, 1.0, 1.2]) * plants.DEG]}},
    effects=[Effect("body_start_spin (craft)", "spin_x", 1e-4),
             sensor("gyro_x_deg_s", "bias", 0.005), sensor("gyro_y_deg_s", "gain", 5e-3), sensor("gyro_z_deg_s", "drift", 5e-4),
             sensor("gyro_x_deg_s", "delay", 0.02), sensor("gyro_y_deg_s", "lag", 0.02), Effect("record_clock", "*:delay", 0.02)],
    outside=[Effect("gyro_x_deg_s", "slosh", 3.0), Effect("gyro_y_deg_s", "leak", 0.02)])


KINDS = {"swing": SWING, "step": STEP, "drive": DRIVE, "payload": PAYLOAD, "flight": FLIGHT}
