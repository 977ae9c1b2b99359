#include "reduction/law_export.hpp"
#include "reduction/law_simulators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace snare::reduction {

namespace {

std::string array(std::string_view name, const std::vector<double>& values) {
  std::string text = fmt::format("  constant Real {}[{}] = {{", name, values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    // A number without a point is an Integer, which Modelica takes for a Real.
    text += fmt::format("{}{}", i == 0 ? "" : i % 8 == 0 ? ",\n    " : ", ", values[i]);
  }
  return text + "};\n";
}

/// What stands in quotes.
std::string in_quotes(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '"' || c == '\\') safe += '\\';
    safe += c == '\n' ? ' ' : c;
  }
  return '"' + safe + '"';
}

constexpr const char* helpers = R"(
  function pow "Power, as C writes it"
    input Real x;
    input Real y;
    output Real z;
  algorithm
    z := x ^ y;
  end pow;

  function fabs "Magnitude, as C writes it"
    input Real x;
    output Real z;
  algorithm
    z := abs(x);
  end fabs;

  function basis "Cell of x among knots, and the cubic Hermite functions there"
    input Real knots[:];
    input Real x;
    output Integer low;
    output Integer high;
    output Real b[4];
  protected
    Integer middle;
    Real h;
    Real t;
    Real u;
  algorithm
    low := 1;
    high := size(knots, 1);
    b := {1.0, 0.0, 0.0, 0.0};
    if high > 1 then
      while high - low > 1 loop
        middle := div(low + high, 2);
        if x >= knots[middle] then
          low := middle;
        else
          high := middle;
        end if;
      end while;
      h := knots[high] - knots[low];
      t := (x - knots[low]) / h;
      u := 1.0 - t;
      b := {u * u * (1.0 + 2.0 * t), h * t * u * u, t * t * (1.0 + 2.0 * u), -h * u * t * t};
    end if;
  end basis;
)";

constexpr const char* of_table = R"(
  function @name@ "@words@"
    input Real d "Travel from first touch [m]";
    input Real position "Along the chord from the left mount [m]";
    input Real slack "Length less span [m]";
    output Real f "Force [N]";
  protected
    Real s;
    Real bd[4];
    Real bs[4];
    Real be[4];
    Real along[4];
    Integer k;
    Integer k1;
    Integer i[2];
    Integer j[2];
    Integer at;
  algorithm
    f := 0.0;
    if d >= 0.0 then
      s := position / @span@;
      if @mirror@ then
        s := 1.0 - s;
      end if;
      (k, k1, bd) := basis(knots_travel, d / @span@);
      (i[1], i[2], bs) := basis(knots_position, s);
      (j[1], j[2], be) := basis(knots_slack, slack / @span@);
      for c in 1:2 loop
        for b in 1:2 loop
          at := 8 * (k - 1 + @nd@ * (i[b] - 1 + @ns@ * (j[c] - 1)));
          for p in 1:4 loop
            along[p] := bd[1] * @nodes@[at + 2 * p - 1] + bd[2] * @nodes@[at + 2 * p] + bd[3] * @nodes@[at + 8 + 2 * p - 1] + bd[4] * @nodes@[at + 8 + 2 * p];
          end for;
          f := f + be[2 * c - 1] * (bs[2 * b - 1] * along[1] + bs[2 * b] * along[2]) + be[2 * c] * (bs[2 * b - 1] * along[3] + bs[2 * b] * along[4]);
        end for;
      end for;
      f := @scale@ * f;
    end if;
  end @name@;
)";

constexpr const char* of_range = R"(
  function in_range "Whether the table holds the place"
    input Real d;
    input Real position;
    input Real slack;
    output Boolean inside;
  protected
    Real s;
  algorithm
    s := position / @span@;
    if @mirror@ then
      s := 1.0 - s;
    end if;
    inside := d / @span@ <= knots_travel[@nd@] + 1e-9 and s >= knots_position[1] - 1e-9 and s <= knots_position[@ns@] + 1e-9 and slack / @span@ >= knots_slack[1] - 1e-9 and slack / @span@ <= knots_slack[@ne@] + 1e-9;
  end in_range;
)";

std::string filled(std::string text, const std::vector<std::pair<std::string_view, std::string>>& values) {
  for (const auto& [key, value] : values) {
    const std::string mark = fmt::format("@{}@", key);
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + value.size()))
      text.replace(at, mark.size(), value);
  }
  return text;
}

}  // namespace

std::string modelica_package(const DistilledCase& one, const std::string& title, const std::string& name) {
  const std::string package = name.empty() ? "snare_law" : name;
  const coupling::ForceTable& table = *one.table.loading;
  const auto& axes = table.axes();
  const std::vector<std::pair<std::string_view, std::string>> numbers{
      {"span", fmt::format("{}", table.span())},          {"scale", fmt::format("{}", table.force_scale())},
      {"mirror", table.mirrored() ? "s > 0.5" : "false"}, {"nd", fmt::format("{}", axes[0].size())},
      {"ns", fmt::format("{}", axes[1].size())},          {"ne", fmt::format("{}", axes[2].size())}};
  const auto evaluation = [&](std::string function, std::string words, std::string nodes) {
    auto values = numbers;
    values.insert(values.end(),
                  {{"name", std::move(function)}, {"words", std::move(words)}, {"nodes", std::move(nodes)}});
    return filled(of_table, values);
  };
  std::string text = fmt::format(
      "package {} {}\n", package,
      in_quotes(fmt::format("{}: force of a snare wire on a pusher, distilled from the full wire by snare; SI units",
                            title)));
  text += array("knots_travel", axes[0]) + array("knots_position", axes[1]) + array("knots_slack", axes[2]) +
          array("nodes", table.nodes());
  if (one.table.unloading) text += array("nodes_unloading", one.table.unloading->nodes());
  text += helpers + evaluation("force", "Of the table", "nodes");
  if (one.table.unloading)
    text += evaluation("force_unloading", "The way back from the end of the travel", "nodes_unloading");
  text += filled(of_range, numbers);
  for (const DistilledPlace& place : one.places) {
    for (const FittedLaw& law : place.laws) {
      const std::string function = law.form->name() + "_" + position_name(place.position);
      text += fmt::format(
          "\n  function {0} {1}\n    input Real d \"Travel from first touch [m]\";\n    output Real f \"Force "
          "[N]\";\n  algorithm\n    f := 0.0;\n    if d >= 0.0 then\n      f := {2};\n    end if;\n  end {0};\n",
          function,
          in_quotes(fmt::format("{}, largest error {:.3g} N of {:.3g} N", law.form->formula(), law.error.largest_force,
                                law.error.force_range)),
          law.form->expression(law.values, ""));
    }
  }
  return text + fmt::format("end {};\n", package);
}

}  // namespace snare::reduction
