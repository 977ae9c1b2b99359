#pragma once

#include "study/design.hpp"
#include "study/proportion.hpp"
#include "study/sobol_indices.hpp"
#include "study/subset.hpp"

#include <boost/math/distributions/chi_squared.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

/// Functions with closed-form probabilities and Sobol indices, and how often the intervals of studies of them
/// hold.
namespace snare::benchmarks {

/// An event margin >= 0 of independent standard normal scores.
struct LimitFunction {
  std::string name;
  std::size_t dimension = 1;
  double probability = 0.0;
  std::function<double(const std::vector<double>&)> margin;
};

/// Planes in 2 and 10 dimensions, the outside of a sphere in 10, two opposite planes in 5, each with this
/// probability.
inline std::vector<LimitFunction> limit_functions(double probability) {
  const double plane = -study::normal_quantile(probability);
  const double two_planes = -study::normal_quantile(0.5 * probability);
  const auto of_sum = [plane](const std::vector<double>& z) {
    double sum = 0.0;
    for (const double one : z) sum += one;
    return sum / std::sqrt(static_cast<double>(z.size())) - plane;
  };
  constexpr double dimension = 10.0;
  const double square =
      boost::math::quantile(boost::math::complement(boost::math::chi_squared(dimension), probability));
  const auto of_radius = [square](const std::vector<double>& z) {
    double sum = 0.0;
    for (const double one : z) sum += one * one;
    return sum - square;
  };
  return {{"plane, 2 variables", 2, probability, of_sum},
          {"plane, 10 variables", 10, probability, of_sum},
          {"sphere, 10 variables", 10, probability, of_radius},
          {"two planes, 5 variables", 5, probability,
           [two_planes](const std::vector<double>& z) { return std::abs(z[0]) - two_planes; }}};
}

/// The same event seen only as yes or no.
inline LimitFunction yes_or_no(LimitFunction limit) {
  limit.name += ", yes or no";
  limit.margin = [margin = limit.margin](const std::vector<double>& z) {
    return margin(z) >= 0.0 ? 0.5 : -0.5;
  };
  return limit;
}

inline study::SubsetSimulation simulated(const LimitFunction& limit, std::uint64_t cases,
                                         std::uint64_t seed) {
  study::SubsetSimulation simulation({.dimension = limit.dimension, .cases = cases, .seed = seed});
  while (!simulation.finished()) {
    std::vector<std::optional<double>> margins;
    for (const std::vector<double>& z : simulation.next()) margins.emplace_back(limit.margin(z));
    simulation.tell(margins);
  }
  return simulation;
}

/// Seeds of studies: `count` of them from `first` on, both >= 1.
struct Seeds {
  int first = 1;
  int count = 400;
  [[nodiscard]] int end() const { return first + count; }
};

/// How many of so many studies have the truth in an interval, and how many gave one at all.
struct Coverage {
  int held = 0;
  int studies = 0;
  void add(bool holds) {
    held += holds ? 1 : 0;
    ++studies;
  }
  [[nodiscard]] double share() const { return static_cast<double>(held) / static_cast<double>(studies); }
};

inline bool contains(const study::ProbabilityInterval& interval, double probability) {
  return interval.low <= probability && probability <= interval.high;
}

/// Subset simulations.
inline Coverage subset_coverage(const LimitFunction& limit, std::uint64_t cases, const Seeds& seeds) {
  Coverage coverage;
  for (int seed = seeds.first; seed < seeds.end(); ++seed)
    coverage.add(
        contains(simulated(limit, cases, static_cast<std::uint64_t>(seed)).interval(), limit.probability));
  return coverage;
}

/// The share of hits of a design of independent standard normal variables.
inline Coverage share_coverage(const LimitFunction& limit, study::DesignKind kind, std::uint64_t cases,
                               const Seeds& seeds) {
  Coverage coverage;
  std::vector<study::Variable> variables;
  for (std::size_t j = 0; j < limit.dimension; ++j)
    variables.push_back({"z", {"z"}, {}, {study::Distribution::Shape::normal, 0.0, 1.0}});
  for (int seed = seeds.first; seed < seeds.end(); ++seed) {
    const study::Design design(variables,
                               {.kind = kind, .cases = cases, .seed = static_cast<std::uint64_t>(seed)});
    std::uint64_t hits = 0;
    for (std::uint64_t k = 0; k < cases; ++k) hits += limit.margin(design.values(k)) >= 0.0 ? 1 : 0;
    coverage.add(contains(study::proportion_interval(hits, cases), limit.probability));
  }
  return coverage;
}

/// A function of uniform numbers in (0, 1) with its indices.
struct IndexFunction {
  std::string name;
  std::vector<double> first, total;
  std::function<double(const std::vector<double>&)> value;
};

/// Ishigami, Homma 1990, a = 7, b = 0.1.
inline IndexFunction ishigami() {
  constexpr double pi = std::numbers::pi, a = 7.0, b = 0.1;
  const double v1 = 0.5 * std::pow(1.0 + b * std::pow(pi, 4) / 5.0, 2);
  const double v2 = a * a / 8.0;
  const double v13 = b * b * std::pow(pi, 8) * (1.0 / 18.0 - 1.0 / 50.0);
  const double v = v1 + v2 + v13;
  return {
      "Ishigami", {v1 / v, v2 / v, 0.0}, {(v1 + v13) / v, v2 / v, v13 / v}, [](const std::vector<double>& u) {
        const auto x = [&u](std::size_t j) { return std::numbers::pi * (2.0 * u[j] - 1.0); };
        const double s = std::sin(x(1));
        return std::sin(x(0)) + 7.0 * s * s + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
      }};
}

/// Saltelli, Sobol' 1995: prod (|4u - 2| + a) / (1 + a); V_j = 1 / (3 (1 + a_j)^2).
inline IndexFunction g_function(const std::vector<double>& a) {
  IndexFunction g{"g-function", {}, {}, [a](const std::vector<double>& u) {
                    double product = 1.0;
                    for (std::size_t j = 0; j < a.size(); ++j)
                      product *= (std::abs(4.0 * u[j] - 2.0) + a[j]) / (1.0 + a[j]);
                    return product;
                  }};
  double all = 1.0;
  for (const double one : a) all *= 1.0 + 1.0 / (3.0 * (1.0 + one) * (1.0 + one));
  for (const double one : a) {
    const double v = 1.0 / (3.0 * (1.0 + one) * (1.0 + one));
    g.first.push_back(v / (all - 1.0));
    g.total.push_back(v * (all / (1.0 + v)) / (all - 1.0));
  }
  return g;
}

/// Yes where all variables are below q = P^(1/n): V = P (1 - P), V_j = P^2 (1/q - 1), T_j = P (1 - q).
inline IndexFunction box(double probability, std::size_t variables) {
  const double q = std::pow(probability, 1.0 / static_cast<double>(variables));
  const double variance = probability * (1.0 - probability);
  return {"yes in a box, P = " + std::to_string(probability),
          std::vector<double>(variables, probability * probability * (1.0 / q - 1.0) / variance),
          std::vector<double>(variables, probability * (1.0 - q) / variance),
          [q](const std::vector<double>& u) {
            for (const double one : u)
              if (one >= q) return 0.0;
            return 1.0;
          }};
}

inline study::SobolIndices indices_of(const IndexFunction& f, std::uint64_t rows, std::uint64_t seed) {
  std::vector<study::Variable> variables;
  for (std::size_t j = 0; j < f.first.size(); ++j) variables.push_back({"u", {"u"}, {}, {}});
  const study::Design design(variables,
                             {.kind = study::DesignKind::sensitivity, .cases = rows, .seed = seed});
  return study::sobol_indices(variables.size(), rows,
                              [&](std::uint64_t k) { return f.value(design.values(k)); });
}

/// All first indices and all total indices of studies; studies without indices do not count.
struct IndexCoverage {
  Coverage first, total;
  double half = 0.0;  ///< mean half interval of the first indices
};
inline IndexCoverage index_coverage(const IndexFunction& f, std::uint64_t rows, const Seeds& seeds) {
  IndexCoverage coverage;
  constexpr double round_off = 1e-12;
  for (int seed = seeds.first; seed < seeds.end(); ++seed) {
    const study::SobolIndices found = indices_of(f, rows, static_cast<std::uint64_t>(seed));
    for (std::size_t j = 0; j < found.of.size(); ++j) {
      const study::SobolIndex& s = found.of[j];
      coverage.first.add(std::abs(s.first - f.first[j]) <= s.first_half + round_off);
      coverage.total.add(std::abs(s.total - f.total[j]) <= s.total_half + round_off);
      coverage.half += s.first_half;
    }
  }
  if (coverage.first.studies > 0) coverage.half /= coverage.first.studies;
  return coverage;
}

}  // namespace snare::benchmarks
