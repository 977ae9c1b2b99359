#include "results/sweep_answers.hpp"

#include "results/finite_json.hpp"
#include "results/version.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace snare::results {

namespace {

using nlohmann::json;
using study::CaseRecord;
using study::DesignKind;

constexpr std::size_t plotted_variables = 4;
constexpr std::size_t plotted_fields = 6;
constexpr std::uint64_t scatter_points = 1000;
constexpr std::size_t map_bins = 12;
constexpr std::size_t worst_of_each = 5;

/// A case that was not run: the field by which the grid is refined, or why its neighbours have none.
CaseRecord inferred_record(const SweepStudy& study, const study::Seen& seen) {
  CaseRecord record{CaseRecord::inferred_status, "", 0.0, {}, {}};
  const json value = seen.word.empty() ? json(seen.number) : json::parse(seen.word, nullptr, false);
  if (value.is_discarded()) {
    record.reason = "around it: " + seen.word;
    return record;
  }
  record.fields.resize(study.sweep().collect.size());
  record.fields[study.sweep().refine->field] = value;
  return record;
}

/// The cases that were run or are inferred, in order.
template <class Use>
void for_each_case(const SweepStudy& study, const SweepCases& cases, const Use& use) {
  const std::uint64_t end =
      cases.refined != nullptr ? cases.count : std::min(cases.count, cases.journal.end());
  for (std::uint64_t index = 0; index < end; ++index) {
    if (const std::optional<std::string> line = cases.journal.result(index)) {
      if (const std::optional<CaseRecord> record = study::record_of(*line)) use(index, *record);
    } else if (const auto seen = cases.refined != nullptr ? cases.refined->inferred(index) : std::nullopt) {
      use(index, inferred_record(study, *seen));
    }
  }
}

/// What a map or a scatter is made of: a field, or a limit of one.
struct Quantity {
  std::string name;
  std::size_t field = 0;
  const study::Limit* limit = nullptr;
  bool share = false;

  [[nodiscard]] std::optional<double> of(const CaseRecord& record) const {
    const std::optional<double> value = record.number(field);
    if (!value || limit == nullptr) return value;
    return (limit->above ? *value > limit->bound : *value < limit->bound) ? 1.0 : 0.0;
  }
};

/// Cells of an axis: one a level in a grid, else of equal width over what the cases have.
std::vector<double> edges_of(std::vector<double> places, bool levels) {
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<double> edges;
  if (levels && places.size() > 1) {
    edges.push_back(places[0] - 0.5 * (places[1] - places[0]));
    for (std::size_t k = 0; k + 1 < places.size(); ++k) edges.push_back(0.5 * (places[k] + places[k + 1]));
    edges.push_back(places.back() + 0.5 * (places.back() - places[places.size() - 2]));
    return edges;
  }
  for (std::size_t k = 0; k <= map_bins; ++k)
    edges.push_back(places.front() + static_cast<double>(k) / static_cast<double>(map_bins) *
                                         (places.back() - places.front()));
  return edges;
}

std::size_t cell_of(const std::vector<double>& edges, double x) {
  const auto after = std::upper_bound(edges.begin() + 1, edges.end() - 1, x);
  return static_cast<std::size_t>(after - edges.begin()) - 1;
}

/// Which cases are the farthest out for a field.
class Worst {
 public:
  Worst(std::string words, double sign) : words_(std::move(words)), sign_(sign) {}
  void add(std::uint64_t index, double value, const std::vector<double>& values) {
    if (found_.size() == worst_of_each && sign_ * value <= sign_ * found_.back().value) return;
    found_.push_back({value, index, values});
    std::ranges::stable_sort(
        found_, [this](const One& a, const One& b) { return sign_ * a.value > sign_ * b.value; });
    if (found_.size() > worst_of_each) found_.pop_back();
  }
  void append_to(std::vector<CaseAnswer>& list, const SweepStudy& study) const {
    for (const One& one : found_)
      list.push_back(
          {one.index + 1, fmt::format("{}: {:.6g}", words_, one.value), study.command_of(one.values)});
  }

