#include "coupling/dynamics/contact_search.hpp"

#include "coupling/dynamics/contact_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::coupling {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXd;
using multibody::Pose;
using numerics::VectorView;

namespace {

// n.X' below this is zero: along a straight wire on a flat face it is round-off of either sign.
constexpr double level_slope = 1e-10;

// Control points of the two halves of a cubic (de Casteljau).
std::pair<BezierWire::Control, BezierWire::Control> halves(const BezierWire::Control& c) {
  const Vector3d ab = 0.5 * (c.col(0) + c.col(1));
  const Vector3d bc = 0.5 * (c.col(1) + c.col(2));
  const Vector3d cd = 0.5 * (c.col(2) + c.col(3));
  const Vector3d abc = 0.5 * (ab + bc);
  const Vector3d bcd = 0.5 * (bc + cd);
  const Vector3d middle = 0.5 * (abc + bcd);
  BezierWire::Control left;
  BezierWire::Control right;
  left << c.col(0), ab, abc, middle;
  right << middle, bcd, cd, c.col(3);
  return {left, right};
}

AlignedBox3d box_of(const BezierWire::Control& c) {
  return {c.rowwise().minCoeff(), c.rowwise().maxCoeff()};
}

// Bound of |dx/dt| on the step of length h that ends where the derivatives are taken: x is a polynomial there.
template <class Norm>
double rate_bound(std::size_t derivatives, double h, const Norm& norm) {
  double bound = 0.0;
  double factor = 1.0;
  for (std::size_t k = 0; k < derivatives; ++k) {
    bound += factor * norm(k);
    factor *= h / static_cast<double>(k + 1);
  }
  return bound;
}

}  // namespace

BezierWire::BezierWire(const wire::RodPart& rod) : rod_(rod) {
  for (int e = 0; e + 1 < rod.vertices(); ++e) {
    Piece piece;
    piece.begin = rod.coordinate(e);
    piece.length = rod.coordinate(e + 1) - piece.begin;
    const CurveWeights w = curve_weights(rod, piece.begin);
    piece.first = w.first;
    // X = a0 + a1 u + a2 u^2 + ... at its beginning, and the vertex at its end.
    const Vector4d a1 = piece.length * w.slope;
    const Vector4d a2 = 0.5 * piece.length * piece.length * w.bend;
    piece.weights << w.value, w.value + a1 / 3.0, w.value + 2.0 / 3.0 * a1 + a2 / 3.0, Vector4d::Unit(e + 1 - w.first);
    largest_weight_sum_ = std::max(largest_weight_sum_, piece.weights.cwiseAbs().colwise().sum().maxCoeff());
    pieces_.push_back(piece);
  }
}

BezierWire::Control BezierWire::control(int element, const VectorView& y) const {
  const Piece& piece = pieces_[static_cast<std::size_t>(element)];
  return Eigen::Map<const Control>(y.data() + rod_.position_of(piece.first)) * piece.weights;
}

double BezierWire::largest(const VectorXd& y, const Vector3d& offset) const {
  return std::sqrt(
      (Eigen::Map<const Eigen::Matrix3Xd>(y.data() + rod_.position_of(0), 3, rod_.vertices()).colwise() - offset)
          .colwise()
          .squaredNorm()
          .maxCoeff());
}

/// The gap and its slope at a material coordinate.
struct ContactSearch::Place {
  double u = 0.0;  // in the element, 0 to 1
  double coordinate = 0.0;
  double gap = 0.0;
  double slope = 0.0;  // n.X'
};

struct ContactSearch::Interval {
  int element = 0;
  Place from, to;
};

