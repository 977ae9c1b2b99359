#pragma once

#include <Python.h>

namespace snare::python {

/// Work without the GIL, for as long as it lives. Unlike pybind11's guard it survives the end of the
/// interpreter: a daemon thread that wants to come back while the interpreter closes is held until the
/// process ends, where CPython would unwind it through C++ and abort.
class WithoutGil {
 public:
  WithoutGil();
  ~WithoutGil() noexcept(false);
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
};

/// The GIL again, within WithoutGil.
class WithGil {
 public:
  WithGil();
  ~WithGil() noexcept(false);
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Whether the interpreter is closing, in other threads than the one that closes it.
[[nodiscard]] bool closing() noexcept;

/// For atexit, with the GIL: waits until every thread without the GIL is held, `patience_s` [s] at most.
void close_work(double patience_s);

}  // namespace snare::python
