#include "study/collect.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace snare::study {

namespace {

using nlohmann::json;
using Taken = Collected::Taken;

constexpr std::pair<std::string_view, Taken> taken_words[] = {{"min ", Taken::least},
                                                              {"max ", Taken::most},
                                                              {"sum ", Taken::sum},
                                                              {"mean ", Taken::mean},
                                                              {"count ", Taken::count}};

/// Under what an element of an array may have its name.
constexpr const char* naming_keys[] = {"name", "series", "model",  "contact",
                                       "body", "wire",   "effect", "joint"};

std::string words_of(const json& node) {
  constexpr std::size_t most = 12;
  std::string text;
  std::size_t count = 0;
  const auto add = [&](const std::string& word) {
    if (count++ < most) text += (text.empty() ? "" : ", ") + word;
  };
  if (node.is_object()) {
    for (const auto& [key, value] : node.items()) add(key);
  } else {
    for (std::size_t i = 0; i < node.size(); ++i) {
      std::string name = std::to_string(i + 1);
      for (const char* key : naming_keys) {
        if (node[i].is_object() && node[i].contains(key) && node[i][key].is_string()) {
          name = node[i][key].get<std::string>();
          break;
        }
      }
      add(name);
    }
  }
  return count > most ? text + ", ..." : text;
}

const json* element(const json& array, const std::string& wanted) {
  for (const char* key : naming_keys) {
    for (const json& one : array) {
      const auto found = one.is_object() ? one.find(key) : one.end();
      if (one.is_object() && found != one.end() && found->is_string() &&
          found->get_ref<const std::string&>() == wanted)
        return &one;
    }
  }
  std::size_t number = 0;
  const char* end = wanted.data() + wanted.size();
  const auto [stop, error] = std::from_chars(wanted.data(), end, number);
  return error == std::errc() && stop == end && number >= 1 && number <= array.size() ? &array[number - 1]
                                                                                      : nullptr;
}

void walk(const json& node, const Collected& field, std::size_t step, std::vector<const json*>& found) {
  if (step == field.path.size() || node.is_null()) {  // what is not known has no parts
    found.push_back(&node);
    return;
  }
  const auto& [key, bracket] = field.path[step];
  if (bracket && key == "*" && node.is_structured()) {
    for (const json& one : node) walk(one, field, step + 1, found);
    return;
  }
  const json* next = nullptr;
  if (node.is_object()) {
    const auto at = node.find(key);
    if (at != node.end()) next = &*at;
  } else if (node.is_array() && bracket) {
    next = element(node, key);
  }
  if (next == nullptr) {
    throw std::out_of_range(
        node.is_structured()
            ? fmt::format("the result has no {}: no {} there; there are: {}", field.text, key,
                          node.empty() ? "none" : words_of(node))
            : fmt::format("the result has no {}: nothing is below what stands before {}", field.text, key));
  }
  walk(*next, field, step + 1, found);
}

/// Of the bracket that a text begins with: what is between may be a key that has brackets itself.
std::size_t closing_bracket(std::string_view text) {
  int open = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '[') ++open;
    if (text[k] == ']' && --open == 0) return k;
  }
  return std::string_view::npos;
}

}  // namespace

std::optional<Collected> parse_collected(std::string name, std::string_view text) {
  Collected field{std::move(name), std::string(text), Taken::value, {}};
  for (const auto& [word, taken] : taken_words) {
    if (!text.starts_with(word)) continue;
    field.taken = taken;
    text.remove_prefix(word.size());
    break;
  }
  bool several = false;
  while (!text.empty()) {
    const std::size_t at = std::min(text.find_first_of(".["), text.size());
    if (at == 0) return std::nullopt;
    field.path.push_back({std::string(text.substr(0, at)), false});
    text.remove_prefix(at);
    while (text.starts_with('[')) {
      const std::size_t end = closing_bracket(text);
      if (end == std::string_view::npos || end == 1) return std::nullopt;
      field.path.push_back({std::string(text.substr(1, end - 1)), true});
      several = several || field.path.back().key == "*";
      text.remove_prefix(end + 1);
    }
    if (text.empty()) break;
    if (text.front() != '.' || text.size() == 1) return std::nullopt;
    text.remove_prefix(1);
  }
  if (field.path.empty() || several != (field.taken != Taken::value)) return std::nullopt;
  return field;
}

json collected(const Collected& field, const json& result) {
  std::vector<const json*> found;
  walk(result, field, 0, found);
  if (field.taken == Taken::value) {
    const json& one = *found.front();
    if (one.is_structured())
      throw std::out_of_range(fmt::format("{} is no single value; there are: {}", field.text, words_of(one)));
    if (one.is_number_float() && !std::isfinite(one.get<double>())) return {};
    return one;
  }
  double count = 0.0;
  double sum = 0.0;
  std::optional<double> least, most;
  for (const json* one : found) {
    if (one->is_null()) continue;
    if (!one->is_number() && !one->is_boolean())
      throw std::out_of_range(fmt::format("{}: not all of these are numbers", field.text));
    const double value = one->is_boolean() ? (one->get<bool>() ? 1.0 : 0.0) : one->get<double>();
    if (!std::isfinite(value)) continue;
    count += one->is_boolean() ? value : 1.0;
    sum += value;
    least = std::min(value, least.value_or(value));
    most = std::max(value, most.value_or(value));
  }
  if (field.taken == Taken::count) return count;
  if (!least) return {};
  switch (field.taken) {
    case Taken::least:
      return *least;
    case Taken::most:
      return *most;
    case Taken::sum:
      return sum;
    default:
      break;
  }
  double known = 0.0;
  for (const json* one : found) known += one->is_null() ? 0.0 : 1.0;
  return sum / known;
}

}  // namespace snare::study
