#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace snare::study {

/// Processes that work together and send each other bytes: those of an `mpirun`, or threads of a test. Used
/// by one thread a process.
class Ranks {
 public:
  struct Message {
    int from = 0;
    std::string bytes;
  };

  virtual ~Ranks() = default;
  [[nodiscard]] virtual int rank() const = 0;  ///< 0: the leader
  [[nodiscard]] virtual int size() const = 0;
  /// Returns at once; whether it arrives is not known.
  virtual void send(int to, const std::string& bytes) = 0;
  /// A message that has arrived, from anybody; nothing where there is none.
  [[nodiscard]] virtual std::optional<Message> receive() = 0;
  /// To be called before the end, when all others will do the same. Without it the process may end, but not
  /// in good order.
  virtual void leave() = 0;
};

}  // namespace snare::study
