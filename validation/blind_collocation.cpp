#include "validation/blind_collocation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::validation::blind {
namespace {

constexpr int kIterations = 25;
constexpr double kTolerance = 1e-7;        // of a step that is then taken: quadratic convergence squares it
constexpr double kTightTolerance = 1e-10;  // without contact, where the position before that step is reported
constexpr double kTurn = 0.4;              // largest change of an angle in one step [rad]

// Nodes of one side from 0 to 1: dense towards both ends, where bending relaxes over a few millimetres, and
// at the edges of a damage. begin, end: coordinates of the side [m].
std::vector<double> graded(const BlindWire& wire, double begin, double end) {
  constexpr std::size_t kSamples = 4000;
  constexpr double kEdge = 1.8e-3;           // half width of the dense zone at an edge [m]
  constexpr double kEdgeInterval = 0.08e-3;  // [m]
  const double layer = wire.length / 20.0;
  std::vector<double> count(kSamples + 1, 0.0);
  const double h = (end - begin) / static_cast<double>(kSamples);
  const auto middle = [&](std::size_t i) { return begin + (static_cast<double>(i) + 0.5) * h; };
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double S = middle(i);
    count[i + 1] = count[i] + 1.0 + 8.0 * (std::exp(-(S - begin) / layer) + std::exp(-(end - S) / layer));
  }
  const double per_sample = wire.intervals / count.back();
  double extra = 0.0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    if (wire.damage_factor != 1.0) {
      for (const double at : {wire.damage_from, wire.damage_to}) {
        extra +=
            wire.intervals / 100.0 * h / kEdgeInterval * std::exp(-std::pow((middle(i) - at) / kEdge, 4));
      }
    }
    count[i + 1] = count[i + 1] * per_sample + extra;
  }
  const auto intervals = static_cast<std::size_t>(std::ceil(count.back() - 1e-6));
  std::vector<double> nodes(intervals + 1, 0.0);
  std::size_t sample = 0;
  for (std::size_t i = 1; i < intervals; ++i) {
    const double wanted = count.back() * static_cast<double>(i) / static_cast<double>(intervals);
    while (count[sample + 1] < wanted) ++sample;
    const double part = (wanted - count[sample]) / (count[sample + 1] - count[sample]);
    nodes[i] = (static_cast<double>(sample) + part) / static_cast<double>(kSamples);
  }
  nodes.back() = 1.0;
  return nodes;
}

// Columns 0 ... 3 of a point are n_x, n_y (of this side), S_c, S_0.
using Four = std::array<double, 4>;

}  // namespace

struct Collocation::Side {
  bool right;
  double begin;       // [m]
  double length;      // [m]
  Eigen::Vector2d n;  // at S_0, as this side continues it
  double feed;        // S_0
};

// u' = (kappa, M') and r' in a section, and their derivatives.
struct Collocation::Point {
  double kappa, slope, gx, gy;  // th', M', r'
  double kappa_M, slope_th, gx_th, gy_th;
  Four kappa_q, slope_q, gx_q, gy_q;
};

Collocation::Collocation(const BlindWire& wire, double contact)
    : length_(wire.length),
      radius_(wire.radius),
      axial_(wire.axial_stiffness),
      mount_axial_(wire.mount_axial_compliance),
      mount_rotational_(wire.mount_rotational_compliance),
      pusher_compliance_(wire.pusher_compliance),
      direction_(std::sin(wire.misalignment), std::cos(wire.misalignment)),
      force_scale_(wire.bending_stiffness / (wire.length * wire.length)),
      moment_scale_(wire.bending_stiffness / wire.length) {
  fraction_ = graded(wire, 0.0, contact);
  left_ = fraction_.size() - 1;
  const auto other = graded(wire, contact, wire.length);
  right_ = other.size() - 1;
  fraction_.insert(fraction_.end(), other.begin() + 1, other.end());
  guess_.assign(2 * nodes(), 0.0);
  band_.resize(2 * nodes());
  columns_.resize(2 * nodes());
  arm_.resize(nodes());
}

