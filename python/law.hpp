#pragma once

#include <pybind11/pybind11.h>
#include <nlohmann/json_fwd.hpp>

namespace snare::python {

/// The laws of a document as law.json has it, one a case, as a Python list.
[[nodiscard]] pybind11::list laws_of(const nlohmann::json& document);

/// The classes Law and SimpleLaw.
void add_laws(pybind11::module_& module);

}  // namespace snare::python
