#include "identification/ring_down_file.hpp"

#include "numerics/csv.hpp"
#include "numerics/toml_reader.hpp"

#include <fmt/format.h>

#include <limits>
#include <set>

namespace snare::identification {

using numerics::CsvColumn;
using numerics::Range;
using numerics::TomlDocument;
using numerics::TomlTable;

namespace {

constexpr std::string_view schema = "snare-ringdown/1";
constexpr double mm = 1e-3;
constexpr double longest = 1e6;          // [s]
constexpr std::size_t most_rows = 200000;
constexpr int most_modes = 6;

RingDown read_readings(TomlDocument& document, const TomlTable& table, const std::filesystem::path& folder) {
  RingDown data;
  const std::string name = table.text("file");
  const double from = table.number_or("from_s", -std::numeric_limits<double>::infinity(), Range::from(-longest, longest));
  const double to = table.number_or("to_s", std::numeric_limits<double>::infinity(), Range::from(-longest, longest));
  if (to <= from) table.fail("to_s", "must be > from_s");
  if (name.empty()) return data;
  const std::filesystem::path path = folder / name;
  if (!std::filesystem::is_regular_file(path)) {
    table.fail("file", fmt::format("{}: must be a CSV file beside this one", path.string()));
    return data;
  }
  try {
    const numerics::CsvTable csv = numerics::read_csv(
        path, {{"time_s", CsvColumn::Presence::required, Range::from(-longest, longest), 1.0, CsvColumn::Order::non_decreasing},
               {"displacement_mm", CsvColumn::Presence::required, Range::from(-1e4, 1e4), mm}});
    std::vector<double> time;
    std::vector<double> displacement;
    for (std::size_t i = 0; i < csv.rows; ++i) {
      if (csv.columns[0][i] < from || csv.columns[0][i] > to) continue;
      time.push_back(csv.columns[0][i]);
      displacement.push_back(csv.columns[1][i]);
    }
    data.time = Eigen::Map<const Eigen::VectorXd>(time.data(), static_cast<Eigen::Index>(time.size()));
    data.displacement =
        Eigen::Map<const Eigen::VectorXd>(displacement.data(), static_cast<Eigen::Index>(displacement.size()));
    if (time.size() > most_rows)
      table.fail("file", fmt::format("{} has {} readings, must have at most {}: thin it out", path.string(), time.size(), most_rows));
  } catch (const numerics::InputError& error) {
    for (const numerics::InputProblem& problem : error.problems()) document.add(problem);
  }
  return data;
}

RingDownSeries read_series(TomlDocument& document, const TomlTable& table, const std::filesystem::path& folder) {
  RingDownSeries series;
  series.data = read_readings(document, table, folder);
  series.data.name = table.text("name");
  series.data.modes = table.integer_or("modes", 1, 1, most_modes);
  series.data.friction = table.boolean_or("friction", true);
  if (table.has("bending_share")) {
    series.bending_share =
        table.numbers("bending_share", 1, static_cast<std::size_t>(most_modes), Range::above(0.0, 1.0));
    if (series.bending_share.size() > static_cast<std::size_t>(series.data.modes))
      table.fail("bending_share", "must not have more numbers than modes");
  }
  if (series.data.time.size() > 0) {
    const std::string problem = ring_down_problem(series.data);
    if (!problem.empty()) table.fail("file", problem);
  }
  return series;
}

}  // namespace

RingDownFile read_ring_down_file(const std::filesystem::path& file, const std::vector<numerics::Override>& overrides) {
  TomlDocument document(file, overrides);
  const TomlTable root = document.root();
  if (root.text("schema") != schema) root.fail("schema", fmt::format("must be \"{}\"", schema));
  RingDownFile result;
  result.file = file;
  result.title = root.text("title");
  result.source = root.text_or("source", "");
  std::set<std::string> names;
  for (const TomlTable& table : root.tables("series")) {
    result.series.push_back(read_series(document, table, file.parent_path()));
    if (!names.insert(result.series.back().data.name).second) table.fail("name", "is taken by another series");
  }
  if (result.series.empty()) root.fail("series", "must have at least one [[series]]");
  document.finish();
  return result;
}

std::vector<DecayOfMode> decays_of(const RingDownFile& file, const std::vector<RingDownFit>& fits) {
  std::vector<DecayOfMode> decays;
  for (std::size_t s = 0; s < fits.size(); ++s) {
    if (!fits[s].report.usable()) continue;
    for (std::size_t m = 0; m < fits[s].modes.size(); ++m) {
      const RingDownMode& mode = fits[s].modes[m];
      if (!mode.significant()) continue;
      const std::vector<double>& share = file.series[s].bending_share;
      decays.push_back({mode.natural(), m < share.size() ? share[m] : 1.0, mode.decay});
    }
  }
  return decays;
}

}  // namespace snare::identification