ContactSearch::ContactSearch(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body,
                             double position_tolerance)
    : shape_(contact.shape),
      X_BS_(contact.X_BS),
      wire_radius_(contact.wire_radius),
      rod_(rod),
      body_(body),
      curve_(rod) {
  double shortest = curve_.length(0);
  for (int e = 1; e < curve_.elements(); ++e) shortest = std::min(shortest, curve_.length(e));
  // The gap's curvature along a straight wire that touches is at most one over the sum of the radii; a quarter of that length shows every
  // minimum. A wire that bends round a large shape shows two within an element: a quarter of that. An element is not cut into more than 64.
  constexpr double share = 0.25;
  constexpr double most_pieces = 64.0;
  const double radius = wire_radius_ + shape_->smallest_radius();
  resolution_ = std::max(share * std::min(radius, std::max(wire_radius_, shortest)), shortest / most_pieces);
  skip_depth_ = std::max(1e-3 * wire_radius_, 10.0 * position_tolerance);
  for (int e = 0; e < curve_.elements(); ++e) longest_element_ = std::max(longest_element_, curve_.length(e));
  free_until_.assign(static_cast<std::size_t>(curve_.elements()), 0.0);
}

void ContactSearch::forget() {
  for (const int e : asked_) free_until_[static_cast<std::size_t>(e)] = 0.0;
}

double ContactSearch::known_clearance() const {
  return *std::min_element(free_until_.begin(), free_until_.end()) - passed_;
}

// The elements that the shape may have met on a step that ends at y. An element whose gap was g when the way was w meets nothing before the
// way is w + g: only where that has come does its distance have to be looked up.
std::vector<int> ContactSearch::met_within(double way, const VectorView& y) {
  passed_ += way;
  asked_.clear();
  for (int e = 0; e < curve_.elements(); ++e) {
    if (free_until_[static_cast<std::size_t>(e)] <= passed_) asked_.push_back(e);
  }
  std::vector<int> met;
  if (asked_.empty()) return met;
  const Pose where = X_WS(y);
  for (const int e : asked_) {
    const double gap = lower_bound(where, box_of(curve_.control(e, y)));
    free_until_[static_cast<std::size_t>(e)] = passed_ + gap;
    if (gap <= way) met.push_back(e);
  }
  return met;
}

Pose ContactSearch::X_WS(const VectorView& y) const {
  return Pose{multibody::rotation(y.segment<4>(body_.quaternion())), y.segment<3>(body_.position())} * X_BS_;
}

ContactSearch::Place ContactSearch::place(const Pose& X_WS, const BezierWire::Control& c, int element, double u) const {
  const double v = 1.0 - u;
  const Vector3d x =
      v * v * v * c.col(0) + 3.0 * u * v * v * c.col(1) + 3.0 * u * u * v * c.col(2) + u * u * u * c.col(3);
  const Vector3d slope =
      3.0 / curve_.length(element) *
      (v * v * (c.col(1) - c.col(0)) + 2.0 * u * v * (c.col(2) - c.col(1)) + u * u * (c.col(3) - c.col(2)));
  const DistanceField field = shape_->at(X_WS.R.transpose() * (x - X_WS.p));
  return {u, curve_.begin(element) + u * curve_.length(element), field.distance - wire_radius_,
          (X_WS.R * field.normal).dot(slope)};
}

// The distance changes by no more than the way: nothing within a ball is nearer than its centre less its radius.
double ContactSearch::lower_bound(const Pose& X_WS, const AlignedBox3d& box) const {
  return shape_->distance(X_WS.R.transpose() * (box.center() - X_WS.p)) - 0.5 * box.diagonal().norm() - wire_radius_;
}

