#include "coupling/contact/law_form.hpp"

#include "coupling/contact/tensioned_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace snare::coupling {

namespace {

using Eigen::VectorXd;

VectorXd vector(std::initializer_list<double> values) {
  VectorXd v(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), v.begin());
  return v;
}

/// A number that reads back to the same double, with a decimal point (3 would be an integer in C).
std::string digits(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return value < 0.0 ? "(" + text + ")" : text;
}

/// F = A d^2 + B d + C, by Horner's scheme.
class PolynomialLaw final : public SpringLaw {
 public:
  PolynomialLaw(double a, double b, double c) : a_(a), b_(b), c_(c) {}

  double force(double d) const override { return (a_ * d + b_) * d + c_; }
  double stiffness(double d) const override { return 2.0 * a_ * d + b_; }
  double curvature(double /*d*/) const override { return 2.0 * a_; }
  double energy(double d) const override {
    return a_ * std::pow(d, 3) / 3.0 + b_ * std::pow(d, 2) / 2.0 + c_ * d;
  }

 private:
  double a_, b_, c_;
};

/// Polynomials in the travel whose coefficients are the numbers, highest power first.
class Polynomial final : public LawForm {
 public:
  Polynomial(std::string name, std::vector<int> powers)
      : name_(std::move(name)), powers_(std::move(powers)) {}

  std::string name() const override { return name_; }
  std::string formula() const override {
    std::string text = "F =";
    for (std::size_t i = 0; i < powers_.size(); ++i) {
      const std::string letter = powers_.size() == 1 ? "k" : std::string(1, static_cast<char>('A' + i));
      text += (i == 0 ? " " : " + ") + letter + (powers_[i] == 2 ? " d^2" : powers_[i] == 1 ? " d" : "");
    }
    return text;
  }
  std::vector<LawParameter> parameters() const override {
    if (powers_.size() == 1) return {{"k", "N/m"}};
    std::vector<LawParameter> result;
    for (std::size_t i = 0; i < powers_.size(); ++i) {
      result.push_back({std::string(1, static_cast<char>('A' + i)), powers_[i] == 2   ? "N/m^2"
                                                                    : powers_[i] == 1 ? "N/m"
                                                                                      : "N"});
    }
    return result;
  }
  std::string expression(const VectorXd& p, const std::string&) const override {
    std::string text;
    for (std::size_t i = 0; i < powers_.size(); ++i) {
      text += (i == 0 ? "" : " + ") + digits(p[static_cast<Eigen::Index>(i)]) +
              (powers_[i] == 2   ? " * d * d"
               : powers_[i] == 1 ? " * d"
                                 : "");
    }
    return text;
  }
  SpringLawPointer with(const VectorXd& p) const override {
    std::array<double, 3> by_power{};
    for (std::size_t i = 0; i < powers_.size(); ++i)
      by_power[static_cast<std::size_t>(powers_[i])] = p[static_cast<Eigen::Index>(i)];
    return std::make_shared<PolynomialLaw>(by_power[2], by_power[1], by_power[0]);
  }
  // Linear in its numbers, F = p . dF/dp: a fit then sees the same columns in the force and in its Jacobian.
  double force(const VectorXd& p, double d) const override { return p.dot(by_parameters(p, d)); }
  VectorXd by_parameters(const VectorXd&, double d) const override {
    VectorXd g(static_cast<Eigen::Index>(powers_.size()));
    for (std::size_t i = 0; i < powers_.size(); ++i)
      g[static_cast<Eigen::Index>(i)] = std::pow(d, powers_[i]);
    return g;
  }
  std::vector<VectorXd> guesses(double, double) const override {
    return {VectorXd::Zero(static_cast<Eigen::Index>(powers_.size()))};
  }

 private:
  std::string name_;
  std::vector<int> powers_;
};

/// F = k d^p.
class PowerLaw final : public SpringLaw {
 public:
  PowerLaw(double k, double p) : k_(k), p_(p) {}

