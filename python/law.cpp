#include "python/law.hpp"

#include "python/convert.hpp"
#include "python/law_numbers.hpp"
#include "python/law_state.hpp"
#include "python/ready.hpp"
#include "scenario/distilled_law.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace snare::python {

namespace py = pybind11;

namespace {

using coupling::ForceTable;
using coupling::Outside;
using scenario::DistilledLaw;
using scenario::SimpleLaw;
using ThisLaw = Ready<DistilledLaw>;
using ThisSimple = Ready<SimpleLaw>;

std::string shown(const py::object& value) {
  return py::repr(value);
}

Outside outside_of(const py::object& word) {
  const std::string message = "outside = " + shown(word) + ", must be 'extrapolate' or 'refuse'";
  if (!py::isinstance<py::str>(word)) throw py::type_error(message);
  const std::string text = py::str(word);
  if (text == "refuse") return Outside::refuse;
  if (text == "extrapolate") return Outside::extrapolate;
  throw std::invalid_argument(message);
}

bool flag_of(const py::object& value, const char* name) {
  if (PyBool_Check(value.ptr())) return value.is(py::bool_(true));
  if (!py::isinstance(value, py::module_::import("numpy").attr("bool_")))
    throw py::type_error(fmt::format("{} = {}, must be True or False", name, shown(value)));
  return py::bool_(value);
}

const ForceTable& table_of(const DistilledLaw& law, const py::object& unloading) {
  if (!flag_of(unloading, "unloading")) return *law.loading;
  if (!law.unloading)
    throw std::invalid_argument("unloading = True: nothing dissipates in this wire, see `dissipates`");
  return *law.unloading;
}

Given slack_or_nominal(const DistilledLaw& law, const py::object& slack) {
  return slack.is_none() ? Given{Numbers(py::float_(law.nominal_slack)), {}, false}
                         : numbers_of(slack, "slack");
}

Broadcast<3> points(const DistilledLaw& law, const py::object& d, const py::object& s,
                    const py::object& slack) {
  return Broadcast<3>({numbers_of(d, "d"), numbers_of(s, "s"), slack_or_nominal(law, slack)});
}

/// The warning snare.OutsideRange, where a force or stiffness is a continuation.
void warn_if(bool continued) {
  if (!continued) return;
  const py::object category = py::module_::import("snare._core").attr("OutsideRange");
  if (PyErr_WarnEx(category.ptr(), "outside the range of the law: continued linearly (see `in_range`)", 1) !=
      0)
    throw py::error_already_set();
}

py::object force(const ThisLaw& law, const py::object& d, const py::object& s, const py::object& slack,
                 const py::object& outside, const py::object& unloading) {
  const ForceTable& table = table_of(*law, unloading);
  const Outside what = outside_of(outside);
  bool continued = false;
  py::object result = points(*law, d, s, slack).map<double>([&](double x, double y, double z) {
    const scenario::ContinuedForce value = DistilledLaw::force(table, x, y, z, what);
    continued |= value.extrapolated;
    return value.force;
  });
  warn_if(continued);
  return result;
}

py::object stiffness(const ThisLaw& law, const py::object& d, const py::object& s, const py::object& slack,
                     const py::object& outside, const py::object& unloading) {
  const ForceTable& table = table_of(*law, unloading);
  const Outside what = outside_of(outside);
  bool continued = false;
  py::object result = points(*law, d, s, slack).map<double>([&](double x, double y, double z) {
    const coupling::LawValue value = DistilledLaw::at(table, x, y, z, what);
    continued |= value.extrapolated;
    return value.stiffness;
  });
  warn_if(continued);
  return result;
}

py::object in_range(const ThisLaw& law, const py::object& d, const py::object& s, const py::object& slack) {
  return points(*law, d, s, slack).map<bool>([&](double x, double y, double z) {
    return law->in_range(x, y, z);
  });
}

bool beyond(const SimpleLaw& one, double d) {
  return d > one.travel[1] * (1.0 + 1e-9);
}

template <double (coupling::SpringLaw::*number)(double) const>
py::object of_travel(const ThisSimple& one, const py::object& d, const py::object& outside) {
  const Outside what = outside_of(outside);
  bool continued = false;
  py::object result = Broadcast<1>({numbers_of(d, "d")}).map<double>([&](double x) {
    if (!std::isfinite(x)) throw std::domain_error(fmt::format("travel {} m: must be finite", x));
    if (x < 0.0) return 0.0;
    if (beyond(*one, x)) {
      continued = true;
      if (what == Outside::refuse)
        throw std::domain_error(
            fmt::format("travel of {:.6g} mm is outside the range of the law, {:.6g} to {:.6g} mm", 1e3 * x,
                        1e3 * one->travel[0], 1e3 * one->travel[1]));
    }
    return ((*one->law).*number)(x);
  });
  warn_if(continued);
  return result;
}

py::object simple_in_range(const ThisSimple& one, const py::object& d) {
  return Broadcast<1>({numbers_of(d, "d")}).map<bool>([&](double x) {
    return !std::isnan(x) && !beyond(*one, x);
  });
}

py::dict parameters_of(const ThisSimple& one) {
  py::dict all;
  for (std::size_t k = 0; k < one->values.size(); ++k)
    all[py::str(one->parameters[k].name)] = py::make_tuple(one->values[k], one->parameters[k].unit);
  return all;
}

/// A member of a class as a property.
template <auto member, class T>
auto get(const Ready<T>& object) {
  return (*object).*member;
}

template <auto range>
py::tuple interval(const ThisLaw& law) {
  return py::make_tuple(((*law).*range)[0], ((*law).*range)[1]);
}

DistilledLaw from_file(const py::object& file, const py::object& number) {
  const std::filesystem::path path = path_of(file, "file");
  if (!PyLong_Check(number.ptr()) || PyBool_Check(number.ptr()))
    throw py::type_error("case = " + shown(number) + ", must be a whole number");
  const std::vector<DistilledLaw> laws = scenario::read_law_file(path);
  const long long index = PyLong_AsLongLong(number.ptr());
  PyErr_Clear();  // a number beyond all indices is -1
  if (index < 0 || static_cast<std::size_t>(index) >= laws.size())
    throw py::index_error(
        fmt::format("case = {}: {} has {} cases, counted from 0", shown(number), path.string(), laws.size()));
  return laws[static_cast<std::size_t>(index)];
}

}  // namespace

