#pragma once

#include "study/journal.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace snare::app {

/// The thread that holds this runs a case. When a signal ends the process there (SIGSEGV, SIGBUS, SIGFPE,
/// SIGILL, SIGABRT: a fault of this program or of a library, a stack that is used up), the journal gets a
/// line that says so, standard error names the case, and the process ends by the signal as it would. The same
/// command then continues with the other cases.
///
/// What ends a process without a signal that can be caught (SIGKILL, a machine that fails) leaves no line:
/// the case is run again. One a thread at a time.
class CrashNote {
 public:
  /// values: what is kept with the case (CaseRecord::values).
  CrashNote(study::Journal& journal, std::uint64_t index, const std::vector<double>& values);
  ~CrashNote();
  CrashNote(const CrashNote&) = delete;
  CrashNote& operator=(const CrashNote&) = delete;

  /// In the handler of the signal, for the case of this thread if there is one.
  static void write(int signal) noexcept;

 private:
  study::Journal& journal_;
  std::uint64_t index_;
  std::string line_;              // with room for the signal's name
  std::size_t name_at_ = 0;       // where in the line
  std::vector<char> stack_;       // for the handler: the thread's own may be used up
  void* stack_before_ = nullptr;  // the handler's stack that the thread had
  std::size_t stack_before_size_ = 0;
};

}  // namespace snare::app
