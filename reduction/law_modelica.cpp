#include "reduction/export_text.hpp"
#include "reduction/law_export.hpp"

#include "base/one_line.hpp"

#include <fmt/format.h>

namespace snare::reduction {

namespace {

std::string array(const char* name, const std::vector<double>& values) {
  // A number without a point is an Integer, which Modelica takes for a Real.
  return fmt::format("  constant Real {}[{}] = {{{}}};\n", name, values.size(),
                     number_list(values, 8, ",\n    "));
}

/// A text as a Modelica string.
std::string in_quotes(const std::string& text) {
  std::string safe;
  for (const char c : base::one_line(text)) {
    if (c == '"' || c == '\\') safe += '\\';
    safe += c;
  }
  return '"' + safe + '"';
}

// Every call has one result, and functions that are called for it assign and branch alone where they can:
// some readers know no more.
constexpr const char* modelica_helpers = R"(
  function pow "Power of a number that is not negative, as C writes it"
    input Real x;
    input Real y;
    output Real z;
  algorithm
    z := max(0.0, x) ^ y;
  end pow;

  function fabs "Magnitude, as C writes it"
    input Real x;
    output Real z;
  algorithm
    z := abs(x);
  end fabs;

  function find_cell "Lower knot of the cell of x; of the first or last cell beyond the knots"
    input Real knots[:];
    input Real x;
    output Integer low;
  protected
    Integer high;
    Integer middle;
  algorithm
    low := 1;
    high := size(knots, 1);
    while high - low > 1 loop
      middle := div(low + high, 2);
      if x >= knots[middle] then
        low := middle;
      else
        high := middle;
      end if;
    end while;
  end find_cell;

  function weights "Weights of value and slope at the lower and the upper knot of a cell: cubic, beyond the knots linear"
    input Real knots[:];
    input Integer low;
    input Real x;
    output Real b[4];
  protected
    Integer n;
    Real h;
    Real t;
    Real u;
  algorithm
    n := size(knots, 1);
    b := {1.0, 0.0, 0.0, 0.0};
    if n > 1 then
      if x < knots[1] then
        b := {1.0, x - knots[1], 0.0, 0.0};
      else
        if x > knots[n] then
          b := {0.0, 0.0, 1.0, x - knots[n]};
        else
          h := knots[low + 1] - knots[low];
          t := (x - knots[low]) / h;
          u := 1.0 - t;
          b := {u * u * (1.0 + 2.0 * t), h * t * u * u, t * t * (1.0 + 2.0 * u), -h * u * t * t};
        end if;
      end if;
    end if;
  end weights;

  function folded "Position over the span, from the nearer mount where left and right are alike"
    input Real position;
    output Real s;
  algorithm
    s := position / @span@;
    if @mirror@ > 0 and s > 0.5 then
      s := 1.0 - s;
    end if;
  end folded;

  function in_range "Whether the force needs no continuation"
    input Real d;
    input Real position;
    input Real slack;
    output Boolean inside;
  protected
    Real s;
    Real e;
  algorithm
    s := folded(position);
    e := slack / @span@;
    inside := d < 0.0 or d / @span@ <= @last@ + 1e-9 and s >= knots_position[1] - 1e-9 and s <= knots_position[@ns@] + 1e-9 and e >= knots_slack[1] - 1e-9 and e <= knots_slack[@ne@] + 1e-9;
  end in_range;