  double force(double d) const override { return k_ * std::pow(d, p_); }
  double stiffness(double d) const override { return k_ * p_ * std::pow(d, p_ - 1.0); }
  double curvature(double d) const override {
    return p_ == 1.0 ? 0.0 : k_ * p_ * (p_ - 1.0) * std::pow(d, p_ - 2.0);
  }
  double energy(double d) const override { return k_ * std::pow(d, p_ + 1.0) / (p_ + 1.0); }

 private:
  double k_, p_;
};

class Power final : public LawForm {
 public:
  std::string name() const override { return "power"; }
  std::string formula() const override { return "F = k d^p"; }
  std::vector<LawParameter> parameters() const override { return {{"k", "N/m^p"}, {"p", ""}}; }
  std::string expression(const VectorXd& p, const std::string& prefix) const override {
    return fmt::format("{} * {}pow(d, {})", digits(p[0]), prefix, digits(p[1]));
  }
  SpringLawPointer with(const VectorXd& p) const override { return std::make_shared<PowerLaw>(p[0], p[1]); }
  VectorXd by_parameters(const VectorXd& p, double d) const override {
    const double power = std::pow(d, p[1]);
    return vector({power, d > 0.0 ? p[0] * power * std::log(d) : 0.0});
  }
  std::vector<VectorXd> guesses(double force, double travel) const override {
    std::vector<VectorXd> result;
    for (int halves = 2; halves <= 8; ++halves) {
      const double p = 0.5 * halves;
      result.push_back(vector({force / std::pow(travel, p), p}));
    }
    return result;
  }
  // Below 1 the stiffness at first touch would be infinite.
  bool admissible(const VectorXd& p) const override { return p[1] >= 1.0 && p[1] < 20.0; }
};

/// Height at which a wire of this length is just taut over the span; 0 where it is no longer than the span.
double taut_height(const LawPlace& w) {
  if (w.length <= w.span) return 0.0;
  // On the ellipse about the mounts: y^2 = (1 - (x/A)^2) B^2, A = L/2, B^2 = A^2 - (l/2)^2, x from mid-span.
  const double a = 0.5 * w.length;
  const double x = w.position - 0.5 * w.span;
  return std::sqrt((1.0 - x * x / (a * a)) * (a * a - 0.25 * w.span * w.span));
}

/// Geometry of the two straight pieces at height y.
struct Pieces {
  double stretch = 0.0;  // (l1 + l2 - L)/L
  double lift = 0.0;     // d(l1 + l2)/dy = y/l1 + y/l2
  double bend = 0.0;     // d lift/dy
  double turn = 0.0;     // d bend/dy
};

Pieces pieces_at(const LawPlace& w, double y) {
  const double a = w.position;
  const double b = w.span - w.position;
  const double l1 = std::hypot(a, y);
  const double l2 = std::hypot(b, y);
  const double bend_1 = a * a / (l1 * l1 * l1), bend_2 = b * b / (l2 * l2 * l2);
  return {(l1 + l2 - w.length) / w.length, y / l1 + y / l2, bend_1 + bend_2,
          -3.0 * y * (bend_1 / (l1 * l1) + bend_2 / (l2 * l2))};
}

/// F = K (l1 + l2 - L)/L (y/l1 + y/l2) at the height y = q + d - d0, 0 while slack; q the taut height.
/// It is the gradient of the energy K L/2 ((l1 + l2 - L)/L)^2.
class StretchedLaw final : public SpringLaw {
 public:
  StretchedLaw(const LawPlace& place, double taut, double axial_stiffness, double free_travel)
      : place_(place), taut_(taut), k_(axial_stiffness), free_travel_(free_travel) {}

  double force(double d) const override {
    const Pieces now = pieces(d);
    return now.stretch > 0.0 ? k_ * now.stretch * now.lift : 0.0;
  }
  double stiffness(double d) const override {
    const Pieces now = pieces(d);
    return now.stretch > 0.0 ? k_ * (now.lift * now.lift / place_.length + now.stretch * now.bend) : 0.0;
  }
  double curvature(double d) const override {
    const Pieces now = pieces(d);
    return now.stretch > 0.0 ? k_ * (3.0 * now.lift * now.bend / place_.length + now.stretch * now.turn)
                             : 0.0;
  }
  double energy(double d) const override { return stored(d) - stored(0.0); }