// Boxes of single elements, of pairs, of fours and so on; what is farther than `reach` is left out with all below it. `least` becomes a
// lower bound of the gap everywhere.
std::vector<int> ContactSearch::near_elements(const Pose& X_WS, const VectorView& y, double reach,
                                              double& least) const {
  std::vector<std::vector<AlignedBox3d>> levels(1);
  for (int e = 0; e < curve_.elements(); ++e) levels[0].push_back(box_of(curve_.control(e, y)));
  while (levels.back().size() > 1) {
    const std::vector<AlignedBox3d>& below = levels.back();
    std::vector<AlignedBox3d> level;
    for (std::size_t k = 0; k < below.size(); k += 2)
      level.push_back(k + 1 < below.size() ? below[k].merged(below[k + 1]) : below[k]);
    levels.push_back(std::move(level));
  }
  std::vector<int> found;
  least = std::numeric_limits<double>::infinity();
  std::vector<std::pair<std::size_t, std::size_t>> stack{{levels.size() - 1, 0}};
  while (!stack.empty()) {
    const auto [level, index] = stack.back();
    stack.pop_back();
    const double bound = lower_bound(X_WS, levels[level][index]);
    // Far parts are not looked at closer once something as near is known.
    if (bound >= reach && (bound >= least || level == 0)) {
      least = std::min(least, bound);
      continue;
    }
    if (level == 0) {
      least = std::min(least, bound);
      found.push_back(static_cast<int>(index));
      continue;
    }
    if (2 * index + 1 < levels[level - 1].size()) stack.emplace_back(level - 1, 2 * index + 1);
    stack.emplace_back(level - 1, 2 * index);
  }
  return found;
}

// Between two places the gap cannot fall by more than the way there and back; the way is no longer than the control polygon.
void ContactSearch::subdivide(const Pose& X_WS, int element, const BezierWire::Control& whole,
                              const BezierWire::Control& part, const Place& from, const Place& to, double reach,
                              std::vector<Interval>& out) const {
  const double way = (part.rightCols<3>() - part.leftCols<3>()).colwise().norm().sum();
  if (0.5 * (from.gap + to.gap - way) >= reach) return;
  if (way <= resolution_) {
    out.push_back({element, from, to});
    return;
  }
  const auto [left, right] = halves(part);
  const Place middle = place(X_WS, whole, element, 0.5 * (from.u + to.u));
  subdivide(X_WS, element, whole, left, from, middle, reach, out);
  subdivide(X_WS, element, whole, right, middle, to, reach, out);
}

std::vector<GapMinimum> ContactSearch::minima_of(const std::vector<int>& elements, const VectorView& y,
                                                 double reach) const {
  const Pose where = X_WS(y);
  std::vector<Interval> intervals;
  Place end;
  int before = -1;
  for (const int e : elements) {
    const BezierWire::Control c = curve_.control(e, y);
    // The curve is C1: the end of one element is the beginning of the next.
    Place begin = end;
    begin.u = 0.0;
    if (e != before + 1 || before < 0) begin = place(where, c, e, 0.0);
    end = place(where, c, e, 1.0);
    before = e;
    subdivide(where, e, c, c, begin, end, reach, intervals);
  }
  std::vector<GapMinimum> found;
  const auto add = [&](double coordinate, double gap) {
    if (gap < reach) found.push_back({coordinate, gap});
  };
  const auto level = [](double slope) { return std::abs(slope) < level_slope ? 0.0 : slope; };
  const int last = curve_.elements() - 1;
  for (const Interval& i : intervals) {
    const double falls = level(i.from.slope);
    const double rises = level(i.to.slope);
    if (i.element == 0 && i.from.u == 0.0 && falls >= 0.0) add(i.from.coordinate, i.from.gap);
    if (falls < 0.0 && rises >= 0.0) {
      // Illinois; a root of a smooth function is found to round-off in about ten evaluations, one of a kink in a few more.
      const BezierWire::Control c = curve_.control(i.element, y);
      Place low = i.from;
      Place high = i.to;
      Place best = high;
      double f_low = low.slope;
      double f_high = high.slope;
      for (int k = 0; k < 60 && high.u - low.u > 1e-14 && f_high > f_low && std::abs(best.slope) > 1e-14; ++k) {
        best = place(where, c, i.element, (low.u * f_high - high.u * f_low) / (f_high - f_low));
        if (best.slope < 0.0) {
          low = best;
          f_low = best.slope;
          f_high *= 0.5;
        } else {
          high = best;
          f_high = best.slope;
          f_low *= 0.5;
        }
      }
      add(best.coordinate, best.gap);
    }
    if (i.element == last && i.to.u == 1.0 && rises < 0.0) add(i.to.coordinate, i.to.gap);
  }
  return found;
}

