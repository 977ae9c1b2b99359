#include "coupling/dynamics/contact/wire_pair_search.hpp"

#include "base/index.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using numerics::VectorView;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// Boxes further apart than this many margins are not looked into.
constexpr double far = 4.0;

}  // namespace

WirePairSearch::WirePairSearch(const WirePair& pair, const wire::RodPart& a, const wire::RodPart& b)
    : thickness_(pair.radii[0] + pair.radii[1]), rods_{&a, &b}, curves_{BezierWire(a), BezierWire(b)} {
  // The gap's curvature along a straight wire that touches is at most one over the sum of the radii: see
  // ContactSearch.
  constexpr double share = 0.25, most_pieces = 64.0;
  margin_ = thickness_;
  for (std::size_t w = 0; w < 2; ++w) {
    const double shortest = curves_[w].shortest();
    resolutions_[w] =
        std::max(share * std::min(thickness_, std::max(pair.radii[w], shortest)), shortest / most_pieces);
    weight_sum_ = std::max(weight_sum_, curves_[w].largest_weight_sum());
    boxes_[w] = ElementBoxes(curves_[w].elements());
    speeds_[w].resize(rods_[w]->vertices());
  }
}

void WirePairSearch::place(std::array<ElementBoxes, 2>& boxes, const VectorView& y) const {
  for (std::size_t w = 0; w < 2; ++w) boxes[w].place(curves_[w], y);
}

// What two wires have gone against each other is at most what each has gone against a rigid body: the one
// that moves most as both together do.
void WirePairSearch::update(const VectorView& y) {
  const bool first = last_[0].cols() == 0;
  Vector3d centre = Vector3d::Zero(), way = Vector3d::Zero(), velocity = Vector3d::Zero();
  const double count = rods_[0]->vertices() + rods_[1]->vertices();
  const auto each = [&](const auto& use) {
    for (std::size_t w = 0; w < 2; ++w) {
      for (int i = 0; i < rods_[w]->vertices(); ++i)
        use(w, i, Vector3d(y.segment<3>(rods_[w]->position_of(i))),
            Vector3d(y.segment<3>(rods_[w]->velocity_of(i))));
    }
  };
  for (std::size_t w = 0; w < 2 && first; ++w) last_[w] = Eigen::Matrix3Xd::Zero(3, rods_[w]->vertices());
  each([&](std::size_t w, int i, const Vector3d& x, const Vector3d& v) {
    centre += x / count;
    way += (x - last_[w].col(i)) / count;
    velocity += v / count;
  });
  const Vector3d before = centre - way;
  // Turn and spin of least squares about the centre, by the second moments there; round-off decides about an
  // axis without any.
  Matrix3d moments = Matrix3d::Zero();
  Vector3d turn = Vector3d::Zero(), spin = Vector3d::Zero();
  each([&](std::size_t w, int i, const Vector3d& x, const Vector3d& v) {
    const Vector3d arm = x - centre;
    moments += arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose();
    turn += arm.cross(x - last_[w].col(i) - way);
    spin += arm.cross(v - velocity);
  });
  constexpr double round_off = 1e-9;
  moments.diagonal().array() += round_off * moments.trace();
  const Eigen::LDLT<Matrix3d> solver(moments);
  turn = solver.solve(turn);
  spin = solver.solve(spin);
  const double angle = turn.norm();
  const Matrix3d R =
      angle > 0.0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Matrix3d::Identity();
  std::array<double, 2> ways{0.0, 0.0};
  each([&](std::size_t w, int i, const Vector3d& x, const Vector3d& v) {
    ways[w] = std::max(ways[w], (x - centre - R * (last_[w].col(i) - before)).norm());
    last_[w].col(i) = x;
    speeds_[w][i] = (v - velocity - spin.cross(x - centre)).norm();
  });
  if (!first) passed_ += weight_sum_ * (ways[0] + ways[1]);
  const double speed = speeds_[0].maxCoeff() + speeds_[1].maxCoeff();
  // The boxes are looked through again when half of what was free has been used up.
  if (first || free_until_ - passed_ < 0.5 * clear_) {
    place(boxes_, y);
    candidates_.clear();
    clear_ = infinite;
    look(ElementBoxes::root, ElementBoxes::root);
    if (!std::isfinite(clear_)) clear_ = far * margin_;  // all are candidates
    free_until_ = passed_ + clear_;
    std::sort(candidates_.begin(), candidates_.end());
    list_runs(0);
    list_runs(1);
  }
  double near_speed = 0.0;  // of the candidates
  for (const auto& [a, b] : candidates_) {
    near_speed = std::max(near_speed, speeds_[0].segment<4>(curves_[0].first_vertex(a)).maxCoeff() +
                                          speeds_[1].segment<4>(curves_[1].first_vertex(b)).maxCoeff());
  }
  longest_step_ =
      1.0 / (2.0 * weight_sum_ * std::max(speed / (free_until_ - passed_), near_speed / thickness_));
}