 private:
  [[nodiscard]] Pieces pieces(double d) const { return pieces_at(place_, taut_ + d - free_travel_); }
  [[nodiscard]] double stored(double d) const {
    const Pieces now = pieces(d);
    return now.stretch > 0.0 ? 0.5 * k_ * place_.length * now.stretch * now.stretch : 0.0;
  }

  LawPlace place_;
  double taut_, k_, free_travel_;
};

/// Numbers K (axial stiffness [N]) and d0 (free travel [m]).
class Stretched final : public LawForm {
 public:
  explicit Stretched(const LawPlace& place) : place_(place), height_(taut_height(place)) {}

  std::string name() const override { return "stretched_wire"; }
  std::string formula() const override {
    return "F = K (l1 + l2 - L)/L (y/l1 + y/l2), y = q + d - d0, 0 while slack";
  }
  std::vector<LawParameter> parameters() const override { return {{"K", "N"}, {"d0", "m"}}; }
  std::string expression(const VectorXd& p, const std::string& prefix) const override {
    // Written with y = y0 + d; slack below the taut height.
    const std::string y = fmt::format("({} + d)", digits(height_ - p[1]));
    const auto length = [&](double side) {
      return fmt::format("{}sqrt({} + {} * {})", prefix, digits(side * side), y, y);
    };
    const std::string l1 = length(place_.position);
    const std::string l2 = length(place_.span - place_.position);
    const std::string strain =
        fmt::format("({} + {} - {}) / {}", l1, l2, digits(place_.length), digits(place_.length));
    return fmt::format("{} * 0.5 * ({} + {}fabs({})) * ({} / {} + {} / {})", digits(p[0]), strain, prefix,
                       strain, y, l1, y, l2);
  }
  SpringLawPointer with(const VectorXd& p) const override {
    return std::make_shared<StretchedLaw>(place_, height_, p[0], p[1]);
  }
  VectorXd by_parameters(const VectorXd& p, double d) const override {
    return vector({force(p, d) / p[0], -stiffness(p, d)});
  }
  std::vector<VectorXd> guesses(double force_scale, double travel) const override {
    std::vector<VectorXd> result;
    for (int tenths = 0; tenths <= 8; ++tenths) {
      const double share = 0.1 * tenths;
      const double unit = force(vector({1.0, share * travel}), travel);
      if (unit > 0.0) result.push_back(vector({force_scale / unit, share * travel}));
    }
    return result;
  }
  // Not so far that the taut wire would hang on the other side of the chord.
  bool admissible(const VectorXd& p) const override {
    return p[0] > 0.0 && p[1] <= std::max(height_, 1e-3 * place_.span);
  }

 private:
  LawPlace place_;
  double height_;  // q, at which the wire is just taut [m]
};

/// F = k max(0, d - d0).
class TautLinearLaw final : public SpringLaw {
 public:
  TautLinearLaw(double k, double free_travel) : k_(k), free_travel_(free_travel) {}

  double force(double d) const override { return k_ * std::max(0.0, d - free_travel_); }
  double stiffness(double d) const override { return d > free_travel_ ? k_ : 0.0; }
  double curvature(double /*d*/) const override { return 0.0; }
  double energy(double d) const override { return stored(d) - stored(0.0); }

 private:
  [[nodiscard]] double stored(double d) const {
    return 0.5 * k_ * std::pow(std::max(0.0, d - free_travel_), 2);
  }

  double k_, free_travel_;
};

