#include "scenario/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace snare::scenario {

using base::TomlTable;

Placement::Placement() {
  frames_["world"] = {};
}

void Placement::add(const std::string& name, const PlacedFrame& frame) {
  frames_.try_emplace(name, frame);
}

void Placement::stand(const TomlTable& table, std::string key, std::string own, Place place) {
  std::string on = table.text_or(key, "world");
  waiting_.push_back({table, std::move(key), std::move(on), std::move(own), std::move(place)});
}

bool Placement::is_excused(const std::string& name) const {
  return std::any_of(excused_.begin(), excused_.end(),
                     [&](const std::string& own) { return name == own || name.starts_with(own + "::"); });
}

bool Placement::brings(const Waiting& waiting, const std::string& name) const {
  return name == waiting.own || name.starts_with(waiting.own + "::");
}

void Placement::resolve() {
  for (bool progress = true; progress;) {
    progress = false;
    std::vector<Waiting> left;
    for (Waiting& w : std::exchange(waiting_, {})) {
      const std::optional<PlacedFrame> on = find(w.on);
      if (!on) {
        left.push_back(std::move(w));
        continue;
      }
      w.place(*on, *this);
      progress = true;
    }
    for (Waiting& w : left) waiting_.push_back(std::move(w));
  }
  for (const Waiting& w : waiting_) {
    if (is_excused(w.on)) continue;
    const bool waits = std::any_of(waiting_.begin(), waiting_.end(),
                                   [&](const Waiting& other) { return brings(other, w.on); });
    w.table.fail(w.key, waits ? "must not stand on itself by way of others, nor on a frame that they lack"
                              : requirement());
  }
  // So that what names them is not reported as well.
  while (!waiting_.empty()) {
    for (const Waiting& w : std::exchange(waiting_, {})) w.place({}, *this);
  }
}

std::optional<PlacedFrame> Placement::find(const std::string& name) const {
  const auto found = frames_.find(name);
  return found == frames_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<PlacedFrame> Placement::frame(const TomlTable& table, std::string_view key) const {
  const std::string name = table.text_or(key, "world");
  std::optional<PlacedFrame> found = find(name);
  if (!found && !name.empty() && !is_excused(name)) table.fail(key, requirement());
  return found;
}

std::string Placement::requirement() const {
  std::string list;
  std::size_t count = 0;
  constexpr std::size_t most = 40;
  for (const auto& [name, frame] : frames_) {
    if (++count > most) break;
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name);
  }
  return fmt::format("must be the name of a frame: {}{}", list, count > most ? ", ..." : "");
}

}  // namespace snare::scenario