 private:
  struct One {
    double value;
    std::uint64_t index;
    std::vector<double> values;
  };
  std::string words_;
  double sign_;
  std::vector<One> found_;
};

void finish(FieldAnswer& field) {
  std::ranges::sort(field.sample);
  if (field.count == 0) field.yes_or_no = false;
}

std::vector<Quantity> quantities_of(const study::SweepFile& sweep, const SweepAnswers& answers) {
  std::vector<Quantity> all;
  for (const study::Limit& limit : sweep.limits) all.push_back({limit.name, limit.field, &limit, true});
  for (std::size_t f = 0; f < answers.fields.size(); ++f)
    if (answers.fields[f].count > 0)
      all.push_back({answers.fields[f].name, f, nullptr, answers.fields[f].yes_or_no});
  if (all.size() > plotted_fields) all.resize(plotted_fields);
  return all;
}

/// Second pass: maps and scatters, their axes known from the first.
void draw(const SweepStudy& study, const SweepCases& cases, const std::vector<std::vector<double>>& places,
          SweepAnswers& answers) {
  const study::SweepFile& sweep = study.sweep();
  const bool grid = sweep.design.settings().kind == DesignKind::grid;
  const auto& variables = sweep.design.variables();
  std::vector<std::size_t> plotted;
  for (std::size_t j = 0; j < variables.size() && plotted.size() < plotted_variables; ++j) {
    if (places[j].empty()) continue;
    const auto [low, high] = std::ranges::minmax(places[j]);
    if (low < high) plotted.push_back(j);
  }
  const std::vector<Quantity> quantities = quantities_of(sweep, answers);
  struct Where {
    std::size_t x, y, quantity;
  };
  std::vector<Where> maps, scatters;
  constexpr std::size_t axes_of_maps = 3;
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    for (std::size_t a = 0; a < std::min(plotted.size(), axes_of_maps); ++a) {
      for (std::size_t b = a + 1; b < std::min(plotted.size(), axes_of_maps); ++b) {
        maps.push_back({plotted[a], plotted[b], q});
        MapAnswer map{quantities[q].name,
                      variables[plotted[a]].name,
                      variables[plotted[b]].name,
                      edges_of(places[plotted[a]], grid),
                      edges_of(places[plotted[b]], grid),
                      quantities[q].share,
                      {},
                      {},
                      {},
                      {}};
        const std::size_t cells = (map.x_edges.size() - 1) * (map.y_edges.size() - 1);
        map.count.resize(cells);
        map.hits.resize(cells);
        map.inferred.resize(cells);
        map.sum.resize(cells);
        answers.maps.push_back(std::move(map));
      }
    }
    if (quantities[q].share) continue;
    for (const std::size_t j : plotted) {
      scatters.push_back({j, 0, q});
      answers.scatters.push_back({variables[j].name, quantities[q].name, {}, {}});
    }
  }
  const std::uint64_t every = std::max<std::uint64_t>(1, cases.count / scatter_points);
  for_each_case(study, cases, [&](std::uint64_t index, const CaseRecord& record) {
    const std::vector<double> values = values_of_case(study, index, record);
    for (std::size_t m = 0; m < maps.size(); ++m) {
      const auto x = shown_number(variables[maps[m].x], values[maps[m].x]);
      const auto y = shown_number(variables[maps[m].y], values[maps[m].y]);
      const auto value = quantities[maps[m].quantity].of(record);
      if (!x || !y || !value) continue;
      MapAnswer& map = answers.maps[m];
      const std::size_t cell = cell_of(map.x_edges, *x) + (map.x_edges.size() - 1) * cell_of(map.y_edges, *y);
      ++map.count[cell];
      map.inferred[cell] += record.inferred() ? 1 : 0;
      map.hits[cell] += *value > 0.5 ? 1 : 0;
      map.sum[cell] += *value;
    }
    if (index % every != 0) return;
    for (std::size_t s = 0; s < scatters.size(); ++s) {
      const auto x = shown_number(variables[scatters[s].x], values[scatters[s].x]);
      const auto value = quantities[scatters[s].quantity].of(record);
      if (!x || !value) continue;
      answers.scatters[s].at.push_back(*x);
      answers.scatters[s].value.push_back(*value);
    }
  });
}

}  // namespace

double FieldAnswer::quantile(double p) const {
  const double at = p * static_cast<double>(sample.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sample.size() - 1);
  return sample[low] + (at - static_cast<double>(low)) * (sample[high] - sample[low]);
}

