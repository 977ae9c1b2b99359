#pragma once

#include "results/watch.hpp"

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>

namespace snare::python {

/// Does long work while Python stays responsive.
///
/// The work runs in a thread of its own without the GIL; the calling thread looks at it every `glance_s`,
/// tells `progress` (a callable of one text, or None) what is under way, and asks Python whether an interrupt
/// has come. Then, and where `progress` raises, the work is told to stop and is waited for `patience_s`; work
/// that has not come to a point where it looks by then is left to end by itself, and the interrupt is raised
/// at once. What the work reads must therefore belong to it.
/// threads: of the work, 0: one a processor. Exceptions of the work are thrown here.
void do_work(const std::function<void(const results::Watch&)>& work, int threads,
             const pybind11::object& progress);

inline constexpr double glance_s = 0.05;
inline constexpr double patience_s = 0.6;

/// Ends the work of daemon threads and waits for what was left, some seconds at most: before the interpreter
/// takes down what they use.
void end_work();

/// The result of `make`, done as work. `make` is copied into the work, and must hold all that it reads.
template <class Make>
auto made(const Make& make, int threads, const pybind11::object& progress) {
  using Result = decltype(make(results::Watch()));
  const auto result = std::make_shared<std::unique_ptr<Result>>();
  do_work([make, result](const results::Watch& watch) { *result = std::make_unique<Result>(make(watch)); },
          threads, progress);
  return std::move(*result);
}

}  // namespace snare::python
