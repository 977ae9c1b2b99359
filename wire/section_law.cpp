#include "wire/section_law.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace snare::wire {

SectionResponse respond(double elastic, const std::vector<SliderElement>& elements, double strain,
                        const double* slipped) {
  SectionResponse r{elastic * strain, elastic, 0.5 * elastic * strain * strain};
  for (std::size_t j = 0; j < elements.size(); ++j) {
    const auto [k, limit] = elements[j];
    const double own = strain - (slipped == nullptr ? 0.0 : slipped[j]);
    const double held = std::clamp(own, -limit, limit);
    r.resultant += k * held;
    r.energy += 0.5 * k * held * held + k * limit * std::abs(own - held);
    if (own == held) r.tangent += k;
  }
  return r;
}

void slide(const std::vector<SliderElement>& elements, double strain, double* slipped) {
  for (std::size_t j = 0; j < elements.size(); ++j) {
    const double limit = elements[j].slip_strain;
    slipped[j] = strain - std::clamp(strain - slipped[j], -limit, limit);
  }
}

std::vector<SliderElement> yielding_section(double bending_stiffness, double diameter, double yield_strain,
                                            double hardening) {
  assert(diameter > 0.0 && yield_strain > 0.0 && hardening > 0.0 && hardening < 1.0);
  // I = int 2 y^2 sqrt(r^2 - y^2) dy over (-r, r); with y = r sin a, a in (0, pi/2), a pair of fibres carries
  //   dI = 4 r^4 sin^2 a cos^2 a da = r^4 sin^2(2 a) da:
  // the midpoint rule in a is exact for it from three points on, and crowds the fibres at the surface.
  constexpr int fibres = 8;
  std::vector<SliderElement> elements;
  for (int i = 0; i < fibres; ++i) {
    const double a = (i + 0.5) / fibres * 0.5 * std::numbers::pi;
    const double share = 2.0 / fibres * std::pow(std::sin(2.0 * a), 2);
    const double y = 0.5 * diameter * std::sin(a);
    elements.push_back({(1.0 - hardening) * bending_stiffness * share, yield_strain / y});
  }
  return elements;
}

std::vector<SliderElement> strand_sliders(const StrandFriction& friction) {
  if (!(friction.breadth > 0.0)) return {{friction.extra_stiffness, friction.slip_curvature}};
  constexpr int shares = 10;
  std::vector<SliderElement> elements;
  for (int i = 0; i < shares; ++i) {
    const double at = 2.0 * (i + 0.5) / shares - 1.0;
    elements.push_back(
        {friction.extra_stiffness / shares, friction.slip_curvature * std::exp(friction.breadth * at)});
  }
  return elements;
}

std::vector<double> carried_over(const MaterialMesh& mesh, const std::vector<double>& values, int components,
                                 bool of_edges, const Controls& from, const Controls& to) {
  if (from == to || values.empty()) return values;
  const int count = of_edges ? mesh.edges() : mesh.vertices();
  const auto place = [&](int i, const Controls& controls) {
    return of_edges ? 0.5 * (mesh.coordinate(i, controls) + mesh.coordinate(i + 1, controls))
                    : mesh.coordinate(i, controls);
  };
  std::vector<double> result(values.size(), 0.0);
  int j = 0;
  for (int i = 0; i < count; ++i) {
    const double s = place(i, to);
    if (s < from.left || s > from.right) continue;  // new material
    while (j < count - 2 && place(j + 1, from) < s) ++j;
    const double a = place(j, from);
    const double part = std::clamp((s - a) / (place(j + 1, from) - a), 0.0, 1.0);
    for (int c = 0; c < components; ++c) {
      const double left = values[static_cast<std::size_t>(j * components + c)];
      const double right = values[static_cast<std::size_t>((j + 1) * components + c)];
      result[static_cast<std::size_t>(i * components + c)] = (1.0 - part) * left + part * right;
    }
  }
  return result;
}

}  // namespace snare::wire
