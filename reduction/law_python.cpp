#include "reduction/export_text.hpp"
#include "reduction/law_export.hpp"

#include <fmt/format.h>

namespace snare::reduction {

namespace {

constexpr const char* python_helpers = R"(

class OutsideRange(UserWarning):
    """A force was asked outside the range of the law and was continued linearly."""


def in_range(d, position, slack):
    """Whether the force at travel d, position and slack [m] needs no continuation."""
    return d < 0.0 or (d / @span@ <= @last@ + 1e-9 and _place_in_range(position, slack))


def travel_in_range(d):
    """The same of the simple laws, which know the travel [m] alone."""
    return d / @span@ <= @last@ + 1e-9


def _check(inside, outside, *numbers):
    if outside not in ("extrapolate", "refuse"):
        raise ValueError(f"outside = {outside!r}, must be 'extrapolate' or 'refuse'")
    if not all(map(math.isfinite, numbers)):
        raise ValueError(f"at {', '.join(map(repr, numbers))}: must be finite")
    if not inside and outside == "refuse":
        raise ValueError(f"at {', '.join(map(repr, numbers))} m: outside the range of the law")
    if not inside:
        warnings.warn("outside the range of the law: continued linearly", OutsideRange, stacklevel=3)


def _folded(position):
    s = position / @span@
    return 1.0 - s if @mirror@ and s > 0.5 else s


def _place_in_range(position, slack):
    s, e = _folded(position), slack / @span@
    return (knots_position[0] - 1e-9 <= s <= knots_position[-1] + 1e-9
            and knots_slack[0] - 1e-9 <= e <= knots_slack[-1] + 1e-9)


def _cell(knots, x):
    low, high = 0, max(1, len(knots) - 1)
    while high - low > 1:
        middle = (low + high) // 2
        if x >= knots[middle]:
            low = middle
        else:
            high = middle
    return low


def _weights(knots, low, x):
    """Weights of value and slope at the lower and the upper knot of the cell: cubic, beyond the knots linear."""
    if len(knots) == 1:
        return 1.0, 0.0, 0.0, 0.0
    if x < knots[0]:
        return 1.0, x - knots[0], 0.0, 0.0
    if x > knots[-1]:
        return 0.0, 0.0, 1.0, x - knots[-1]
    h = knots[low + 1] - knots[low]
    t = (x - knots[low]) / h
    u = 1.0 - t
    return u * u * (1.0 + 2.0 * t), h * t * u * u, t * t * (1.0 + 2.0 * u), -h * u * t * t


def _table(values, d, position, slack):
    if d < 0.0:
        return 0.0
    inside = _place_in_range(position, slack)
    x, s, e = d / @span@, min(1.0, max(0.0, _folded(position))), slack / @span@
    i, j, last = _cell(knots_position, s), _cell(knots_slack, e), _cell(knots_travel, x)
    bs, be = _weights(knots_position, i, s), _weights(knots_slack, j, e)
    top = 0.0
    for k in range(last if inside else 0, last + 1):
        end = [0.0] * 4  # value and slope at both ends of the cell along the travel
        for b in range(2):
            for c in range(2):
                at_s, at_e = i + b if @ns@ > 1 else 0, j + c if @ne@ > 1 else 0
                for n in range(4):
                    at = 8 * (k + n // 2 + @nd@ * (at_s + @ns@ * at_e)) + n % 2
                    end[n] += (be[2 * c] * (bs[2 * b] * values[at] + bs[2 * b + 1] * values[at + 2])
                               + be[2 * c + 1] * (bs[2 * b] * values[at + 4] + bs[2 * b + 1] * values[at + 6]))
        h = knots_travel[k + 1] - knots_travel[k]
        control = [end[0], end[0] + h / 3.0 * end[1], end[2] - h / 3.0 * end[3], end[2]]
        if not inside:  # there the force does not fall along the travel
            for n in range(4):
                top = control[n] = max(top, control[n])
    t = (x - knots_travel[last]) / h
    u = 1.0 - t
    if t > 1.0:
        f = control[3] + 3.0 * max(0.0, control[3] - control[2]) * (t - 1.0)
    else:
        f = u * u * (u * control[0] + 3.0 * t * control[1]) + t * t * (3.0 * u * control[2] + t * control[3])
    return @scale@ * max(0.0, f)
)";

constexpr const char* table_function = R"(

def @name@(d, position, slack, outside="extrapolate"):
    """Force [N] at travel d, position and slack [m].

    outside: what happens outside the range, "extrapolate" (linearly, with the warning OutsideRange) or "refuse" (ValueError)."""
    _check(in_range(d, position, slack), outside, d, position, slack)
    return _table(@nodes@, d, position, slack)
)";

constexpr const char* simple_function = R"(

def @name@(d, outside="extrapolate"):
    """@words@"""
    _check(travel_in_range(d), outside, d)
    if d < 0.0:
        return 0.0
    if d > @end@:
        return @end_force@ + @end_stiffness@ * (d - @end@)
    return max(0.0, @expression@)
)";

constexpr const char* load_unload = R"(

def @name@(d, memory, outside="extrapolate"):
    """Load and unload. memory: [1.0, 0.0] at first, changed by every call; largest error on the way back @error@ N."""
    _check(travel_in_range(d), outside, d)
    memory[0] = min(1.0, max(-1.0, memory[0] + 2.0 * (d - memory[1]) / @turn@))
    memory[1] = d
    if d < 0.0:
        memory[0] = 1.0
        return 0.0
    return _table(nodes, d, @position@, @slack@) * (@sum@ + memory[0] * @difference@)
)";

}  // namespace

std::string python_module(const DistilledCase& one, const std::string& title) {
  const coupling::ForceTable& table = *one.table.loading;
  // The first line settles the encoding, whatever the title says.
  std::string text = "# -*- coding: utf-8 -*-\n";
  for (const std::string& line : head_lines(one, title)) text += "# " + line + "\n";
  text += "import math\nimport warnings\n\n";
  const auto array = [&](const char* name, const std::vector<double>& values) {
    text += fmt::format("{} = (\n  {},)\n", name, number_list(values));
  };
  array("knots_travel", table.axes()[0]);
  array("knots_position", table.axes()[1]);
  array("knots_slack", table.axes()[2]);
  array("nodes", table.nodes());
  if (one.table.unloading) array("nodes_unloading", one.table.unloading->nodes());
  text += filled(python_helpers, table_numbers(table)) +
          filled(table_function, {{"name", "force"}, {"nodes", "nodes"}});
  if (one.table.unloading)
    text += filled(table_function, {{"name", "force_unloading"}, {"nodes", "nodes_unloading"}});
  for (const DistilledPlace& place : one.places) {
    for (const ExportedLaw& law : exported_laws(place, "math.")) {
      Replacements words = law.of_numbers;
      words.insert(words.end(), {{"name", law.name}, {"words", law.words}});
      text += filled(simple_function, words);
    }
    if (!place.load_unload) continue;
    Replacements words = load_unload_numbers(one, place);
    words.insert(words.end(), {{"name", "load_unload_" + position_name(place.position)},
                               {"error", fmt::format("{:.3g}", place.load_unload->largest_error)}});
    text += filled(load_unload, words);
  }
  return text;
}

}  // namespace snare::reduction
