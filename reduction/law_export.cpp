#include "reduction/law_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace snare::reduction {

namespace {

/// What differs between the three languages.
struct Language {
  std::string comment;     // begins a line of comment
  std::string prefix;      // of mathematical functions
  std::string qualifier;   // of functions: {q} below
  std::string own;         // begins the names that others see: {p} below
  std::string array_open;  // "static const double {}[] = {"
  std::string array_close;
  std::string function_open;  // of one argument d: {name}
  std::string function_close;
  std::string prelude;
  std::string basis;        // what evaluating a table needs
  std::string table;        // evaluation of one: {name}, {nodes}
  std::string range;        // in_range
  std::string load_unload;  // the law with its memory: {name}, {turn}, {position}, {slack}, {sum}, {difference}, {p}
  std::string end;
};

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{}", values[i], i + 1 < values.size() ? (i % 8 == 7 ? ",\n  " : ", ") : "");
  }
  return text;
}

std::string error_words(const FittedLaw& law) {
  return fmt::format("{}, largest error {:.3g} N of {:.3g} N", law.form->formula(), law.error.largest_force,
                     law.error.force_range);
}

std::string head(const DistilledCase& one, const std::string& title, const std::string& comment) {
  const TableError& e = one.table.loading_error;
  const auto& axes = one.table.loading->axes();
  const double span = one.table.loading->span();
  const auto range = [&](std::size_t a) {
    return fmt::format("{:.6g} to {:.6g} m", axes[a].front() * span, axes[a].back() * span);
  };
  std::string title_line = title;
  std::replace(title_line.begin(), title_line.end(), '\n', ' ');
  // Nor may it end a comment of C, or go on behind its line.
  std::replace(title_line.begin(), title_line.end(), '*', ' ');
  std::replace(title_line.begin(), title_line.end(), '\\', ' ');
  std::string text;
  for (const std::string& line :
       {title_line,
        std::string("Force of a snare wire on a pusher, distilled from the full wire by snare. SI units: m, N."),
        "travel d from first touch: " + range(0), "position s along the chord: " + range(1), "slack: " + range(2),
        fmt::format("table within {:.4g} N of the full wire ({:.3g} % of the range of the force)", e.bound,
                    100.0 * e.bound / e.force_range),
        std::string(one.wire.dissipates() ? "force: loading; force_unloading: the way back from the end of the travel"
                                          : "")}) {
    if (!line.empty()) text += comment + line + "\n";
  }
  return text;
}

std::string generate(const DistilledCase& one, const std::string& title, const Language& l) {
  const coupling::ForceTable& table = *one.table.loading;
  const auto& axes = table.axes();
  std::string text = head(one, title, l.comment) + l.prelude;
  const auto array = [&](const std::string& name, const std::vector<double>& values) {
    text += fmt::format(fmt::runtime(l.array_open), name) + "\n  " + numbers(values) + l.array_close;
  };
  array("knots_travel", axes[0]);
  array("knots_position", axes[1]);
  array("knots_slack", axes[2]);
  array("nodes", table.nodes());
  if (one.table.unloading) array("nodes_unloading", one.table.unloading->nodes());
  const auto add = [&](const std::string& source, const char* name, const char* nodes) {
    text += fmt::format(fmt::runtime(source), fmt::arg("nd", axes[0].size()), fmt::arg("ns", axes[1].size()),
                        fmt::arg("ne", axes[2].size()), fmt::arg("span", table.span()),
                        fmt::arg("scale", table.force_scale()),
                        fmt::arg("mirror", table.mirrored() ? "s > 0.5" : "s > 1e300"), fmt::arg("name", name),
                        fmt::arg("nodes", nodes), fmt::arg("q", l.qualifier), fmt::arg("p", l.own));
  };
  add(l.basis, "", "");
  add(l.table, "force", "nodes");
  if (one.table.unloading) add(l.table, "force_unloading", "nodes_unloading");
  add(l.range, "", "");
  for (const DistilledPlace& place : one.places) {
    for (const FittedLaw& law : place.laws) {
      text += "\n" + l.comment + error_words(law) + "\n";
      text += fmt::format(fmt::runtime(l.function_open), fmt::arg("q", l.qualifier),
                          fmt::arg("name", l.own + law.form->name() + "_" + position_name(place.position)));
      text += law.form->expression(law.values, l.prefix) + l.function_close;
    }
    if (!place.load_unload) continue;
    const LoadUnloadLaw& law = place.load_unload->law;
    text += "\n" + l.comment +
            fmt::format("load and unload; its memory is 1 and 0 at first; largest error on the way back {:.3g} N\n",
                        place.load_unload->largest_error);
    text += fmt::format(fmt::runtime(l.load_unload), fmt::arg("q", l.qualifier), fmt::arg("p", l.own),
                        fmt::arg("name", l.own + "load_unload_" + position_name(place.position)),
                        fmt::arg("turn", law.turn()), fmt::arg("position", place.position),
                        fmt::arg("slack", one.wire.nominal_slack()), fmt::arg("sum", 0.5 * (1.0 + law.returned())),
                        fmt::arg("difference", 0.5 * (1.0 - law.returned())));
  }
  return text + l.end;
}

