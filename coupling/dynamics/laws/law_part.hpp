#pragma once

#include "coupling/dynamics/contact/interaction.hpp"
#include "coupling/dynamics/joints/body_part.hpp"
#include "coupling/dynamics/model/result.hpp"

#include <vector>

namespace snare::coupling {

/// A law between a point of a body and a plane fixed in the world, in place of a wire.        theory.md (L.5)
///   d = n.(p_WP - p_0) - v_0 t,  d' = n.v_WP - v_0;  the body gets -F(d, d') n at P
/// It has no unknowns of its own and adds to the body's rows.
class LawPart final : public numerics::DaePart, public Interaction {
 public:
  LawPart(const PointContactLaw& spring, const BodyPart& body) : spring_(spring), body_(body) {}

  void declare(numerics::DaeLayout& layout) override;
  void sparsity(std::vector<std::pair<int, int>>& entries) const override;
  void attach_pattern(const numerics::SparseMatrix& pattern) override;
  void residual(const numerics::DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) override;
  void jacobian(const numerics::DaePoint& at, double c, std::vector<double>& values) override;
  /// The penetration: its zeros are where the law has its corner.
  [[nodiscard]] int event_count() const override { return 1; }
  void events(const numerics::DaePoint& at, std::span<double> values) override;

  /// What it does at a state: gap -d [m], force F n [N] on what stands for the wire, and its point on the
  /// body [m].
  [[nodiscard]] ContactSample sample(const numerics::DaePoint& at) const override;
  /// Energy of the law's spring [J], and power that its damping takes from body and plane [W], >= 0.
  struct Power {
    double energy = 0.0;
    double lost = 0.0;
  };
  [[nodiscard]] Power power(const numerics::DaePoint& at) const;

  void append(std::vector<numerics::DaePart*>& parts) override { parts.push_back(this); }
  [[nodiscard]] double energy(const numerics::DaePoint& at) const override { return power(at).energy; }
  [[nodiscard]] double law_loss(const numerics::DaePoint& at) const override { return power(at).lost; }
  void add_rates(const numerics::DaePoint& at, const IntegralRates& rates) const override;
  [[nodiscard]] Load load(const numerics::DaePoint& at) const override;
  [[nodiscard]] Observed observe(const numerics::DaePoint& now, double time_before,
                                 const Eigen::VectorXd& before) override;

 private:
  struct Geometry;
  [[nodiscard]] Geometry geometry(double time, const numerics::VectorView& y) const;

  PointContactLaw spring_;
  const BodyPart& body_;
  std::vector<int> slots_;  // of the body's rows v, w by its columns p, q, v, w, row by row
};

}  // namespace snare::coupling
