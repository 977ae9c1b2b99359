#include "study/sweep_file.hpp"

#include "base/archive.hpp"
#include "base/csv.hpp"
#include "base/files.hpp"
#include "base/plain_name.hpp"
#include "base/toml_reader.hpp"
#include "study/fixed_keys.hpp"
#include "study/trace_numbers.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace snare::study {

namespace {

using base::Range;
using base::TomlNode;
using base::TomlTable;

/// A variable while the file is read, and where its mistakes are told.
struct Draft {
  TomlTable table;
  const TomlNode* node;  // as it stands in the file
  Variable variable;
  std::string trace, parameter;  // where its distribution comes from
  std::optional<int> points;
  bool numbers = false;  // the levels are numbers
  std::string column;    // of the table of cases
};

constexpr const char* sources[] = {"values",    "range",      "uniform",   "normal",
                                   "lognormal", "triangular", "from_trace"};

constexpr base::Choice<DesignKind> designs[] = {{"grid", DesignKind::grid},
                                                {"latin_hypercube", DesignKind::latin_hypercube},
                                                {"sobol", DesignKind::sobol},
                                                {"file", DesignKind::file},
                                                {"sensitivity", DesignKind::sensitivity},
                                                {"subset", DesignKind::subset}};

class Reader {
 public:
  Reader(std::filesystem::path file, TomlNode root, base::TomlDocument& document)
      : file_(std::move(file)), root_(std::move(root)), document_(document), top_(document.root()) {}

  SweepFile read() {
    base::require_schema(top_, "snare-sweep/1");
    const std::string title = top_.text_or("title", "");
    const std::string source = top_.text_or("source", "");
    const std::filesystem::path case_file = beside(top_.text("case"));
    const std::string verb = top_.text_or("verb", "");
    const double time_limit = top_.number_or("time_limit_s", 3600.0, Range::above(0.0));
    kind_ = top_.choice("design", designs).value_or(DesignKind::grid);
    const std::vector<base::Override> fixed = read_fixed_keys(top_, &root_, "set");
    read_variables();
    DesignSettings settings = read_design();
    std::vector<Collected> collect = read_collect();
    std::vector<Limit> limits = read_limits(collect);
    const SubsetSettings subset = read_subset(limits);
    std::optional<RefineSettings> refine = read_refine(collect);
    std::optional<HistorySettings> histories = read_histories();
    document_.finish();
    std::vector<Variable> variables;
    for (Draft& d : drafts_) variables.push_back(std::move(d.variable));
    std::string canonical = document_.canonical() + beside_;
    return {file_,
            title,
            source,
            case_file,
            verb,
            fixed,
            Design(std::move(variables), std::move(settings)),
            collect,
            limits,
            subset,
            std::move(refine),
            std::move(histories),
            time_limit,
            std::move(canonical)};
  }

 private:
  [[nodiscard]] std::filesystem::path beside(const std::string& name) const {
    const std::filesystem::path path(name);
    return path.is_absolute() ? path : file_.parent_path() / path;
  }

  void read_variables() {
    const TomlNode* list = root_.find("vary");
    const std::vector<TomlTable> tables = top_.tables("vary");
    if (tables.empty()) {
      document_.add(
          {file_.string(), 0, "vary", "", "is missing: what differs from case to case, as [[vary]]"});
      return;
    }
    if (tables.size() > variable_limit) {
      top_.fail("vary", fmt::format("must be at most {}", variable_limit));
      return;
    }
    std::set<std::string> names, keys;
    for (std::size_t k = 0; k < tables.size(); ++k) {
      Draft d{tables[k], &list->items[k], {}, {}, {}, {}, false, {}};
      read_keys(d, keys);
      d.variable.name = d.table.text_or("name", d.variable.keys.front());
      if ((d.table.has("name") || !d.variable.name.empty()) && !base::names_a_column(d.variable.name))
        d.table.fail(
            "name",
            "must be a name without commas, quotes, number signs and line breaks: it is that of a column");
      if (!names.insert(d.variable.name).second) d.table.fail("name", "must not be used twice");
      read_source(d);
      drafts_.push_back(std::move(d));
    }
  }

  void read_keys(Draft& d, std::set<std::string>& used) {
    const bool one = d.table.has("key");
    const bool many = d.table.has("keys");
    if (one == many) {
      d.table.fail("", "must have either key or keys: what gets the value");
    } else if (one) {
      d.variable.keys = {d.table.text("key")};
    } else {
      d.variable.keys = d.table.texts_or_none("keys");
    }
    if (d.variable.keys.empty()) d.variable.keys = {""};
    for (const std::string& key : d.variable.keys) {
      if (!key.empty() && !used.insert(key).second)
        d.table.fail(one ? "key" : "keys", fmt::format("{} must not be varied twice", key));
    }
  }

