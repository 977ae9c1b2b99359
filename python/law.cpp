#include "python/law.hpp"

#include "python/convert.hpp"
#include "scenario/distilled_law.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace snare::python {

namespace py = pybind11;

namespace {

using coupling::ForceTable;
using coupling::Outside;
using scenario::DistilledLaw;
using scenario::SimpleLaw;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A number or an array of real numbers, as the argument `name`. NumPy would also read texts, times and the real parts of complex numbers.
Numbers numbers(const py::object& given, const char* name) {
  const py::array any(given);  // raises what NumPy has to say: of rows that are not of one length, of memory
  const char kind = any.dtype().kind();
  if (std::string_view("fiubO").find(kind) == std::string_view::npos) {
    throw py::type_error(
        fmt::format("{} = {}, must be a number or an array of real numbers", name, std::string(py::repr(given))));
  }
  return Numbers(any);
}

/// Arrays of one shape, or single numbers beside them: what a loop may step through.
template <std::size_t count>
class Broadcast {
 public:
  explicit Broadcast(std::array<Numbers, count> given) : arrays_(std::move(given)) {
    const Numbers* shaped = nullptr;
    bool plain = true;
    for (const Numbers& one : arrays_) {
      if (one.ndim() == 0) continue;
      if (shaped != nullptr) plain = plain && same_shape(one, *shaped);
      shaped = &one;
    }
    if (!plain) {  // NumPy's own rules, at the cost of copies
      const py::object all = py::module_::import("numpy").attr("broadcast_arrays")(*py::cast(arrays_));
      const py::sequence broadcast(all);
      for (std::size_t k = 0; k < count; ++k) arrays_[k] = Numbers(py::object(broadcast[k]));
      shaped = arrays_.data();
    }
    if (shaped != nullptr) {
      shape_.assign(shaped->shape(), shaped->shape() + shaped->ndim());
      size_ = static_cast<std::size_t>(shaped->size());
    }
    for (std::size_t k = 0; k < count; ++k) {
      data_[k] = arrays_[k].data();
      step_[k] = arrays_[k].ndim() == 0 ? 0 : 1;
    }
  }

  /// Calls function(result, numbers...) for every point without the GIL. A number where all are.
  template <class Result, class Function>
  [[nodiscard]] py::object map(const Function& function) const {
    py::array_t<Result> result(shape_);
    Result* out = result.mutable_data();
    {
      const py::gil_scoped_release release;
      for (std::size_t i = 0; i < size_; ++i) {
        std::array<double, count> x;
        for (std::size_t k = 0; k < count; ++k) x[k] = data_[k][step_[k] * i];
        try {
          out[i] = std::apply(function, x);
          if constexpr (std::is_floating_point_v<Result>) {
            if (!std::isfinite(out[i]))
              throw std::domain_error(fmt::format("at {}: the result is beyond all numbers", fmt::join(x, ", ")));
          }
        } catch (const std::domain_error& error) {
          if (shape_.empty()) throw;
          throw std::domain_error(fmt::format("point {}: {}", i, error.what()));
        }
      }
    }
    if (shape_.empty()) return result.attr("item")();
    return result;
  }

 private:
  static bool same_shape(const Numbers& a, const Numbers& b) {
    return a.ndim() == b.ndim() && std::equal(a.shape(), a.shape() + a.ndim(), b.shape());
  }

