#include "results/benchmark_run.hpp"

#include "base/archive.hpp"
#include "base/csv.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/own_file.hpp"
#include "base/toml_reader.hpp"
#include "results/history_table.hpp"
#include "results/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

namespace snare::results {

namespace {

using nlohmann::json;
using study::BenchmarkCase;
using study::BenchmarkFile;
using study::BenchmarkModel;

constexpr const char* reference_schema = "snare-benchmark-reference/1";

/// What runs the archive: a model as others.
BenchmarkModel archive_model(const BenchmarkCase& c, std::size_t refinement) {
  return {fmt::format("refinement {}", refinement + 1), c.file, c.refinements[refinement], c.columns, {}};
}

std::vector<base::Override> all_fixed(const BenchmarkCase& c, const BenchmarkModel& model) {
  std::vector<base::Override> all = c.fixed;
  all.insert(all.end(), model.fixed.begin(), model.fixed.end());
  return all;
}

/// The columns of a model's history: x, then the quantities in their order.
std::vector<std::string> columns_of(const BenchmarkCase& c, const BenchmarkModel& model) {
  std::vector<std::string> columns{c.x};
  for (const auto& [name, column] : model.columns) columns.push_back(column);
  return columns;
}

/// Equal for equal input of the archive.
std::string identity_of(const BenchmarkCase& c) {
  std::string all = contents_of_files(c.file) + c.x;
  for (const auto& [name, column] : c.columns) all += fmt::format("\n{} = {}", name, column);
  for (const auto& [name, threshold] : c.touch_above) all += fmt::format("\n{} > {}", name, threshold);
  for (const study::Collected& field : c.outcome) all += fmt::format("\n{}: {}", field.name, field.text);
  for (std::size_t k = 0; k < c.refinements.size(); ++k) {
    all += "\n";
    for (const base::Override& one : all_fixed(c, archive_model(c, k)))
      all += fmt::format("{}={};", one.key, one.value);
  }
  return fmt::format("{:016x}", base::fingerprint(all));
}

constexpr std::size_t longest_history = std::size_t{1} << 30u;  // [byte]

/// Fingerprint of the text of an archived history, byte by byte: its JSON file belongs to this history and to
/// no other.
std::string fingerprint_of(const std::string& history) {
  return fmt::format("{:016x}", base::fingerprint(history));
}

/// The numbers of a column of a history; none where it has no such column.
const std::vector<double>& numbers_of(const History& history, const std::string& column) {
  static const std::vector<double> none;
  const auto found = std::ranges::find(history.columns, column, &HistoryColumn::name);
  return found != history.columns.end() ? found->numbers : none;
}

/// What the integration has made or lost, over the most that moved and was stretched at a time; none where
/// the history does not say.
std::optional<double> energy_error(const History& history) {
  const std::vector<double>&error = numbers_of(history, "integrator_J"),
        &kinetic = numbers_of(history, "kinetic_J"), &strain = numbers_of(history, "strain_J");
  if (error.empty() || kinetic.size() != error.size() || strain.size() != error.size()) return std::nullopt;
  double worst = 0.0, most = 0.0;
  for (std::size_t i = 0; i < error.size(); ++i) {
    worst = std::max(worst, std::abs(error[i]));
    most = std::max(most, kinetic[i] + strain[i]);
  }
  return most > 0.0 ? std::optional(worst / most) : std::nullopt;
}

/// Rows of numbers of a history.
Tracks tracks_of(const BenchmarkCase& c, const BenchmarkModel& model, const History& history) {
  const std::vector<double>& x = numbers_of(history, c.x);
  Tracks tracks;
  for (const auto& [name, column] : model.columns) {
    study::Track& track = tracks[name];
    const std::vector<double>& q = numbers_of(history, column);
    for (std::size_t i = 0; i < q.size() && i < x.size(); ++i) {
      if (q[i] != q[i]) continue;  // an empty cell
      track.x.push_back(x[i]);
      track.q.push_back(q[i]);
    }
  }
  return tracks;
}

Scores scores_of(const BenchmarkCase& c, const Tracks& tracks, const Tracks& reference) {
  Scores scores;
  for (const auto& [name, track] : tracks) {
    const auto threshold = c.touch_above.find(name);
    try {
      scores[name] =
          study::score_of(track, reference.at(name),
                          threshold == c.touch_above.end() ? std::nullopt : std::optional(threshold->second));
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(fmt::format("{}: {}", name, error.what()));
    }
  }
  return scores;
}

/// A run of a model: its tracks and its outcome.
struct ModelRun {
  CaseEnd end;
  double seconds = 0.0;
  Tracks tracks;
  std::optional<double> energy_error;
  std::map<std::string, json> outcome;
};

ModelRun run_model(const BenchmarkCase& c, const BenchmarkModel& model, const Watch& watch) {
  ModelRun r;
  const CaseRunner runner(model.file, "", model.file);
  HistoryTable table({}, 1);
  json result;
  const auto begin = std::chrono::steady_clock::now();
  r.end = runner.run(all_fixed(c, model), {{}, watch.stop}, result, &table);
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (r.end.status != CaseEnd::Status::done) return r;
  try {
    for (const study::Collected& field : c.outcome) r.outcome[field.name] = study::collected(field, result);
  } catch (const std::out_of_range& error) {
    r.end = {CaseEnd::Status::broken, error.what()};
    return r;
  }
  r.tracks = tracks_of(c, model, table.history());
  r.energy_error = energy_error(table.history());
  return r;
}

/// The largest explicit step at the time that the case names; none where the model has too many unknowns, or
/// has stopped before.
std::optional<double> largest_step(const BenchmarkCase& c, const BenchmarkModel& model, const Watch& watch) {
  std::vector<base::Override> until = all_fixed(c, model);
  until.push_back({"duration_s", fmt::format("{}", *c.step_at)});
  until.push_back({"output.modes", "true"});
  json result;
  const CaseEnd end = CaseRunner(model.file, "", model.file).run(until, {{}, watch.stop}, result);
  if (end.status != CaseEnd::Status::done) return std::nullopt;
  const json step = result.value("largest_explicit_step_s", json());
  return step.is_number() ? std::optional(step.get<double>()) : std::nullopt;
}

json score_json(const study::TrackScore& s) {
  return {{"peak", s.peak},
          {"integral", s.integral},
          {"rms", s.rms},
          {"touch", s.touch ? json(*s.touch) : json()},
          {"same_touch", s.same_touch},
          {"covered", s.covered}};
}

study::TrackScore score_of_json(const json& j) {
  study::TrackScore s;
  s.peak = j.at("peak");
  s.integral = j.at("integral");
  s.rms = j.at("rms");
  if (j.at("touch").is_number()) s.touch = j.at("touch").get<double>();
  s.same_touch = j.at("same_touch");
  s.covered = j.at("covered");
  return s;
}

json scores_json(const Scores& scores) {
  json all = json::object();
  for (const auto& [name, score] : scores) all[name] = score_json(score);
  return all;
}

/// Of a CSV file with x and the quantities by their names in the benchmark.
Tracks read_tracks(const std::filesystem::path& file, const BenchmarkCase& c) {
  std::vector<base::CsvColumn> columns{{c.x, base::CsvColumn::Presence::required, base::Range::finite(), 1.0,
                                        base::CsvColumn::Order::non_decreasing}};
  for (const auto& [name, column] : c.columns) columns.push_back({name});
  base::CsvTable table = base::read_csv(file, columns);
  if (table.rows < 2) throw base::InputError({file.string(), 0, "", "", "must have at least two rows"});
  Tracks tracks;
  std::size_t k = 0;
  for (const auto& [name, column] : c.columns)
    tracks[name] = {table.columns.front(), std::move(table.columns[++k])};
  return tracks;
}

const char* word(CaseEnd::Status status) {
  switch (status) {
    case CaseEnd::Status::done:
      return "done";
    case CaseEnd::Status::failed:
      return "failed";
    case CaseEnd::Status::refused:
      return "refused";
    case CaseEnd::Status::stopped:
      return "stopped";
    case CaseEnd::Status::broken:
      break;
  }
  return "broken";
}

}  // namespace

void check_benchmark_case(const BenchmarkFile& benchmark, const BenchmarkCase& c) {
  std::vector<BenchmarkModel> all = c.models;
  for (std::size_t k = 0; k < c.refinements.size(); ++k) all.push_back(archive_model(c, k));
  for (const BenchmarkModel& model : all) {
    if (!model.csv.empty()) {
      static_cast<void>(read_tracks(model.csv, c));
      continue;
    }
    const CaseRunner runner(model.file, "", benchmark.file);
    HistoryTable table(columns_of(c, model), 1);
    try {
      runner.check(all_fixed(c, model), &table);
    } catch (const base::InputError& error) {
      // What the case's reader calls an override is a value of the benchmark's file.
      std::vector<base::InputProblem> problems = error.problems();
      for (base::InputProblem& problem : problems) {
        if (problem.file == "--set")
          problem.file = fmt::format("{}, {}, {}", benchmark.file.string(), c.name, model.name);
      }
      throw base::InputError(std::move(problems));
    }
    if (table.missing().empty()) continue;
    throw base::InputError({benchmark.file.string(), 0, fmt::format("cases[{}].quantities", c.name),
                            table.missing(),
                            fmt::format("must be a column of the history of {}{}", model.file.string(),
                                        base::nearest_or_all(table.missing(), table.names()))});
  }
}

BenchmarkReference read_reference(const BenchmarkFile& benchmark, const BenchmarkCase& c) {
  const std::filesystem::path csv = benchmark.references / (c.name + ".csv");
  const std::filesystem::path about = benchmark.references / (c.name + ".json");
  for (const std::filesystem::path& file : {csv, about}) {
    if (!std::filesystem::exists(file))
      throw base::InputError({file.string(), 0, "", "", "is missing: snare benchmark --archive makes it"});
  }
  BenchmarkReference reference;
  reference.tracks = read_tracks(csv, c);
  try {
    const json j = json::parse(base::read_text(about, std::size_t{1} << 20u));
    if (j.at("schema") != reference_schema)
      throw std::runtime_error(fmt::format("schema must be {}", reference_schema));
    if (j.at("history") != fingerprint_of(base::read_text(csv, longest_history)))
      throw std::runtime_error(fmt::format("{} has been changed since", csv.filename().string()));
    for (const auto& [name, column] : c.columns) reference.bars[name] = score_of_json(j.at("bars").at(name));
    for (const study::Collected& field : c.outcome)
      reference.outcome[field.name] = j.at("outcome").at(field.name);
    reference.stale = j.at("identity") != identity_of(c);
  } catch (const std::exception& error) {
    throw base::InputError(
        {about.string(), 0, "", "", fmt::format("is damaged or of another case: {}", error.what())});
  }
  return reference;
}

CaseEnd archive_case(const BenchmarkFile& benchmark, const BenchmarkCase& c, const Watch& watch) {
  std::vector<ModelRun> runs;
  for (std::size_t k = 0; k < c.refinements.size(); ++k) {
    watch.say(fmt::format("{}: refinement {} of {}", c.name, k + 1, c.refinements.size()));
    ModelRun one = run_model(c, archive_model(c, k), watch);
    if (one.end.status != CaseEnd::Status::done) return one.end;
    runs.push_back(std::move(one));
  }
  const ModelRun& finest = runs.back();
  json apart = json::array();  // of each from the finest
  for (std::size_t k = 0; k + 1 < runs.size(); ++k)
    apart.push_back(scores_json(scores_of(c, runs[k].tracks, finest.tracks)));
  json seconds = json::array();
  for (const ModelRun& one : runs) seconds.push_back(one.seconds);
  json about{{"schema", reference_schema}, {"case", c.name},           {"identity", identity_of(c)},
             {"version", version()},       {"bars", apart.back()},     {"refinements", apart},
             {"wall_s", seconds},          {"outcome", finest.outcome}};
  std::filesystem::create_directories(benchmark.references);
  std::vector<std::string> names{c.x};
  for (const auto& [name, track] : finest.tracks) names.push_back(name);
  const std::filesystem::path file = benchmark.references / (c.name + ".csv");
  base::CsvWriter csv(file, names, {c.title + "; made by snare benchmark --archive"});
  const study::Track& first = finest.tracks.begin()->second;
  for (std::size_t i = 0; i < first.x.size(); ++i) {
    std::vector<base::CsvCell> cells{first.x[i]};
    for (const auto& [name, track] : finest.tracks) cells.emplace_back(track.q.at(i));
    csv.row(cells);
  }
  csv.commit();
  about["history"] = fingerprint_of(base::read_own(file, longest_history));
  base::write_text(benchmark.references / (c.name + ".json"), about.dump(1) + "\n");
  return {};
}

BenchmarkRow run_benchmark_model(const BenchmarkCase& c, const BenchmarkModel& model,
                                 const BenchmarkReference& reference, const Watch& watch) {
  BenchmarkRow row;
  row.model = model.name;
  ModelRun one;
  if (model.csv.empty())
    one = run_model(c, model, watch);
  else
    one.tracks = read_tracks(model.csv, c);
  row.end = one.end;
  row.seconds = one.seconds;
  row.energy_error = one.energy_error;
  row.outcome = std::move(one.outcome);
  if (row.end.status != CaseEnd::Status::done) return row;
  try {
    row.scores = scores_of(c, one.tracks, reference.tracks);
  } catch (const std::runtime_error& error) {
    row.end = {CaseEnd::Status::broken, error.what()};
  }
  row.tracks = std::move(one.tracks);
  if (c.step_at && model.csv.empty()) row.largest_step = largest_step(c, model, watch);
  return row;
}

json benchmark_json(const BenchmarkFile& benchmark, const std::vector<BenchmarkAnswer>& answers,
                    std::size_t asked) {
  json cases = json::array();
  std::size_t done = 0;
  for (const BenchmarkAnswer& answer : answers) {
    json models = json::array();
    for (const BenchmarkRow& row : answer.rows) {
      json outcome = json::object();
      for (const auto& [name, value] : row.outcome) {
        const json& expected = answer.reference.outcome.at(name);
        outcome[name] = {{"value", value}, {"reference", expected}, {"same", value == expected}};
      }
      models.push_back({{"model", row.model},
                        {"status", word(row.end.status)},
                        {"reason", row.end.reason},
                        {"wall_s", row.seconds},
                        {"energy_error", row.energy_error ? json(*row.energy_error) : json()},
                        {"largest_explicit_step_s", row.largest_step ? json(*row.largest_step) : json()},
                        {"scores", scores_json(row.scores)},
                        {"outcome", outcome}});
      ++done;
    }
    cases.push_back({{"name", answer.asked->name},
                     {"title", answer.asked->title},
                     {"x", answer.asked->x},
                     {"stale", answer.reference.stale},
                     {"bars", scores_json(answer.reference.bars)},
                     {"models", models}});
  }
  return {{"schema", "snare-benchmark-result/1"},
          {"version", version()},
          {"title", benchmark.title},
          {"interrupted", done < asked},
          {"rows", {{"asked", asked}, {"done", done}}},
          {"cases", cases}};
}

void give_scores(TableSink& sink, const std::vector<BenchmarkAnswer>& answers) {
  sink.begin({"case", "model", "status", "quantity", "peak", "peak_bar", "integral", "integral_bar", "rms",
              "rms_bar", "touch", "touch_bar", "same_touch", "covered", "energy_error",
              "largest_explicit_step_s", "wall_s"});
  const auto optional = [](const std::optional<double>& value) {
    return value ? base::CsvCell(*value) : base::CsvCell();
  };
  for (const BenchmarkAnswer& answer : answers) {
    for (const BenchmarkRow& row : answer.rows) {
      if (row.scores.empty()) {
        std::vector<base::CsvCell> cells{std::string_view(answer.asked->name), std::string_view(row.model),
                                         word(row.end.status)};
        cells.resize(16);
        cells.emplace_back(row.seconds);
        sink.row(cells);
      }
      for (const auto& [name, s] : row.scores) {
        const study::TrackScore& bar = answer.reference.bars.at(name);
        sink.row({std::string_view(answer.asked->name), std::string_view(row.model), std::string_view("done"),
                  std::string_view(name), s.peak, bar.peak, s.integral, bar.integral, s.rms, bar.rms,
                  optional(s.touch), optional(bar.touch), s.same_touch ? 1LL : 0LL, s.covered,
                  optional(row.energy_error), optional(row.largest_step), row.seconds});
      }
    }
  }
}

}  // namespace snare::results