  void read_source(Draft& d) {
    if (kind_ == DesignKind::file) {
      d.column = d.table.text_or("column", d.variable.name);
      for (const char* key : sources)
        if (d.table.has(key)) d.table.fail(key, "must be left out: the values come from the table of cases");
      return;
    }
    std::vector<const char*> found;
    for (const char* key : sources)
      if (d.table.has(key)) found.push_back(key);
    if (found.size() != 1) {
      d.table.fail("", "must have one of values, range, uniform, normal, lognormal, triangular, from_trace");
      return;
    }
    const std::string_view source = found.front();
    Distribution& dist = d.variable.distribution;
    if (source == "values") {
      read_values(d);
    } else if (source == "range" || source == "uniform") {
      read_range(d, found.front());
    } else if (source == "normal" || source == "lognormal") {
      const TomlTable of = d.table.table(source);
      dist.shape = source == "normal" ? Distribution::Shape::normal : Distribution::Shape::lognormal;
      if (source == "normal") {
        dist.a = of.number("mean", Range::finite());
        dist.b = of.number("sigma", Range::above(0.0));
      } else {
        dist.a = std::log(of.number("median", Range::above(0.0)));
        dist.b = of.number("sigma_log", Range::above(0.0, 10.0));
      }
    } else if (source == "triangular") {
      const std::vector<double> ends = d.table.numbers("triangular", 3, 3, Range::finite());
      if (ends.size() == 3) {
        dist = {Distribution::Shape::triangular, ends[0], ends[2], ends[1]};
        if (!(ends[0] <= ends[1] && ends[1] <= ends[2] && ends[0] < ends[2]))
          d.table.fail("triangular", "must be [low, mode, high], in this order");
      }
    } else {
      read_from_trace(d);
    }
    read_cut(d);
    if (kind_ == DesignKind::grid && d.variable.levels.empty())
      d.table.fail("", "must have values, or range and points, in a grid");
  }

  void read_values(Draft& d) {
    const TomlNode* array = d.node->find("values");
    if (array->kind != TomlNode::Kind::array || array->items.empty()) {
      d.table.fail("values", "must be an array of at least one value");
      return;
    }
    d.numbers = true;
    for (std::size_t i = 0; i < array->items.size(); ++i) {
      const std::string text = literal_of(array->items[i]);
      const bool number = array->items[i].kind == TomlNode::Kind::number;
      d.numbers = d.numbers && number;
      if (text.empty() || (number && !std::isfinite(array->items[i].number)))
        d.table.fail_element("values", i, "must be a finite number, a text, a boolean or an array of them");
      d.variable.levels.push_back(text);
    }
  }

  void read_range(Draft& d, const char* source) {
    const std::vector<double> ends = d.table.numbers(source, 2, 2, Range::finite());
    if (std::string_view(source) == "range" && kind_ == DesignKind::grid)
      d.points = d.table.integer("points", 1, 100000);
    if (ends.size() != 2) return;
    if (!(ends[0] < ends[1])) {
      d.table.fail(source, "must be [low, high], low < high");
      return;
    }
    d.variable.distribution = {Distribution::Shape::uniform, ends[0], ends[1]};
    if (!d.points) return;
    for (int i = 0; i < *d.points; ++i) {
      const double share = *d.points > 1 ? static_cast<double>(i) / (*d.points - 1) : 0.5;
      const double value = i + 1 == *d.points && i > 0 ? ends[1] : ends[0] + share * (ends[1] - ends[0]);
      // Twelve digits hide the roundings of the division: 0.3, not 0.30000000000000004.
      constexpr double rounding = 1e-12;
      const bool zero = std::abs(value) < rounding * (ends[1] - ends[0]);
      d.variable.levels.push_back(zero ? "0" : fmt::format("{:.12g}", value));
    }
    d.numbers = true;
  }

  void read_from_trace(Draft& d) {
    d.trace = d.table.text("from_trace");
    d.parameter = d.table.text_or("parameter", d.variable.keys.front());
    if (d.trace.empty()) return;
    const std::optional<TraceNumbers> numbers =
        base::read_beside(document_, [&] { return read_trace_numbers(beside(d.trace)); });
    if (!numbers) return;
    traces_.emplace(d.trace, *numbers);
    const auto found = std::ranges::find(numbers->keys, d.parameter);
    if (found == numbers->keys.end()) {
      std::string there;
      for (const std::string& key : numbers->keys) there += (there.empty() ? "" : ", ") + key;
      d.table.fail(d.table.has("parameter") ? "parameter" : "from_trace",
                   fmt::format("the trace has no fitted number {} with a standard error; there are: {}",
                               d.parameter, there.empty() ? "none" : there));
      return;
    }
    const auto at = static_cast<std::size_t>(found - numbers->keys.begin());
    d.variable.distribution = {Distribution::Shape::normal, numbers->values[at], numbers->errors[at]};
  }

