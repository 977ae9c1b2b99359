#pragma once

#include <pybind11/pybind11.h>

namespace snare::python {

/// The verbs: what the command of the same name writes, as dictionaries and columns.
void add_verbs(pybind11::module_& module);

}  // namespace snare::python
