#include "python/law_numbers.hpp"

#include <string>
#include <string_view>

namespace snare::python {

namespace py = pybind11;

Given numbers_of(const py::object& given, const char* name) {
  const py::array any(given);  // raises what NumPy has to say: of rows that are not of one length, of memory
  const char kind = any.dtype().kind();
  if (std::string_view("fiubO").find(kind) == std::string_view::npos) {
    throw py::type_error(fmt::format("{} = {}, must be a number or an array of real numbers", name,
                                     std::string(py::repr(given))));
  }
  if (PyFloat_Check(given.ptr()) || PyLong_Check(given.ptr())) return {Numbers(any), {}, false};
  const py::object ma = py::module_::import("numpy").attr("ma");
  if (!py::isinstance(given, ma.attr("MaskedArray"))) return {Numbers(any), {}, false};
  // What stands behind a mask may be no number.
  return {Numbers(py::object(ma.attr("filled")(given, 0.0))),
          Mask(py::object(ma.attr("getmaskarray")(given))), true};
}

}  // namespace snare::python