double Collocation::coordinate(const Unknowns& z, std::size_t node) const {
  const bool right = node > left_;
  return right ? z.contact + fraction_[node] * (length_ - z.contact)
               : z.begin + fraction_[node] * (z.contact - z.begin);
}

Collocation::Point Collocation::evaluate(const Section& law, const Conditions& at, const Side& side, double S,
                                         double fraction, const std::array<double, 2>& u,
                                         double guess) const {
  const double c = std::cos(u[0]);
  const double s = std::sin(u[0]);
  const double nx = side.n.x() - at.weight.x() * (S - side.feed);
  const double ny = side.n.y() - at.weight.y() * (S - side.feed);
  const double N = nx * c + ny * s;
  const double Q = -nx * s + ny * c;
  const Response bend = law.bend(u[1], S, at.rate, guess);
  const Response stretch = law.stretch(N, S, at.rate);
  const double e1 = 1.0 + stretch.strain;
  const double eN = stretch.by_stress;
  Point p;
  p.kappa = bend.strain;
  p.slope = -e1 * Q;
  p.gx = e1 * c;
  p.gy = e1 * s;
  p.kappa_M = bend.by_stress;
  p.slope_th = e1 * N - eN * Q * Q;
  p.gx_th = -e1 * s + eN * Q * c;
  p.gy_th = e1 * c + eN * Q * s;
  // By n of the section: N by t, Q by nu.
  const double slope_nx = e1 * s - eN * c * Q;
  const double slope_ny = -e1 * c - eN * s * Q;
  const double S_c = side.right ? 1.0 - fraction : fraction;
  const double S_0 = side.right ? 0.0 : 1.0 - fraction;
  const std::array<double, 4> dS{0.0, 0.0, S_c, S_0};
  const std::array<double, 4> dnx{1.0, 0.0, -at.weight.x() * S_c, at.weight.x() * (1.0 - S_0)};
  const std::array<double, 4> dny{0.0, 1.0, -at.weight.y() * S_c, at.weight.y() * (1.0 - S_0)};
  for (std::size_t j = 0; j < 4; ++j) {
    const double de = eN * (c * dnx[j] + s * dny[j]) + stretch.by_coordinate * dS[j];
    p.kappa_q[j] = bend.by_coordinate * dS[j];
    p.slope_q[j] = slope_nx * dnx[j] + slope_ny * dny[j] - stretch.by_coordinate * dS[j] * Q;
    p.gx_q[j] = de * c;
    p.gy_q[j] = de * s;
  }
  return p;
}

// Rows: clamp, two a interval, clamp.
void Collocation::assemble(const Section& law, const Conditions& at, const Unknowns& z) {
  for (auto& a : arm_) a = {};
  for (auto& a : arm_global_) a = {};
  band_.front() = {0.0, 0.0, 1.0, -mount_rotational_, 0.0, 0.0, 0.0};
  columns_.front() = {};
  columns_.front()[kGlobals] = z.section.front()[0] - mount_rotational_ * z.section.front()[1];
  band_.back() = {0.0, 1.0, mount_rotational_, 0.0, 0.0, 0.0, 0.0};
  columns_.back() = {};
  columns_.back()[kGlobals] = z.section.back()[0] + mount_rotational_ * z.section.back()[1];

  for (int which = 0; which < 2; ++which) {
    const bool right = which == 1;
    Side side{right, z.begin, z.contact - z.begin, z.n, z.begin};
    if (right) side = {true, z.contact, length_ - z.contact, z.n - z.f, z.begin};
    const std::size_t first = right ? left_ : 0;
    const std::size_t last = right ? left_ + right_ : left_;
    double fraction = 0.0;
    Point a = evaluate(law, at, side, side.begin, 0.0, z.section[first], guess_[2 * first]);
    guess_[2 * first] = a.kappa;
    for (std::size_t i = first; i < last; ++i) {
      a = add_interval(law, at, z, side, i, fraction, a);
      fraction = fraction_[i + 1];
    }
  }
}

