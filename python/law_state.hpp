#pragma once

#include "scenario/distilled_law.hpp"

#include <pybind11/pybind11.h>

namespace snare::python {

// What pickle keeps of a law: plain Python objects, all numbers to the last bit.

[[nodiscard]] pybind11::tuple state_of(const scenario::SimpleLaw& law);
[[nodiscard]] pybind11::tuple state_of(const scenario::DistilledLaw& law);

/// The law that has this state. Throws pybind11::value_error for what is none.
[[nodiscard]] scenario::SimpleLaw simple_law_of(const pybind11::tuple& state);
[[nodiscard]] scenario::DistilledLaw distilled_law_of(const pybind11::tuple& state);

}  // namespace snare::python
