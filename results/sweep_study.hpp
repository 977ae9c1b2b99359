#pragma once

#include "results/case_runner.hpp"
#include "results/history_table.hpp"
#include "study/case_record.hpp"
#include "study/journal.hpp"
#include "study/subset.hpp"
#include "study/sweep_file.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace snare::results {

/// The cases of a sweep file: what each is, and how it is run.
class SweepStudy {
 public:
  /// Reads both files; throws base::InputError with everything that is wrong in them and in the values of
  /// some cases.
  SweepStudy(const std::filesystem::path& file, const std::vector<base::Override>& overrides);

  /// The sweep file.
  [[nodiscard]] const study::SweepFile& sweep() const noexcept { return sweep_; }
  /// Who runs its case.
  [[nodiscard]] const CaseRunner& runner() const noexcept { return runner_; }
  /// Cases there are; 0: known at the end only.
  [[nodiscard]] std::uint64_t count() const noexcept;
  /// One line, equal where the sweep file, its case, the files that they name and the version are.
  [[nodiscard]] const std::string& identity() const noexcept { return identity_; }

  /// What a case changes in the file, its values given in the units of their keys (the index of a level where
  /// there are levels).
  [[nodiscard]] std::vector<base::Override> overrides_of(const std::vector<double>& values) const {
    return study::overrides_of(sweep_, values);
  }

  /// Runs one case, values as above in the units of their keys; never throws. stop: asked often. keep: is
  /// given what is asked to be kept of its history, where it has one; what it throws becomes the reason of a
  /// case that is `unkept`.
  [[nodiscard]] study::CaseRecord run(const std::vector<double>& values, const std::function<bool()>& stop,
                                      const std::function<void(History&)>& keep = {}) const;

  /// The command that runs a case by itself, values in the units of their keys.
  [[nodiscard]] std::string command_of(const std::vector<double>& values) const;

  /// Of a subset simulation: how far a case's field is beyond the bound, in the field's unit; nothing where
  /// the case has no result.
  [[nodiscard]] std::optional<double> margin_of(const study::CaseRecord& record) const;
  [[nodiscard]] study::SubsetSimulation::Settings subset_settings() const;

 private:
  study::SweepFile sweep_;
  CaseRunner runner_;
  std::string identity_;
};

}  // namespace snare::results
