#pragma once

#include "app/console.hpp"

#include <string>

namespace snare::app {

/// A commented starting set of files that run, in options.out: "capture", "experiment" or "wire". Throws
/// base::InputError for another name, and where a file is there already; then nothing is written.
[[nodiscard]] ExitStatus run_new(const std::string& what, const CommonOptions& options, Console& console);

}  // namespace snare::app
