#include "results/record_json.hpp"

#include "results/finding_json.hpp"
#include "results/finite_json.hpp"
#include "results/version.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace snare::results {

namespace {

using identification::ChannelError;
using identification::RecordCandidate;
using identification::RecordSet;
using identification::RecordStage;
using identification::RecordTrace;
using identification::TracedNumber;
using nlohmann::json;
using results::finite;

/// "rmse_N": with the unit of the fitted channels, where there is one; else over their scales.
std::string with_unit(const char* name, const RecordTrace& trace) {
  std::string unit;
  int count = 0;
  for (const ChannelError& e : trace.base.errors) {
    if (!e.fitted) continue;
    ++count;
    const std::size_t low = e.unit.find_first_of(" /");
    unit = low == std::string::npos ? e.unit : std::string();
  }
  return count == 1 && !unit.empty() ? std::string(name) + "_" + unit : std::string(name);
}

json errors_json(const std::vector<ChannelError>& errors) {
  json list = json::array();
  for (const ChannelError& e : errors)
    list.push_back({{"sensor", e.sensor},
                    {"unit", e.unit},
                    {"fitted", e.fitted},
                    {"rmse", finite(e.rmse)},
                    {"nrmse", finite(e.nrmse)},
                    {"relative", finite(e.relative)},
                    {"sigma", finite(e.sigma)}});
  return list;
}

json number_json(const TracedNumber& n) {
  return {{"value", finite(n.value)},
          {"stderr", n.identified ? finite(n.stderr_) : json()},
          {"unit", n.unit},
          {"lower", finite(n.lower)},
          {"upper", finite(n.upper)},
          {"identified", n.identified},
          {"on_bound", bound_json(n.bound)}};
}

json open_json(const std::vector<identification::OpenNumbers>& open) {
  json result = json::array();
  for (const identification::OpenNumbers& direction : open) {
    json changes = json::object(), known = json::object();
    for (const identification::NamedChange& c : direction.changes) changes[c.key] = finite(c.change);
    for (const TracedNumber& n : direction.known) known[n.key] = number_json(n);
    result.push_back({{"what", identification::null_words(direction.changes)},
                      {"changes", changes},
                      {"held", {{"key", direction.changes.front().key}, {"value", finite(direction.held)}}},
                      {"known", known}});
  }
  return result;
}

json stage_json(const RecordTrace& trace, const RecordStage& stage) {
  json numbers = json::object();
  for (const TracedNumber& n : stage.numbers) numbers[n.key] = number_json(n);
  return {{with_unit("rmse", trace), finite(stage.rmse)}, {"nrmse", finite(stage.nrmse)},
          {"chi2_dof", finite(stage.chi2_dof)},           {"parameters", numbers},
          {"indistinguishable", open_json(stage.open)},   {"channels", errors_json(stage.errors)}};
}

const char* end_name(identification::ProfileEnd end) {
  switch (end) {
    case identification::ProfileEnd::crossed:
      return "crossed";
    case identification::ProfileEnd::bound:
      return "bound";
    case identification::ProfileEnd::open:
      return "open";
    case identification::ProfileEnd::not_simulated:
      break;
  }
  return "not_simulated";
}

json profiles_json(const RecordTrace& trace) {
  json all = json::object();
  for (const identification::Profile& p : trace.profiles) {
    json points = json::array();
    for (const identification::ProfilePoint& point : p.points)
      points.push_back({{"value", finite(point.value)}, {"rise", finite(point.rise)}});
    all[p.key] = {{"value", finite(p.value)},
                  {"unit", p.unit},
                  {"lower", finite(p.lower.limit)},
                  {"upper", finite(p.upper.limit)},
                  {"lower_end", end_name(p.lower.end)},
                  {"upper_end", end_name(p.upper.end)},
                  {"fall", finite(p.fall)},
                  {"simulations", p.simulations},
                  {"points", points}};
  }
  return all;
}

json families_json(const RecordTrace& trace) {
  json all = json::array();
  for (const identification::ModelFamily& f : trace.families) {
    json numbers = json::object();
    for (const TracedNumber& n : f.numbers) numbers[n.key] = number_json(n);
    all.push_back({{"name", f.name},
                   {"chi2_dof", f.failure.empty() ? finite(f.chi2_dof) : json()},
                   {"parameters", numbers},
                   {"simulations", f.simulations},
                   {"failure", f.failure}});
  }
  return all;
}

json candidate_json(const RecordTrace& trace, const RecordCandidate& c) {
  const identification::RecordEffect& effect = trace.effects[c.score.effect];
  json value = json::object();
  for (const TracedNumber& n : c.numbers) value[n.key] = finite(n.value);
  return {{"effect", effect.name},
          {"place", effect.place},
          {"channel", effect.channel},
          {"unobservable", c.score.unobservable},
          {"score_p", finite(c.score.p)},
          {"adjusted_p", finite(c.score.adjusted_p)},
          {"z", finite(c.score.z)},
          {"detectable", finite(c.score.detectable)},
          {"refitted", c.refitted},
          {with_unit("rmse", trace), c.refitted ? finite(c.rmse) : json()},
          {"delta_bic", c.refitted ? finite(c.delta_bic) : json()},
          {"value", value},
          {"plausible", c.plausible},
          {"why_not", c.why_not},
          {"heldout_improves", c.heldout_improves ? json(*c.heldout_improves) : json()},
          {"class", c.class_index}};
}

json head(const RecordSet& set, const RecordTrace& trace, const char* schema) {
  return {{"schema", schema},
          {"interrupted", trace.interrupted},
          {"title", set.title},
          {"source", set.source},
          {"version", version()},
          {"warnings", trace.warnings},
          {"findings", findings_json(trace.findings)},
          {"noise", {{with_unit("sigma", trace), finite(trace.sigma)}, {"source", trace.noise_source}}},
          {"declared", stage_json(trace, trace.declared)},
          {"profiles", profiles_json(trace)},
          {"families", families_json(trace)},
          {"simulations",
           {{"all", trace.simulations},
            {"base_fit", trace.fit_simulations},
            {"iterations", trace.fit_iterations}}}};
}

json tests_json(const RecordTrace& trace) {
  return {{"runs_p", finite(trace.runs)},
          {"ljung_box_p", finite(trace.ljung_box)},
          {"lack_of_fit_p", finite(trace.lack_of_fit)}};
}

}  // namespace