// Interval from a to b of width h:
//   u_m = (u_a + u_b)/2 + h/8 (u'_a - u'_b),  R = u_b - u_a - h/6 (u'_a + 4 u'_m + u'_b).
Collocation::Point Collocation::add_interval(const Section& law, const Conditions& at, const Unknowns& z,
                                             const Side& side, std::size_t i, double fraction,
                                             const Point& a) {
  const bool right = side.right;
  const double next = fraction_[i + 1];
  const double h = side.length * (next - fraction);
  const auto& ua = z.section[i];
  const auto& ub = z.section[i + 1];
  const Point b = evaluate(law, at, side, side.begin + side.length * next, next, ub, guess_[2 * i + 2]);
  guess_[2 * i + 2] = b.kappa;
  const double middle = 0.5 * (fraction + next);
  const std::array<double, 2> um{0.5 * (ua[0] + ub[0]) + 0.125 * h * (a.kappa - b.kappa),
                                 0.5 * (ua[1] + ub[1]) + 0.125 * h * (a.slope - b.slope)};
  const Point m = evaluate(law, at, side, side.begin + side.length * middle, middle, um, guess_[2 * i + 1]);
  guess_[2 * i + 1] = m.kappa;

  const double h6 = h / 6.0;
  const double h8 = h / 8.0;
  const double by_M = 4.0 * m.kappa_M;
  const double by_th = 4.0 * m.slope_th;
  // th_m = ... + h/8 (kappa_a - kappa_b) depends on M; M_m = ... + h/8 (M'_a - M'_b) on th.
  auto& upper = band_[2 * i + 1];  // columns 2 i - 1 ...
  auto& lower = band_[2 * i + 2];  // columns 2 i ...
  upper = {0.0,
           -1.0 - h6 * by_M * h8 * a.slope_th,
           -h6 * (a.kappa_M + 0.5 * by_M),
           1.0 + h6 * by_M * h8 * b.slope_th,
           -h6 * (b.kappa_M + 0.5 * by_M),
           0.0,
           0.0};
  lower = {-h6 * (a.slope_th + 0.5 * by_th),
           -1.0 - h6 * by_th * h8 * a.kappa_M,
           -h6 * (b.slope_th + 0.5 * by_th),
           1.0 + h6 * by_th * h8 * b.kappa_M,
           0.0,
           0.0,
           0.0};
  const std::size_t row_x = right ? 2 : 0;
  auto& arm_a = arm_[i];
  auto& arm_b = arm_[i + 1];
  arm_a[row_x][0] += h6 * (a.gx_th + 2.0 * m.gx_th);
  arm_a[row_x][1] += h6 * 4.0 * m.gx_th * h8 * a.kappa_M;
  arm_a[row_x + 1][0] += h6 * (a.gy_th + 2.0 * m.gy_th);
  arm_a[row_x + 1][1] += h6 * 4.0 * m.gy_th * h8 * a.kappa_M;
  arm_b[row_x][0] += h6 * (b.gx_th + 2.0 * m.gx_th);
  arm_b[row_x][1] -= h6 * 4.0 * m.gx_th * h8 * b.kappa_M;
  arm_b[row_x + 1][0] += h6 * (b.gy_th + 2.0 * m.gy_th);
  arm_b[row_x + 1][1] -= h6 * 4.0 * m.gy_th * h8 * b.kappa_M;
  // h by S_c and S_0.
  const Four dh{0.0, 0.0, (right ? -1.0 : 1.0) * (next - fraction), right ? 0.0 : fraction - next};
  add_interval_globals({a, m, b}, h, dh, {ub[0] - ua[0], ub[1] - ua[1]}, right, i);
  return b;
}

