#include "results/published_map.hpp"

#include "base/archive.hpp"
#include "identification/effects/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

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
json shown_values(const identification::Model& model, const HypothesisMap& map, const std::vector<double>& values) {
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
  json evidence = json::array();
  for (std::size_t r = 0; r < ranges.ranges().size(); ++r) evidence.push_back(json::array());
  for (const MapCell& c : map.cells) evidence[c.range].push_back(rounded(c.log_evidence, 0.01));
  return {{"model", map.hypothesis.name},
          {"meaning", map.hypothesis.meaning},
          {"family", map.hypothesis.family},
          {"numbers", map.hypothesis.numbers.size()},
          {"probability", map.probability},
          {"log_evidence", map.log_evidence},
          {"range", to_string(range.kind)},
          {"range_mm", 1e3 * *std::ranges::max_element(range.to)},
          {"readings", ranges.readings()[best.readings]},
          {"p", p ? json(*p) : json()},
          {"values", shown_values(model, map, best.values)},
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

/// "something gives along the wire, 24 to 38 micrometres a newton more than declared"
std::string meaning_of(const Family& family) {
  if (family.members.size() == 1) return family.members.front()["meaning"].get<std::string>();
  double least = 1e9, most = 0.0;
  for (const json& m : family.members) {
    if (probability(m) < 0.02 * family.least()) continue;
    const auto more = m["more_compliance_um_N"].get<double>();
    least = std::min(least, more);
    most = std::max(most, more);
  }
  return fmt::format("something gives along the wire, by some {:.0f} to {:.0f} micrometres a newton more than declared",
                     least, most);
}

/// The members of a family that count; the sampling does not settle how they share its probability.
std::string members_of(const Family& family) {
  std::vector<std::string> all;
  for (const json& m : family.members)
    if (probability(m) >= 0.02 * family.least()) all.push_back(m["meaning"].get<std::string>());
  return fmt::format("{}", fmt::join(all, "; "));
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
  std::string all = "1;";  // of the method
  for (const identification::Series& s : experiment.series) {
    const coupling::PushProblem& t = s.test;
    all += fmt::format("{},{},{},{},{},{},{},{},{},{},{};", t.contact_position, t.wire.length, t.wire.diameter,
                       t.wire.bending_stiffness(), t.wire.axial_stiffness(), static_cast<int>(t.mount.kind),
                       t.mount.span, t.pusher.radius, t.pusher.friction, static_cast<int>(t.pusher.direction),
                       identification::Model({s}, experiment.solver)
                           .declared(identification::parameters().at("mount_axial_compliance.compliance_m_N")));
    if (s.law)
      all += fmt::format("{},{},{},{},{};", s.law->force(0.0), s.law->force(1e-3), s.law->force(2e-3), s.law->r_squared,
                         s.law->r_squared_digits);
  }
  for (const identification::Hypothesis& h : identification::published_hypotheses()) {
    all += h.name;
    for (const identification::PriorNumber& n : h.numbers) all += fmt::format(",{},{},{}", n.key, n.lower, n.upper);
  }
  return fmt::format("{:016x}", base::fingerprint(all));
}

json published_map_json(const Experiment& experiment, const FitRanges& ranges, const std::vector<HypothesisMap>& maps,
                        const std::vector<std::optional<double>>& p, bool coarse) {
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
  const std::string meaning = meaning_of(family);
  const std::string sure = fmt::format("probability {} among {} explanations, over all ranges and numbers of readings",
                                       percent(family.least()), map["map"].size());
  switch (verdict.answer) {
    case PublishedAnswer::explained:
      verdict.headline = fmt::format("The published fits agree with the declared wire if {} ({}).", meaning, sure);
      break;
    case PublishedAnswer::most_likely:
      verdict.headline = fmt::format("Most likely: {} ({}).", meaning, sure);
      break;
    case PublishedAnswer::none_of_these:
      verdict.headline = fmt::format("No explanation agrees with the published fits; the nearest is: {}.", meaning);
      break;
    case PublishedAnswer::cannot_tell:
      verdict.headline =
          fmt::format("The published fits cannot tell; the likeliest explanation is: {} ({}).", meaning, sure);
      break;
  }
  const std::string fits =
      fmt::format("range {:.1f} mm, {} readings", leading["range_mm"].get<double>(), leading["readings"].get<int>());
  if (family.members.size() > 1)
    verdict.headline += fmt::format(
        " They cannot tell which of these it is: {}; the range of the test, its largest force or one raw reading would "
        "tell more "
        "(the likeliest rests on: {}{}).",
        members_of(family), fits, p.is_null() ? "" : fmt::format(", p = {:.2g}", p.get<double>()));
  else
    verdict.headline +=
        fmt::format(" It rests on: {}{}.", fits, p.is_null() ? "" : fmt::format(", p = {:.2g}", p.get<double>()));
  return verdict;
}

}  // namespace snare::results