std::uint64_t SweepAnswers::inferred() const {
  const auto found = statuses.find(CaseRecord::inferred_status);
  return found == statuses.end() ? 0 : found->second;
}

std::optional<double> shown_number(const study::Variable& variable, double value) {
  if (variable.levels.empty()) return value;
  const json level = json::parse(study::literal(variable, value), nullptr, false);
  return level.is_number() ? std::optional(level.get<double>()) : std::nullopt;
}

std::vector<double> values_of_case(const SweepStudy& study, std::uint64_t index, const CaseRecord& record) {
  return record.values.empty() ? study.sweep().design.values(index) : record.values;
}

namespace {

/// Gathers the results of the cases of a sweep, one after the other.
class Gathering {
 public:
  Gathering(const SweepStudy& study, const SweepCases& cases)
      : study_(study),
        sweep_(study.sweep()),
        every_(std::max<std::uint64_t>(1, cases.count / FieldAnswer::sample_limit)),
        places_(sweep_.design.variables().size()),
        squares_(sweep_.collect.size()) {
    answers_.cases = study.count();
    for (const study::Collected& field : sweep_.collect) answers_.fields.emplace_back().name = field.name;
    for (const study::Limit& limit : sweep_.limits) {
      answers_.limits.push_back({limit.name, 0, 0});
      worst_.push_back(
          {limit.field,
           {fmt::format("{} {}", limit.above ? "largest" : "least", sweep_.collect[limit.field].name),
            limit.above ? 1.0 : -1.0}});
    }
    for (std::size_t f = 0; sweep_.limits.empty() && f < sweep_.collect.size(); ++f)
      worst_.push_back({f, {"largest " + sweep_.collect[f].name, 1.0}});
  }

  void add(std::uint64_t index, const CaseRecord& record) {
    count(record);
    const std::vector<double> values = values_of_case(study_, index, record);
    add_places(values);
    for (std::size_t f = 0; f < answers_.fields.size(); ++f) {
      if (const std::optional<double> value = record.number(f))
        add_number(f, *value, record.fields[f].is_boolean(), index % every_ == 0);
    }
    for (std::size_t l = 0; l < sweep_.limits.size(); ++l) {
      const study::Limit& limit = sweep_.limits[l];
      const std::optional<double> value = record.number(limit.field);
      if (!value) continue;
      ++answers_.limits[l].count;
      answers_.limits[l].hits += (limit.above ? *value > limit.bound : *value < limit.bound) ? 1 : 0;
    }
    for (auto& [field, worst] : worst_) {
      const std::optional<double> value = record.number(field);
      if (value && !record.inferred() && !record.fields[field].is_boolean()) worst.add(index, *value, values);
    }
  }

  SweepAnswers end(const SweepCases& cases) {
    for (std::size_t f = 0; f < answers_.fields.size(); ++f) {
      FieldAnswer& field = answers_.fields[f];
      finish(field);
      if (field.count > 1) field.deviation = std::sqrt(squares_[f] / static_cast<double>(field.count - 1));
      if (sweep_.design.settings().kind == DesignKind::sensitivity && field.count > 0)
        field.indices = indices_of(f, cases);
    }
    for (const auto& [field, worst] : worst_) worst.append_to(answers_.worst, study_);
    if (answers_.finished > 0) draw(study_, cases, places_, answers_);
    return std::move(answers_);
  }

