#include "identification/ring_down/ring_down_file.hpp"

#include "base/csv.hpp"
#include "base/plain_name.hpp"
#include "base/toml_reader.hpp"
#include "base/units.hpp"
#include "scenario/push_reader.hpp"

#include <fmt/format.h>

#include <limits>
#include <set>

namespace snare::identification {

using base::CsvColumn;
using base::Range;
using base::TomlDocument;
using base::TomlTable;

namespace {

constexpr std::string_view schema = "snare-ringdown/1";
using base::mm;
constexpr double longest = 1e6;  // [s]
constexpr std::size_t most_rows = 200000;
constexpr int most_modes = 6;

RingDown read_readings(TomlDocument& document, const TomlTable& table, const std::filesystem::path& folder) {
  RingDown data;
  const std::string name = table.text("file");
  const double from =
      table.number_or("from_s", -std::numeric_limits<double>::infinity(), Range::from(-longest, longest));
  const double to =
      table.number_or("to_s", std::numeric_limits<double>::infinity(), Range::from(-longest, longest));
  if (to <= from) table.fail("to_s", "must be > from_s");
  if (name.empty()) return data;
  const std::filesystem::path path = folder / name;
  if (!std::filesystem::is_regular_file(path)) {
    table.fail("file", fmt::format("{}: must be a CSV file beside this one", path.string()));
    return data;
  }
  try {
    const base::CsvTable csv = base::read_csv(
        path, {{"time_s", CsvColumn::Presence::required, Range::from(-longest, longest), 1.0,
                CsvColumn::Order::non_decreasing},
               {"displacement_mm", CsvColumn::Presence::required, Range::from(-1e4, 1e4), mm}});
    std::vector<double> time;
    std::vector<double> displacement;
    for (std::size_t i = 0; i < csv.rows; ++i) {
      if (csv.columns[0][i] < from || csv.columns[0][i] > to) continue;
      time.push_back(csv.columns[0][i]);
      displacement.push_back(csv.columns[1][i]);
    }
    data.time = Eigen::Map<const Eigen::VectorXd>(time.data(), static_cast<Eigen::Index>(time.size()));
    data.displacement = Eigen::Map<const Eigen::VectorXd>(displacement.data(),
                                                          static_cast<Eigen::Index>(displacement.size()));
    if (time.empty()) table.fail("file", fmt::format("{} has no reading from from_s to to_s", path.string()));
    if (time.size() > most_rows)
      table.fail("file", fmt::format("{} has {} readings, must have at most {}: thin it out", path.string(),
                                     time.size(), most_rows));
  } catch (const base::InputError& error) {
    for (const base::InputProblem& problem : error.problems()) document.add(problem);
  }
  return data;
}

RingDownSeries read_series(TomlDocument& document, const TomlTable& table,
                           const std::filesystem::path& folder) {
  RingDownSeries series;
  series.data = read_readings(document, table, folder);
  series.data.name = table.text("name");
  base::require_plain_name(table, "name", series.data.name);
  series.data.modes = table.integer_or("modes", 1, 1, most_modes);
  series.data.friction = table.boolean_or("friction", true);
  if (table.has("bending_share")) {
    series.bending_share =
        table.numbers("bending_share", 1, static_cast<std::size_t>(most_modes), Range::above(0.0, 1e3));
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

RingDownFile read_ring_down_file(const std::filesystem::path& file,
                                 const std::vector<base::Override>& overrides) {
  TomlDocument document(file, overrides);
  const TomlTable root = document.root();
  base::require_schema(root, schema);
  RingDownFile result;
  result.file = file;
  result.title = root.text("title");
  result.source = root.text_or("source", "");
  if (root.has("wire") || root.has("mount")) {
    const scenario::PushTables tables{root.table("wire"), root.table("mount"), root.table("wire"),
                                      root.table("wire"), root.table("wire")};
    result.wire = scenario::read_wire_and_mounts(tables);
    if (result.wire->mount.kind == wire::MountKind::supports)
      tables.mount.fail("kind", "must be \"clamped\" or \"pinned\"");
    for (const char* key : scenario::keys_of_giving_mounts()) {
      if (tables.mount.has(key)) tables.mount.fail(key, "mounts are rigid in motion");
    }
    for (const char* key : {"yield_stress_MPa", "natural_curvature_1_m"}) {
      if (tables.wire.has(key))
        tables.wire.fail(key, "the wire does not yield and is naturally straight in motion");
    }
    if (tables.wire.has("strand_slip_breadth"))
      tables.wire.fail("strand_slip_breadth", "all strands slide at one curvature in motion");
  }
  std::set<std::string> names;
  for (const TomlTable& table : root.tables("series")) {
    result.series.push_back(read_series(document, table, file.parent_path()));
    if (!names.insert(result.series.back().data.name).second)
      table.fail("name", "is taken by another series");
  }
  if (result.series.empty()) root.fail("series", "must have at least one [[series]]");
  document.finish();
  return result;
}

}  // namespace snare::identification
