#include "base/toml_reader.hpp"

#include "base/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace snare::base {

namespace {

std::string dotted(const std::string& address, std::string_view key) {
  if (address.empty() || key.empty()) return address.empty() ? std::string(key) : address;
  return fmt::format("{}.{}", address, key);
}

std::string number_requirement(std::string_view kind, Range range) {
  const std::string phrase = range.phrase();
  return fmt::format("must be {}{}{}", kind, phrase.empty() ? "" : " ", phrase);
}

/// "a", "a or b", "a, b or c", each in quotes.
std::string alternatives(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += fmt::format("\"{}\"", names[i]);
  }
  return text;
}

/// Optimal string alignment distance (Damerau 1964, restricted): dynamic programming over prefixes.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        current[j] = std::min(current[j], before[j - 2] + 1);
    }
    before.swap(previous);
    previous.swap(current);
  }
  return previous[b.size()];
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 100;  // of a key that can be a slip of the finger
  if (word.size() > longest) return {};
  std::string nearest;
  std::size_t smallest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance >= smallest || distance >= candidate.size()) continue;
    smallest = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string nearest_or_all(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_word(word, candidates);
  return nearest.empty() ? fmt::format(": {}", fmt::join(candidates, ", "))
                         : fmt::format("; did you mean {}?", nearest);
}

TomlDocument::TomlDocument(const std::filesystem::path& file, const std::vector<Override>& overrides)
    : TomlDocument(file.string(), read_text(file, size_limit), overrides) {}

TomlDocument::TomlDocument(const std::string& file, std::string_view text,
                           const std::vector<Override>& overrides)
    : TomlDocument(file, parse_toml(file, text), overrides) {}

TomlDocument::TomlDocument(std::string file, TomlNode root, const std::vector<Override>& overrides)
    : file_(std::move(file)), root_(std::move(root)) {
  for (const Override& change : overrides) apply_override(root_, change, problems_);
}

TomlTable TomlDocument::root() {
  return TomlTable(*this, &root_, "", false);
}

void TomlDocument::add(InputProblem problem) {
  if (problems_.size() >= problem_limit) {
    more_ = true;
    return;
  }
  if (messages_.insert(problem.message()).second) problems_.push_back(std::move(problem));
}

void TomlDocument::report(const TomlNode& at, std::string key, std::string requirement) {
  add({at.overridden ? "--set" : file_of(&at), at.line, std::move(key), at.written, std::move(requirement)});
}

std::string TomlDocument::file_of(const TomlNode* at) const {
  return at != nullptr && at->part ? at->part->file : file_;
}

std::string TomlDocument::suggestion(std::string_view key, const Visit& visit) const {
  std::string nearest = nearest_word(key, {visit.asked.begin(), visit.asked.end()});
  for (const auto& [node, other] : visits_)  // the right key in the wrong table
    if (nearest.empty() && !other.address.empty() && other.asked.contains(key))
      nearest = dotted(other.address, key);
  if (!nearest.empty()) return fmt::format("unknown key; did you mean {}?", nearest);
  std::vector<std::string> known(visit.asked.begin(), visit.asked.end());
  std::erase(known, "");  // asked for by what is said of a whole table
  return known.empty() ? "unknown key" : fmt::format("unknown key; known here: {}", fmt::join(known, ", "));
}

void TomlDocument::report_unknown_keys() {
  for (const auto& [node, visit] : visits_) {
    for (const TomlEntry& entry : node->entries) {
      if (more_) return;
      if (!visit.asked.contains(entry.key))
        report(entry.node, dotted(visit.address, entry.key), suggestion(entry.key, visit));
    }
  }
}

std::string TomlDocument::canonical(std::string_view without) const {
  const std::size_t dot = without.find('.');
  if (dot == std::string_view::npos) return canonical_text(root_);
  TomlNode root = root_;
  for (TomlEntry& entry : root.entries) {
    if (entry.key == without.substr(0, dot))
      std::erase_if(entry.node.entries, [&](const TomlEntry& e) { return e.key == without.substr(dot + 1); });
  }
  std::erase_if(root.entries, [&](const TomlEntry& e) {
    return e.key == without.substr(0, dot) && e.node.kind == TomlNode::Kind::table && e.node.entries.empty();
  });
  return canonical_text(root);
}

void TomlDocument::finish() {
  report_unknown_keys();
  if (problems_.empty()) return;
  const auto rank = [&](const InputProblem& problem) {
    const int group = problem.file == file_ ? 0 : problem.file == "--set" ? 1 : 2;
    return std::tuple(group, group == 0 ? problem.line : 0);
  };
  std::stable_sort(problems_.begin(), problems_.end(),
                   [&](const InputProblem& a, const InputProblem& b) { return rank(a) < rank(b); });
  if (more_)
    problems_.push_back(
        {file_, 0, "", "", fmt::format("and more: only {} problems are listed", problem_limit)});
  throw InputError(problems_);
}

