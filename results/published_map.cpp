#include "results/published_map.hpp"

#include "base/archive.hpp"
#include "identification/effects/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace snare::results {

using identification::Experiment;
using identification::FitRange;
using identification::FitRanges;
using identification::HypothesisMap;
using identification::MapCell;
using nlohmann::json;

namespace {

double rounded(double value, double unit) {
  return std::isfinite(value) ? std::round(value / unit) * unit : -1e9;
}

json ranges_mm(const FitRange& range) {
  json all = json::array();
  for (const double to : range.to) all.push_back(rounded(1e3 * to, 1e-3));
  return all;
}

/// Values as files show them, by key.
json shown_values(const identification::Model& model, const HypothesisMap& map,
                  const std::vector<double>& values) {
  json result = json::object();
  for (std::size_t j = 0; j < values.size(); ++j) {
    const identification::Parameter& p = identification::parameters().at(map.hypothesis.numbers[j].key);
    const bool shift = p.parametrisation == identification::Parametrisation::shift;
    result[p.key] = model.shown({&p, shift ? values[j] : std::log(values[j])});
  }
  return result;
}

json entry_of(const Experiment& experiment, const identification::Model& model, const FitRanges& ranges,
              const HypothesisMap& map, const std::optional<double>& p) {
  const MapCell& best = leading_cell(map, ranges);
  const FitRange& range = ranges.ranges()[best.range];
  json evidence = json::array(), to_mm = json::array();
  for (const double to : best.to) to_mm.push_back(1e3 * to);
  for (std::size_t r = 0; r < ranges.ranges().size(); ++r) evidence.push_back(json::array());
  for (const MapCell& c : map.cells) evidence[c.range].push_back(rounded(c.log_evidence, 0.01));
  return {{"model", map.hypothesis.name},
          {"meaning", map.hypothesis.meaning},
          {"family", map.hypothesis.family},
          {"numbers", map.hypothesis.numbers.size()},
          {"probability", map.probability},
          {"log_evidence", map.log_evidence},
          {"range", to_string(range.kind)},
          {"range_mm", 1e3 * *std::ranges::max_element(best.to)},
          {"to_mm", to_mm},
          {"readings", ranges.readings()[best.readings]},
          {"p", p ? json(*p) : json()},
          {"values", shown_values(model, map, best.values)},
          {"effective", std::isfinite(map.effective) ? json(map.effective) : json()},
          {"more_compliance_um_N", 1e6 * more_compliance(experiment, map.hypothesis, best.values)},
          {"by_range_and_readings", evidence}};
}

double probability(const json& entry) {
  return std::min(entry["probability"][0].get<double>(), entry["probability"][1].get<double>());
}

/// A family: its members by falling probability, and its own under both priors.
struct Family {
  std::vector<json> members;
  double probability[2] = {0.0, 0.0};
  [[nodiscard]] double least() const { return std::min(probability[0], probability[1]); }
};

Family leading_family(const json& map) {
  std::map<std::string, Family> families;
  for (const json& entry : map["map"]) {
    Family& family = families[entry["family"].get<std::string>()];
    family.members.push_back(entry);
    for (std::size_t prior = 0; prior < 2; ++prior)
      family.probability[prior] += entry["probability"][prior].get<double>();
  }
  Family best;
  for (auto& [name, family] : families) {
    std::ranges::stable_sort(family.members, std::greater(), probability);
    if (best.members.empty() || family.least() > best.least()) best = family;
  }
  return best;
}

std::string percent(double share) {
  return share > 0.999 ? "more than 99.9 %" : fmt::format("{:.0f} %", 100.0 * share);
}

/// "something gives along the wire, by 27 micrometres a newton more than declared (24 to 38 with 95 %)"
std::string meaning_of(const json& map, const Family& family) {
  if (family.members.size() == 1) return family.members.front()["meaning"].get<std::string>();
  if (family.members.front()["family"] == identification::slips) return "the wire slips at a mount";
  const json& more = map["along_the_wire"]["more_compliance_um_N"];
  return fmt::format(
      "something gives along the wire, by {:.0f} micrometres a newton more than declared ({:.0f} to {:.0f} "
      "with 95 %)",
      more["median"].get<double>(), more["lower95"].get<double>(), more["upper95"].get<double>());
}

/// The members of a family with their least shares, those below 5 % together.
std::string members_of(const Family& family) {
  constexpr double counts = 0.05;
  std::vector<std::string> all;
  double others = 0.0;
  for (const json& m : family.members) {
    if (probability(m) >= counts * family.least())
      all.push_back(fmt::format("{} ({:.0f} %)", m["meaning"].get<std::string>(), 100.0 * probability(m)));
    else
      others += probability(m);
  }
  if (others > 0.005) all.push_back(fmt::format("others ({:.0f} %)", 100.0 * others));
  return fmt::format("{}", fmt::join(all, ", "));
}

/// Ranges and numbers of readings that most of the probability of a family rests on: "5.2 to 16 mm and 6 to
/// 45 readings".
std::string region_of(const json& map) {
  const json& region = map["region"];
  return fmt::format("{:.2g} to {:.2g} mm and {} to {} readings", region["range_mm"][0].get<double>(),
                     region["range_mm"][1].get<double>(), region["readings"][0].get<int>(),
                     region["readings"][1].get<int>());
}

/// The value below which a share of the weights lies. pairs: of a value and its weight, in any order, not
/// empty.
double quantile(std::vector<std::pair<double, double>> pairs, double share) {
  std::ranges::sort(pairs);
  double all = 0.0, below = 0.0;
  for (const auto& [value, weight] : pairs) all += weight;
  for (const auto& [value, weight] : pairs) {
    below += weight;
    if (below >= share * all) return value;
  }
  return pairs.back().first;
}

/// By how much more than declared wire and mounts give along the wire: median and the wider of the intervals
/// of both priors.
json compliance_of(const Experiment& experiment, const std::vector<HypothesisMap>& maps) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const HypothesisMap& m : maps) largest = std::max({largest, m.log_evidence[0], m.log_evidence[1]});
  double median = 0.0, lower = std::numeric_limits<double>::max(), upper = 0.0;
  for (int prior = 0; prior < 2; ++prior) {
    std::vector<std::pair<double, double>> weighted;
    for (const HypothesisMap& m : maps) {
      if (m.hypothesis.family != identification::along_the_wire) continue;
      for (const identification::PosteriorPoint& point : m.posterior)
        weighted.emplace_back(1e6 * more_compliance(experiment, m.hypothesis, point.values),
                              std::exp(point.log_weight[prior] - largest));
    }
    if (weighted.empty()) return nullptr;
    if (prior == 0) median = quantile(weighted, 0.5);
    lower = std::min(lower, quantile(weighted, 0.025));
    upper = std::max(upper, quantile(weighted, 0.975));
  }
  return {{"more_compliance_um_N", {{"median", median}, {"lower95", lower}, {"upper95", upper}}}};
}

