#include "identification/ring_down/mode_match.hpp"

#include "coupling/dynamics/model/modes.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "wire/motion/rod_in_motion.hpp"
#include "wire/motion/rod_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>

namespace snare::identification {

namespace {

/// A mode of the declared wire.
struct WireMode {
  wire::RodMode mode;
  std::optional<double> mesh_error;  // of its frequency [Hz]
};

std::vector<wire::RodMode> modes_on_mesh(const coupling::PushProblem& test, int elements, int count) {
  wire::RodInMotion rod = wire::rod_in_motion(test.wire, test.mount.span, elements);
  rod.properties.left.kind = rod.properties.right.kind = test.mount.kind == wire::MountKind::clamped
                                                             ? wire::SpatialEnd::Kind::clamp
                                                             : wire::SpatialEnd::Kind::twisting_pin;
  return wire::rod_modes(rod, coupling::resting_wire(rod), count);
}

/// In the form in which meshes are compared.
coupling::SmallMotions small_motions_of(const std::vector<wire::RodMode>& modes) {
  coupling::SmallMotions small;
  for (const wire::RodMode& m : modes) {
    coupling::MotionMode& one = small.modes.emplace_back();
    one.frequency = 0.5 / std::numbers::pi * m.natural;
    one.shape.wires = {m.shape.cast<std::complex<double>>()};
  }
  return small;
}

/// Modes of the declared wire at rest, some more than a record can show, each with the error of its mesh.
std::vector<WireMode> modes_of(const coupling::PushProblem& test) {
  constexpr int elements = 60;
  constexpr int count = 24;
  const std::vector<wire::RodMode> modes = modes_on_mesh(test, elements, count);
  coupling::SmallMotions fine = small_motions_of(modes);
  add_mesh_errors(fine, small_motions_of(modes_on_mesh(test, elements / 2, count)));
  std::vector<WireMode> result;
  for (std::size_t k = 0; k < modes.size(); ++k) result.push_back({modes[k], fine.modes[k].mesh_error});
  return result;
}

}  // namespace

std::vector<MatchedMode> match_modes(const RingDownFile& file, const std::vector<RingDownFit>& fits) {
  std::vector<WireMode> computed;
  if (file.wire) computed = modes_of(*file.wire);
  std::vector<MatchedMode> modes;
  for (std::size_t s = 0; s < fits.size(); ++s) {
    if (!fits[s].report.usable()) continue;
    for (std::size_t m = 0; m < fits[s].modes.size(); ++m) {
      const RingDownMode& mode = fits[s].modes[m];
      if (!mode.significant()) continue;
      MatchedMode match;
      match.series = s;
      match.mode = m;
      match.decay = {mode.natural(), 1.0, mode.decay};
      match.covariance = fits[s].decay_covariance.row(static_cast<Eigen::Index>(m));
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& [candidate, mesh_error] : computed) {
        const double distance = std::abs(std::log(candidate.natural / mode.natural()));
        if (distance >= nearest) continue;
        nearest = distance;
        match.computed = candidate.natural;
        match.computed_error = mesh_error;
        match.decay.bending_share = candidate.bending_share + candidate.axial_share;
      }
      const std::vector<double>& given = file.series[s].bending_share;
      if (!given.empty()) match.decay.bending_share = m < given.size() ? given[m] : 1.0;
      modes.push_back(match);
    }
  }
  return modes;
}

DampingSplit split_damping(const std::vector<MatchedMode>& modes) {
  constexpr double far_off = 1.2;
  std::vector<DecayOfMode> decays;
  const auto n = static_cast<Eigen::Index>(modes.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    decays.push_back(modes[i].decay);
    for (std::size_t k = 0; k < modes.size(); ++k) {
      if (modes[i].series == modes[k].series)
        covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
            modes[i].covariance[static_cast<Eigen::Index>(modes[k].mode)];
    }
  }
  DampingSplit split = split_damping(decays, covariance);
  for (const MatchedMode& m : modes) {
    if (m.computed == 0.0 || std::max(m.computed / m.decay.natural, m.decay.natural / m.computed) < far_off)
      continue;
    split.warnings.push_back(
        fmt::format("{:.4g} Hz is no mode of the declared wire, the nearest has {:.4g} Hz",
                    0.5 / std::numbers::pi * m.decay.natural, 0.5 / std::numbers::pi * m.computed));
    split.statement += "; " + split.warnings.back();
  }
  return split;
}

}  // namespace snare::identification
