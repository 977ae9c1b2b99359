#!/usr/bin/env python3
"""Writes docs/effects.md and its pictures, docs/drawings/effects/*.svg, from the effects' own files.

usage: effect_glossary.py [--check]

Names, channels, meanings, keys and units stand in identification/effects/*.cpp and identification/motion_effects/*.cpp. What a sign means
and what is drawn stands here: an effect that has neither is an error. --check compares and writes nothing; a test does that.
"""

import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BLUE, GREY, RED = "#1f5fa8", "#999999", "#b3261e"


# --- Pictures: 200 by 100, what is declared in grey, the effect in blue, forces in red.

def line(points, colour=BLUE, dash="", width=2):
    d = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{d}" fill="none" stroke="{colour}" stroke-width="{width}"' + (f' stroke-dasharray="{dash}"' if dash else "") + "/>"


def arrow(x1, y1, x2, y2, colour=RED):
    a = math.atan2(y2 - y1, x2 - x1)
    wing = [(x2 - 7 * math.cos(a + s), y2 - 7 * math.sin(a + s)) for s in (0.45, -0.45)]
    return line([(x1, y1), (x2, y2)], colour, width=1.5) + line([wing[0], (x2, y2), wing[1]], colour, width=1.5)


def word(x, y, text, colour="#333333"):
    return f'<text x="{x}" y="{y}" font-family="sans-serif" font-size="11" fill="{colour}">{text}</text>'


def wire(left=25, right=175, height=28, colour=BLUE, dash="", base=75):
    return line([(left + (right - left) * t / 40, base - height * math.sin(math.pi * t / 40) ** 2) for t in range(41)], colour, dash)


def clamp(x, colour="#333333"):
    return f'<rect x="{x - 6}" y="67" width="12" height="16" fill="{colour}"/>'


def pusher(x=85, y=59, colour="#333333"):
    return f'<circle cx="{x}" cy="{y}" r="9" fill="none" stroke="{colour}" stroke-width="2"/>'


def bench(*more, left=25, right=175, **kind):
    return [wire(left, right, **kind), clamp(left), clamp(right), *more]


def plot(curves, across, up):
    """curves: (function of -1..1 or 0..1, colour, dash); the first is what is declared."""
    out = [arrow(30, 90, 190, 90, "#333333"), arrow(30, 90, 30, 8, "#333333"), word(192 - 6.2 * len(across), 84, across), word(36, 16, up)]
    for k, f in enumerate(curves):
        points = [(30 + 150 * t / 60, 90 - 70 * f(t / 60)) for t in range(61)]
        out.append(line([(x, min(max(y, 8), 98)) for x, y in points], GREY if k == 0 else BLUE, "4 3" if k == 0 else ""))
    return out


def signed(curves, across, up):
    """The same with the origin in the middle; functions of -1..1."""
    out = [arrow(10, 50, 192, 50, "#333333"), arrow(100, 96, 100, 6, "#333333"), word(192 - 6.2 * len(across), 64, across), word(106, 14, up)]
    for k, f in enumerate(curves):
        points = [(100 + 80 * t / 40, 50 - 38 * f(t / 40)) for t in range(-40, 41)]
        out.append(line(points, GREY if k == 0 else BLUE, "4 3" if k == 0 else ""))
    return out


def body(*more):
    return ['<rect x="75" y="35" width="50" height="36" fill="none" stroke="#333333" stroke-width="2"/>', *more]


def sign(v):
    return (v > 0) - (v < 0)


def wave(t):
    return 0.5 + 0.3 * math.sin(7 * t)