json record_trace_json(const RecordSet& set, const RecordTrace& trace) {
  json result = head(set, trace, "snare-trace/1");
  result["base"] = stage_json(trace, trace.base);
  result["residual"] = {{"significant", trace.significant}, {"tests", tests_json(trace)}};
  result["candidates"] = json::array();
  result["classes"] = json::array();
  result["rounds"] = json::array();
  for (const identification::RecordRound& round : trace.rounds) {
    json candidates = json::array();
    for (const RecordCandidate& c : round.candidates) candidates.push_back(candidate_json(trace, c));
    if (result["rounds"].empty()) {
      result["candidates"] = candidates;
      result["classes"] = round.classes;
    }
    result["rounds"].push_back({{"candidates", candidates},
                                {"classes", round.classes},
                                {"added", round.added},
                                {"reason", round.reason}});
  }
  json names = json::array();
  for (const std::size_t e : trace.selected_effects) names.push_back(trace.effects[e].name);
  result["selected"] = names;
  result["selected_places"] = trace.selected;
  result["partial"] = {{"effects", trace.partial}};
  if (trace.with_partial) {
    result["partial"]["model"] = stage_json(trace, *trace.with_partial);
    result["partial"]["heldout"] = errors_json(trace.with_partial->heldout);
  }
  result["final"] = stage_json(trace, trace.final);
  result["heldout"] = {
      {with_unit("rmse_base", trace), trace.base.heldout.empty() ? json() : finite(trace.base.heldout_rmse)},
      {with_unit("rmse_final", trace),
       trace.final.heldout.empty() ? json() : finite(trace.final.heldout_rmse)},
      {with_unit("rmse_declared", trace),
       trace.declared.heldout.empty() ? json() : finite(trace.declared.heldout_rmse)},
      {"base", errors_json(trace.base.heldout)},
      {"final", errors_json(trace.final.heldout)}};
  result["explained"] = trace.kind == identification::VerdictKind::nothing_missing ||
                        trace.kind == identification::VerdictKind::explained;
  result["verdict_kind"] = to_string(trace.kind);
  json left = json::array();
  for (std::size_t k = 0; k < std::min<std::size_t>(trace.leftovers.size(), 10); ++k)
    left.push_back({{"sensor", trace.leftovers[k].sensor},
                    {"on", trace.leftovers[k].on},
                    {"share", finite(trace.leftovers[k].share)}});
  result["remaining"] = {{with_unit("rmse", trace), finite(trace.final.rmse)},
                         {"share_of_excess", finite(trace.share_left)},
                         {"channel", trace.leftovers.empty() ? "" : trace.leftovers.front().sensor},
                         {"hangs_on", left}};
  result["channel"] = trace.channel;
  result["next_experiment"] = {{"what", trace.next_measurement}, {"separates", trace.next_separates}};
  return result;
}

json record_fit_json(const RecordSet& set, const RecordTrace& trace) {
  json result = head(set, trace, "snare-fit/1");
  result["fit"] = stage_json(trace, trace.base);
  result["residual"] = {{"acceptable", !trace.significant}, {"tests", tests_json(trace)}};
  result["heldout"] = {{"declared", errors_json(trace.declared.heldout)},
                       {"fit", errors_json(trace.base.heldout)}};
  return result;
}

void give_record_curves(TableSink& sink, const RecordSet& set, const RecordTrace& trace) {
  sink.begin({"record", "sensor", "unit", "time_s", "measured", "declared", "base", "final"});
  for (std::size_t r = 0; r < set.records.size(); ++r) {
    const identification::Record& record = set.records[r];
    for (std::size_t c = 0; c < record.channels.size(); ++c) {
      std::string unit;
      for (const identification::ChannelError& e : trace.base.errors)
        if (e.sensor == record.channels[c].sensor) unit = e.unit;
      const auto cell = [&](const identification::RecordStage& stage, Eigen::Index i) -> base::CsvCell {
        if (r >= stage.predictions.size() || stage.predictions[r].channels.empty()) return std::monostate{};
        return stage.predictions[r].channels[c][i];
      };
      for (Eigen::Index i = 0; i < record.times.size(); ++i)
        sink.row({std::string_view(record.name), std::string_view(record.channels[c].sensor),
                  std::string_view(unit), record.times[i], record.channels[c].values[i],
                  cell(trace.declared, i), cell(trace.base, i), cell(trace.final, i)});
    }
  }
}

}  // namespace snare::results
