#pragma once

#include <functional>
#include <optional>
#include <string>

namespace snare::app {

/// SIGINT, SIGTERM, SIGHUP (unless ignored from the start) and SIGXCPU are answered within a second.
///
/// The first one sets a flag at which long work looks; it stops and the verb writes what it has. Work that
/// does not come to a point where it looks within `patience_s` is left where it is: a thread that waits for
/// nothing else writes what the verb has said is to be kept, says so, and ends the process with the status of
/// a solver that was stopped. While results are being written nobody is left. A second signal ends the
/// process at once.
inline constexpr double patience_s = 0.6;

/// Whether a signal has come.
[[nodiscard]] bool interrupted() noexcept;

/// From here on the signals are caught; SIGXFSZ and SIGPIPE become errors of the writes that they were sent
/// for. Once a process.
/// before_end: what else a process that leaves its work must do.
void catch_interrupts(void (*before_end)() noexcept);

/// What the verb is doing, for the message: "reading the input" until it says something else.
void set_stage(const std::string& stage);

/// What is to be done where work is left, for as long as the object lives; then what was to be done before.
class KeepWhenInterrupted {
 public:
  /// `keep` writes what is finished at any time and says what that is, as a sentence; it is called from
  /// another thread while the work continues, so what it reads must be guarded against it; an empty sentence
  /// is not printed. Empty: nothing is kept. `json_schema`: under which standard output gets the word that
  /// all was interrupted; empty: it gets none, or what `keep` writes; nothing: as before, at first none.
  KeepWhenInterrupted(std::function<std::string()> keep, std::optional<std::string> json_schema);
  ~KeepWhenInterrupted();
  KeepWhenInterrupted(const KeepWhenInterrupted&) = delete;
  KeepWhenInterrupted& operator=(const KeepWhenInterrupted&) = delete;

 private:
  std::function<std::string()> keep_before_;
  std::string schema_before_;
};

/// The work is done, what follows is writing. Returns never when the work was left already.
void begin_writing();

}  // namespace snare::app