STIFFER = [lambda t: 0.55 * t, lambda t: 0.85 * t]
TOUCH = arrow(85, 97, 85, 72)
# Name: what a larger or positive value means, and the picture. Of pushes.
PUSH = {
    "bending_stiffness": ("larger: the wire resists bending more, and the force rises from the first touch on", bench(pusher(), TOUCH)),
    "axial_stiffness": ("larger: the force rises more steeply where the wire is taut", plot([lambda t: 0.5 * t**3, lambda t: 0.9 * t**3], "travel", "force")),
    "wire_diameter": ("larger: thicker; the bending stiffness grows with its fourth, the axial one with its second power", [wire(height=30, colour=GREY, dash="4 3"), wire(height=25), wire(height=35), clamp(25), clamp(175)]),
    "wire_length": ("larger: more slack, a higher bulge, less force at the same travel", bench(wire(height=45, colour=GREY, dash="4 3"))),
    "span": ("larger: the mounts stand further apart, less slack", bench(arrow(100, 92, 174, 92), arrow(100, 92, 26, 92), word(90, 60, "span"))),
    "contact_position": ("positive: the pusher touches further from the left mount", bench(pusher(70, 65, GREY), pusher(97, 56), arrow(70, 90, 97, 90), word(102, 94, "+"))),
    "push_misalignment": ("positive: the push is turned towards the right mount", bench(pusher(), line([(85, 97), (85, 70)], GREY, "4 3"), arrow(72, 97, 83, 71), word(60, 97, "+"))),
    "mount_slip": ("the tension beyond which a mount feeds wire, which one is not told where the pusher is smooth; smaller: it slips earlier", bench(arrow(8, 62, 42, 62), word(4, 54, "wire slips"))),
    "mount_slip_right": ("the tension beyond which the right mount feeds wire; smaller: it slips earlier", bench(arrow(192, 62, 158, 62), word(146, 54, "wire slips"))),
    "clamp_slide": ("the force beyond which the left mount slides along the chord with the wire; smaller: earlier", bench(arrow(8, 92, 42, 92), word(4, 84, "mount slides"))),
    "clamp_slide_right": ("the same of the right mount", bench(arrow(192, 92, 158, 92), word(138, 84, "mount slides"))),
    "clamp_slide_both": ("the same of either mount, each by itself", bench(arrow(8, 92, 42, 92), arrow(192, 92, 158, 92), word(70, 96, "mounts slide"))),
    "mount_axial_compliance": ("of each mount, 0 is rigid; larger: they come together more under tension", bench(line([(3, 75), (6, 69), (9, 81), (12, 69), (15, 81), (18, 75)]), line([(182, 75), (185, 69), (188, 81), (191, 69), (194, 81), (197, 75)]), arrow(28, 92, 50, 92), arrow(172, 92, 150, 92))),
    "mount_rotational_compliance": ("of each clamp, 0 is rigid; larger: they turn more with the wire", bench(line([(25 + 18 * math.cos(a / 10), 75 - 18 * math.sin(a / 10)) for a in range(0, 12)], RED, width=1.5), line([(175 - 18 * math.cos(a / 10), 75 - 18 * math.sin(a / 10)) for a in range(0, 12)], RED, width=1.5))),
    "mount_axial_compliance_left": ("of the left mount by itself, 0 is rigid; larger: it follows the tension more", bench(line([(3, 75), (6, 69), (9, 81), (12, 69), (15, 81), (18, 75)]), arrow(28, 92, 50, 92))),
    "mount_axial_compliance_right": ("of the right mount by itself, 0 is rigid; larger: it follows the tension more", bench(line([(182, 75), (185, 69), (188, 81), (191, 69), (194, 81), (197, 75)]), arrow(172, 92, 150, 92))),
    "mount_rotational_compliance_left": ("of the left clamp by itself, 0 is rigid; larger: it turns more with the wire", bench(line([(25 + 18 * math.cos(a / 10), 75 - 18 * math.sin(a / 10)) for a in range(0, 12)], RED, width=1.5))),
    "mount_rotational_compliance_right": ("of the right clamp by itself, 0 is rigid; larger: it turns more with the wire", bench(line([(175 - 18 * math.cos(a / 10), 75 - 18 * math.sin(a / 10)) for a in range(0, 12)], RED, width=1.5))),
    "contact_friction": ("0 or more; larger: the force is larger on the way in and smaller on the way back", plot([lambda t: 0.6 * t, lambda t: 0.75 * t, lambda t: 0.45 * t], "travel", "force")),
    "pusher_compliance": ("0 is rigid; larger: the pusher travels less than the machine recorded", bench(pusher(), line([(85, 68), (80, 73), (90, 78), (80, 83), (90, 88), (85, 94)]), arrow(112, 97, 112, 76), word(118, 97, "recorded"))),
    "displacement_offset": ("the recorded travel at the first touch: positive where the touch comes after the zero", plot([lambda t: 0.8 * t * t, lambda t: 0.8 * max(0, t - 0.25) ** 2], "recorded travel", "force")),
    "force_offset": ("what the cell reads without load: positive, all readings are too large by it", plot([lambda t: 0.6 * t * t, lambda t: 0.2 + 0.6 * t * t], "travel", "reading")),
    "force_gain": ("reading over true force; 1 is right, above 1 the cell reads too much", plot([lambda t: 0.55 * t * t, lambda t: 0.85 * t * t], "travel", "reading")),
    "load_cell_nonlinearity": ("error of the reading at half of the largest force, as a share of that force; zero without load and at the largest force", plot([lambda t: 0.8 * t, lambda t: 0.8 * t + 0.6 * t * (1 - t)], "force", "reading")),
    "travel_nonlinearity": ("error of the reading at half of the largest travel, as a share of that travel; zero at first touch and at the largest travel", plot([lambda t: 0.8 * t, lambda t: 0.8 * t + 0.6 * t * (1 - t)], "travel", "reading")),
    "force_drift": ("positive: the reading grows with time", plot([wave, lambda t: wave(t) + 0.2 * t], "time", "reading")),
    "creep": ("share of a change of the force by which the reading continues to change, and the time constant; negative: it relaxes", plot([lambda t: 0.6 * (t > 0.2), lambda t: (0.6 + 0.2 * (1 - math.exp(-5 * (t - 0.2)))) * (t > 0.2)], "time", "reading")),
    "data_lag": ("positive: the force is recorded later than the travel", plot([wave, lambda t: wave(max(0, t - 0.12))], "time", "force")),
    "pusher_play": ("0 or more: travel that is lost where the push turns back", plot([lambda t: 0.7 * t, lambda t: 0.7 * max(0, t - 0.12)], "travel", "force")),
    "natural_curvature": ("positive: the free wire is curved with the bulge", [wire(40, 160, 38, base=62), line([(40, 80), (160, 80)], GREY, "4 3"), word(60, 95, "without load")]),
    "strand_hysteresis": ("stiffness that sticking strands add, the change of curvature at which they slide, and over which share of it, in logarithms, they do so one after the other; larger: a wider loop", signed([lambda t: 0.6 * t, lambda t: 0.6 * t + 0.25, lambda t: 0.6 * t - 0.25], "curvature", "moment")),
    "plasticity": ("the stress at which the metal yields; smaller: it yields earlier", plot([lambda t: t, lambda t: min(t, 0.5) + 0.1 * max(0, t - 0.5)], "strain", "stress")),
    "gravity": ("acceleration along the bulge: positive, the weight pulls to the side of the bulge", bench(arrow(60, 52, 60, 30), arrow(100, 40, 100, 18), arrow(140, 52, 140, 30), word(106, 20, "+"))),
    "rate_viscosity": ("0 or more; larger: the force grows with the speed of the push", plot([lambda t: 0.5 * t, lambda t: 0.5 * t + 0.2], "travel", "force")),
}
# The same of records in time. What has the sign of a number of the scenario has its axes.
MOTION = {
    "body_inertia": ("all three moments by one factor; larger: it turns less easily", body(line([(100 + 38 * math.cos(a / 10), 53 - 38 * math.sin(a / 10)) for a in range(-6, 7)], RED, width=1.5))),
    "body_centre_of_mass": ("by axis of the body's frame", body('<circle cx="112" cy="60" r="3" fill="%s"/>' % BLUE, line([(100, 53), (112, 60)], GREY, "4 3"))),
    "body_mass": ("larger: it is accelerated less", body(word(91, 57, "m"), arrow(30, 53, 72, 53))),
    "body_start_attitude": ("its rotation vector, by axis of the frame on which it is placed", body(line([(88, 24), (134, 42), (116, 88), (70, 70), (88, 24)]), word(128, 20, "t = 0"))),
    "body_start_position": ("by axis of the frame on which it is placed", body(line([(90, 28), (140, 28), (140, 64), (90, 64), (90, 28)]), word(146, 20, "t = 0"))),
    "body_start_spin": ("by axis of the body's frame, right-handed positive", body(line([(100 + 38 * math.cos(a / 10), 53 - 38 * math.sin(a / 10)) for a in range(0, 14)], RED, width=1.5), word(128, 20, "t = 0"))),
    "body_start_velocity": ("by axis of the world", body(arrow(127, 53, 175, 53), word(140, 45, "t = 0"))),
    "bushing_damping": ("larger: it takes more energy", plot([wave, lambda t: 0.5 + 0.3 * math.exp(-3 * t) * math.sin(7 * t)], "time", "shift")),
    "bushing_stiffness": ("larger: stiffer, all axes by one factor", plot(STIFFER, "shift", "force")),
    "contact_friction": ("Coulomb's coefficient, 0 or more", signed([lambda t: 0.3 * sign(t), lambda t: 0.7 * sign(t)], "slip speed", "friction")),
    "joint_back_drive": ("0 or more; added to the dry friction while the joint is limp", signed([lambda t: 0.2 * sign(t), lambda t: 0.7 * sign(t)], "speed", "torque")),
    "joint_backlash": ("half the gap, 0 or more; larger: more free play", signed([lambda t: 0.9 * t, lambda t: 0.9 * sign(t) * max(0, abs(t) - 0.3)], "deflection", "torque")),
    "joint_breakaway": ("0 or more; beside the dry friction, and gone at speed", signed([lambda t: 0.4 * sign(t), lambda t: sign(t) * (0.4 + 0.5 * math.exp(-20 * t * t))], "speed", "resistance")),
    "joint_coulomb_friction": ("0 or more; it resists the motion either way", signed([lambda t: 0, lambda t: 0.6 * sign(t)], "speed", "resistance")),
    "joint_damping": ("larger: vibrations die faster", plot([wave, lambda t: 0.5 + 0.3 * math.exp(-3 * t) * math.sin(7 * t)], "time", "deflection")),
    "joint_friction_asymmetry": ("positive: more resistance forward than backward", signed([lambda t: 0.5 * sign(t), lambda t: 0.5 * sign(t) + 0.25], "speed", "resistance")),
    "joint_quadratic_drag": ("0 or more; it resists the motion either way", signed([lambda t: 0, lambda t: 0.9 * t * abs(t)], "speed", "resistance")),
    "joint_stiffness": ("larger: less deflection at the same torque", signed([lambda t: 0.5 * t, lambda t: 0.9 * t], "deflection", "torque")),
    "joint_viscous_asymmetry": ("positive: viscous friction is larger forward than backward", signed([lambda t: 0.5 * t, lambda t: (0.8 if t > 0 else 0.2) * t], "speed", "resistance")),
    "joint_viscous_friction": ("0 or more; it resists the motion either way", signed([lambda t: 0.3 * t, lambda t: 0.9 * t], "speed", "resistance")),
    "link_flexibility": ("angle by which its end turns under a moment, 0 is rigid; larger: it bends more", [clamp(25), line([(25, 75), (175, 75)], GREY, "4 3"), line([(25 + 150 * t / 20, 75 - 30 * (t / 20) ** 2 * (1.5 - 0.5 * t / 20)) for t in range(21)]), arrow(175, 92, 175, 52)]),
    "motor_inertia": ("on the side of the output; larger: accelerated less", body(line([(100 + 14 * math.cos(a / 5), 53 - 14 * math.sin(a / 5)) for a in range(32)], BLUE), arrow(60, 25, 82, 40))),
    "record_clock": ("positive: all readings come later than what they tell of", plot([wave, lambda t: wave(max(0, t - 0.12))], "time", "all readings")),
    "ring_delay": ("positive: the phase begins later than declared", plot([lambda t: min(1, max(0, 3 * (t - 0.2))) * 0.8, lambda t: min(1, max(0, 3 * (t - 0.4))) * 0.8], "time", "angle")),
    "ring_rate": ("larger: the ring closes faster", plot([lambda t: min(0.8, 1.1 * t), lambda t: min(0.8, 1.9 * t)], "time", "angle")),
    "sensor_bias": ("positive: all readings are too large by it", plot([wave, lambda t: wave(t) + 0.15], "time", "reading")),
    "sensor_delay": ("positive: the reading comes later than what it tells of", plot([wave, lambda t: wave(max(0, t - 0.12))], "time", "reading")),
    "sensor_drift": ("positive: the zero rises with time", plot([wave, lambda t: wave(t) + 0.2 * t], "time", "reading")),
    "sensor_gain": ("reading over what it tells of; 1 is right, above 1 it reads too much", plot([wave, lambda t: 1.35 * wave(t)], "time", "reading")),
    "sensor_lag": ("time constant of a low-pass filter of first order, 0 or more", plot([lambda t: 0.8 * (t > 0.2), lambda t: 0.8 * (1 - math.exp(-6 * max(0, t - 0.2)))], "time", "reading")),
    "servo_gain": ("larger: the servo holds stiffer", signed([lambda t: 0.5 * t, lambda t: 0.9 * t], "error", "torque")),
    "wire_axial_stiffness": ("larger: less stretch at the same tension", plot(STIFFER, "stretch", "tension")),
    "wire_bending_stiffness": ("larger: more moment at the same curvature", plot(STIFFER, "curvature", "moment")),
    "wire_damping": ("time over which the material gives way; larger: waves die faster", plot([wave, lambda t: 0.5 + 0.3 * math.exp(-3 * t) * math.sin(7 * t)], "time", "shift")),
    "wire_length": ("larger: more slack", bench(wire(height=45, colour=GREY, dash="4 3"))),
    "wire_modulus": ("larger: both stiffnesses grow by one factor", plot(STIFFER, "strain", "stress")),
}