TomlTable::TomlTable(TomlDocument& document, const TomlNode* node, std::string address, bool broken)
    : document_(&document), layers_{{node, std::move(address), broken}} {
  if (node != nullptr) document.visits_[node].address = layers_.front().address;
}

TomlTable TomlTable::over(const TomlTable& base) const {
  TomlTable both = *this;
  both.layers_.insert(both.layers_.end(), base.layers_.begin(), base.layers_.end());
  return both;
}

TomlTable::Found TomlTable::find(std::string_view key) const {
  Found found;
  for (const Layer& layer : layers_) {
    if (layer.node == nullptr) continue;
    document_->visits_[layer.node].asked.emplace(key);
    const TomlNode* node = layer.node->find(key);
    if (node != nullptr && found.node == nullptr) found = {node, dotted(layer.address, key)};
  }
  return found;
}

bool TomlTable::has(std::string_view key) const {
  return find(key).node != nullptr;
}

void TomlTable::missing(std::string_view key, const std::string& requirement) const {
  // With several layers the last is the general one, where the key belongs.
  const Layer& layer = layers_.back();
  if (std::any_of(layers_.begin(), layers_.end(), [](const Layer& one) { return one.broken; })) return;
  const bool nowhere =
      std::all_of(layers_.begin(), layers_.end(), [](const Layer& one) { return !one.node; });
  InputProblem problem{document_->file_of(layer.node), layer.node ? layer.node->line : 0, layer.address, "",
                       ""};
  if (nowhere) {
    problem.requirement = "missing, must be a table";
  } else {
    problem.key = dotted(layer.address, key);
    problem.requirement = "missing, " + requirement;
  }
  document_->add(std::move(problem));
}

std::optional<double> TomlTable::checked(const Found& found, Range range, double unit) const {
  const TomlNode& node = *found.node;
  const bool is_number = node.kind == TomlNode::Kind::number;
  if (is_number && range.contains(node.number)) return to_si(node.number, unit);
  const std::string_view kind = !is_number                    ? "a number"
                                : !std::isfinite(node.number) ? "a finite number"
                                                              : "";
  const std::string phrase = range.phrase();
  document_->report(node, found.address,
                    kind.empty() ? "must be " + phrase : number_requirement(kind, range));
  return std::nullopt;
}

double TomlTable::number(std::string_view key, Range range, double unit) const {
  const Found found = find(key);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (found.node != nullptr) return checked(found, range, unit).value_or(nan);
  missing(key, number_requirement("a number", range));
  return nan;
}

double TomlTable::number_or(std::string_view key, double otherwise, Range range, double unit) const {
  return has(key) ? number(key, range, unit) : otherwise;
}

std::optional<double> TomlTable::optional_number(std::string_view key, Range range, double unit) const {
  return has(key) ? std::optional(number(key, range, unit)) : std::nullopt;
}

int TomlTable::integer(std::string_view key, int low, int high) const {
  const Range range = Range::from(low, high);
  const Found found = find(key);
  if (found.node == nullptr) {
    missing(key, number_requirement("an integer", range));
    return low;
  }
  const TomlNode& node = *found.node;
  if (node.kind == TomlNode::Kind::number && node.integer && range.contains(node.number))
    return static_cast<int>(node.number);
  document_->report(node, found.address, number_requirement("an integer", range));
  return low;
}

int TomlTable::integer_or(std::string_view key, int otherwise, int low, int high) const {
  return has(key) ? integer(key, low, high) : otherwise;
}

bool TomlTable::boolean_or(std::string_view key, bool otherwise) const {
  const Found found = find(key);
  if (found.node == nullptr) return otherwise;
  if (found.node->kind == TomlNode::Kind::boolean) return found.node->boolean;
  document_->report(*found.node, found.address, "must be true or false");
  return otherwise;
}

std::string TomlTable::text(std::string_view key) const {
  const Found found = find(key);
  if (found.node == nullptr) {
    missing(key, "must be a text in quotes");
    return {};
  }
  if (found.node->kind == TomlNode::Kind::text) return found.node->text;
  document_->report(*found.node, found.address, "must be a text in quotes");
  return {};
}

std::string TomlTable::text_or(std::string_view key, std::string otherwise) const {
  return has(key) ? text(key) : std::move(otherwise);
}

