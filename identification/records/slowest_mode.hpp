#pragma once

#include "coupling/dynamics/model/model.hpp"

#include <optional>
#include <string>

namespace snare::identification {

/// An oscillation for which a motion has a spring.
struct SlowMode {
  std::string of;       ///< "arm a", "bushing gf, turning"
  double period = 0.0;  ///< [s]
};

/// The slowest of them, about the start and without damping: of every arm by itself, 1/f of its lowest mode
/// with f > 0, and of the carriers of every bushing, 2 pi sqrt(m/k) with the reduced mass m and 2 pi
/// sqrt(J/k) with the largest moment of inertia about the bushing, reduced likewise; arms and the world do
/// not give way there. Weight, contacts and wires are no springs here: a pendulum's swing is not among them.
[[nodiscard]] std::optional<SlowMode> slowest_mode(const coupling::Motion& motion);

}  // namespace snare::identification