def text_of(source, field):
    """A member of an effect's initialisation that is a text, of one or several pieces."""
    found = re.search(rf'\.{field} =\s*((?:"[^"]*"\s*)+)', source)
    return "".join(re.findall(r'"([^"]*)"', found.group(1))) if found else ""


def push_effects():
    """The list of the catalogue, in its order."""
    folder = ROOT / "identification/effects"
    for name in re.findall(r"EFFECT\((\w+)\)", (folder / "catalogue.cpp").read_text(encoding="utf-8")):
        source = (folder / f"{name}.cpp").read_text(encoding="utf-8")
        keys = []
        for part in re.split(r"(?=\.key = )", source)[1:]:
            unit = text_of(part, "unit")
            keys.append(f"`{text_of(part, 'key')}`" + (f" [{unit}]" if unit else ""))
        channel = re.search(r"Channel::(\w+)", source)
        yield text_of(source, "name"), channel.group(1), text_of(source, "meaning"), ", ".join(keys), text_of(source, "independent_check")


def motion_effects():
    for path in sorted((ROOT / "identification/motion_effects").glob("*.cpp")):
        source = path.read_text(encoding="utf-8")
        if ".name = " in source:
            yield text_of(source, "name"), text_of(source, "channel"), text_of(source, "meaning"), "", text_of(source, "independent_check")


