#include <base/errors.hpp>
#include <wire/specification.hpp>

#include <iostream>

/// Uses a function of the installed libraries and a header of another module; 0 when both are as documented.
int main() {
  snare::wire::WireSpecification wire;
  wire.diameter = -1.5e-3;
  const snare::base::InputProblem problem{
      .file = "wire.toml", .line = 3, .key = "wire.diameter_mm", .value = "-1.5", .requirement = "must be > 0"};
  std::cout << problem.message() << '\n';
  return wire.diameter < 0.0 && problem.message() == "wire.toml:3: wire.diameter_mm = -1.5, must be > 0" ? 0 : 1;
}