// The evaluation in C, which C++ takes as well.
constexpr const char* c_basis = R"(
{q}unsigned find_cell_(const double* knots, unsigned count, double x) {{
  unsigned low = 0, high = count > 1 ? count - 1 : 1;
  while (high - low > 1) {{
    unsigned middle = (low + high) / 2;
    if (x >= knots[middle]) low = middle; else high = middle;
  }}
  return low;
}}

{q}unsigned basis_(const double* knots, unsigned count, double x, double b[4], unsigned* upper) {{
  unsigned i = find_cell_(knots, count, x);
  double h, t, u;
  b[0] = 1.0; b[1] = 0.0; b[2] = 0.0; b[3] = 0.0;
  *upper = i;
  if (count == 1) return i;
  *upper = i + 1;
  h = knots[i + 1] - knots[i];
  t = (x - knots[i]) / h;
  u = 1.0 - t;
  b[0] = u * u * (1.0 + 2.0 * t); b[1] = h * t * u * u; b[2] = t * t * (1.0 + 2.0 * u); b[3] = -h * u * t * t;
  return i;
}}
)";

constexpr const char* c_table = R"(
/* force [N] at travel d, position and slack [m] */
{q}double {p}{name}(double d, double position, double slack) {{
  double x = d / {span}, s = position / {span}, e = slack / {span};
  double bd[4], bs[4], be[4], total = 0.0;
  unsigned k, k1, i[2], j[2], b, c, p;
  if (d < 0.0) return 0.0;
  if ({mirror}) s = 1.0 - s;
  k = basis_(knots_travel, {nd}, x, bd, &k1);
  i[0] = basis_(knots_position, {ns}, s, bs, &i[1]);
  j[0] = basis_(knots_slack, {ne}, e, be, &j[1]);
  (void)k1;
  for (c = 0; c < 2; ++c) {{
    for (b = 0; b < 2; ++b) {{
      const double* low = {nodes} + 8 * (k + {nd} * (i[b] + {ns} * j[c]));
      const double* high = low + 8;
      double along[4];
      for (p = 0; p < 4; ++p) {{
        along[p] = bd[0] * low[2 * p] + bd[1] * low[2 * p + 1] + bd[2] * high[2 * p] + bd[3] * high[2 * p + 1];
      }}
      total += be[2 * c] * (bs[2 * b] * along[0] + bs[2 * b + 1] * along[1]) +
               be[2 * c + 1] * (bs[2 * b] * along[2] + bs[2 * b + 1] * along[3]);
    }}
  }}
  return {scale} * total;
}}
)";

