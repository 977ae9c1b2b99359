#include "validation/suite.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace snare::validation {

std::string_view key_of(Kind kind) {
  switch (kind) {
    case Kind::closed_form:
      return "closed_form";
    case Kind::published_measurement:
      return "published_measurement";
    case Kind::published_computation:
      return "published_computation";
    case Kind::independent_code:
      return "independent_code";
    case Kind::convergence:
      break;
  }
  return "convergence";
}

std::string_view words_of(Kind kind) {
  switch (kind) {
    case Kind::closed_form:
      return "closed form";
    case Kind::published_measurement:
      return "published measurement";
    case Kind::published_computation:
      return "published computation";
    case Kind::independent_code:
      return "independent code";
    case Kind::convergence:
      break;
  }
  return "convergence of this code";
}

Limit::Limit(ErrorKind error_kind, double value, std::string reason)
    : error_kind_(error_kind), value_(value), reason_(std::move(reason)) {}

Limit Limit::relative(double limit) {
  return {ErrorKind::relative, limit, {}};
}

Limit Limit::absolute(double limit, std::string reason) {
  if (reason.empty()) throw std::invalid_argument("an absolute limit needs its reason");
  return {ErrorKind::absolute, limit, std::move(reason)};
}

double Row::error() const {
  double error = std::abs(value - reference);
  if (limit.error_kind() == ErrorKind::relative) error /= std::abs(reference);
  return std::isfinite(error) ? error : std::numeric_limits<double>::max();
}

std::string count_by_kind(const std::vector<Row>& rows) {
  std::vector<std::pair<std::ptrdiff_t, Kind>> counts;
  for (const Kind kind : all_kinds) counts.emplace_back(std::ranges::count(rows, kind, &Row::kind), kind);
  std::ranges::stable_sort(counts, std::ranges::greater(), &std::pair<std::ptrdiff_t, Kind>::first);
  std::vector<std::string> words;
  for (const auto& [count, kind] : counts)
    if (count > 0) words.push_back(fmt::format("{} {}", count, words_of(kind)));
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace snare::validation