// Residuals of an interval with points a, m, b, and their derivatives by the globals. du: u_b - u_a.
void Collocation::add_interval_globals(const std::array<Point, 3>& points, double h, const Four& dh,
                                       const std::array<double, 2>& du, bool right, std::size_t i) {
  const auto& [a, m, b] = points;
  const double h6 = h / 6.0;
  const double h8 = h / 8.0;
  const double by_M = 4.0 * m.kappa_M;
  const double by_th = 4.0 * m.slope_th;
  const double sum_th = (a.kappa + 4.0 * m.kappa + b.kappa) / 6.0;
  const double sum_M = (a.slope + 4.0 * m.slope + b.slope) / 6.0;
  const double sum_x = (a.gx + 4.0 * m.gx + b.gx) / 6.0;
  const double sum_y = (a.gy + 4.0 * m.gy + b.gy) / 6.0;
  Column& up = columns_[2 * i + 1];
  Column& low = columns_[2 * i + 2];
  up[kGlobals] = du[0] - h * sum_th;
  low[kGlobals] = du[1] - h * sum_M;
  Four th_q;
  Four M_q;
  Four x_q;
  Four y_q;
  for (std::size_t j = 0; j < 4; ++j) {
    const double thm = h8 * (a.kappa_q[j] - b.kappa_q[j]) + 0.125 * dh[j] * (a.kappa - b.kappa);
    const double Mm = h8 * (a.slope_q[j] - b.slope_q[j]) + 0.125 * dh[j] * (a.slope - b.slope);
    th_q[j] = -h6 * (a.kappa_q[j] + 4.0 * m.kappa_q[j] + by_M * Mm + b.kappa_q[j]) - dh[j] * sum_th;
    M_q[j] = -h6 * (a.slope_q[j] + 4.0 * m.slope_q[j] + by_th * thm + b.slope_q[j]) - dh[j] * sum_M;
    x_q[j] = h6 * (a.gx_q[j] + 4.0 * (m.gx_q[j] + m.gx_th * thm) + b.gx_q[j]) + dh[j] * sum_x;
    y_q[j] = h6 * (a.gy_q[j] + 4.0 * (m.gy_q[j] + m.gy_th * thm) + b.gy_q[j]) + dh[j] * sum_y;
  }
  // n of the right side is n_0 - f.
  const double f_sign = right ? -1.0 : 0.0;
  const auto spread = [f_sign](Column& column, const Four& q, double sign) {
    column[0] += sign * q[0];
    column[1] += sign * q[1];
    column[2] += sign * f_sign * q[0];
    column[3] += sign * f_sign * q[1];
    column[4] += sign * q[2];
    column[5] += sign * q[3];
  };
  const std::size_t row_x = right ? 2 : 0;
  for (std::size_t j = 0; j < kGlobals; ++j) up[j] = low[j] = 0.0;
  spread(up, th_q, 1.0);
  spread(low, M_q, 1.0);
  spread(arm_global_[row_x], x_q, 1.0);
  spread(arm_global_[row_x + 1], y_q, 1.0);
  arm_global_[row_x][kGlobals] += h * sum_x;
  arm_global_[row_x + 1][kGlobals] += h * sum_y;
}

