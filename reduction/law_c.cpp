#include "reduction/export_text.hpp"
#include "reduction/law_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace snare::reduction {

namespace {

/// What differs between C and C++.
struct Dialect {
  bool cpp = false;
  std::string own;  ///< begins the names that others see, in C
};

/// A comment on a line of its own, which no text can end or continue.
std::string comment(std::string text) {
  const auto part = [&text](const char* mark, const char* apart) {
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at))
      text.replace(at, 2, apart);
  };
  part("*/", "* /");
  part("/*", "/ *");
  return "/* " + text + " */\n";
}

std::string head(const DistilledCase& one, const std::string& title) {
  std::string text;
  for (const std::string& line : head_lines(one, title)) text += comment(line);
  return text;
}

/// A function of numbers with its refusal outside the range.
struct Function {
  std::string name;
  std::string parameters;  ///< "double d, double position"
  std::string arguments;   ///< "d, position"
  std::string inside;      ///< condition for the range
  std::string body;        ///< statements
};

std::string declaration(const Function& f, const Dialect& dialect) {
  return fmt::format("double {0}{1}({2});\ndouble {0}{1}_or_nan({2});\n", dialect.own, f.name, f.parameters);
}

std::string definition(const Function& f, const Dialect& dialect) {
  if (dialect.cpp) {
    return fmt::format(
        "inline double {}({}, Outside outside = Outside::extrapolate) {{\n"
        "  if (outside == Outside::refuse && !{}) throw std::domain_error(\"{}: outside the range of the "
        "law\");\n{}}}\n",
        f.name, f.parameters, f.inside, f.name, f.body);
  }
  return fmt::format(
      "double {0}{1}({2}) {{\n{3}}}\n\ndouble {0}{1}_or_nan({2}) {{\n  return {4} ? {0}{1}({5}) : NAN;\n}}\n",
      dialect.own, f.name, f.parameters, f.body, f.inside, f.arguments);
}

constexpr const char* helpers = R"(
/* The lower knot of the cell of x; of the first or last cell beyond the knots. */
@static@unsigned find_cell_(const double* knots, unsigned count, double x) {
  unsigned low = 0, high = count > 1 ? count - 1 : 1;
  while (high - low > 1) {
    unsigned middle = (low + high) / 2;
    if (x >= knots[middle]) low = middle; else high = middle;
  }
  return low;
}

/* Weights of value and slope at the lower and the upper knot of the cell: cubic, beyond the knots linear. */
@static@void weights_(const double* knots, unsigned count, unsigned low, double x, double b[4]) {
  double h, t, u;
  b[0] = 1.0; b[1] = 0.0; b[2] = 0.0; b[3] = 0.0;
  if (count == 1) return;
  if (x < knots[0]) { b[1] = x - knots[0]; return; }
  if (x > knots[count - 1]) { b[0] = 0.0; b[2] = 1.0; b[3] = x - knots[count - 1]; return; }
  h = knots[low + 1] - knots[low];
  t = (x - knots[low]) / h;
  u = 1.0 - t;
  b[0] = u * u * (1.0 + 2.0 * t); b[1] = h * t * u * u; b[2] = t * t * (1.0 + 2.0 * u); b[3] = -h * u * t * t;
}

/* A position over the span, from the nearer mount where left and right are alike. */
@static@double folded_(double position) {
  double s = position / @span@;
  return @mirror@ && s > 0.5 ? 1.0 - s : s;
}

@static@int place_in_range_(double position, double slack) {
  double s = folded_(position), e = slack / @span@;
  return s >= knots_position[0] - 1e-9 && s <= knots_position[@ns@ - 1] + 1e-9 &&
         e >= knots_slack[0] - 1e-9 && e <= knots_slack[@ne@ - 1] + 1e-9;
}

