#pragma once

#include <string>

namespace snare::identification {

/// An experiment file without a fault; tests spoil one passage at a time. The number of each line stands
/// behind it.
inline const std::string valid_experiment =
    "schema = \"snare-experiment/1\"\n"                                                      // 1
    "title = \"a loose wire\"\n"                                                             // 2
    "\n"                                                                                     // 3
    "[wire]\n"                                                                               // 4
    "construction = \"solid\"\n"                                                             // 5
    "diameter_mm = 1.5\n"                                                                    // 6
    "length_mm = 180.0\n"                                                                    // 7
    "youngs_modulus_GPa = 193.0\n"                                                           // 8
    "poisson_ratio = 0.29\n"                                                                 // 9
    "density_kg_m3 = 7930.0\n"                                                               // 10
    "\n"                                                                                     // 11
    "[mount]\n"                                                                              // 12
    "kind = \"clamped\"\n"                                                                   // 13
    "span_mm = 175.0\n"                                                                      // 14
    "\n"                                                                                     // 15
    "[pusher]\n"                                                                             // 16
    "shape = \"cylinder\"\n"                                                                 // 17
    "radius_mm = 6.0\n"                                                                      // 18
    "friction = 0.0\n"                                                                       // 19
    "direction = \"outward\"\n"                                                              // 20
    "\n"                                                                                     // 21
    "[[series]]\n"                                                                           // 22
    "name = \"s40\"\n"                                                                       // 23
    "contact_position_mm = 40.0\n"                                                           // 24
    "travel_mm = 2.0\n"                                                                      // 25
    "points = 21\n"                                                                          // 26
    "\n"                                                                                     // 27
    "[[series]]\n"                                                                           // 28
    "name = \"s65\"\n"                                                                       // 29
    "contact_position_mm = 65.0\n"                                                           // 30
    "law = { A_N_m2 = 878089.0, B_N_m = -1086.0, C_N = 0.2115, R2 = 0.998, to_mm = 4.0 }\n"  // 31
    "\n"                                                                                     // 32
    "[fit]\n"                                                                                // 33
    "free = [\"wire.length_mm\", \"reading.force_gain\"]\n"                                  // 34
    "heldout = [\"s65\"]\n";                                                                 // 35

/// The valid file with one passage replaced.
inline std::string edited(const std::string& from, const std::string& to) {
  std::string text = valid_experiment;
  return text.replace(text.find(from), from.size(), to);  // throws when `from` is not there
}

}  // namespace snare::identification
