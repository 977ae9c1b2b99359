#include "base/inputs.hpp"

#include "base/errors.hpp"
#include "base/sha256.hpp"

#include <fmt/format.h>

#include <utility>

namespace snare::base {

namespace {

namespace fs = std::filesystem;

thread_local std::shared_ptr<Inputs> of_thread;

/// The entry of a folder that a name stands for: links in the folder's own path are followed, a link of this
/// name is not.
fs::path entry_of(const fs::path& path) {
  std::error_code code;
  const fs::path absolute = fs::absolute(path, code);
  const fs::path folder = fs::weakly_canonical(absolute.parent_path(), code);
  return code ? absolute.lexically_normal() : folder / absolute.filename();
}

fs::path resolved(const fs::path& path) {
  std::error_code code;
  fs::path target = fs::weakly_canonical(path, code);
  return code ? path : target;
}

}  // namespace

std::shared_ptr<const std::string> Inputs::text(const fs::path& path, std::size_t limit,
                                                const std::function<std::string()>& read) {
  const fs::path entry = entry_of(path);
  const std::scoped_lock lock(mutex_);
  const auto found = entries_.find(entry.string());
  if (found == entries_.end()) {
    auto text = std::make_shared<const std::string>(read());
    entries_.emplace(entry.string(), Entry{path, resolved(entry), text});
    return text;
  }
  if (const std::size_t size = found->second.text->size(); size > limit)
    throw InputError(
        {path.string(), 0, "", "", fmt::format("has {} bytes, must have at most {}", size, limit)});
  return found->second.text;
}

std::vector<Inputs::File> Inputs::files() const {
  const std::scoped_lock lock(mutex_);
  std::vector<File> all;
  for (const auto& [name, entry] : entries_) all.push_back({entry.path, sha256(*entry.text)});
  return all;
}

void Inputs::protect(const fs::path& output, const std::string& key) const {
  const fs::path entry = entry_of(output);
  const std::scoped_lock lock(mutex_);
  for (const auto& [name, input] : entries_) {
    if (name == entry.string() || input.resolved == entry)
      throw InputError(
          {input.path.string(), 0, key, output.parent_path().string(),
           fmt::format("must be another folder: {} would overwrite this input", output.filename().string())});
  }
}

std::shared_ptr<Inputs> current_inputs() noexcept {
  return of_thread;
}

InputScope::InputScope(std::shared_ptr<Inputs> inputs)
    : before_(std::exchange(of_thread, std::move(inputs))) {}

InputScope::~InputScope() {
  of_thread = std::move(before_);
}

}  // namespace snare::base