  std::array<Numbers, count> arrays_;
  std::array<const double*, count> data_{};
  std::array<std::size_t, count> step_{};
  std::vector<py::ssize_t> shape_;
  std::size_t size_ = 1;
};

Numbers slack_or_nominal(const DistilledLaw& law, const py::object& slack) {
  return slack.is_none() ? Numbers(py::float_(law.nominal_slack)) : numbers(slack, "slack");
}

Broadcast<3> points(const DistilledLaw& law, const py::object& d, const py::object& s, const py::object& slack) {
  return Broadcast<3>({numbers(d, "d"), numbers(s, "s"), slack_or_nominal(law, slack)});
}

Outside outside_of(const std::string& word) {
  if (word == "refuse") return Outside::refuse;
  if (word == "extrapolate") return Outside::extrapolate;
  throw std::invalid_argument("outside = '" + word + "', must be 'refuse' or 'extrapolate'");
}

const ForceTable& table_of(const DistilledLaw& law, bool unloading) {
  if (!unloading) return *law.loading;
  if (!law.unloading)
    throw std::invalid_argument("unloading = True: nothing dissipates in this wire, see `dissipates`");
  return *law.unloading;
}

py::object force(const DistilledLaw& law, const py::object& d, const py::object& s, const py::object& slack,
                 const std::string& outside, bool unloading) {
  const ForceTable& table = table_of(law, unloading);
  const Outside what = outside_of(outside);
  return points(law, d, s, slack).map<double>([&](double x, double y, double z) {
    return law.force(table, x, y, z, what);
  });
}

py::object stiffness(const DistilledLaw& law, const py::object& d, const py::object& s, const py::object& slack,
                     const std::string& outside, bool unloading) {
  const ForceTable& table = table_of(law, unloading);
  const Outside what = outside_of(outside);
  return points(law, d, s, slack).map<double>([&](double x, double y, double z) {
    return law.stiffness(table, x, y, z, what);
  });
}

py::object in_range(const DistilledLaw& law, const py::object& d, const py::object& s, const py::object& slack) {
  return points(law, d, s, slack).map<bool>([&](double x, double y, double z) { return law.in_range(x, y, z); });
}

template <double (coupling::SpringLaw::*number)(double) const>
py::object of_travel(const SimpleLaw& one, const py::object& d) {
  return Broadcast<1>({numbers(d, "d")}).map<double>([&](double x) {
    if (!std::isfinite(x)) throw std::domain_error(fmt::format("travel {} m: must be finite", x));
    return x < 0.0 ? 0.0 : ((*one.law).*number)(x);
  });
}

py::dict parameters_of(const SimpleLaw& one) {
  py::dict all;
  for (std::size_t k = 0; k < one.values.size(); ++k)
    all[py::str(one.parameters[k].name)] = py::make_tuple(one.values[k], one.parameters[k].unit);
  return all;
}

DistilledLaw from_file(const std::filesystem::path& file, std::size_t number) {
  const std::vector<DistilledLaw> laws = scenario::read_law_file(file);
  if (number >= laws.size())
    throw py::index_error(
        fmt::format("case = {}: {} has {} cases, counted from 0", number, file.string(), laws.size()));
  return laws[number];
}

}  // namespace

py::list laws_of(const nlohmann::json& document) {
  py::list laws;
  for (DistilledLaw& law : scenario::read_laws("law.json", document)) laws.append(py::cast(std::move(law)));
  return laws;
}

