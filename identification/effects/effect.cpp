#include "identification/effects/effect.hpp"

#include "identification/fitting/legs.hpp"

#include <cmath>
#include <cstddef>

namespace snare::identification {

std::string to_string(Channel channel) {
  static constexpr const char* names[] = {"wire", "mount", "contact", "pusher", "sensor", "geometry"};
  return names[static_cast<std::size_t>(channel)];
}

std::string needs_mounts(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.test.mount.kind != wire::MountKind::supports) return "";
  }
  return "a wire that rests on supports is not held by mounts";
}

double compliance(const std::optional<double>& stiffness) {
  return stiffness ? 1.0 / *stiffness : 0.0;
}

void set_compliance(std::optional<double>& stiffness, double value) {
  // 1e-11 m/N moves a mount by 10 nm under 1 kN: rigid, and a stiffer spring would only spoil the equations.
  if (std::abs(value) < 1e-11)
    stiffness.reset();
  else
    stiffness = 1.0 / value;
}

std::string needs_times(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.readings && !s.readings->time.empty()) return "";
  }
  return "the record has no times";
}

std::string needs_unloading(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.readings && s.readings->displacement.size() > 1 && legs_of(s.readings->displacement).size() > 1)
      return "";
  }
  return "no record turns back";
}

std::string needs_readings(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.readings) return "";
  }
  return "there are published fits only, no readings";
}

}  // namespace snare::identification