  function travel_in_range "The same of the simple laws, which know the travel alone"
    input Real d;
    output Boolean inside;
  algorithm
    inside := d / @span@ <= @last@ + 1e-9;
  end travel_in_range;
)";

constexpr const char* of_table = R"(
  function @name@ "@words@"
    input Real d "Travel from first touch [m]";
    input Real position "Along the chord from the left mount [m]";
    input Real slack "Length less span [m]";
    output Real f "Force [N]";
  protected
    Boolean inside;
    Real x;
    Real s;
    Real h;
    Real t;
    Real u;
    Real top;
    Real bs[4];
    Real be[4];
    Real ends[4];
    Real control[4];
    Integer i;
    Integer j;
    Integer first;
    Integer last;
    Integer at;
  algorithm
    f := 0.0;
    if d >= 0.0 then
      x := d / @span@;
      s := min(1.0, max(0.0, folded(position)));
      i := find_cell(knots_position, s);
      j := find_cell(knots_slack, slack / @span@);
      last := find_cell(knots_travel, x);
      bs := weights(knots_position, i, s);
      be := weights(knots_slack, j, slack / @span@);
      inside := in_range(0.0, position, slack);
      first := last;
      if not inside then
        first := 1;
      end if;
      top := 0.0;
      h := 1.0;
      control := {0.0, 0.0, 0.0, 0.0};
      for k in first:last loop
        ends := {0.0, 0.0, 0.0, 0.0};
        for c in 1:@corners_e@ loop
          for b in 1:@corners_s@ loop
            for n in 1:4 loop
              at := 8 * (k - 1 + div(n - 1, 2) + @nd@ * (i + b - 2 + @ns@ * (j + c - 2))) + 1 + mod(n - 1, 2);
              ends[n] := ends[n] + be[2 * c - 1] * (bs[2 * b - 1] * @nodes@[at] + bs[2 * b] * @nodes@[at + 2]) + be[2 * c] * (bs[2 * b - 1] * @nodes@[at + 4] + bs[2 * b] * @nodes@[at + 6]);
            end for;
          end for;
        end for;
        h := knots_travel[k + 1] - knots_travel[k];
        control := {ends[1], ends[1] + h / 3.0 * ends[2], ends[3] - h / 3.0 * ends[4], ends[3]};
        if not inside then
          for n in 1:4 loop
            control[n] := max(top, control[n]);
            top := control[n];
          end for;
        end if;
      end for;
      t := (x - knots_travel[last]) / h;
      u := 1.0 - t;
      if t > 1.0 then
        f := control[4] + 3.0 * max(0.0, control[4] - control[3]) * (t - 1.0);
      else
        f := u * u * (u * control[1] + 3.0 * t * control[2]) + t * t * (3.0 * u * control[3] + t * control[4]);
      end if;
      f := @scale@ * max(0.0, f);
    end if;
  end @name@;

  function @name@_or_stop "The same, which stops outside the range"
    input Real d;
    input Real position;
    input Real slack;
    output Real f;
  algorithm
    assert(in_range(d, position, slack), "outside the range of the law");
    f := @name@(d, position, slack);
  end @name@_or_stop;
)";

constexpr const char* simple = R"(
  function @name@ "@words@"
    input Real d "Travel from first touch [m]";
    output Real f "Force [N]";
  algorithm
    f := 0.0;
    if d > @end@ then
      f := @end_force@ + @end_stiffness@ * (d - @end@);
    else
      if d >= 0.0 then
        f := max(0.0, @expression@);
      end if;
    end if;
  end @name@;

  function @name@_or_stop "The same, which stops outside the range"
    input Real d;
    output Real f;
  algorithm
    assert(travel_in_range(d), "outside the range of the law");
    f := @name@(d);
  end @name@_or_stop;
)";

}  // namespace

std::string modelica_package(const DistilledCase& one, const std::string& title, const std::string& name) {
  const std::string package = name.empty() ? "snare_law" : name;
  const coupling::ForceTable& table = *one.table.loading;
  Replacements numbers = table_numbers(table);
  // An axis of one knot has one corner.
  numbers.emplace_back("corners_s", table.axes()[1].size() > 1 ? "2" : "1");
  numbers.emplace_back("corners_e", table.axes()[2].size() > 1 ? "2" : "1");
  const auto evaluation = [&](const char* function, const char* words, const char* nodes) {
    Replacements values = numbers;
    values.insert(values.end(), {{"name", function}, {"words", words}, {"nodes", nodes}});
    return filled(of_table, values);
  };
  std::string head;
  for (const std::string& line : head_lines(one, title)) head += (head.empty() ? "" : "; ") + line;
  std::string text = fmt::format("package {} {}\n", package, in_quotes(head));
  text += array("knots_travel", table.axes()[0]) + array("knots_position", table.axes()[1]) +
          array("knots_slack", table.axes()[2]) + array("nodes", table.nodes());
  if (one.table.unloading) text += array("nodes_unloading", one.table.unloading->nodes());
  text += filled(modelica_helpers, numbers) + evaluation("force", "Force of the table", "nodes");
  if (one.table.unloading)
    text += evaluation("force_unloading", "The way back from the end of the travel", "nodes_unloading");
  for (const DistilledPlace& place : one.places) {
    for (const ExportedLaw& law : exported_laws(place, "")) {
      Replacements values = law.of_numbers;
      values.insert(values.end(), {{"name", law.name}, {"words", law.words}});
      text += filled(simple, values);
    }
  }
  return text + fmt::format("end {};\n", package);
}

}  // namespace snare::reduction