/// How likely it is that a decimal point slipped in print, and in which series.
json decimal_point_of(const Experiment& experiment, const std::vector<HypothesisMap>& maps) {
  const auto least = std::ranges::min_element(
      experiment.series, {}, [](const identification::Series& s) { return std::abs(s.law->b); });
  double probability[2] = {0.0, 0.0};
  for (const HypothesisMap& m : maps)
    for (int prior = 0; prior < 2; ++prior)
      probability[prior] += m.hypothesis.decimal_point ? m.probability[prior] : 0.0;
  return {{"series", least->name}, {"probability", probability}};
}

/// Where the probability of a family lies: shares of the kinds of ranges, and 95 % of the common ranges and
/// of the numbers of readings.
json region_json(const FitRanges& ranges, const std::vector<HypothesisMap>& maps, const std::string& family) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const HypothesisMap& m : maps) largest = std::max(largest, m.log_evidence[0]);
  std::vector<std::pair<double, double>> to, readings;
  std::map<std::string, double> kinds;
  double all = 0.0;
  for (const HypothesisMap& m : maps) {
    if (m.hypothesis.family != family) continue;
    for (const MapCell& c : m.cells) {
      const double weight = std::exp(c.log_evidence + std::log(ranges.mass(c.range, false)) - largest);
      all += weight;
      kinds[to_string(ranges.ranges()[c.range].kind)] += weight;
      to.emplace_back(1e3 * *std::ranges::max_element(c.to), weight);
      readings.emplace_back(ranges.readings()[c.readings], weight);
    }
  }
  for (auto& [kind, weight] : kinds) weight /= all;
  return {{"family", family},
          {"kinds", kinds},
          {"range_mm", {quantile(to, 0.025), quantile(to, 0.975)}},
          {"readings", {std::lround(quantile(readings, 0.025)), std::lround(quantile(readings, 0.975))}}};
}

}  // namespace

std::string to_string(PublishedAnswer answer) {
  switch (answer) {
    case PublishedAnswer::explained:
      return "explained";
    case PublishedAnswer::most_likely:
      return "most_likely";
    case PublishedAnswer::none_of_these:
      return "none_of_these";
    case PublishedAnswer::cannot_tell:
      return "cannot_tell";
  }
  return "";
}

