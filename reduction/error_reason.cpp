#include "reduction/error_reason.hpp"

#include "base/units.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>

namespace snare::reduction {

namespace {

using Eigen::VectorXd;

constexpr double worth_a_word = 0.05;  // of the wire's range of force
constexpr double most_left = 1.0 / 3.0;

double rms(const VectorXd& v) {
  return v.norm() / std::sqrt(static_cast<double>(std::max<Eigen::Index>(1, v.size())));
}

/// The way out: up to the largest travel.
struct Way {
  VectorXd travel, wire, model;
};

Way way_out(const std::vector<double>& travel, const std::vector<double>& wire,
            const std::vector<double>& model) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < travel.size(); ++i) {
    if (chosen.empty() || travel[i] > travel[chosen.back()]) chosen.push_back(i);
  }
  Way way;
  for (VectorXd* v : {&way.travel, &way.wire, &way.model})
    v->resize(static_cast<Eigen::Index>(chosen.size()));
  for (Eigen::Index k = 0; k < way.travel.size(); ++k) {
    const std::size_t i = chosen[static_cast<std::size_t>(k)];
    way.travel[k] = travel[i];
    way.wire[k] = wire[i];
    way.model[k] = model[i];
  }
  return way;
}

/// The model at another travel, straight between and beyond its points.
double model_at(const Way& way, double d) {
  const Eigen::Index n = way.travel.size();
  const auto after = std::upper_bound(way.travel.data(), way.travel.data() + n, d) - way.travel.data();
  const Eigen::Index high = std::clamp<Eigen::Index>(after, 1, n - 1);
  const double share = (d - way.travel[high - 1]) / (way.travel[high] - way.travel[high - 1]);
  return way.model[high - 1] + share * (way.model[high] - way.model[high - 1]);
}

/// Where the model is less off when it is moved along the travel: by how much [m], and what is left.
std::pair<double, double> best_shift(const Way& way) {
  constexpr int tried = 200;
  const double length = way.travel.tail<1>()[0] - way.travel[0];
  std::pair<double, double> best{0.0, rms(way.model - way.wire)};
  for (int k = -tried; k <= tried; ++k) {
    const double shift = 0.5 * length * k / tried;
    VectorXd off(way.travel.size());
    for (Eigen::Index i = 0; i < off.size(); ++i) off[i] = model_at(way, way.travel[i] + shift) - way.wire[i];
    if (const double left = rms(off); left < best.second) best = {shift, left};
  }
  return best;
}

}  // namespace

std::string error_reason(const std::vector<double>& travel, const std::vector<double>& wire,
                         const std::vector<double>& model) {
  const Way way = way_out(travel, wire, model);
  if (way.travel.size() < 3) return "";
  const VectorXd off = way.model - way.wire;
  const double range = way.wire.maxCoeff() - way.wire.minCoeff();
  Eigen::Index worst = 0;
  const double largest = off.cwiseAbs().maxCoeff(&worst);
  if (!off.allFinite() || largest <= worth_a_word * range) return "";

  const double before = rms(off);
  struct Reason {
    double left;
    std::string words;
  };
  std::vector<Reason> reasons;
  const double wires =
      way.model.squaredNorm() > 0.0 ? way.model.dot(way.wire) / way.model.squaredNorm() : 0.0;
  if (wires > 0.0) {
    reasons.push_back(
        {rms(wires * way.model - way.wire),
         wires < 1.0
             ? fmt::format("too stiff: {:.3g} times the force of the wire at the same travel", 1.0 / wires)
             : fmt::format("too soft: {:.3g} of the force of the wire at the same travel", 1.0 / wires)});
  }
  const auto [shift, left] = best_shift(way);
  reasons.push_back({left, fmt::format("its force comes {:.2g} mm of travel too {}",
                                       std::abs(shift) / base::mm, shift > 0.0 ? "late" : "early")});
  reasons.push_back({rms(off.array() - off.mean()),
                     fmt::format("{:.3g} N too much{}", std::abs(off.mean()), " everywhere")});
  if (off.mean() < 0.0) reasons.back().words = fmt::format("{:.3g} N too little everywhere", -off.mean());
  const auto best = std::ranges::min_element(reasons, {}, &Reason::left);
  if (best->left <= most_left * before) return best->words;

  // Another form: above or below at first, in the middle, at the end.
  const Eigen::Index n = off.size();
  const char* names[] = {"at first", "in the middle", "at the end"};
  std::string above, below;
  int high = 0, low = 0;
  for (int third = 0; third < 3; ++third) {
    const Eigen::Index from = n * third / 3, to = std::max(from + 1, n * (third + 1) / 3);
    const double mean = off.segment(from, to - from).mean();
    if (std::abs(mean) < 0.1 * largest) continue;
    std::string& of = mean > 0.0 ? above : below;
    of += fmt::format("{}{}", of.empty() ? "" : " and ", names[third]);
    ++(mean > 0.0 ? high : low);
  }
  if (high == 3) above = "everywhere";
  if (low == 3) below = "everywhere";
  std::string where;
  if (!above.empty()) where += "above the wire " + above + ", ";
  if (!below.empty()) where += "below the wire " + below + ", ";
  return fmt::format("of another form: {}farthest off at {:.3g} mm", where, way.travel[worst] / base::mm);
}

}  // namespace snare::reduction