constexpr const char* c_load_unload = R"({q}double {name}(double d, double* branch, double* last) {{
  *branch += 2.0 * (d - *last) / {turn};
  if (*branch > 1.0) *branch = 1.0;
  if (*branch < -1.0) *branch = -1.0;
  *last = d;
  if (d < 0.0) {{
    *branch = 1.0;
    return 0.0;
  }}
  return {p}force(d, {position}, {slack}) * ({sum} + *branch * {difference});
}}
)";

constexpr const char* c_range = R"(
{q}int {p}in_range(double d, double position, double slack) {{
  double x = d / {span}, s = position / {span}, e = slack / {span};
  if ({mirror}) s = 1.0 - s;
  return x <= knots_travel[{nd} - 1] + 1e-9 && s >= knots_position[0] - 1e-9 && s <= knots_position[{ns} - 1] + 1e-9 &&
         e >= knots_slack[0] - 1e-9 && e <= knots_slack[{ne} - 1] + 1e-9;
}}
)";

constexpr const char* python_basis = R"(

def _basis(knots, x):
    if len(knots) == 1:
        return 0, 0, (1.0, 0.0, 0.0, 0.0)
    low, high = 0, len(knots) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if x >= knots[middle]:
            low = middle
        else:
            high = middle
    h = knots[low + 1] - knots[low]
    t = (x - knots[low]) / h
    u = 1.0 - t
    return low, low + 1, (u * u * (1.0 + 2.0 * t), h * t * u * u, t * t * (1.0 + 2.0 * u), -h * u * t * t)
)";

constexpr const char* python_table = R"(

def {name}(d, position, slack):
    """Force [N] at travel d, position and slack [m]."""
    if d < 0.0:
        return 0.0
    x, s, e = d / {span}, position / {span}, slack / {span}
    if {mirror}:
        s = 1.0 - s
    k, _, bd = _basis(knots_travel, x)
    i0, i1, bs = _basis(knots_position, s)
    j0, j1, be = _basis(knots_slack, e)
    total = 0.0
    for c, j in enumerate((j0, j1)):
        for b, i in enumerate((i0, i1)):
            low = 8 * (k + {nd} * (i + {ns} * j))
            along = [bd[0] * {nodes}[low + 2 * p] + bd[1] * {nodes}[low + 2 * p + 1]
                     + bd[2] * {nodes}[low + 8 + 2 * p] + bd[3] * {nodes}[low + 9 + 2 * p] for p in range(4)]
            total += (be[2 * c] * (bs[2 * b] * along[0] + bs[2 * b + 1] * along[1])
                      + be[2 * c + 1] * (bs[2 * b] * along[2] + bs[2 * b + 1] * along[3]))
    return {scale} * total
)";

constexpr const char* python_load_unload = R"(def {name}(d, memory):
    """memory: [1.0, 0.0] at first, changed by every call."""
    memory[0] = min(1.0, max(-1.0, memory[0] + 2.0 * (d - memory[1]) / {turn}))
    memory[1] = d
    if d < 0.0:
        memory[0] = 1.0
        return 0.0
    return force(d, {position}, {slack}) * ({sum} + memory[0] * {difference})
)";

constexpr const char* python_range = R"(

def in_range(d, position, slack):
    x, s, e = d / {span}, position / {span}, slack / {span}
    if {mirror}:
        s = 1.0 - s
    return (x <= knots_travel[-1] + 1e-9 and knots_position[0] - 1e-9 <= s <= knots_position[-1] + 1e-9
            and knots_slack[0] - 1e-9 <= e <= knots_slack[-1] + 1e-9)
)";