@static@double table_(const double* values, double d, double position, double slack) {
  double x = d / @span@, s = folded_(position), e = slack / @span@;
  double bs[4], be[4], end[4], control[4], h = 1.0, t, u, rise, top = 0.0, f;
  unsigned i, j, k, last, corner, n;
  int inside = place_in_range_(position, slack);
  if (d < 0.0) return 0.0;
  if (s < 0.0) s = 0.0;
  if (s > 1.0) s = 1.0;
  i = find_cell_(knots_position, @ns@, s);
  j = find_cell_(knots_slack, @ne@, e);
  weights_(knots_position, @ns@, i, s, bs);
  weights_(knots_slack, @ne@, j, e, be);
  last = find_cell_(knots_travel, @nd@, x);
  for (k = inside ? last : 0; ; ++k) {
    /* value and slope at both ends of the cell along the travel */
    for (n = 0; n < 4; ++n) {
      end[n] = 0.0;
      for (corner = 0; corner < 4; ++corner) {
        unsigned b = corner % 2, c = corner / 2;
        unsigned at_s = @ns@ > 1 ? i + b : 0u, at_e = @ne@ > 1 ? j + c : 0u;
        const double* v = values + 8 * (k + n / 2 + @nd@ * (at_s + @ns@ * at_e)) + n % 2;
        end[n] += be[2 * c] * (bs[2 * b] * v[0] + bs[2 * b + 1] * v[2]) +
                  be[2 * c + 1] * (bs[2 * b] * v[4] + bs[2 * b + 1] * v[6]);
      }
    }
    h = knots_travel[k + 1] - knots_travel[k];
    control[0] = end[0];
    control[1] = end[0] + h / 3.0 * end[1];
    control[2] = end[2] - h / 3.0 * end[3];
    control[3] = end[2];
    /* beyond the positions or slacks the force does not fall along the travel */
    for (n = 0; !inside && n < 4; ++n) {
      if (control[n] < top) control[n] = top;
      top = control[n];
    }
    if (k == last) break;
  }
  t = (x - knots_travel[last]) / h;
  u = 1.0 - t;
  if (t > 1.0) {
    rise = control[3] - control[2];
    f = control[3] + 3.0 * (rise < 0.0 ? 0.0 : rise) * (t - 1.0);
  } else {
    f = u * u * (u * control[0] + 3.0 * t * control[1]) + t * t * (3.0 * u * control[2] + t * control[3]);
  }
  return f < 0.0 ? 0.0 : @scale@ * f;
}

/* 0 where a force is continued linearly */
@extern@@flag@ @p@in_range(double d, double position, double slack) {
  return d < 0.0 || (d / @span@ <= @last@ + 1e-9 && place_in_range_(position, slack));
}

/* The same of the simple laws, which know the travel alone. */
@extern@@flag@ @p@travel_in_range(double d) {
  return d / @span@ <= @last@ + 1e-9;
}

)";

constexpr const char* simple_body = R"(  double f;
  if (d < 0.0) return 0.0;
  if (d > @end@) return @end_force@ + @end_stiffness@ * (d - @end@);
  f = @expression@;
  return f < 0.0 ? 0.0 : f;
)";

constexpr const char* load_unload_body = R"(  *branch += 2.0 * (d - *last) / @turn@;
  if (*branch > 1.0) *branch = 1.0;
  if (*branch < -1.0) *branch = -1.0;
  *last = d;
  if (d < 0.0) {
    *branch = 1.0;
    return 0.0;
  }
  return @p@force(d, @position@, @slack@) * (@sum@ + *branch * @difference@);
)";

/// The table as a function of travel, position and slack.
Function of_table(const std::string& name, const std::string& values, const Dialect& dialect) {
  return {name, "double d, double position, double slack", "d, position, slack",
          dialect.own + "in_range(d, position, slack)",
          fmt::format("  return table_({}, d, position, slack);\n", values)};
}

std::vector<Function> of_tables(const DistilledCase& one, const Dialect& dialect) {
  std::vector<Function> all{of_table("force", "nodes", dialect)};
  if (one.table.unloading) all.push_back(of_table("force_unloading", "nodes_unloading", dialect));
  return all;
}

Function of_law(const ExportedLaw& law, const Dialect& dialect) {
  return {law.name, "double d", "d", dialect.own + "travel_in_range(d)", filled(simple_body, law.of_numbers)};
}

Function load_unload(const DistilledCase& one, const DistilledPlace& place, const Dialect& dialect) {
  Replacements numbers = load_unload_numbers(one, place);
  numbers.emplace_back("p", dialect.own);
  return {"load_unload_" + position_name(place.position), "double d, double* branch, double* last",
          "d, branch, last", dialect.own + "travel_in_range(d)", filled(load_unload_body, numbers)};
}

