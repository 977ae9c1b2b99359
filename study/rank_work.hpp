#pragma once

#include "study/case_loop.hpp"
#include "study/ranks.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace snare::study {

/// Runs a case of which the values may be given: those of a design are known from its number.
using RunWithValues = std::function<std::string(std::uint64_t index, const std::vector<double>& values)>;

/// The leader of some ranks: hands cases to the others, and runs some itself.
/// docs/decisions/sweeps.md#cases-journal-and-ranks
///
/// A rank that says nothing for `silence_s` is lost; what it had is given to others. Every rank says a word a
/// second.
class RankLeader {
 public:
  struct Settings {
    std::string identity;     ///< of the study; ranks that have read something else are refused
    double silence_s = 15.0;  ///< [s]
    int threads = 1;          ///< of the leader's own
  };
  RankLeader(Ranks& ranks, Settings settings);
  /// Tells the others that it is over.
  ~RankLeader();
  RankLeader(const RankLeader&) = delete;
  RankLeader& operator=(const RankLeader&) = delete;

  /// Until everything is done or has ended. values: of a case, in the units of their keys, sent with it; may
  /// be empty. given_up: as of Dispatcher.
  /// first: number in the study of the dispatcher's first case, for those who run one.
  /// Throws what the dispatcher was ended with; base::InputError when a rank has read other files.
  void run(Dispatcher& dispatcher, const RunWithValues& run,
           const std::function<std::vector<double>(std::uint64_t)>& values,
           const std::function<std::string(std::uint64_t)>& given_up, std::uint64_t first = 0);

  [[nodiscard]] int lost() const noexcept { return lost_; }  ///< ranks that were lost

 private:
  struct Other {
    bool gone = false;
    bool idle = false;   ///< waits for cases
    double heard = 0.0;  ///< last [s]
  };
  void hear(Dispatcher& dispatcher);

  Ranks& ranks_;
  Settings settings_;
  std::vector<Other> others_;
  int lost_ = 0;
};

/// Any other rank: runs what it is given, each by its number in the study, until the leader says that it is
/// over, or `stop`.
void follow(Ranks& ranks, const std::string& identity, int threads, const RunWithValues& run,
            const std::function<bool()>& stop);

}  // namespace snare::study
