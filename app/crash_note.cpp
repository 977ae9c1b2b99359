#include "app/crash_note.hpp"

#include "study/case_record.hpp"

#include <unistd.h>

#include <array>
#include <charconv>
#include <csignal>
#include <string_view>
#include <utility>

namespace snare::app {

namespace {

constexpr std::array<std::pair<int, std::string_view>, 5> fatal{
    {{SIGSEGV, "SIGSEGV"}, {SIGBUS, "SIGBUS"}, {SIGFPE, "SIGFPE"}, {SIGILL, "SIGILL"}, {SIGABRT, "SIGABRT"}}};
constexpr std::size_t longest_name = 7;
constexpr std::size_t handler_stack = 1 << 16;  // [byte]

thread_local CrashNote* current = nullptr;

extern "C" void on_fatal_signal(int signal) {
  CrashNote::write(signal);
  // What ends a process ends it: the signal comes again when this handler returns.
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void catch_fatal_signals() {
  for (const auto& [signal, name] : fatal) {
    struct sigaction action {};
    action.sa_handler = on_fatal_signal;
    action.sa_flags = SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
}

void say(std::string_view text) noexcept {
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

CrashNote::CrashNote(study::Journal& journal, std::uint64_t index, const std::vector<double>& values)
    : journal_(journal), index_(index), stack_(handler_stack) {
  [[maybe_unused]] static const bool caught = (catch_fatal_signals(), true);
  const std::string reason = "the process ended in this case by ";
  line_ = study::line_of({"crashed", reason, 0.0, {}, values});
  name_at_ = line_.find(reason) + reason.size();
  line_.reserve(line_.size() + longest_name);
  stack_t own{}, before{};
  own.ss_sp = stack_.data();
  own.ss_size = stack_.size();
  sigaltstack(&own, &before);
  stack_before_ = (before.ss_flags & SS_DISABLE) != 0 ? nullptr : before.ss_sp;
  stack_before_size_ = before.ss_size;
  current = this;
}

CrashNote::~CrashNote() {
  current = nullptr;
  stack_t before{};
  before.ss_sp = stack_before_;
  before.ss_size = stack_before_size_;
  before.ss_flags = stack_before_ == nullptr ? SS_DISABLE : 0;
  sigaltstack(&before, nullptr);
}

void CrashNote::write(int signal) noexcept {
  CrashNote* const note = std::exchange(current, nullptr);
  if (note == nullptr) return;
  std::string_view name = "a signal";
  for (const auto& [number, own] : fatal)
    if (number == signal) name = own;
  note->line_.insert(note->name_at_, name.substr(0, longest_name));
  note->journal_.append_at_the_end(note->index_, note->line_);
  std::array<char, 24> number{};
  const char* const end = std::to_chars(number.data(), number.data() + number.size(), note->index_ + 1).ptr;
  const std::string_view digits(number.data(), static_cast<std::size_t>(end - number.data()));
  say("\ncase ");
  say(digits);
  say(" ended the process by ");
  say(name);
  say(". What is finished is kept; the same command goes on with the other cases, --case ");
  say(digits);
  say(" runs this one alone\n");
}

}  // namespace snare::app