py::list laws_of(const nlohmann::json& document) {
  py::list laws;
  for (DistilledLaw& law : scenario::read_laws("law.json", document)) laws.append(py::cast(std::move(law)));
  return laws;
}

namespace {

void add_simple_law(py::module_& module) {
  constexpr auto* default_outside = "extrapolate";
  py::class_<SimpleLaw>(
      module, "SimpleLaw",
      "A law of a few numbers, fitted to the full wire at one position; found in Law.simple. Force, "
      "stiffness and energy are\n"
      "functions of the travel d [m]: a number or an array of any shape. Without contact (d < 0) "
      "they are 0. A force is never\n"
      "negative. Beyond the fitted travel it continues linearly with the warning OutsideRange; "
      "outside='refuse' raises\n"
      "ValueError instead.")
      .def_property_readonly("position", &get<&SimpleLaw::position, SimpleLaw>,
                             "s, of the pusher along the chord from the left mount [m].")
      .def_property_readonly("name", &get<&SimpleLaw::name, SimpleLaw>,
                             "As in law.json: 'quadratic', 'power_law', ...")
      .def_property_readonly("formula", &get<&SimpleLaw::formula, SimpleLaw>, "The law, for people.")
      .def_property_readonly("parameters", &parameters_of, "By name: (value, unit), in SI units.")
      .def_property_readonly("travel", &get<&SimpleLaw::travel, SimpleLaw>,
                             "[from, to], the travels at which it was fitted [m].")
      .def_property_readonly("largest_error", &get<&SimpleLaw::largest_error, SimpleLaw>,
                             "Against the full wire over these travels [N].")
      .def("force", &of_travel<&coupling::SpringLaw::force>, py::arg("d"), py::kw_only(),
           py::arg("outside") = default_outside, "Force [N] at the travel d [m].")
      .def("stiffness", &of_travel<&coupling::SpringLaw::stiffness>, py::arg("d"), py::kw_only(),
           py::arg("outside") = default_outside, "dF/dd [N/m] at the travel d [m].")
      .def("energy", &of_travel<&coupling::SpringLaw::energy>, py::arg("d"), py::kw_only(),
           py::arg("outside") = default_outside, "Integral of the force from 0 to the travel d [m], in J.")
      .def("in_range", &simple_in_range, py::arg("d"),
           "Whether the force at the travel d [m] needs no continuation.")
      .def("__reduce__",
           [](const ThisSimple& one) {
             return py::make_tuple(py::module_::import("snare._laws").attr("simple_law"),
                                   py::make_tuple(state_of(*one)));
           })
      .def("__repr__", [](const ThisSimple& one) {
        return fmt::format("<snare.SimpleLaw {} at {:.6g} m: {}>", one->name, one->position, one->formula);
      });
}

void add_law(py::module_& module) {
  constexpr auto* default_outside = "extrapolate";
  py::class_<DistilledLaw>(
      module, "Law",
      "The force of one wire as a table over travel, position and slack, with the simple laws fitted to "
      "it.\n\n"
      "Law(file, case=0) reads a law.json; `distil` returns laws, too. Lengths are in m, forces in N.")
      .def(py::init(&from_file), py::arg("file"), py::arg("case") = 0)
      .def("force", &force, py::arg("d"), py::arg("s"), py::arg("slack") = py::none(), py::kw_only(),
           py::arg("outside") = default_outside, py::arg("unloading") = false,
           "Force [N] on the pusher at travel d [m] from first touch, position s [m] along the chord from "
           "the left "
           "mount, and\n"
           "slack [m], length less span (None: the nominal one).\n\n"
           "Numbers or arrays; shapes are broadcast as NumPy does, and the result has theirs; points that "
           "are masked "
           "stay masked.\n"
           "Negative travel is no contact: 0. A force is never negative.\n"
           "outside: what happens outside the table's range. 'extrapolate' continues linearly, with the "
           "warning "
           "OutsideRange, and\n"
           "never falls along the travel; 'refuse' raises ValueError. `in_range` tells the points.\n"
           "unloading: on the way back from the end of the travel, where something dissipates.")
      .def("stiffness", &stiffness, py::arg("d"), py::arg("s"), py::arg("slack") = py::none(), py::kw_only(),
           py::arg("outside") = default_outside, py::arg("unloading") = false,
           "dF/dd [N/m], arguments as of `force`.")
      .def("in_range", &in_range, py::arg("d"), py::arg("s"), py::arg("slack") = py::none(),
           "Whether the force at these points needs no continuation; arguments as of `force`.")
      .def_property_readonly("title", &get<&DistilledLaw::title, DistilledLaw>, "Of the wire file.")
      .def_property_readonly(
          "span", [](const ThisLaw& law) { return law->loading->span(); }, "Distance of the mounts [m].")
      .def_property_readonly("travel", &interval<&DistilledLaw::travel>, "(from, to), the range of d [m].")
      .def_property_readonly(
          "position", &interval<&DistilledLaw::position>,
          "(from, to), the range of s [m]; the mirror image belongs to it where mounts are alike.")
      .def_property_readonly("slack", &interval<&DistilledLaw::slack>,
                             "(from, to), the range of the slack [m].")
      .def_property_readonly("nominal_slack", &get<&DistilledLaw::nominal_slack, DistilledLaw>,
                             "Length less span of the wire file [m].")
      .def_property_readonly("bound", &get<&DistilledLaw::bound, DistilledLaw>,
                             "Stated largest error of the table [N].")
      .def_property_readonly("force_range", &get<&DistilledLaw::force_range, DistilledLaw>,
                             "Range of the full wire's force [N].")
      .def_property_readonly(
          "dissipates", [](const ThisLaw& law) { return law->unloading != nullptr; },
          "Whether the way back has a force of its own.")
      .def_property_readonly("simple", &get<&DistilledLaw::simple, DistilledLaw>,
                             "The simple laws, a list of SimpleLaw.")
      .def("__reduce__",
           [](const ThisLaw& law) {
             return py::make_tuple(py::module_::import("snare._laws").attr("law"),
                                   py::make_tuple(state_of(*law)));
           })
      .def("__repr__", [](const ThisLaw& law) {
        return fmt::format(
            "<snare.Law '{}': travel {:.4g} to {:.4g} m, position {:.4g} to {:.4g} m, slack {:.4g} to {:.4g} "
            "m, "
            "within {:.3g} N>",
            law->title, law->travel[0], law->travel[1], law->position[0], law->position[1], law->slack[0],
            law->slack[1], law->bound);
      });
}

}  // namespace

void add_laws(py::module_& module) {
  const py::object warning = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(
      "snare.OutsideRange", "A force was asked outside the range of a law and was continued linearly.",
      PyExc_UserWarning, nullptr));
  module.attr("OutsideRange") = warning;
  add_simple_law(module);
  add_law(module);
  module.def("_simple_law_of", &simple_law_of, py::arg("state"), "The SimpleLaw that pickle kept.");
  module.def("_law_of", &distilled_law_of, py::arg("state"), "The Law that pickle kept.");
}

}  // namespace snare::python