  void read_cut(Draft& d) {
    if (!d.table.has("within")) return;
    const std::vector<double> ends = d.table.numbers("within", 2, 2, Range::finite());
    if (ends.size() != 2) return;
    if (!d.variable.levels.empty())
      d.table.fail("within", "must be left out where there is a list of values");
    if (!(ends[0] < ends[1])) {
      d.table.fail("within", "must be [low, high], low < high");
      return;
    }
    Distribution& dist = d.variable.distribution;
    dist.lower = ends[0];
    dist.upper = ends[1];
    if (std::isfinite(dist.a) && std::isfinite(dist.b) && dist.a != dist.b && !drawable(dist))
      d.table.fail("within", "must hold more than 1e-9 of the distribution");
  }

  DesignSettings read_design() {
    DesignSettings s;
    s.kind = kind_;
    const bool counted = kind_ != DesignKind::grid && kind_ != DesignKind::file;
    if (counted) {
      const double most =
          case_limit / (kind_ == DesignKind::sensitivity ? 2.0 + static_cast<double>(drafts_.size()) : 1.0);
      s.cases = static_cast<std::uint64_t>(top_.integer("cases", 1, static_cast<int>(most)));
      s.seed = static_cast<std::uint64_t>(top_.integer_or("seed", 1, 0, 2147483647));
    } else {
      if (top_.has("cases")) top_.fail("cases", "must be left out: the design says how many there are");
      if (top_.has("seed")) top_.fail("seed", "must be left out: nothing is drawn in this design");
    }
    if (kind_ == DesignKind::grid) {
      double count = 1.0;
      for (const Draft& d : drafts_) count *= static_cast<double>(d.variable.levels.size());
      if (count > case_limit)
        top_.fail("vary", fmt::format("makes {:.3g} cases, must make at most {:g}", count, case_limit));
    }
    if (kind_ == DesignKind::file) {
      s.table = read_table();
    } else if (top_.has("table")) {
      top_.fail("table", "must be left out but with design = \"file\"");
    }
    read_correlation(s);
    return s;
  }

  std::vector<std::vector<double>> read_table() {
    const std::string name = top_.text("table");
    std::vector<base::CsvColumn> columns;
    for (const Draft& d : drafts_) columns.push_back({.name = d.column});
    if (name.empty() || columns.empty()) return {};
    const auto table = base::read_beside(document_, [&] { return base::read_csv(beside(name), columns); });
    if (!table) return {};
    for (const auto& column : table->columns)
      for (const double x : column) beside_ += fmt::format("{:a},", x);
    return table->columns;
  }

  void read_correlation(DesignSettings& s) {
    const auto n = static_cast<Eigen::Index>(drafts_.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
    bool any = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        const Draft& a = drafts_[static_cast<std::size_t>(i)];
        const Draft& b = drafts_[static_cast<std::size_t>(j)];
        if (a.trace.empty() || a.trace != b.trace || !traces_.contains(a.trace)) continue;
        const double r = traces_.at(a.trace).correlation_of(a.parameter, b.parameter);
        matrix(i, j) = matrix(j, i) = r;
        any = any || r != 0.0;
      }
    }
    const bool listed = top_.has("correlate");
    const std::vector<TomlTable> tables = listed ? top_.tables("correlate") : std::vector<TomlTable>();
    for (const TomlTable& table : tables) {
      const std::vector<std::string> names = table.texts_or_none("names");
      const double r = table.number("correlation", Range{-1.0, 1.0, false});
      std::vector<Eigen::Index> at;
      for (std::size_t k = 0; k < names.size(); ++k) {
        const auto found =
            std::ranges::find(drafts_, names[k], [](const Draft& d) { return d.variable.name; });
        if (found == drafts_.end()) {
          table.fail_element("names", k, "is no name (or key) of a [[vary]]");
        } else if (!found->variable.levels.empty()) {
          table.fail_element("names", k, "is a list of values, which has no correlation");
        } else {
          at.push_back(found - drafts_.begin());
        }
      }
      if (names.size() != 2 || (at.size() == 2 && at[0] == at[1]))
        table.fail("names", "must be two different names");
      if (at.size() == 2) matrix(at[0], at[1]) = matrix(at[1], at[0]) = r;
      any = true;
    }
    if (!any) return;
    if (kind_ == DesignKind::grid || kind_ == DesignKind::file || kind_ == DesignKind::sensitivity) {
      // Sobol's indices are of independent variables; a grid and a table have no distribution.
      if (listed)
        top_.fail("correlate", "must be left out in this design");
      else if (kind_ == DesignKind::sensitivity)
        document_.add({file_.string(), 0, "from_trace", "",
                       "numbers of a trace that are correlated have no Sobol indices"});
      return;
    }
    if (matrix.allFinite() && !is_correlation(matrix))
      top_.fail(listed ? "correlate" : "vary",
                "the correlations contradict each other: the matrix is not positive definite");
    s.correlation = matrix;
  }