std::vector<GapMinimum> ContactSearch::minima(const VectorView& y, double reach) const {
  double least = 0.0;
  return minima_of(near_elements(X_WS(y), y, reach, least), y, reach);
}

double ContactSearch::clearance(const VectorView& y) const {
  double least = 0.0;
  static_cast<void>(near_elements(X_WS(y), y, -std::numeric_limits<double>::infinity(), least));
  return least;
}

GapMinimum ContactSearch::nearest(const VectorView& y) const {
  // The nearest end of an element bounds the least gap from above, which closes in on the elements around it.
  const Pose where = X_WS(y);
  double bound = std::numeric_limits<double>::infinity();
  const int last = curve_.elements() - 1;
  double least = 0.0;
  static_cast<void>(near_elements(where, y, -std::numeric_limits<double>::infinity(), least));
  const double longest = resolution_;
  for (double reach = std::max(0.0, least) + longest;; reach += reach - least + longest) {
    const std::vector<GapMinimum> found = minima(y, reach);
    GapMinimum best{0.0, bound};
    for (const GapMinimum& m : found) {
      if (m.gap < best.gap) best = m;
    }
    if (std::isfinite(best.gap)) return best;
    // All of the wire within reach and no minimum: it is at an end that a level slope hid.
    if (static_cast<int>(near_elements(where, y, reach, least).size()) == curve_.elements()) break;
  }
  const Place a = place(where, curve_.control(0, y), 0, 0.0);
  const Place b = place(where, curve_.control(last, y), last, 1.0);
  return a.gap <= b.gap ? GapMinimum{a.coordinate, a.gap} : GapMinimum{b.coordinate, b.gap};
}

std::vector<GapMinimum> ContactSearch::open_minima(std::vector<GapMinimum> all, const VectorView& y,
                                                   const std::vector<Held>& held) const {
  for (const Held& one : held) {
    const double h = y[one.unknown];
    // A closed contact holds the minimum at which it stands.
    const auto own = std::min_element(all.begin(), all.end(), [h](const GapMinimum& a, const GapMinimum& b) {
      return std::abs(a.coordinate - h) < std::abs(b.coordinate - h);
    });
    if (own != all.end() && std::abs(own->coordinate - h) < one.within) all.erase(own);
    std::erase_if(all,
                  [&](const GapMinimum& m) { return m.gap > -one.depth && std::abs(m.coordinate - h) < one.around; });
  }
  return all;
}

// A stretch that lies flat has one minimum, and touches in all of its vertices at once.
std::vector<GapMinimum> ContactSearch::flat_vertices(const VectorView& y, double touch) const {
  double least = 0.0;
  const Pose where = X_WS(y);
  std::vector<GapMinimum> found;
  for (const int e : near_elements(where, y, touch + skip_depth_, least)) {
    if (e == 0) continue;
    const Place vertex = place(where, curve_.control(e, y), e, 0.0);
    if (vertex.gap <= touch && std::abs(vertex.slope) < level_slope) found.push_back({vertex.coordinate, vertex.gap});
  }
  return found;
}

std::vector<GapMinimum> ContactSearch::touching(const VectorView& y, const std::vector<Held>& held,
                                                double touch) const {
  // Above the touch too, since a closed contact's own minimum may stand at round-off above it.
  std::vector<GapMinimum> found = open_minima(minima(y, touch + skip_depth_), y, held);
  std::erase_if(found, [touch](const GapMinimum& m) { return m.gap > touch; });
  if (found.empty()) return found;
  for (const GapMinimum& v : open_minima(flat_vertices(y, touch), y, held)) {
    const auto beside = [&](const GapMinimum& m) { return std::abs(m.coordinate - v.coordinate) < resolution_; };
    if (std::none_of(found.begin(), found.end(), beside)) found.push_back(v);
  }
  return found;
}

