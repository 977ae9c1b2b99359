#pragma once

#include "app/report/reproduce_result.hpp"

#include <string>

namespace snare::app {

/// Returns traced.toml: wire, mounts and pusher of the leading explanation of published fits, else of the
/// final model of the tracing, as a `snare-wire/1` file (docs/wire_file.md); empty where there is neither.
/// Comments state the experiment, the verdict, the command and every fitted number, of a tracing with its
/// standard error; title and comments say so where no model is accepted.
///
/// The wire is that of the first series. Simple laws are asked at the places of the series (the first 32
/// different ones), with the fitted zeros of the travel where all of them lie inside it; an outward push is
/// asked to the largest displacement of the tests.
///
/// command: as it would be typed.
[[nodiscard]] std::string traced_wire_toml(const Reproduction& result, const std::string& command);

}  // namespace snare::app