Language cpp_language(const std::string& name) {
  return {.comment = "// ",
          .prefix = "std::",
          .qualifier = "inline ",
          .own = "",
          .array_open = "inline constexpr double {}[] = {{",
          .array_close = "};\n",
          .function_open = "{q}double {name}(double d) {{\n  return d < 0.0 ? 0.0 : ",
          .function_close = ";\n}\n",
          .prelude = fmt::format("#pragma once\n\n#include <cmath>\n\nnamespace {} {{\n\n", name),
          .basis = c_basis,
          .table = c_table,
          .range = c_range,
          .load_unload = c_load_unload,
          .end = fmt::format("\n}}  // namespace {}\n", name)};
}

/// Comments of C end where they should.
std::string closed_comments(const std::string& text) {
  std::string closed;
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::string line = text.substr(from, end - from);
    if (line.starts_with("/* ") && !line.ends_with("*/")) line += " */";
    closed += line + "\n";
    from = end + 1;
  }
  return closed;
}

/// C has no namespaces.
std::string own_prefix(const std::string& name) {
  return name.empty() ? "" : name + "_";
}

}  // namespace

std::string position_name(double position) {
  std::string text = fmt::format("s{:.6g}", 1e3 * position);
  std::replace(text.begin(), text.end(), '.', '_');
  return text;
}

std::string cpp_header(const DistilledCase& one, const std::string& title, const std::string& name) {
  return generate(one, title, cpp_language(name.empty() ? "snare_law" : name));
}

std::string c_header(const DistilledCase& one, const std::string& title, const std::string& name) {
  const std::string own = own_prefix(name);
  std::string guard = (name.empty() ? "snare_law" : name) + "_h";
  std::ranges::transform(guard, guard.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string text = head(one, title, "/* ");
  text += fmt::format("#ifndef {0}\n#define {0}\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n", guard);
  constexpr const char* of_table = "double {}{}(double d, double position, double slack);\n";
  text += "/* force [N] at travel d, position and slack [m] */\n" + fmt::format(of_table, own, "force");
  if (one.table.unloading)
    text += "/* the way back from the end of the travel */\n" + fmt::format(of_table, own, "force_unloading");
  text += "/* 0 where the outermost cell goes on beyond the table */\n" +
          fmt::format("int {}in_range(double d, double position, double slack);\n", own);
  for (const DistilledPlace& place : one.places) {
    const std::string where = position_name(place.position);
    text += fmt::format("\n/* simple laws at s = {:.6g} mm: force [N] at travel d [m] */\n", 1e3 * place.position);
    for (const FittedLaw& law : place.laws)
      text += fmt::format("double {}{}_{}(double d);\n", own, law.form->name(), where);
    if (!place.load_unload) continue;
    text += "/* with a memory that is 1 and 0 at first */\n" +
            fmt::format("double {}load_unload_{}(double d, double* branch, double* last);\n", own, where);
  }
  return closed_comments(text + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n");
}

std::string c_source(const DistilledCase& one, const std::string& title, const std::string& name) {
  Language l = cpp_language("");
  l.comment = "/* ";
  l.own = own_prefix(name);
  l.prefix = l.qualifier = l.end = "";
  l.array_open = "static const double {}[] = {{";
  l.prelude = "#include <math.h>\n\n";
  std::string closed = closed_comments(generate(one, title, l));
  // What no other file should see.
  for (const char* helper : {"unsigned find_cell_(", "unsigned basis_("}) {
    const std::size_t at = closed.find(std::string("\n") + helper);
    if (at != std::string::npos) closed.insert(at + 1, "static ");
  }
  return closed;
}

std::string python_module(const DistilledCase& one, const std::string& title) {
  return generate(one, title,
                  {.comment = "# ",
                   .prefix = "math.",
                   .qualifier = "",
                   .own = "",
                   .array_open = "{} = (",
                   .array_close = ",)\n",
                   .function_open = "def {name}(d):\n    return 0.0 if d < 0.0 else ",
                   .function_close = "\n",
                   .prelude = "import math\n\n",
                   .basis = python_basis,
                   .table = python_table,
                   .range = python_range,
                   .load_unload = python_load_unload,
                   .end = ""});
}

}  // namespace snare::reduction