 private:
  void count(const CaseRecord& record) {
    answers_.finished += record.inferred() ? 0 : 1;
    ++answers_.statuses[record.status];
    answers_.seconds += record.seconds;
    constexpr std::size_t most_reasons = 100;
    if (!record.done() && !record.inferred() &&
        (answers_.reasons.size() < most_reasons || answers_.reasons.contains(record.reason)))
      ++answers_.reasons[record.reason];
  }
  void add_places(const std::vector<double>& values) {
    constexpr std::size_t most_places = 200;
    for (std::size_t j = 0; j < values.size() && j < places_.size(); ++j) {
      const std::optional<double> x = shown_number(sweep_.design.variables()[j], values[j]);
      std::vector<double>& p = places_[j];
      if (!x || std::ranges::find(p, *x) != p.end()) continue;
      if (p.size() < most_places)
        p.push_back(*x);
      else if (*x < *std::ranges::min_element(p))
        *std::ranges::min_element(p) = *x;
      else if (*x > *std::ranges::max_element(p))
        *std::ranges::max_element(p) = *x;
    }
  }
  void add_number(std::size_t f, double value, bool boolean, bool in_sample) {
    FieldAnswer& field = answers_.fields[f];
    field.yes_or_no = field.yes_or_no && boolean;
    field.hits += boolean && value > 0.5 ? 1 : 0;
    field.least = field.count == 0 ? value : std::min(field.least, value);
    field.most = field.count == 0 ? value : std::max(field.most, value);
    const double n = static_cast<double>(++field.count);  // Welford 1962
    const double before = value - field.mean;
    field.mean += before / n;
    squares_[f] += before * (value - field.mean);
    if (in_sample) field.sample.push_back(value);
  }
  [[nodiscard]] std::optional<study::SobolIndices> indices_of(std::size_t f, const SweepCases& cases) const {
    return study::sobol_indices(sweep_.design.variables().size(), sweep_.design.settings().cases,
                                [&](std::uint64_t index) -> std::optional<double> {
                                  const std::optional<std::string> line = cases.journal.result(index);
                                  if (!line) return std::nullopt;
                                  const auto record = study::record_of(*line);
                                  return record && record->done() ? record->number(f) : std::nullopt;
                                });
  }

  const SweepStudy& study_;
  const study::SweepFile& sweep_;
  std::uint64_t every_;  // so many cases one is kept for quantiles
  SweepAnswers answers_;
  std::vector<std::pair<std::size_t, Worst>> worst_;  // with their fields
  /// That cells are made of: extremes, or all levels of a grid.
  std::vector<std::vector<double>> places_;
  std::vector<double> squares_;  // of the deviations from the mean, one a field
};

}  // namespace

SweepAnswers sweep_answers(const SweepStudy& study, const SweepCases& cases) {
  Gathering gathering(study, cases);
  for_each_case(study, cases,
                [&](std::uint64_t index, const CaseRecord& record) { gathering.add(index, record); });
  return gathering.end(cases);
}

study::Seen seen_of(const SweepStudy& study, const CaseRecord& record) {
  if (!record.done()) return {0.0, record.status};
  const json& value = record.fields.at(study.sweep().refine->field);
  return value.is_number() ? study::Seen{value.get<double>(), ""} : study::Seen{0.0, value.dump()};
}

void give_cases(TableSink& sink, const SweepStudy& study, const SweepCases& cases) {
  const study::SweepFile& sweep = study.sweep();
  std::vector<std::string> columns{"case", "status", "reason"};
  for (const study::Variable& v : sweep.design.variables()) columns.push_back(v.name);
  for (const study::Collected& c : sweep.collect) columns.push_back(c.name);
  sink.begin(columns);
  std::vector<base::CsvCell> row;
  std::vector<std::string> texts(columns.size());
  for_each_case(study, cases, [&](std::uint64_t index, const CaseRecord& record) {
    row.assign({static_cast<long long>(index + 1), std::string_view(record.status),
                std::string_view(record.reason)});
    const std::vector<double> values = values_of_case(study, index, record);
    const auto add = [&](const json& value) {
      std::string& text = texts[row.size()];
      if (value.is_boolean()) {
        row.emplace_back(value.get<bool>() ? 1LL : 0LL);
      } else if (value.is_number_integer()) {
        row.emplace_back(value.get<long long>());
      } else if (value.is_number()) {
        row.emplace_back(value.get<double>());
      } else if (value.is_string() || value.is_array()) {
        text = value.is_string() ? value.get<std::string>() : value.dump();
        row.emplace_back(std::string_view(text));
      } else {
        row.emplace_back();
      }
    };
    for (std::size_t j = 0; j < values.size(); ++j) {
      const study::Variable& v = sweep.design.variables()[j];
      if (v.levels.empty())
        row.emplace_back(values[j]);
      else
        add(json::parse(study::literal(v, values[j]), nullptr, false));
    }
    for (std::size_t f = 0; f < sweep.collect.size(); ++f)
      add(f < record.fields.size() ? record.fields[f] : json());
    sink.row(row);
  });
}