// The six conditions on the globals, all as residuals:
//   0  x_c + R sin th_c - a_x = 0            3  y_L = 0
//   1  y_c - R cos th_c - a_y = 0  (f_x)     4  grip  (f_y)
//   2  x_L + c n_x(L) - span = 0             5  S_0 (place) held, or C (n_x) = limit
// with a = pusher - c_p (f . m) m; rows 1 and 4 are f = 0 without contact.
void Collocation::close(const Section& law, const Conditions& at, const Unknowns& z, Square& by_global,
                        Globals& residual) {
  by_global.setZero();
  residual.setZero();
  for (auto& row : close_node_) row = {};
  for (auto& row : close_arm_) row = {};
  const auto& first = z.section.front();
  const double th = z.section[left_][0];
  const Eigen::Vector2d t(std::cos(th), std::sin(th));
  const Eigen::Vector2d nu(-t.y(), t.x());
  const auto integral = [&](Eigen::Index row, std::size_t which) {
    close_arm_[static_cast<std::size_t>(row)][which] += 1.0;
    residual[row] += arm_global_[which][kGlobals];
    for (std::size_t j = 0; j < kGlobals; ++j) {
      by_global(row, static_cast<Eigen::Index>(j)) += arm_global_[which][j];
    }
  };
  const double x_begin = z.place + mount_axial_ * z.n.x();
  contact_position_ = {x_begin + arm_global_[0][kGlobals], arm_global_[1][kGlobals]};

  integral(0, 0);
  residual[0] += x_begin + radius_ * t.y() - at.pusher.x();
  by_global(0, 0) += mount_axial_;
  close_node_[0][2] = radius_ * t.x();
  if (at.touching) {
    const Eigen::Vector2d give = pusher_compliance_ * direction_;
    const double force = z.f.dot(direction_);
    residual[0] += give.x() * force;
    by_global(0, 2) += give.x() * direction_.x();
    by_global(0, 3) += give.x() * direction_.y();
    integral(1, 1);
    residual[1] += -radius_ * t.x() - at.pusher.y() + give.y() * force;
    close_node_[1][2] = radius_ * t.y();
    by_global(1, 2) += give.y() * direction_.x();
    by_global(1, 3) += give.y() * direction_.y();
    if (at.grip == Grip::sticking) {
      residual[4] = z.contact + radius_ * th - at.anchor;
      by_global(4, 4) = 1.0;
      close_node_[4][2] = radius_;
    } else {
      const Eigen::Vector2d across = t - at.slope * nu;
      residual[4] = z.f.dot(across);
      by_global(4, 2) = across.x();
      by_global(4, 3) = across.y();
      close_node_[4][2] = z.f.dot(nu + at.slope * t);
    }
  } else {
    residual[1] = z.f.x();
    by_global(1, 2) = 1.0;
    residual[4] = z.f.y();
    by_global(4, 3) = 1.0;
  }

  integral(2, 0);
  integral(2, 2);
  const double nx_end = z.n.x() - at.weight.x() * (length_ - z.begin) - z.f.x();
  residual[2] += x_begin + mount_axial_ * nx_end - at.span;
  by_global(2, 0) += 2.0 * mount_axial_;
  by_global(2, 2) -= mount_axial_;
  if (!at.slides) by_global(2, 5) += mount_axial_ * at.weight.x();
  if (at.slides) by_global(0, 5) = by_global(2, 5) = 1.0;
  integral(3, 1);
  integral(3, 3);

  if (at.slides) {
    residual[5] = at.feeding ? z.n.x() - at.feed_limit : z.place - at.begin;
    by_global(5, at.feeding ? 0 : 5) = 1.0;
  } else if (at.feeding) {
    const double c = std::cos(first[0]);
    const double s = std::sin(first[0]);
    const double N = z.n.x() * c + z.n.y() * s;
    const auto [EI, EI_slope] = law.stiffness(z.begin);
    const double by_N = 1.0 + N / axial_;
    residual[5] = N + 0.5 * N * N / axial_ + 0.5 * first[1] * first[1] / EI - at.feed_limit;
    by_global(5, 0) = by_N * c;
    by_global(5, 1) = by_N * s;
    by_global(5, 5) = -0.5 * first[1] * first[1] * EI_slope / (EI * EI);
    close_node_[5][0] = by_N * (-z.n.x() * s + z.n.y() * c);
    close_node_[5][1] = first[1] / EI;
  } else {
    residual[5] = z.begin - at.begin;
    by_global(5, 5) = 1.0;
  }
}