std::vector<double> TomlTable::numbers(std::string_view key, std::size_t least, std::size_t most, Range range,
                                       double unit) const {
  const std::string count = least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
  const std::string requirement = fmt::format("must be an array of {} numbers", count);
  const Found found = find(key);
  if (found.node == nullptr) {
    missing(key, requirement);
    return {};
  }
  const TomlNode& array = *found.node;
  if (array.kind != TomlNode::Kind::array || array.items.size() < least || array.items.size() > most) {
    document_->report(array, found.address, requirement);
    return {};
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < array.items.size(); ++i) {
    const Found item{&array.items[i], fmt::format("{}[{}]", found.address, i + 1)};
    if (const std::optional<double> value = checked(item, range, unit)) values.push_back(*value);
  }
  if (values.size() < array.items.size()) values.clear();
  return values;
}

std::vector<double> TomlTable::numbers_or_one(std::string_view key, std::size_t count, Range range,
                                              double unit) const {
  const Found found = find(key);
  if (found.node == nullptr || found.node->kind != TomlNode::Kind::number)
    return numbers(key, count, count, range, unit);
  const std::optional<double> value = checked(found, range, unit);
  return value ? std::vector<double>(count, *value) : std::vector<double>();
}

std::vector<std::string> TomlTable::texts_or_none(std::string_view key) const {
  const Found found = find(key);
  if (found.node == nullptr) return {};
  if (found.node->kind != TomlNode::Kind::array) {
    document_->report(*found.node, found.address, "must be an array of texts in quotes");
    return {};
  }
  std::vector<std::string> values;
  for (std::size_t i = 0; i < found.node->items.size(); ++i) {
    const TomlNode& item = found.node->items[i];
    if (item.kind == TomlNode::Kind::text)
      values.push_back(item.text);
    else
      document_->report(item, fmt::format("{}[{}]", found.address, i + 1), "must be a text in quotes");
  }
  if (values.size() < found.node->items.size()) values.clear();
  return values;
}

std::optional<std::size_t> TomlTable::choice_index(std::string_view key,
                                                   const std::vector<std::string_view>& names) const {
  const std::string requirement = "must be " + alternatives(names);
  const Found found = find(key);
  if (found.node == nullptr) {
    missing(key, requirement);
    return std::nullopt;
  }
  const auto at = std::find(names.begin(), names.end(), found.node->text);
  if (found.node->kind == TomlNode::Kind::text && at != names.end())
    return static_cast<std::size_t>(at - names.begin());
  document_->report(*found.node, found.address, requirement);
  return std::nullopt;
}

std::string TomlTable::scope() const {
  const TomlNode* node = layers_.front().node;
  return node != nullptr && node->part ? node->part->scope : std::string();
}

void require_schema(const TomlTable& root, std::string_view schema) {
  const Choice<bool> only[] = {{schema, true}};
  static_cast<void>(root.choice("schema", only));
}

bool TomlTable::holds_table(std::string_view key) const {
  const Found found = find(key);
  return found.node != nullptr && found.node->kind == TomlNode::Kind::table;
}

TomlTable TomlTable::table(std::string_view key) const {
  const Found found = find(key);
  if (found.node == nullptr)
    return TomlTable(*document_, nullptr, dotted(address(), key), layers_.front().broken);
  if (found.node->kind == TomlNode::Kind::table)
    return TomlTable(*document_, found.node, found.address, false);
  document_->report(*found.node, found.address, "must be a table");
  return TomlTable(*document_, nullptr, found.address, true);
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  const Found found = find(key);
  if (found.node == nullptr) return {};
  if (found.node->kind != TomlNode::Kind::array) {
    document_->report(*found.node, found.address, fmt::format("must be tables, each headed [[{}]]", key));
    return {};
  }
  std::vector<TomlTable> elements;
  for (std::size_t i = 0; i < found.node->items.size(); ++i) {
    const TomlNode& item = found.node->items[i];
    const std::string element = fmt::format("{}[{}]", found.address, element_label(item, i));
    const bool is_table = item.kind == TomlNode::Kind::table;
    if (!is_table) document_->report(item, element, "must be a table");
    elements.push_back(TomlTable(*document_, is_table ? &item : nullptr, element, !is_table));
  }
  return elements;
}

void TomlTable::fail(std::string_view key, std::string requirement) const {
  const Found found = find(key);
  if (found.node != nullptr) return document_->report(*found.node, found.address, std::move(requirement));
  const Layer& layer = layers_.front();
  InputProblem problem{document_->file_of(layer.node), layer.node ? layer.node->line : 0,
                       dotted(layer.address, key), "", std::move(requirement)};
  document_->add(std::move(problem));
}

void TomlTable::fail_element(std::string_view key, std::size_t index, std::string requirement) const {
  const Found found = find(key);
  if (found.node == nullptr || index >= found.node->items.size()) return fail(key, std::move(requirement));
  document_->report(found.node->items[index], fmt::format("{}[{}]", found.address, index + 1),
                    std::move(requirement));
}

}  // namespace snare::base
