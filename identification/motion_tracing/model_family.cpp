#include "identification/motion_tracing/model_family.hpp"

#include "identification/fitting/statistics.hpp"
#include "identification/motion_tracing/record_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::identification {

namespace {

/// Whether the records show a number: more than that it is not zero.
bool shown(const TracedNumber& n) {
  return n.lower && n.upper && half_width_95 * n.stderr_ < std::abs(n.value);
}

}  // namespace

std::vector<ModelFamily> fit_families(const RecordSet& set, const ChannelScales& scales,
                                      const std::vector<RecordSetting>& base,
                                      const std::function<bool(int iteration, double chi2)>& progress) {
  std::vector<ModelFamily> families;
  bool stop = false;
  for (const RecordFamily& family : set.families) {
    RecordSet other = set;
    for (const base::Override& one : family.set) other.set.push_back(one);
    const RecordModel model(other, [&stop] { return stop; });
    const std::vector<std::size_t> fitted = other.used(false);
    const RecordData data = record_data(other, fitted, scales);
    // The same numbers from where the base has led them; what the keys declare otherwise begins there.
    std::vector<RecordSetting> start = model.free_settings(fitted);
    for (RecordSetting& s : start)
      for (const RecordSetting& reached : base)
        if (reached.number.key == s.number.key && reached.number.declared == s.number.declared)
          s.value = reached.value;
    RecordFitOptions options;
    options.progress = [&](int iteration, double chi2) {
      stop = progress && !progress(iteration, chi2);
      return !stop;
    };
    const RecordFit fit = fit_motion(model, data, start, options);
    if (stop) return families;
    ModelFamily told;
    told.name = family.name;
    told.simulations = model.simulations();
    if (!fit.report.usable()) {
      told.failure = fit.report.message;
    } else {
      const RecordStage stage = record_stage(model, data, fit, nullptr, {});
      told.numbers = stage.numbers;
      told.chi2_dof = stage.chi2_dof;
    }
    families.push_back(std::move(told));
  }
  return families;
}

std::vector<std::string> family_differences(const std::vector<TracedNumber>& base,
                                            const std::vector<ModelFamily>& families) {
  std::vector<std::string> told;
  for (const ModelFamily& family : families) {
    if (!family.failure.empty())
      told.push_back(fmt::format("family {}: could not be fitted: {}", family.name, family.failure));
    for (const TracedNumber& there : family.numbers) {
      const auto here =
          std::find_if(base.begin(), base.end(), [&](const TracedNumber& n) { return n.key == there.key; });
      if (here == base.end() || !shown(*here) || !shown(there)) continue;
      if (there.value >= *here->lower && there.value <= *here->upper) continue;
      told.push_back(
          fmt::format("{} is {:.5g} {} [{:.5g}, {:.5g}], and {:.5g} with the models of family {}: a "
                      "systematic difference between models of {:.2g} %, which no interval holds",
                      here->key, here->value, here->unit, *here->lower, *here->upper, there.value,
                      family.name, 100.0 * (there.value / here->value - 1.0)));
    }
  }
  return told;
}

}  // namespace snare::identification