/// The tangent at the taut height; straight wires have none, and their law begins with the chord.
class StretchedLinear final : public LawForm {
 public:
  explicit StretchedLinear(const LawPlace& place) {
    const Pieces taut = pieces_at(place, taut_height(place));
    unit_ = taut.lift * taut.lift / place.length + std::max(0.0, taut.stretch) * taut.bend;
  }
  std::string name() const override { return "stretched_wire_linear"; }
  std::string formula() const override { return "F = K (q/l1 + q/l2)^2/L (d - d0), 0 while slack"; }
  std::vector<LawParameter> parameters() const override { return {{"K", "N"}, {"d0", "m"}}; }
  std::string expression(const VectorXd& p, const std::string& prefix) const override {
    const std::string x = fmt::format("(d - {})", digits(p[1]));
    return fmt::format("{} * 0.5 * ({} + {}fabs({}))", digits(p[0] * unit_), x, prefix, x);
  }
  SpringLawPointer with(const VectorXd& p) const override {
    return std::make_shared<TautLinearLaw>(p[0] * unit_, p[1]);
  }
  VectorXd by_parameters(const VectorXd& p, double d) const override {
    return vector({unit_ * std::max(0.0, d - p[1]), -stiffness(p, d)});
  }
  std::vector<VectorXd> guesses(double force_scale, double travel) const override {
    std::vector<VectorXd> result;
    if (unit_ <= 0.0) return result;
    for (int tenths = 0; tenths <= 8; ++tenths) {
      const double share = 0.1 * tenths;
      result.push_back(vector({force_scale / (unit_ * (1.0 - share) * travel), share * travel}));
    }
    return result;
  }
  bool admissible(const VectorXd& p) const override { return p[0] > 0.0; }

 private:
  double unit_ = 0.0;  // stiffness at K = 1 [1/m]
};

class Tensioned final : public LawForm {
 public:
  explicit Tensioned(const LawPlace& place) : place_(place) {}

  std::string name() const override { return "tensioned_wire"; }
  std::string formula() const override { return "F = k(EI, T, s) d, clamped-clamped under the tension T"; }
  std::vector<LawParameter> parameters() const override { return {{"T", "N"}}; }
  std::string expression(const VectorXd& p, const std::string&) const override {
    return digits(at(p).value) + " * d";
  }
  SpringLawPointer with(const VectorXd& p) const override {
    return std::make_shared<PolynomialLaw>(0.0, at(p).value, 0.0);
  }
  VectorXd by_parameters(const VectorXd& p, double d) const override {
    return vector({at(p).by_tension * d});
  }
  std::vector<VectorXd> guesses(double force_scale, double travel) const override {
    const double s = place_.position;
    const double string =
        force_scale / travel * s * (place_.span - s) / place_.span;  // tension of a string as stiff
    return {vector({0.0}), vector({0.3 * string}), vector({string})};
  }
  bool admissible(const VectorXd& p) const override {
    return p[0] > -39.4 * place_.bending_stiffness / (place_.span * place_.span);  // buckling, 4 pi^2 EI/l^2
  }

 private:
  [[nodiscard]] TensionedStiffness at(const VectorXd& p) const {
    return tensioned_stiffness(place_.bending_stiffness, p[0], place_.span, place_.position);
  }
  LawPlace place_;
};

}  // namespace

LawFormPointer quadratic_law() {
  return std::make_shared<Polynomial>("quadratic", std::vector<int>{2, 1, 0});
}
LawFormPointer quadratic_through_origin() {
  return std::make_shared<Polynomial>("quadratic_through_origin", std::vector<int>{2, 1});
}
LawFormPointer linear_law() {
  return std::make_shared<Polynomial>("linear", std::vector<int>{1});
}
LawFormPointer power_law() {
  return std::make_shared<Power>();
}
LawFormPointer stretched_wire_law(const LawPlace& place) {
  return std::make_shared<Stretched>(place);
}
LawFormPointer stretched_wire_linearised(const LawPlace& place) {
  return std::make_shared<StretchedLinear>(place);
}
LawFormPointer tensioned_wire_law(const LawPlace& place) {
  return std::make_shared<Tensioned>(place);
}

std::vector<LawFormPointer> law_forms(const LawPlace& place) {
  return {quadratic_law(),
          quadratic_through_origin(),
          linear_law(),
          power_law(),
          stretched_wire_law(place),
          stretched_wire_linearised(place),
          tensioned_wire_law(place)};
}

}  // namespace snare::coupling
