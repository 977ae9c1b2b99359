#pragma once

#include "tests/app/command_fixture.hpp"
#include "tests/support/wire_text.hpp"

#include <filesystem>
#include <string>

namespace snare::app {

/// A folder with one.toml, a push of two points, and sweep.toml, 60 of them with other lengths and diameters.
class SmallSweep : public CommandFixture {
 protected:
  inline static const std::string push =
      "schema = \"snare-experiment/1\"\ntitle = \"push\"\nsource = \"a test\"\n" +
      test::wire_tables("180.0") + R"([[series]]
name = "middle"
contact_position_mm = 87.5
travel_mm = 0.5
points = 2
[solver]
elements = 16
)";

  /// `shortest_mm`: of the wires, 175 mm are those between the mounts; `sigma_mm`: of the diameters about 1.5
  /// mm; `more`: tables after [collect].
  SmallSweep(const std::string& shortest_mm, const std::string& sigma_mm, const std::string& more)
      : sweep(R"(schema = "snare-sweep/1"
title = "pushes"
case = "one.toml"
design = "latin_hypercube"
cases = 60
[[vary]]
key = "wire.length_mm"
uniform = [)" +
              shortest_mm +
              R"(, 181.0]
[[vary]]
key = "wire.diameter_mm"
normal = { mean = 1.5, sigma = )" +
              sigma_mm + R"( }
[collect]
force = "series[middle].largest_force_N"
)" + more) {
    write("one.toml", push);
    write("sweep.toml", sweep);
  }
  [[nodiscard]] bool exists(const std::string& file) const { return std::filesystem::exists(path(file)); }

  const std::string sweep;
};

}  // namespace snare::app