std::string load_unload_words(const DistilledPlace& place) {
  return fmt::format(
      "load and unload; its memory is 1 and 0 at first; largest error on the way back {:.3g} N",
      place.load_unload->largest_error);
}

std::string prefix(const Dialect& dialect) {
  return dialect.cpp ? "std::" : "";
}

std::string definitions(const DistilledCase& one, const Dialect& dialect) {
  const coupling::ForceTable& table = *one.table.loading;
  std::string text;
  const auto array = [&](const char* name, const std::vector<double>& values) {
    text += fmt::format("{} double {}[] = {{\n  {}}};\n", dialect.cpp ? "inline constexpr" : "static const",
                        name, number_list(values));
  };
  array("knots_travel", table.axes()[0]);
  array("knots_position", table.axes()[1]);
  array("knots_slack", table.axes()[2]);
  array("nodes", table.nodes());
  if (one.table.unloading) array("nodes_unloading", one.table.unloading->nodes());
  Replacements words = table_numbers(table);
  words.insert(words.end(), {{"static", dialect.cpp ? "inline " : "static "},
                             {"extern", dialect.cpp ? "inline " : ""},
                             {"flag", dialect.cpp ? "bool" : "int"},
                             {"p", dialect.own}});
  text += filled(helpers, words);
  for (const Function& f : of_tables(one, dialect))
    text += comment("force [N] at travel d, position and slack [m]") + definition(f, dialect);
  for (const DistilledPlace& place : one.places) {
    for (const ExportedLaw& law : exported_laws(place, prefix(dialect)))
      text += "\n" + comment(law.words) + definition(of_law(law, dialect), dialect);
    if (place.load_unload)
      text +=
          "\n" + comment(load_unload_words(place)) + definition(load_unload(one, place, dialect), dialect);
  }
  return text;
}

Dialect c_dialect(const std::string& name) {
  return {false, name.empty() ? "" : name + "_"};  // C has no namespaces
}

}  // namespace

std::string cpp_header(const DistilledCase& one, const std::string& title, const std::string& name) {
  const std::string space = name.empty() ? "snare_law" : name;
  return head(one, title) +
         fmt::format(
             "#pragma once\n\n#include <cmath>\n#include <stdexcept>\n\nnamespace {} {{\n\n"
             "/* Outside its range a force is continued linearly, or std::domain_error is thrown. */\n"
             "enum class Outside {{ extrapolate, refuse }};\n\n",
             space) +
         definitions(one, {true, ""}) + fmt::format("\n}}  /* namespace {} */\n", space);
}

std::string c_header(const DistilledCase& one, const std::string& title, const std::string& name) {
  const Dialect dialect = c_dialect(name);
  std::string guard = (name.empty() ? "snare_law" : name) + "_h";
  std::ranges::transform(guard, guard.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string text = head(one, title);
  text += fmt::format("#ifndef {0}\n#define {0}\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n", guard);
  text +=
      comment(
          "1 within the range; 0 where a force is continued linearly. The functions with _or_nan give no "
          "number "
          "there.") +
      fmt::format(
          "int {0}in_range(double d, double position, double slack);\nint {0}travel_in_range(double d);\n\n",
          dialect.own) +
      comment(
          "force [N] at travel d, position and slack [m]; force_unloading: the way back from the end of the "
          "travel");
  for (const Function& f : of_tables(one, dialect)) text += declaration(f, dialect);
  for (const DistilledPlace& place : one.places) {
    text += "\n" + comment(fmt::format("simple laws at s = {:.6g} mm: force [N] at travel d [m]",
                                       1e3 * place.position));
    for (const ExportedLaw& law : exported_laws(place, prefix(dialect)))
      text += declaration(of_law(law, dialect), dialect);
    if (place.load_unload)
      text += comment(load_unload_words(place)) + declaration(load_unload(one, place, dialect), dialect);
  }
  return text + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n";
}

std::string c_source(const DistilledCase& one, const std::string& title, const std::string& name) {
  // Declared before they are defined, as -Wmissing-prototypes wants it.
  return head(one, title) + "#include <math.h>\n\n" + definitions(one, c_dialect(name));
}

}  // namespace snare::reduction
