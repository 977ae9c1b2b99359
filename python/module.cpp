// The extension module snare._core: what the package in python/snare/ stands on.
#include "base/errors.hpp"
#include "python/law.hpp"
#include "python/verbs.hpp"
#include "python/work.hpp"
#include "results/version.hpp"

#include <pybind11/pybind11.h>

#include <exception>

namespace py = pybind11;

namespace {

/// snare.InputError with `problems`: dictionaries of file, line, key, value, requirement.
void raise_input_error(const py::object& type, const snare::base::InputError& error) {
  py::list problems;
  for (const snare::base::InputProblem& p : error.problems()) {
    py::dict one;
    one["file"] = p.file;
    one["line"] = p.line;
    one["key"] = p.key;
    one["value"] = p.value;
    one["requirement"] = p.requirement;
    problems.append(one);
  }
  const py::object raised = type(error.what());
  raised.attr("problems") = problems;
  PyErr_SetObject(type.ptr(), raised.ptr());
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of snare; use the package `snare`.";
  module.attr("__version__") = snare::results::version();

  static py::exception<snare::base::InputError> input_error(module, "InputError", PyExc_ValueError);
  input_error.attr("__module__") = "snare";
  input_error.doc() =
      "A file or an override is wrong. The message has a line a problem; `problems` has them as dictionaries "
      "of\n"
      "file, line, key, value and requirement.";
  // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 asks for this signature
  py::register_exception_translator([](std::exception_ptr raised) {
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const snare::base::InputError& error) {
      raise_input_error(input_error, error);
    }
  });

  snare::python::add_laws(module);
  snare::python::add_verbs(module);
  py::module_::import("atexit").attr("register")(py::cpp_function(&snare::python::end_work));
}
