#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Times by which the wires' material is damped, along the wire and in bending: (W.14).
std::vector<RecordEffect> wire_damping_effects(const RecordModel& model) {
  if (model.declared().names("wires").empty() && model.declared().names("snares").empty()) return {};
  constexpr double usual = 1e-5;               // [s], where the file says nothing
  constexpr double least = 0.05, most = 20.0;  // of what is declared, which is hardly ever known
  std::vector<RecordEffect> effects;
  for (const char* place : {"axial", "bending"}) {
    const std::string key = std::string("damping.") + place + "_time_s";
    const double declared = model.declared().number(key).value_or(usual);
    if (!(declared > 0.0)) continue;
    RecordNumber number = number_at(key, declared, 0.1 * declared);
    number.lower = 0.01 * declared;
    number.upper = 100.0 * declared;
    effects.push_back({.name = "wire_damping",
                       .place = place,
                       .channel = "wire",
                       .meaning = "the wire's material takes more or less energy",
                       .numbers = {number},
                       .plausible_lower = least * declared,
                       .plausible_upper = most * declared,
                       .independent_check = "pluck the wire and let it ring down"});
  }
  return effects;
}

}  // namespace snare::identification
