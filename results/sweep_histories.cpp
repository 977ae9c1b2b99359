#include "results/sweep_histories.hpp"

#include "base/archive.hpp"
#include "base/files.hpp"
#include "base/own_file.hpp"
#include "results/hdf5_file.hpp"
#include "results/sweep_answers.hpp"
#include "results/version.hpp"
#include "study/case_record.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace snare::results {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view schema = "snare-sweep-histories/1";
constexpr std::string_view part_ending = ".part";

/// A part begins with this line; its columns and the fingerprint of these follow.
std::string head_of(const SweepStudy& study, std::uint64_t index) {
  return fmt::format("snare-history/1 {} {}\n", study.identity(), index + 1);
}

bool has_history(const study::CaseRecord& record) {
  return record.done() || record.status == "failed";
}

/// The record of a case in the journal, where it is one that has a history.
std::optional<study::CaseRecord> record_with_history(const study::Journal& journal, std::uint64_t index) {
  const std::optional<std::string> line = journal.result(index);
  std::optional<study::CaseRecord> record = line ? study::record_of(*line) : std::nullopt;
  if (record && !has_history(*record)) record.reset();
  return record;
}

/// A variable of a case as cases.csv has it: a number, a text, and 1 or 0 of a boolean.
Hdf5Value shown_value(const study::Variable& variable, double value) {
  if (const std::optional<double> number = shown_number(variable, value)) return *number;
  const std::string literal = study::literal(variable, value);
  const nlohmann::json level = nlohmann::json::parse(literal, nullptr, false);
  if (level.is_boolean()) return static_cast<std::int64_t>(level.get<bool>() ? 1 : 0);
  return level.is_string() ? level.get<std::string>() : literal;
}

/// Temporary files that a process has left which was killed while it wrote `name`, or anything where that is
/// empty.
void remove_unfinished(const fs::path& folder, const std::string& name) {
  std::error_code code;
  std::vector<fs::path> left;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const std::string one = entry.path().filename().string();
    if (one.starts_with("." + name) && one.ends_with(".tmp")) left.push_back(entry.path());
  }
  for (const fs::path& one : left) fs::remove(one, code);
}

}  // namespace

SweepHistories::SweepHistories(const SweepStudy& study, const fs::path& out)
    : study_(study), folder_(out / "histories"), file_(out / "histories.h5") {}

fs::path SweepHistories::part(std::uint64_t index) const {
  return folder_ / fmt::format("{:06}{}", index + 1, part_ending);
}

bool SweepHistories::joined() const {
  return is_whole_hdf5(file_) && text_attribute(file_, "identity") == study_.identity();
}

bool SweepHistories::damaged() const {
  return fs::exists(file_) && !is_whole_hdf5(file_);
}

bool SweepHistories::has(std::uint64_t index) const {
  const fs::path file = part(index);
  if (!fs::is_regular_file(file)) return false;
  const base::InputFile opened = base::open_input(file);
  const std::string head = head_of(study_, index);
  std::string begin(head.size(), '\0');
  begin.resize(base::read_bytes(opened.handle.get(), begin.data(), begin.size(), file));
  return begin == head;
}

void SweepHistories::keep(std::uint64_t index, History& history) const {
  base::ByteWriter columns;
  columns(history);
  std::uint64_t sum = base::fingerprint(columns.bytes());
  base::ByteWriter end;
  end(sum);
  base::AtomicFile file(part(index));
  file.write(head_of(study_, index));
  file.write(columns.bytes());
  file.write(end.bytes());
  file.commit();
}

History SweepHistories::read(std::uint64_t index) const {
  const fs::path file = part(index);
  History history;
  try {
    const std::string all = base::read_own(file, std::numeric_limits<std::size_t>::max());
    const std::string head = head_of(study_, index);
    std::uint64_t sum = 0;
    if (!all.starts_with(head) || all.size() < head.size() + sizeof sum)
      throw std::runtime_error("it is another's");
    const std::string_view columns =
        std::string_view(all).substr(head.size(), all.size() - head.size() - sizeof sum);
    base::ByteReader(std::string_view(all).substr(all.size() - sizeof sum))(sum);
    if (sum != base::fingerprint(columns)) throw std::runtime_error("its checksum is another");
    base::ByteReader reader(columns);
    reader(history);
  } catch (const std::runtime_error& error) {
    std::error_code ignored;
    fs::remove(file, ignored);
    throw std::runtime_error(fmt::format(
        "{}: the history of case {} is missing or damaged; the same command runs this case again, in a "
        "folder that all ranks see ({})",
        file.string(), index + 1, error.what()));
  }
  return history;
}

std::set<std::uint64_t> SweepHistories::missing(const study::Journal& journal) const {
  require_hdf5();
  std::set<std::uint64_t> cases;
  if (joined()) return cases;
  for (std::uint64_t k = 0; k < journal.end(); ++k)
    if (record_with_history(journal, k) && !has(k)) cases.insert(k);
  return cases;
}

void SweepHistories::join(const study::Journal& journal, std::uint64_t cases) const {
  if (!joined()) {
    remove_unfinished(file_.parent_path(), file_.filename().string());
    base::AtomicFile whole(file_);
    write(whole.temporary(), journal, cases);
    whole.commit();
  }
  remove_parts();
}

void SweepHistories::write(const fs::path& file, const study::Journal& journal, std::uint64_t cases) const {
  Hdf5Writer hdf5(file, file_);
  const study::SweepFile& sweep = study_.sweep();
  const std::vector<study::Variable>& variables = sweep.design.variables();
  std::vector<std::string> names;
  for (const study::Variable& v : variables) names.push_back(v.name);
  hdf5.attributes({{"schema", std::string(schema)},
                   {"version", version()},
                   {"title", sweep.title},
                   {"source", sweep.source},
                   {"verb", study_.runner().verb()},
                   {"variables", names},
                   {"every", static_cast<std::int64_t>(sweep.histories->every)},
                   {"identity", study_.identity()}});
  const std::size_t digits = std::max<std::size_t>(6, std::to_string(cases).size());
  for (std::uint64_t k = 0; k < cases; ++k) {
    const std::optional<study::CaseRecord> record = record_with_history(journal, k);
    if (!record) continue;
    const History history = read(k);
    Hdf5Attributes attributes{{"case", static_cast<std::int64_t>(k + 1)}, {"status", record->status}};
    const std::vector<double> values = values_of_case(study_, k, *record);
    for (std::size_t j = 0; j < values.size(); ++j) {
      attributes.emplace_back(variables[j].name, shown_value(variables[j], values[j]));
    }
    const std::string group = fmt::format("/case_{:0{}}", k + 1, digits);
    hdf5.group(group, attributes);
    for (const HistoryColumn& column : history.columns) {
      Hdf5Attributes unit;
      if (const std::string words = unit_of_column(column.name); !words.empty())
        unit.emplace_back("unit", words);
      if (column.texts.empty())
        hdf5.dataset(group + "/" + column.name, column.numbers, unit);
      else
        hdf5.dataset(group + "/" + column.name, column.texts, unit);
    }
  }
  hdf5.close();
}

void SweepHistories::remove_parts() const {
  std::error_code code;
  std::vector<fs::path> parts;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, code))
    if (entry.path().extension() == part_ending) parts.push_back(entry.path());
  for (const fs::path& one : parts) fs::remove(one, code);
  remove_unfinished(folder_, "");
  fs::remove(folder_, code);  // stays where somebody has put something else into it
}

}  // namespace snare::results