  std::vector<Collected> read_collect() {
    std::vector<Collected> fields;
    const TomlTable table = top_.table("collect");
    const TomlNode* node = root_.find("collect");
    if (node == nullptr || node->kind != TomlNode::Kind::table || node->entries.empty()) {
      document_.add(
          {file_.string(), 0, "collect", "", "is missing: names of columns and fields of a case's result"});
      return fields;
    }
    std::set<std::string> names{"case", "status", "reason"};
    for (const Draft& d : drafts_) names.insert(d.variable.name);
    for (const base::TomlEntry& entry : node->entries) {
      const std::string text = table.text(entry.key);
      if (text.empty()) continue;
      std::optional<Collected> field = parse_collected(entry.key, text);
      if (!field) {
        table.fail(entry.key,
                   "must be the place of a field, as outcome.caught or series[s40].largest_force_N; with [*] "
                   "and with nothing else one of min, max, sum, mean, count before it");
        continue;
      }
      if (!names.insert(entry.key).second || !base::names_a_column(entry.key))
        table.fail(entry.key,
                   "must be a name that no other column has, without commas, quotes and number signs");
      for (const char* timed : {"wall_s", "real_time_factor", "seconds"}) {
        if (std::ranges::any_of(field->path, [&](const auto& step) { return step.key == timed; }))
          table.fail(entry.key, "must not be a time that the machine took: it differs from run to run");
      }
      fields.push_back(std::move(*field));
    }
    return fields;
  }

  /// Index of the field that `of` names.
  static std::size_t read_field(const TomlTable& table, const std::string& of,
                                const std::vector<Collected>& fields) {
    const auto found = std::ranges::find(fields, of, &Collected::name);
    if (found == fields.end() && !of.empty()) {
      std::vector<std::string> all;
      all.reserve(fields.size());
      for (const Collected& f : fields) all.push_back(f.name);
      const std::string near = base::nearest_word(of, all);
      table.fail("of", near.empty() ? "must be a name of [collect]"
                                    : fmt::format("must be a name of [collect]; did you mean {}?", near));
    }
    return static_cast<std::size_t>(found - fields.begin());
  }

  std::vector<Limit> read_limits(const std::vector<Collected>& fields) {
    std::vector<Limit> limits;
    std::set<std::string> names;
    for (const TomlTable& table : top_.tables("limits")) {
      Limit limit;
      const std::string of = table.text("of");
      limit.field = read_field(table, of, fields);
      limit.above = table.has("above");
      if (limit.above == table.has("below")) {
        table.fail("", "must have either above or below: the bound beyond which a case counts");
      } else {
        limit.bound = table.number(limit.above ? "above" : "below", Range::finite());
      }
      limit.name = table.text_or("name", fmt::format("{} {} {}", of, limit.above ? ">" : "<", limit.bound));
      if (!names.insert(limit.name).second) table.fail("name", "must not be used twice");
      limits.push_back(limit);
    }
    return limits;
  }

  SubsetSettings read_subset(const std::vector<Limit>& limits) {
    SubsetSettings s;
    if (kind_ != DesignKind::subset) {
      if (top_.has("subset")) top_.fail("subset", "must be left out but with design = \"subset\"");
      return s;
    }
    const TomlTable table = top_.table("subset");
    s.level_probability = table.number_or("level_probability", s.level_probability, Range::above(0.0, 0.5));
    s.most_levels = table.integer_or("levels", s.most_levels, 1, 100);
    if (limits.size() != 1)
      document_.add({file_.string(), 0, "limits", "",
                     "must be one [[limits]]: the event whose probability is asked for"});
    for (const Draft& d : drafts_)
      if (!d.variable.levels.empty()) d.table.fail("values", "must be a distribution in this design");
    const double n =
        static_cast<double>(std::max(1, top_.integer_or("cases", 1, 1, static_cast<int>(case_limit))));
    if (n * s.level_probability < 10.0 && top_.has("cases"))
      top_.fail("cases", fmt::format("must be at least {:.0f}: ten cases start the next level",
                                     std::ceil(10.0 / s.level_probability)));
    return s;
  }