void add_laws(py::module_& module) {
  py::class_<SimpleLaw>(
      module, "SimpleLaw",
      "A law of a few numbers, fitted to the full wire at one position. Force, stiffness and energy are\n"
      "functions of the travel d [m]: a number or an array of any shape. Without contact (d < 0) they are 0.")
      .def_readonly("position", &SimpleLaw::position, "s, of the pusher along the chord from the left mount [m].")
      .def_readonly("name", &SimpleLaw::name, "As in law.json: 'quadratic', 'power_law', ...")
      .def_readonly("formula", &SimpleLaw::formula, "The law, for people.")
      .def_property_readonly("parameters", &parameters_of, "By name: (value, unit), in SI units.")
      .def_readonly("travel", &SimpleLaw::travel, "[from, to], the travels at which it was fitted [m].")
      .def_readonly("largest_error", &SimpleLaw::largest_error, "Against the full wire over these travels [N].")
      .def("force", &of_travel<&coupling::SpringLaw::force>, py::arg("d"), "Force [N] at the travel d [m].")
      .def("stiffness", &of_travel<&coupling::SpringLaw::stiffness>, py::arg("d"), "dF/dd [N/m] at the travel d [m].")
      .def("energy", &of_travel<&coupling::SpringLaw::energy>, py::arg("d"),
           "Integral of the force from 0 to the travel d [m], in J.")
      .def("__repr__", [](const SimpleLaw& one) {
        return fmt::format("<snare.SimpleLaw {} at {:.6g} m: {}>", one.name, one.position, one.formula);
      });

  const auto interval = [](const std::array<double, 2>& range) { return py::make_tuple(range[0], range[1]); };
  py::class_<DistilledLaw>(
      module, "Law",
      "The force of one wire as a table over travel, position and slack, with the simple laws fitted to it.\n\n"
      "Law(file, case=0) reads a law.json; `distil` returns laws, too. Lengths are in m, forces in N.")
      .def(py::init(&from_file), py::arg("file"), py::arg("case") = 0)
      .def(
          "force", &force, py::arg("d"), py::arg("s"), py::arg("slack") = py::none(), py::kw_only(),
          py::arg("outside") = "refuse", py::arg("unloading") = false,
          "Force [N] on the pusher at travel d [m] from first touch, position s [m] along the chord from the left "
          "mount, and\n"
          "slack [m], length less span (None: the nominal one).\n\n"
          "Numbers or arrays; shapes are broadcast as NumPy does, and the result has theirs. Negative travel is no "
          "contact: 0.\n"
          "outside: 'refuse' raises ValueError for a point outside the table's range, 'extrapolate' goes on linearly.\n"
          "unloading: on the way back from the end of the travel, where something dissipates.")
      .def("stiffness", &stiffness, py::arg("d"), py::arg("s"), py::arg("slack") = py::none(), py::kw_only(),
           py::arg("outside") = "refuse", py::arg("unloading") = false, "dF/dd [N/m], arguments as of `force`.")
      .def("in_range", &in_range, py::arg("d"), py::arg("s"), py::arg("slack") = py::none(),
           "Whether the table has these points; arguments as of `force`.")
      .def_readonly("title", &DistilledLaw::title, "Of the wire file.")
      .def_property_readonly(
          "span", [](const DistilledLaw& law) { return law.loading->span(); }, "Distance of the mounts [m].")
      .def_property_readonly(
          "travel", [interval](const DistilledLaw& law) { return interval(law.travel); },
          "(from, to), the range of d [m].")
      .def_property_readonly(
          "position", [interval](const DistilledLaw& law) { return interval(law.position); },
          "(from, to), the range of s [m]; the mirror image belongs to it where mounts are alike.")
      .def_property_readonly(
          "slack", [interval](const DistilledLaw& law) { return interval(law.slack); },
          "(from, to), the range of the slack [m].")
      .def_readonly("nominal_slack", &DistilledLaw::nominal_slack, "Length less span of the wire file [m].")
      .def_readonly("bound", &DistilledLaw::bound, "Stated largest error of the table [N].")
      .def_readonly("force_range", &DistilledLaw::force_range, "Range of the full wire's force [N].")
      .def_property_readonly(
          "dissipates", [](const DistilledLaw& law) { return law.unloading != nullptr; },
          "Whether the way back has a force of its own.")
      .def_readonly("simple", &DistilledLaw::simple, "The simple laws, a list of SimpleLaw.")
      .def("__repr__", [](const DistilledLaw& law) {
        return fmt::format(
            "<snare.Law '{}': travel {:.4g} to {:.4g} m, position {:.4g} to {:.4g} m, slack {:.4g} to {:.4g} m, "
            "within {:.3g} N>",
            law.title, law.travel[0], law.travel[1], law.position[0], law.position[1], law.slack[0], law.slack[1],
            law.bound);
      });
}

}  // namespace snare::python