// Band elimination with row exchange, two rows below the diagonal; all right-hand sides at once.
bool Collocation::eliminate() {
  const std::size_t rows = band_.size();
  for (std::size_t j = 0; j < rows; ++j) {
    const std::size_t end = std::min(j + 3, rows);
    std::size_t pivot = j;
    for (std::size_t r = j + 1; r < end; ++r) {
      if (std::abs(band_[r][j + 2 - r]) > std::abs(band_[pivot][j + 2 - pivot])) pivot = r;
    }
    const double largest = band_[pivot][j + 2 - pivot];
    if (largest == 0.0 || !std::isfinite(largest)) return false;
    if (pivot != j) {
      // Row r keeps column j + k in place j + k + 2 - r.
      const std::size_t shift = pivot - j;
      std::array<double, 5> upper{};
      for (std::size_t k = 0; k < 5; ++k) upper[k] = band_[j][k + 2];
      for (std::size_t k = 0; k < 5; ++k) {
        band_[j][k + 2] = band_[pivot][k + 2 - shift];
        band_[pivot][k + 2 - shift] = upper[k];
      }
      std::swap(columns_[j], columns_[pivot]);
    }
    const double inverse = 1.0 / band_[j][2];
    for (std::size_t r = j + 1; r < end; ++r) {
      const std::size_t shift = r - j;
      const double factor = band_[r][2 - shift] * inverse;
      if (factor == 0.0) continue;
      for (std::size_t k = 1; k < 5; ++k) band_[r][k + 2 - shift] -= factor * band_[j][k + 2];
      for (std::size_t c = 0; c < kColumns; ++c) columns_[r][c] -= factor * columns_[j][c];
    }
  }
  for (std::size_t j = rows; j-- > 0;) {
    Column& x = columns_[j];
    for (std::size_t k = 1; k < 5 && j + k < rows; ++k) {
      const double factor = band_[j][k + 2];
      for (std::size_t c = 0; c < kColumns; ++c) x[c] -= factor * columns_[j + k][c];
    }
    const double inverse = 1.0 / band_[j][2];
    for (double& value : x) value *= inverse;
  }
  return true;
}

// With A du + P dq = -r and G_u du + G_q dq = -g: (G_q - G_u A^-1 P) dq = -(g - G_u A^-1 r). Returns the
// step's length in the unknowns' scales, negative where it has none.
double Collocation::apply(const Square& by_global, const Globals& residual, Unknowns& z) {
  std::array<Column, 4> arms{};
  for (std::size_t i = 0; i < nodes(); ++i) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t c = 0; c < kColumns; ++c) {
        arms[a][c] += arm_[i][a][0] * columns_[2 * i][c] + arm_[i][a][1] * columns_[2 * i + 1][c];
      }
    }
  }
  const std::array<std::size_t, 6> ends{0, 1, 2 * left_, 2 * left_ + 1, band_.size() - 2, band_.size() - 1};
  Square matrix = by_global;
  Globals right = -residual;
  for (std::size_t row = 0; row < kGlobals; ++row) {
    Column product{};
    for (std::size_t a = 0; a < 4; ++a) {
      if (close_arm_[row][a] == 0.0) continue;
      for (std::size_t c = 0; c < kColumns; ++c) product[c] += close_arm_[row][a] * arms[a][c];
    }
    for (std::size_t k = 0; k < ends.size(); ++k) {
      if (close_node_[row][k] == 0.0) continue;
      for (std::size_t c = 0; c < kColumns; ++c) product[c] += close_node_[row][k] * columns_[ends[k]][c];
    }
    const auto r = static_cast<Eigen::Index>(row);
    for (std::size_t c = 0; c < kGlobals; ++c) matrix(r, static_cast<Eigen::Index>(c)) -= product[c];
    right[r] += product[kGlobals];
  }
  const Globals dq = matrix.partialPivLu().solve(right);
  if (!dq.allFinite()) return -1.0;

  double turn = 0.0;
  double size = 0.0;
  for (std::size_t row = 0; row < band_.size(); ++row) {
    Column& column = columns_[row];
    double change = -column[kGlobals];
    for (std::size_t c = 0; c < kGlobals; ++c) change -= column[c] * dq[static_cast<Eigen::Index>(c)];
    column[kGlobals] = change;
    if (row % 2 == 0) {
      turn = std::max(turn, std::abs(change));
    } else {
      size = std::max(size, std::abs(change) / moment_scale_);
    }
  }
  const double forces = std::max({force_scale_, z.n.norm(), z.f.norm()});
  size = std::max({size, turn, dq.head<4>().lpNorm<Eigen::Infinity>() / forces,
                   dq.tail<2>().lpNorm<Eigen::Infinity>() / length_});
  if (!std::isfinite(size)) return -1.0;
  const double part = std::min(1.0, kTurn / std::max(turn, 1e-300));
  for (std::size_t i = 0; i < nodes(); ++i) {
    z.section[i][0] += part * columns_[2 * i][kGlobals];
    z.section[i][1] += part * columns_[2 * i + 1][kGlobals];
  }
  z.n += part * dq.segment<2>(0);
  z.f += part * dq.segment<2>(2);
  z.contact += part * dq[4];
  (slides_ ? z.place : z.begin) += part * dq[5];
  return size;
}