  std::optional<RefineSettings> read_refine(const std::vector<Collected>& fields) {
    if (!top_.has("refine")) return std::nullopt;
    if (kind_ != DesignKind::grid) {
      top_.fail("refine", "must be left out but with design = \"grid\"");
      return std::nullopt;
    }
    RefineSettings s;
    const TomlTable table = top_.table("refine");
    s.field = read_field(table, table.text("of"), fields);
    constexpr int most_levels = 16;
    s.grid.levels = table.integer_or("levels", 2, 1, most_levels);
    s.grid.differs_by = table.number_or("differs_by", 0.0, Range::from(0.0));
    const int width = 1 << static_cast<unsigned>(s.grid.levels);
    double count = 1.0;
    std::size_t refined = 0;
    for (const Draft& d : drafts_) {
      count *= static_cast<double>(d.variable.levels.size());
      const int steps = d.points.value_or(1) - 1;
      s.grid.axes.push_back({d.variable.levels.size(), steps > 0});
      if (steps == 0) continue;
      ++refined;
      if (steps % width != 0)
        d.table.fail("points",
                     fmt::format("must be one more than a multiple of {}, the steps in a first cell of "
                                 "[refine]: {}",
                                 width, std::max(1, (steps + width / 2) / width) * width + 1));
    }
    if (refined == 0 || refined > RefinedGrid::most_axes)
      table.fail("", fmt::format("must have 1 to {} [[vary]] with range and points to refine, not {}",
                                 RefinedGrid::most_axes, refined));
    if (count > static_cast<double>(RefinedGrid::most_points))
      table.fail("", fmt::format("must be of a grid of at most {} cases, not {:.3g}",
                                 RefinedGrid::most_points, count));
    return s;
  }

  std::optional<HistorySettings> read_histories() {
    if (!top_.has("histories")) return std::nullopt;
    HistorySettings kept;
    const TomlTable table = top_.table("histories");
    const TomlNode* node = root_.find("histories");
    const TomlNode* columns = node->kind == TomlNode::Kind::table ? node->find("columns") : nullptr;
    if (columns != nullptr && columns->kind == TomlNode::Kind::text) {
      if (table.text("columns") != "all")
        table.fail("columns", "must be \"all\" or an array of names of columns");
    } else if (columns == nullptr || columns->kind != TomlNode::Kind::array || columns->items.empty()) {
      static_cast<void>(table.has("columns"));
      table.fail(columns != nullptr ? "columns" : "",
                 "must have columns: \"all\" or an array of names of columns");
    } else {
      kept.columns = table.texts_or_none("columns");
      std::set<std::string> names;
      for (std::size_t k = 0; k < kept.columns.size(); ++k)
        if (!names.insert(kept.columns[k]).second)
          table.fail_element("columns", k, "must not be named twice");
    }
    kept.every = table.integer_or("every", 1, 1, 1000000);
    // A case's group has its values beside its number and its status.
    for (const Draft& d : drafts_) {
      if (d.variable.name == "case" || d.variable.name == "status")
        d.table.fail(
            "name",
            "must not be case or status where histories are kept: these are names of what a case has");
    }
    return kept;
  }

  std::filesystem::path file_;
  TomlNode root_;
  base::TomlDocument& document_;
  TomlTable top_;
  DesignKind kind_ = DesignKind::grid;
  std::vector<Draft> drafts_;
  std::map<std::string, TraceNumbers> traces_;
  std::string beside_;  // what files beside the sweep file say
};

}  // namespace

SweepFile read_sweep_file(const std::filesystem::path& file, const std::vector<base::Override>& overrides) {
  TomlNode root = base::parse_toml(file.string(), base::read_text(file, base::TomlDocument::size_limit));
  std::vector<base::InputProblem> problems;
  for (const base::Override& change : overrides) base::apply_override(root, change, problems);
  base::TomlDocument document(file.string(), root);
  for (base::InputProblem& problem : problems) document.add(std::move(problem));
  return Reader(file, std::move(root), document).read();
}

std::vector<base::Override> overrides_of(const SweepFile& sweep, const std::vector<double>& values) {
  std::vector<base::Override> all = sweep.fixed;
  const std::vector<Variable>& variables = sweep.design.variables();
  for (std::size_t j = 0; j < variables.size(); ++j)
    for (const std::string& key : variables[j].keys) all.push_back({key, literal(variables[j], values[j])});
  return all;
}

}  // namespace snare::study
