#pragma once

#include "python/gil.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace snare::python {

using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;
using Mask = pybind11::array_t<bool, pybind11::array::c_style | pybind11::array::forcecast>;

/// A number or an array of real numbers, and what of a masked array is masked.
struct Given {
  Numbers numbers;
  Mask mask;            ///< of the shape of the numbers, where `masked`
  bool masked = false;  ///< it was a masked array of NumPy
};

/// What was given as the argument `name`. NumPy would also read texts, times and the real parts of complex
/// numbers: a TypeError here.
[[nodiscard]] Given numbers_of(const pybind11::object& given, const char* name);

/// Arrays of one shape, or single numbers beside them: what a loop may step through.
template <std::size_t count>
class Broadcast {
 public:
  explicit Broadcast(std::array<Given, count> given) {
    for (std::size_t k = 0; k < count; ++k) {
      masked_ = masked_ || given[k].masked;
      arrays_[k] = given[k].numbers;
    }
    const Numbers* shaped = nullptr;
    bool plain = true;
    for (const Numbers& one : arrays_) {
      if (one.ndim() == 0) continue;
      if (shaped != nullptr) plain = plain && same_shape(one, *shaped);
      shaped = &one;
    }
    if (!plain) {  // NumPy's own rules, at the cost of copies
      const pybind11::object all = numpy().attr("broadcast_arrays")(*pybind11::cast(arrays_));
      const pybind11::sequence broadcast(all);
      for (std::size_t k = 0; k < count; ++k) arrays_[k] = Numbers(pybind11::object(broadcast[k]));
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
    if (masked_) join_masks(given);
  }

  /// Calls function(numbers...) for every point without the GIL. A number where all are; a masked array where
  /// one is, with the points masked that are masked in any argument, for which nothing is called.
  template <class Result, class Function>
  [[nodiscard]] pybind11::object map(const Function& function) const {
    pybind11::array_t<Result> result(shape_);
    Result* out = result.mutable_data();
    const bool* hidden = masked_ ? mask_.data() : nullptr;
    {
      const WithoutGil released;
      for (std::size_t i = 0; i < size_; ++i) {
        if (hidden != nullptr && hidden[i]) {
          out[i] = Result();
          continue;
        }
        std::array<double, count> x;
        for (std::size_t k = 0; k < count; ++k) x[k] = data_[k][step_[k] * i];
        try {
          out[i] = std::apply(function, x);
          if constexpr (std::is_floating_point_v<Result>) {
            if (!std::isfinite(out[i]))
              throw std::domain_error(
                  fmt::format("at {}: the result is beyond all numbers", fmt::join(x, ", ")));
          }
        } catch (const std::domain_error& error) {
          if (shape_.empty()) throw;
          throw std::domain_error(fmt::format("point {}: {}", i, error.what()));
        }
      }
    }
    const pybind11::object ma = masked_ ? pybind11::object(numpy().attr("ma")) : pybind11::none();
    if (shape_.empty())
      return masked_ && mask_.data()[0] ? pybind11::object(ma.attr("masked")) : result.attr("item")();
    return masked_ ? ma.attr("array")(result, pybind11::arg("mask") = mask_) : pybind11::object(result);
  }

 private:
  static pybind11::module_ numpy() { return pybind11::module_::import("numpy"); }
  static bool same_shape(const Numbers& a, const Numbers& b) {
    return a.ndim() == b.ndim() && std::equal(a.shape(), a.shape() + a.ndim(), b.shape());
  }
  void join_masks(const std::array<Given, count>& given) {
    mask_ = Mask(shape_);
    std::fill_n(mask_.mutable_data(), size_, false);
    for (const Given& one : given) {
      if (!one.masked) continue;
      const Mask whole(numpy().attr("broadcast_to")(one.mask, pybind11::cast(shape_)));
      std::transform(mask_.data(), mask_.data() + size_, whole.data(), mask_.mutable_data(),
                     [](bool a, bool b) { return a || b; });
    }
  }

  std::array<Numbers, count> arrays_;
  std::array<const double*, count> data_{};
  std::array<std::size_t, count> step_{};
  std::vector<pybind11::ssize_t> shape_;
  std::size_t size_ = 1;
  bool masked_ = false;
  Mask mask_;
};

}  // namespace snare::python