HEAD = """# Effects

What a declared model may lack: the word that pages say, the name that files have, what it is, what its sign means, and how to settle it by
itself. Names and meanings are those of the code (`scripts/effect_glossary.py` writes this page). In the pictures what is declared is grey and
broken, the effect blue. Displacement is the travel of the pusher from first touch, force is that on the pusher against its way, positive when
the wire resists; *x* runs along the chord from the left mount, *y* to the side of the bulge.

`snare trace` asks the readings for all of these; [trace.json](trace_json.md) has the answer, the [theory](theory/identification.md) how it is had,
and [CONTRIBUTING](../CONTRIBUTING.md#adding-an-effect) how another one is added.
"""


def files():
    """Path and text of everything that is written."""
    out, page = {}, [HEAD]
    lists = (("push", "Of a push", push_effects(), PUSH), ("motion", "Of records in time", motion_effects(), MOTION))
    for kind, title, effects, known in lists:
        page.append(f"## {title}\n")
        names = []
        for name, channel, meaning, keys, check in effects:
            if name not in known:
                raise SystemExit(f"{name}: scripts/effect_glossary.py says nothing of its sign and has no picture")
            names.append(name)
            meant, picture = known[name]
            drawn = f"{kind}_{name}"
            page.append(f"### {name.replace('_', ' ')}" + (" (in motion)" if kind == "motion" else "") + "\n")
            page.append(f"![{name.replace('_', ' ')}](drawings/effects/{drawn}.svg)\n")
            page.append(f"`{name}`, channel `{channel}`: {meaning}.\n")
            page.append(("- Numbers: " + keys + ".\n" if keys else "") + f"- Sign: {meant}.\n- By itself: {check}.\n")
            out[ROOT / f"docs/drawings/effects/{drawn}.svg"] = \
                '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100" width="200" height="100">\n' \
                f"<title>{name.replace('_', ' ')}</title>\n" + "\n".join(picture) + "\n</svg>\n"
        gone = set(known) - set(names)
        if gone:
            raise SystemExit(f"scripts/effect_glossary.py knows effects that are gone: {', '.join(sorted(gone))}")
    out[ROOT / "docs/effects.md"] = "\n".join(page)
    return out


def main():
    wanted = files()
    if sys.argv[1:] == ["--check"]:
        stale = [path for path, text in wanted.items() if not path.is_file() or path.read_text(encoding="utf-8") != text]
        stale += set((ROOT / "docs/drawings/effects").glob("*.svg")) - set(wanted)
        for path in stale:
            print(f"{path.relative_to(ROOT)} is not what the effects say: run scripts/effect_glossary.py")
        return 1 if stale else 0
    for path, text in wanted.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