void WirePairSearch::look(std::size_t a, std::size_t b) {
  if (boxes_[0].is_empty(a) || boxes_[1].is_empty(b)) return;
  const double gap = boxes_[0].box(a).exteriorDistance(boxes_[1].box(b)) - thickness_;
  const bool leaf_a = boxes_[0].is_element(a), leaf_b = boxes_[1].is_element(b);
  if (leaf_a && leaf_b && gap < margin_) {
    candidates_.emplace_back(boxes_[0].element(a), boxes_[1].element(b));
    return;
  }
  if ((leaf_a && leaf_b) || gap >= far * margin_) {
    clear_ = std::min(clear_, gap);
    return;
  }
  const bool divide_a = leaf_b || (!leaf_a && boxes_[0].box(a).diagonal().squaredNorm() >
                                                  boxes_[1].box(b).diagonal().squaredNorm());
  for (std::size_t k = 0; k < 2; ++k)
    look(divide_a ? ElementBoxes::child(a, k) : a, divide_a ? b : ElementBoxes::child(b, k));
}

void WirePairSearch::list_runs(std::size_t wire) {
  turned_.clear();
  for (const auto& [a, b] : candidates_) turned_.push_back(wire == 0 ? std::pair(a, b) : std::pair(b, a));
  std::sort(turned_.begin(), turned_.end());
  near_[wire].clear();
  for (const auto& [own, other] : turned_) {
    const bool goes_on =
        !near_[wire].empty() && near_[wire].back().element == own && near_[wire].back().last + 1 == other;
    if (goes_on)
      near_[wire].back().last = other;
    else
      near_[wire].push_back({own, other, other});
  }
}

NearestPoints WirePairSearch::nearest(const VectorView& y) const {
  std::array<ElementBoxes, 2> boxes{ElementBoxes(curves_[0].elements()), ElementBoxes(curves_[1].elements())};
  place(boxes, y);
  std::array<CubicPieces, 2> pieces;
  for (std::size_t w = 0; w < 2; ++w) {
    pieces[w] = CubicPieces(curves_[w].elements());
    for (int e = 0; e < curves_[w].elements(); ++e) pieces[w].set(e, curves_[w].control(e, y));
  }
  NearestPoints best{{0.0, 0.0}, infinite};
  search(boxes, pieces, ElementBoxes::root, ElementBoxes::root, best);
  return best;
}

// The nearer boxes first; none that cannot hold anything nearer.
void WirePairSearch::search(const std::array<ElementBoxes, 2>& boxes,
                            const std::array<CubicPieces, 2>& pieces, std::size_t a, std::size_t b,
                            NearestPoints& best) const {
  const auto bound = [&](std::size_t i, std::size_t j) {
    if (boxes[0].is_empty(i) || boxes[1].is_empty(j)) return infinite;
    return boxes[0].box(i).exteriorDistance(boxes[1].box(j)) - thickness_;
  };
  if (bound(a, b) >= best.gap) return;
  const bool leaf_a = boxes[0].is_element(a), leaf_b = boxes[1].is_element(b);
  if (leaf_a && leaf_b) {
    search(pieces, boxes[0].element(a), boxes[1].element(b), best);
    return;
  }
  const bool divide_a = leaf_b || (!leaf_a && boxes[0].box(a).diagonal().squaredNorm() >
                                                  boxes[1].box(b).diagonal().squaredNorm());
  std::array<std::pair<std::size_t, std::size_t>, 2> parts;
  for (std::size_t k = 0; k < 2; ++k)
    parts[k] = divide_a ? std::pair(ElementBoxes::child(a, k), b) : std::pair(a, ElementBoxes::child(b, k));
  if (bound(parts[1].first, parts[1].second) < bound(parts[0].first, parts[0].second))
    std::swap(parts[0], parts[1]);
  for (const auto& [i, j] : parts) search(boxes, pieces, i, j, best);
}

// At places that no minimum passes, and between them from the least.
void WirePairSearch::search(const std::array<CubicPieces, 2>& pieces, int a, int b,
                            NearestPoints& best) const {
  const auto gap = [&](double u) {
    const Vector3d x = pieces[0].value(a, u);
    const FootPoint foot = foot_point(pieces[1], b, b, x);
    const double g = (x - pieces[1].value(b, foot.u)).norm() - thickness_;
    if (g < best.gap) {
      best = {{curves_[0].begin(a) + u * curves_[0].length(a),
               curves_[1].begin(b) + foot.u * curves_[1].length(b)},
              g};
    }
    return g;
  };
  const int cuts = std::max(2, static_cast<int>(std::ceil(curves_[0].length(a) / resolutions_[0])));
  double lowest = infinite;
  int at = 0;
  for (int k = 0; k <= cuts; ++k) {
    const double g = gap(static_cast<double>(k) / cuts);
    if (g < lowest) {
      lowest = g;
      at = k;
    }
  }
  static_cast<void>(boost::math::tools::brent_find_minima(gap, std::max(0.0, (at - 1.0) / cuts),
                                                          std::min(1.0, (at + 1.0) / cuts), 30));
}

}  // namespace snare::coupling
