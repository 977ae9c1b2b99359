"""Draws the published test, force against displacement at every position, as SVG: the same bytes for the same numbers."""

COLOURS = ("#0a6aa8", "#cc5500", "#008060")
WIDTH, HEIGHT = 760, 420
LEFT, RIGHT, TOP, BOTTOM = 60, 740, 72, 372  # of the frame
GREY, INK = "#e4e7ec", "#1f2733"


def ticks(low, high, count=6):
    """Round numbers from low to high, about so many."""
    step = 10.0 ** 6
    for mantissa in (1, 2, 5, 10):
        for exponent in range(-6, 7):
            size = mantissa * 10.0 ** exponent
            if (high - low) / size <= count and size < step:
                step = size
    first = int(low // step)
    return [k * step for k in range(first, int(high // step) + 1) if k * step >= low - 1e-9 * step]


def curve_picture(result):
    """The picture of a stored reproduce.json: published fits with a band of two standard deviations, and the last model, dashed."""
    series, label = result["series"], result["models"][-1]["label"]
    largest = max(s["displacement_mm"][-1] for s in series)
    bounds = [value + sign * 2.0 * s["sigma_N"] for s in series for value in s["published_N"] for sign in (-1.0, 1.0)]
    low, high = min(bounds + [min(s["computed_N"]) for s in series]), max(bounds + [max(s["computed_N"]) for s in series])

    def across(d):
        return LEFT + (RIGHT - LEFT) * d / largest

    def up(force):
        return BOTTOM - (BOTTOM - TOP) * (force - low) / (high - low)

    def points(displacement, force):
        return " ".join(f"{across(d):.1f},{up(f):.1f}" for d, f in zip(displacement, force))

    def text(x, y, words, anchor="start"):
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{INK}">{words}</text>'

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" '
           'font-family="sans-serif" font-size="13">',
           "<title>Force against displacement at three positions: published fits and one fitted wire</title>",
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>']
    for d in ticks(0.0, largest):
        out += [f'<line x1="{across(d):.1f}" y1="{TOP}" x2="{across(d):.1f}" y2="{BOTTOM}" stroke="{GREY}"/>', text(across(d), BOTTOM + 18, f"{d:g}", "middle")]
    for f in ticks(low, high):
        out += [f'<line x1="{LEFT}" y1="{up(f):.1f}" x2="{RIGHT}" y2="{up(f):.1f}" stroke="{GREY}"/>', text(LEFT - 8, up(f) + 4, f"{f:g}", "end")]
    for k, (s, colour) in enumerate(zip(series, COLOURS)):
        d, published, band = s["displacement_mm"], s["published_N"], 2.0 * s["sigma_N"]
        edge = points(d, [f + band for f in published]) + " " + points(d[::-1], [f - band for f in published[::-1]])
        out += [f'<polygon points="{edge}" fill="{colour}" fill-opacity="0.15"/>',
                f'<polyline points="{points(d, published)}" fill="none" stroke="{colour}" stroke-width="2"/>',
                f'<polyline points="{points(d, s["computed_N"])}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="6 4"/>']
        x = LEFT + 230 * k
        out += [f'<line x1="{x}" y1="18" x2="{x + 28}" y2="18" stroke="{colour}" stroke-width="2"/>', text(x + 34, 22, f"s = {s['contact_position_mm']:g} mm, published"),
                f'<line x1="{x}" y1="38" x2="{x + 28}" y2="38" stroke="{colour}" stroke-width="2" stroke-dasharray="6 4"/>', text(x + 34, 42, "one fitted wire")]
    out += [text(LEFT - 40, TOP - 10, "force [N]; bands: published fit and two standard deviations of a reading"), text(RIGHT, HEIGHT - 12, "displacement [mm]", "end"),
            f"<desc>Dashed: {label}.</desc>", "</svg>"]
    return "\n".join(out) + "\n"
