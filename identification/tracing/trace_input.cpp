#include "identification/tracing/trace_input.hpp"

#include "base/errors.hpp"
#include "identification/tracing/model_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::identification {

bool replace_laws(std::vector<Series>& series) {
  bool any = false;
  for (Series& s : series) {
    if (s.readings || !s.law) continue;
    Readings r;
    r.displacement = s.test.travel;
    for (const double d : r.displacement) r.force.push_back(s.law->force(d));
    s.readings = std::move(r);
    any = true;
  }
  return any;
}

void check_readings(const std::filesystem::path& file, const std::vector<Series>& series,
                    const std::vector<bool>& heldout) {
  std::vector<base::InputProblem> problems;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const std::string key = "series[" + series[k].name + "]";
    const auto refuse = [&](const std::string& requirement) {
      problems.push_back({file.string(), 0, key, "", requirement});
    };
    if (!series[k].readings) {
      refuse("must have readings or a law to be fitted");
      continue;
    }
    if (heldout[k]) continue;
    const std::vector<double>& f = series[k].readings->force;
    const auto [low, high] = std::minmax_element(f.begin(), f.end());
    if (*low == *high) {
      refuse(fmt::format("force_N is {} in every reading: there is nothing to fit", *low));
      continue;
    }
    // A wire that is pushed answers with a force that goes with the travel: neighbouring readings are alike
    // (von Neumann 1941: the ratio is 2 +- 2/sqrt(n) for noise).
    double mean = 0.0;
    for (const double v : f) mean += v / static_cast<double>(f.size());
    double variance = 0.0;
    double steps = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      variance += (f[i] - mean) * (f[i] - mean);
      if (i > 0) steps += (f[i] - f[i - 1]) * (f[i] - f[i - 1]);
    }
    const double n = static_cast<double>(f.size());
    if (f.size() >= 8 && steps / variance > std::max(0.8, 2.0 - 6.0 / std::sqrt(n))) {
      const double largest = std::max(std::abs(*low), std::abs(*high));
      const auto at_the_top =
          std::ranges::count_if(f, [&](double v) { return std::abs(v) > 0.97 * largest; });
      if (2 * at_the_top > static_cast<std::ptrdiff_t>(f.size()))
        refuse(fmt::format(
            "force_N is about {:.3g} in {} of {} readings: the sensor is saturated, or the pusher did "
            "not move; leave those readings out",
            largest, at_the_top, f.size()));
      else
        refuse(
            "the forces do not follow the travel: the pusher never touched the wire, or the record is noise");
    }
  }
  if (!problems.empty()) throw base::InputError(problems);
}

Division::Division(const Experiment& experiment) : all(experiment.series) {
  from_laws = replace_laws(all);
  const std::vector<std::string>& names = experiment.heldout;
  for (const Series& s : all)
    is_heldout.push_back(std::find(names.begin(), names.end(), s.name) != names.end());
  check_readings(experiment.file, all, is_heldout);
  for (std::size_t k = 0; k < all.size(); ++k) (is_heldout[k] ? heldout : fitted).push_back(all[k]);
}

Data data_of(const std::vector<Series>& fitted, PublishedScatter scatter) {
  Data data;
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    data.series.push_back(k);
    data.measured.push_back(forces_of(fitted[k]));
  }
  data.noise = declared_noise(fitted, scatter);
  return data;
}

std::vector<std::string> default_free(const Experiment& experiment) {
  const bool supports = experiment.series.front().test.mount.kind == wire::MountKind::supports;
  // A wire that slides over supports is not stretched.
  if (supports) return {"wire.bending_stiffness_Nm2"};
  return {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N"};
}

}  // namespace snare::identification
