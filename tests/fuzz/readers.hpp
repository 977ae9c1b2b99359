#pragma once

#include "base/csv.hpp"
#include "base/errors.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/experiment.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

namespace snare::fuzz {

/// Gives arbitrary bytes to the CSV reader. It must return finite numbers or throw InputError; whatever else
/// leaves here is a defect. Whether it was accepted.
inline bool read_bytes_as_csv(std::string_view bytes) {
  const std::vector<base::CsvColumn> columns{
      {"displacement_mm", base::CsvColumn::Presence::required, base::Range::from(-1000.0, 1000.0), 1e-3},
      {"force_N"},
      {"time_s", base::CsvColumn::Presence::optional, base::Range::finite(), 1.0,
       base::CsvColumn::Order::non_decreasing}};
  try {
    const base::CsvTable table = base::parse_csv("fuzz.csv", bytes, columns);
    for (const auto& column : table.columns)
      for (const double value : column)
        if (!std::isfinite(value)) throw std::logic_error("a number that is not finite was read");
    return true;
  } catch (const base::InputError& error) {
    if (error.problems().empty()) throw std::logic_error("an error without a problem");
    return false;
  }
}

/// The same for the reader of experiment files (and of overrides: the first line, where it starts with "--set
/// ").
inline bool read_bytes_as_experiment(std::string_view bytes) {
  try {
    std::vector<identification::Override> overrides;
    constexpr std::string_view flag = "--set ";
    if (bytes.starts_with(flag)) {
      const std::size_t end = bytes.find('\n');
      overrides.push_back(base::parse_override(bytes.substr(flag.size(), end - flag.size())));
      bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
    }
    const identification::Experiment experiment =
        identification::parse_experiment("fuzz.toml", bytes, identification::parameters(), overrides);
    for (const identification::Series& series : experiment.series) {
      const coupling::PushProblem& test = series.test;
      for (const double value :
           {test.wire.diameter, test.wire.length, test.wire.bending_stiffness(), test.wire.axial_stiffness(),
            test.wire.torsional_stiffness(), test.mount.span, test.contact_position})
        if (!(std::isfinite(value) && value > 0.0))
          throw std::logic_error("a number that must be positive is not");
      if (test.travel.size() < 2) throw std::logic_error("a series without travel");
    }
    return true;
  } catch (const base::InputError& error) {
    if (error.problems().empty()) throw std::logic_error("an error without a problem");
    return false;
  }
}

}  // namespace snare::fuzz