double ContactSearch::speed_bound(const Step& step) const {
  const double h = step.to - step.from;
  const std::vector<VectorXd>& d = step.derivatives;
  const VectorXd& y = step.ida.y();
  const double way = rate_bound(d.size(), h, [&](std::size_t k) {
    return curve_.largest_weight_sum() * curve_.largest(d[k], d[k].segment<3>(body_.position()));
  });
  const double spin =
      2.0 * rate_bound(d.size(), h, [&](std::size_t k) { return d[k].segment<4>(body_.quaternion()).norm(); });
  if (spin == 0.0) return way;
  const double arm = curve_.largest_weight_sum() * curve_.largest(y, y.segment<3>(body_.position()));
  return way + spin * (arm + h * way);
}

double ContactSearch::speed_bound(const Step& step, const std::vector<int>& elements) const {
  const double h = step.to - step.from;
  const std::vector<VectorXd>& d = step.derivatives;
  const VectorXd& y = step.ida.y();
  const double spin =
      2.0 * rate_bound(d.size(), h, [&](std::size_t k) { return d[k].segment<4>(body_.quaternion()).norm(); });
  const auto largest = [&](int e, const VectorXd& v) {
    return std::sqrt(
        (curve_.control(e, v).colwise() - Vector3d(v.segment<3>(body_.position()))).colwise().squaredNorm().maxCoeff());
  };
  double bound = 0.0;
  for (const int e : elements) {
    const double way = rate_bound(d.size(), h, [&](std::size_t k) { return largest(e, d[k]); });
    bound = std::max(bound, way + spin * (largest(e, y) + h * way));
  }
  return bound;
}

std::optional<double> ContactSearch::first_touch(const Step& step, double until, const std::vector<Held>& held,
                                                 double touch) {
  const double h = step.to - step.from;
  const double way = h * speed_bound(step);
  const VectorXd& end = step.ida.y();
  const std::vector<int> candidates = met_within(way, end);
  if (candidates.empty()) return std::nullopt;
  const double speed = speed_bound(step, candidates);
  if (speed == 0.0) return std::nullopt;
  // The least open gap at a time, or nothing when it is beyond `reach`.
  const auto least = [&](double t, double reach) -> std::optional<double> {
    const VectorXd y = t == step.to ? end : step.ida.interpolate(t);
    const std::vector<GapMinimum> open = open_minima(minima_of(candidates, y, reach), y, held);
    if (open.empty()) return std::nullopt;
    return std::min_element(open.begin(), open.end(),
                            [](const GapMinimum& a, const GapMinimum& b) { return a.gap < b.gap; })
        ->gap;
  };
  // Nothing within the way of the whole step at its end: nothing was touched on it.
  if (!least(step.to, speed * h + skip_depth_)) return std::nullopt;
  double before = step.from;
  std::optional<double> gap_before;
  double t = step.from;
  while (true) {
    const std::optional<double> gap = least(t, speed * (until - t) + skip_depth_);
    if (!gap) return std::nullopt;
    if (*gap <= touch) break;
    if (t >= until) return std::nullopt;
    before = t;
    gap_before = gap;
    t = std::min(until, t + (*gap - touch + skip_depth_) / speed);
  }
  if (!gap_before) return step.from;  // inside from the start
  // Between `before` and t the least gap passes `touch`: bisection with the secant's first guess (Illinois).
  double low = before;
  double high = t;
  double f_low = *gap_before - touch;
  const auto value = [&](double s) {
    return least(s, speed * (until - s) + skip_depth_).value_or(skip_depth_) - touch;
  };
  double f_high = value(high);
  constexpr double sharp = 1e-13;  // [m]
  for (int k = 0; k < 100 && f_high < -sharp && high - low > 1e-15 * std::max(high, h); ++k) {
    double s = (low * f_high - high * f_low) / (f_high - f_low);
    if (!(s > low && s < high)) s = 0.5 * (low + high);
    const double f = value(s);
    if (f > 0.0) {
      low = s;
      f_low = f;
      f_high *= 0.5;
    } else {
      high = s;
      f_high = f;
      f_low *= 0.5;
    }
  }
  return high;
}

}  // namespace snare::coupling
