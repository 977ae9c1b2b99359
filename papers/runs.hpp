#pragma once

#include "results/history_table.hpp"
#include "results/watch.hpp"
#include "scenario/scenario.hpp"

#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace snare::papers {

/// A shipped scenario with some of its keys changed.
struct Case {
  std::string file;                        ///< under data/
  std::vector<std::string> settings = {};  ///< "key=value", as for `--set`
};

/// A finished run of a case.
struct Run {
  scenario::Scenario asked;
  std::vector<coupling::MotionSample> samples;
  coupling::MotionResult result;
  results::History history, telemetry;  ///< history.csv and telemetry.csv of this run

  /// Two columns of the table that has `y`, in the units of their names. Throws std::out_of_range, naming
  /// both, if no table has them.
  [[nodiscard]] std::pair<const std::vector<double>&, const std::vector<double>&> columns(
      const std::string& x, const std::string& y) const;
  /// Time of the first touch of a contact [s]; NaN where it never touched.
  [[nodiscard]] double first_touch(std::size_t contact) const;
  /// 0, or NaN where the run ended early: added to a number of the run, it spoils the comparison. [-]
  [[nodiscard]] double usable() const;
};

/// Thrown where somebody wants the work to end.
class Stopped : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

/// The work that figures share: every run is made once.
class Runs {
 public:
  /// data: folder of the shipped files. watch: sees each run; when it stops the work, `Stopped` is thrown.
  explicit Runs(std::filesystem::path data, results::Watch watch = {})
      : data_(std::move(data)), watch_(std::move(watch)) {}

  /// The run of a case. Throws base::InputError for a wrong key.
  [[nodiscard]] const Run& of(const Case& asked);
  /// The result of `make`, which is called when the name is first asked for. Reports the
  /// first line of the name as a stage.
  template <class Value>
  [[nodiscard]] const Value& once(const std::string& name, const std::function<Value()>& make) {
    std::shared_ptr<const void>& kept = kept_[name];
    if (!kept) {
      watch_.say(stage_ + name.substr(0, name.find('\n')));
      kept = std::make_shared<const Value>(make());
    }
    return *static_cast<const Value*>(kept.get());
  }

  [[nodiscard]] const std::filesystem::path& data() const { return data_; }  ///< folder of the shipped files
  [[nodiscard]] const results::Watch& watch() const { return watch_; }       ///< observer of the work
  /// Text before the name of every later stage.
  void set_stage(std::string stage) { stage_ = std::move(stage); }
  /// Throws `Stopped` where somebody wants the work to end.
  void go_on() const {
    if (watch_.stopped()) throw Stopped();
  }

 private:
  [[nodiscard]] Run run(const Case& asked) const;

  std::filesystem::path data_;
  results::Watch watch_;
  std::string stage_;
  std::map<std::string, std::shared_ptr<const void>> kept_;
};

}  // namespace snare::papers
