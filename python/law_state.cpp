#include "python/law_state.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace snare::python {

namespace py = pybind11;

namespace {

using coupling::ForceTable;
using Vector = std::vector<double>;

constexpr int version = 1;  // of the states

void require(bool holds) {
  if (!holds) throw py::value_error("this is no state of a law of this version of snare");
}

py::array_t<double> array(const Vector& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

bool is_axis(const Vector& knots, std::size_t least) {
  return knots.size() >= least && std::ranges::is_sorted(knots, std::less_equal<>());
}

std::shared_ptr<const ForceTable> table(const ForceTable::Axes& axes, Vector nodes, double span, double scale,
                                        bool mirrored) {
  require(is_axis(axes[0], 2) && is_axis(axes[1], 1) && is_axis(axes[2], 1) && span > 0.0 && scale > 0.0);
  require(nodes.size() == ForceTable::numbers_a_node * axes[0].size() * axes[1].size() * axes[2].size());
  return std::make_shared<const ForceTable>(
      ForceTable::from_nodes(axes, std::move(nodes), span, scale, mirrored));
}

/// The parts of a state as C++ values; a state of other parts is none.
template <class... Parts>
std::tuple<Parts...> parts(const py::tuple& state) {
  require(state.size() == sizeof...(Parts));
  try {
    return state.cast<std::tuple<Parts...>>();
  } catch (const py::cast_error&) {
    require(false);
    throw;
  }
}

}  // namespace

py::tuple state_of(const scenario::SimpleLaw& law) {
  return py::make_tuple(version, law.name, law.formula, law.place.span, law.place.position, law.place.length,
                        law.place.bending_stiffness, law.values, law.travel, law.largest_error);
}

scenario::SimpleLaw simple_law_of(const py::tuple& state) {
  const auto [of_version, name, formula, span, position, length, stiffness, values, travel, error] =
      parts<int, std::string, std::string, double, double, double, double, Vector, std::array<double, 2>,
            double>(state);
  const std::size_t numbers = scenario::parameters_of_law(name).size();
  require(of_version == version && numbers > 0 && values.size() == numbers && span > 0.0 && position > 0.0 &&
          position < span && length > 0.0 && stiffness > 0.0 && travel[1] > 0.0);
  const coupling::LawPlace place{span, position, length, stiffness};
  require(std::ranges::all_of(values, [](double v) { return std::isfinite(v); }));
  scenario::SimpleLaw law = scenario::make_simple_law(name, place, values, travel);
  law.formula = formula;
  law.largest_error = error;
  return law;
}

py::tuple state_of(const scenario::DistilledLaw& law) {
  const ForceTable& t = *law.loading;
  py::object unloading = py::none();
  if (law.unloading) unloading = array(law.unloading->nodes());
  py::list simple;
  for (const scenario::SimpleLaw& one : law.simple) simple.append(state_of(one));
  return py::make_tuple(
      version, law.title,
      py::make_tuple(array(t.axes()[0]), array(t.axes()[1]), array(t.axes()[2]), array(t.nodes()), unloading,
                     t.span(), t.force_scale(), t.mirrored()),
      law.bound, law.force_range, law.travel, law.position, law.slack, law.nominal_slack,
      py::make_tuple(law.wire.bending_stiffness, law.wire.axial_stiffness, law.wire.span, law.wire.radius),
      simple);
}

scenario::DistilledLaw distilled_law_of(const py::tuple& state) {
  using Range = std::array<double, 2>;
  const auto [of_version, title, tables, bound, force_range, travel, position, slack, nominal, wire, simple] =
      parts<int, std::string, py::tuple, double, double, Range, Range, Range, double, std::array<double, 4>,
            py::list>(state);
  require(of_version == version);
  const auto [d, s, e, nodes, unloading, span, scale, mirrored] =
      parts<Vector, Vector, Vector, Vector, std::optional<Vector>, double, double, bool>(tables);
  scenario::DistilledLaw law;
  law.title = title;
  law.loading = table({d, s, e}, nodes, span, scale, mirrored);
  if (unloading) law.unloading = table({d, s, e}, *unloading, span, scale, mirrored);
  law.bound = bound;
  law.force_range = force_range;
  law.travel = travel;
  law.position = position;
  law.slack = slack;
  law.nominal_slack = nominal;
  law.wire = {wire[0], wire[1], wire[2], wire[3]};
  for (const py::handle one : simple) {
    require(py::isinstance<py::tuple>(one));
    law.simple.push_back(simple_law_of(py::reinterpret_borrow<py::tuple>(one)));
  }
  return law;
}

}  // namespace snare::python