bool Collocation::solve(const Section& law, const Conditions& at, Unknowns& z) {
  Square by_global;
  Globals residual;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    assemble(law, at, z);
    slides_ = at.slides;
    if (slides_) {
      // The sixth global moves nothing inside the wire.
      for (Column& column : columns_) column[5] = 0.0;
      for (Column& column : arm_global_) column[5] = 0.0;
    }
    close(law, at, z, by_global, residual);
    if (!eliminate()) return false;
    const double size = apply(by_global, residual, z);
    if (size < 0.0) return false;
    if (z.contact <= z.begin + 0.01 * length_ || z.contact >= 0.99 * length_) return false;
    if (size < (at.touching ? kTolerance : kTightTolerance)) return true;
  }
  return false;
}

// th and M between the nodes by the cubic of their values and slopes, which is the collocation's own.
void Collocation::remember(Section& law, const Conditions& at, const Unknowns& z) const {
  std::size_t node = 0;
  const auto rates = [&](const std::array<double, 2>& u, double S, bool right, double guess) {
    const Eigen::Vector2d n = z.n - at.weight * (S - z.begin) - (right ? z.f : Eigen::Vector2d::Zero());
    const Eigen::Vector2d t(std::cos(u[0]), std::sin(u[0]));
    const double strain = law.stretch(n.dot(t), S, at.rate).strain;
    return std::array<double, 2>{law.bend(u[1], S, at.rate, guess).strain,
                                 -(1.0 + strain) * (-n.x() * t.y() + n.y() * t.x())};
  };
  struct Sample {
    std::size_t point;
    double M;
    double N;
  };
  std::vector<Sample> samples;
  samples.reserve(law.points());
  std::size_t prepared = nodes();
  std::array<double, 2> rate_a{};
  std::array<double, 2> rate_b{};
  for (std::size_t j = 0; j < law.points(); ++j) {
    const double S = law.coordinate(j);
    if (S < z.begin || S > length_ * (1.0 + 1e-12)) continue;
    while (node + 2 < nodes() && coordinate(z, node + 1) < S) ++node;
    const bool right = node >= left_;
    const double a = right && node == left_ ? z.contact : coordinate(z, node);
    const double b = coordinate(z, node + 1);
    const auto& ua = z.section[node];
    const auto& ub = z.section[node + 1];
    if (prepared != node) {
      rate_a = rates(ua, a, right, guess_[2 * node]);
      rate_b = rates(ub, b, right, guess_[2 * node + 2]);
      prepared = node;
    }
    const double h = b - a;
    const double x = (S - a) / h;
    const auto cubic = [&](std::size_t k) {
      const double change = ub[k] - ua[k];
      const double p = h * rate_a[k] - change;
      const double q = -h * rate_b[k] + change;
      return ua[k] + x * change + x * (1.0 - x) * ((1.0 - x) * p + x * q);
    };
    const double th = cubic(0);
    const Eigen::Vector2d n = z.n - at.weight * (S - z.begin) - (right ? z.f : Eigen::Vector2d::Zero());
    samples.push_back({j, cubic(1), n.x() * std::cos(th) + n.y() * std::sin(th)});
  }
  for (const Sample& s : samples) law.remember(s.point, s.M, s.N, at.rate);
}

}  // namespace snare::validation::blind