std::string published_inputs(const Experiment& experiment) {
  std::string all = "3;";  // of the method
  for (const identification::Series& s : experiment.series) {
    const coupling::PushProblem& t = s.test;
    all +=
        fmt::format("{},{},{},{},{},{},{},{},{},{},{};", t.contact_position, t.wire.length, t.wire.diameter,
                    t.wire.bending_stiffness(), t.wire.axial_stiffness(), static_cast<int>(t.mount.kind),
                    t.mount.span, t.pusher.radius, t.pusher.friction, static_cast<int>(t.pusher.direction),
                    identification::Model({s}, experiment.solver)
                        .declared(identification::parameters().at("mount_axial_compliance.compliance_m_N")));
    if (s.law)
      all += fmt::format("{},{},{},{},{};", s.law->force(0.0), s.law->force(1e-3), s.law->force(2e-3),
                         s.law->r_squared, s.law->r_squared_digits);
  }
  for (const identification::Hypothesis& h : identification::published_hypotheses()) {
    all += h.name;
    for (const identification::PriorNumber& n : h.numbers)
      all += fmt::format(",{},{},{}", n.key, n.lower, n.upper);
  }
  return fmt::format("{:016x}", base::fingerprint(all));
}

json published_map_json(const Experiment& experiment, const FitRanges& ranges,
                        const std::vector<HypothesisMap>& maps, const std::vector<std::optional<double>>& p,
                        bool coarse) {
  const identification::Model model(experiment.series, experiment.solver);
  json result{{"schema", "snare-published-map/1"},
              {"inputs", published_inputs(experiment)},
              {"coarse", coarse},
              {"readings", ranges.readings()},
              {"ranges", json::array()},
              {"map", json::array()}};
  for (const FitRange& r : ranges.ranges())
    result["ranges"].push_back({{"range", to_string(r.kind)}, {"to_mm", ranges_mm(r)}});
  for (std::size_t k = 0; k < maps.size(); ++k)
    result["map"].push_back(entry_of(experiment, model, ranges, maps[k], k < p.size() ? p[k] : std::nullopt));
  result["along_the_wire"] = compliance_of(experiment, maps);
  result["decimal_point"] = decimal_point_of(experiment, maps);
  const Family leading = leading_family(result);
  result["region"] = region_json(ranges, maps, leading.members.front()["family"].get<std::string>());
  return result;
}

PublishedVerdict published_verdict(const json& map) {
  const Family family = leading_family(map);
  PublishedVerdict verdict;
  const json& leading = family.members.front();
  verdict.leading = leading["model"].get<std::string>();
  bool any = false, all_rejected = true;
  for (const json& entry : map["map"]) {
    if (entry["p"].is_null()) continue;
    any = true;
    all_rejected = all_rejected && entry["p"].get<double>() < 0.01;
  }
  const json& p = leading["p"];
  if (any && all_rejected) {
    verdict.answer = PublishedAnswer::none_of_these;
  } else if (family.least() >= 0.95 && !p.is_null() && p.get<double>() >= 0.05) {
    verdict.answer = PublishedAnswer::explained;
  } else if (family.least() >= 0.5) {
    verdict.answer = PublishedAnswer::most_likely;
  }
  const std::string meaning = meaning_of(map, family);
  const std::string sure =
      fmt::format("probability {} among {} explanations, over all ranges and numbers of readings{}",
                  percent(family.least()), map["map"].size(),
                  p.is_null() ? "" : fmt::format(", p = {:.2g}", p.get<double>()));
  switch (verdict.answer) {
    case PublishedAnswer::explained:
      verdict.headline =
          fmt::format("The published fits agree with the declared wire if {}: {}.", meaning, sure);
      break;
    case PublishedAnswer::most_likely:
      verdict.headline = fmt::format("Most likely, {}: {}.", meaning, sure);
      break;
    case PublishedAnswer::none_of_these:
      verdict.headline =
          fmt::format("No explanation agrees with the published fits; the nearest is: {}.", meaning);
      break;
    case PublishedAnswer::cannot_tell:
      verdict.headline =
          fmt::format("The published fits cannot tell; the likeliest explanation is: {}: {}.", meaning, sure);
      break;
  }
  const double slipped = probability(map["decimal_point"]);
  const std::string misprint =
      slipped < 0.5 ? ""
                    : fmt::format("; in series {}, B is most likely printed a hundred times too small ({})",
                                  map["decimal_point"]["series"].get<std::string>(), percent(slipped));
  const std::string more = "the range of the test, its largest force or one raw reading would tell more";
  verdict.headline += family.members.size() > 1
                          ? fmt::format(" They cannot tell which of these it is: {}{}; {} ({} fit).",
                                        members_of(family), misprint, more, region_of(map))
                          : fmt::format(" They fit over {}{}; {}.", region_of(map), misprint, more);
  return verdict;
}

}  // namespace snare::results