namespace {

json share_json(std::uint64_t hits, std::uint64_t count) {
  if (count == 0) return nullptr;
  const study::ProbabilityInterval interval = study::proportion_interval(hits, count);
  return {{"cases", count},
          {"hits", hits},
          {"share", static_cast<double>(hits) / static_cast<double>(count)},
          {"interval95", {interval.low, interval.high}},
          {"interval_kind", "at least 95 % of independent cases"}};
}

json sobol_json(const study::SobolIndices& indices, const std::vector<study::Variable>& variables) {
  json sobol{{"rows", indices.rows},
             {"dropped", indices.dropped},
             {"effective_rows", indices.effective_rows},
             {"variance", indices.variance},
             {"variables", json::object()}};
  for (std::size_t j = 0; j < indices.of.size(); ++j) {
    const study::SobolIndex& s = indices.of[j];
    sobol["variables"][variables[j].name] = {
        {"first", s.first},
        {"first_interval95", {s.first - s.first_half, s.first + s.first_half}},
        {"total", s.total},
        {"total_interval95", {s.total - s.total_half, s.total + s.total_half}}};
  }
  return sobol;
}

json field_json(const FieldAnswer& field, const std::vector<study::Variable>& variables) {
  json one{{"count", field.count}};
  if (field.count == 0) return one;
  if (field.yes_or_no) {
    one["true"] = share_json(field.hits, field.count);
  } else {
    one.update(
        {{"mean", field.mean}, {"deviation", field.deviation}, {"least", field.least}, {"most", field.most}});
    for (const auto& [name, p] :
         {std::pair{"q05", 0.05}, {"q25", 0.25}, {"q50", 0.5}, {"q75", 0.75}, {"q95", 0.95}})
      one[name] = field.quantile(p);
  }
  if (field.indices) one["sobol"] = sobol_json(*field.indices, variables);
  return one;
}

/// The answer of a search for a rare event, in place of shares of its cases, most of which it drew near the
/// event.
void add_failure(const study::SweepFile& sweep, const SubsetAnswer& subset, json& summary) {
  json levels = json::array();
  for (const auto& level : subset.levels) {
    levels.push_back({{"threshold", results::finite(level.threshold)},
                      {"probability", level.probability},
                      {"variation", level.variation}});
  }
  summary["limits"] = json::object();
  summary["drawn"] = false;
  summary["failure"] = {{"limit", sweep.limits.front().name},
                        {"reached", subset.reached},
                        {"probability", subset.probability},
                        {"coefficient_of_variation", subset.variation},
                        {"interval95", {subset.interval.low, subset.interval.high}},
                        {"levels", levels}};
}

}  // namespace

json sweep_summary(const SweepStudy& study, const SweepAnswers& answers) {
  const study::SweepFile& sweep = study.sweep();
  const bool drawn =
      sweep.design.settings().kind != DesignKind::grid && sweep.design.settings().kind != DesignKind::file;
  json summary{{"schema", "snare-sweep-summary/1"},
               {"title", sweep.title},
               {"source", sweep.source},
               {"version", version()},
               {"case_file", sweep.case_file.string()},
               {"verb", study.runner().verb()},
               {"cases", answers.cases == 0 ? answers.finished : answers.cases},
               {"finished", answers.finished},
               {"interrupted", answers.interrupted},
               {"drawn", drawn},
               {"statuses", answers.statuses},
               {"reasons", answers.reasons},
               {"seconds", answers.seconds},
               {"fields", json::object()},
               {"limits", json::object()},
               {"worst", json::array()}};
  if (sweep.histories && !answers.interrupted) summary["histories"] = "histories.h5";
  for (const FieldAnswer& field : answers.fields)
    summary["fields"][field.name] = field_json(field, sweep.design.variables());
  for (const LimitAnswer& limit : answers.limits)
    summary["limits"][limit.name] = share_json(limit.hits, limit.count);
  for (const CaseAnswer& one : answers.worst)
    summary["worst"].push_back({{"case", one.number}, {"why", one.why}, {"command", one.command}});
  if (answers.subset) add_failure(sweep, *answers.subset, summary);
  return summary;
}

}  // namespace snare::results
