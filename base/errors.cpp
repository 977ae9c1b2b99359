#include "base/errors.hpp"

#include "base/one_line.hpp"

#include <fmt/format.h>

#include <utility>

namespace snare::base {

namespace {

std::string joined(const std::vector<InputProblem>& problems) {
  std::string text;
  for (const InputProblem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.message();
  }
  return text;
}

}  // namespace

std::string InputProblem::message() const {
  std::string text;
  if (!file.empty()) text = line > 0 ? fmt::format("{}:{}: ", file, line) : fmt::format("{}: ", file);
  text += key;
  if (!key.empty() && !value.empty()) text += fmt::format(" = {}", value);
  if (!key.empty() && !requirement.empty()) text += ", ";
  text += requirement;
  return visible(text);  // it may go to a terminal
}

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

InputError::InputError(InputProblem problem) : InputError(std::vector{std::move(problem)}) {}

LibraryError::LibraryError(const std::string& function, int code, const std::string& meaning)
    : std::runtime_error(fmt::format("{} returned {}: {}", function, code, meaning)), code_(code) {}

}  // namespace snare::base
