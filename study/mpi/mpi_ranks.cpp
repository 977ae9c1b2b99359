// The ranks of an mpirun, for `snare sweep`. One thread of a process calls MPI, the first that came here.
#include "study/ranks.hpp"

#include <mpi.h>

#include <deque>
#include <utility>

namespace snare::study {

namespace {

class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD,
                            MPI_ERRORS_RETURN);  // one rank that is gone is not the end of all
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }

  void send(int to, const std::string& bytes) override {
    sent_.push_back({bytes, MPI_REQUEST_NULL});
    Sent& one = sent_.back();
    MPI_Isend(one.bytes.data(), static_cast<int>(one.bytes.size()), MPI_CHAR, to, tag, MPI_COMM_WORLD,
              &one.request);
    forget_sent();
  }

  [[nodiscard]] std::optional<Message> receive() override {
    forget_sent();
    int there = 0;
    MPI_Status status;
    if (MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status) != MPI_SUCCESS || there == 0)
      return std::nullopt;
    int size = 0;
    MPI_Get_count(&status, MPI_CHAR, &size);
    Message message{status.MPI_SOURCE, std::string(static_cast<std::size_t>(size), '\0')};
    if (MPI_Recv(message.bytes.data(), size, MPI_CHAR, status.MPI_SOURCE, tag, MPI_COMM_WORLD, &status) !=
        MPI_SUCCESS)
      return std::nullopt;
    return message;
  }

  void leave() override {
    for (Sent& one : sent_) MPI_Wait(&one.request, MPI_STATUS_IGNORE);
    MPI_Finalize();
  }

 private:
  static constexpr int tag = 7;
  struct Sent {
    std::string bytes;
    MPI_Request request;
  };

  /// A text must stay where it is until it was sent.
  void forget_sent() {
    while (!sent_.empty()) {
      int gone = 0;
      if (MPI_Test(&sent_.front().request, &gone, MPI_STATUS_IGNORE) == MPI_SUCCESS && gone == 0) return;
      sent_.pop_front();
    }
  }

  int rank_ = 0;
  int size_ = 1;
  std::deque<Sent> sent_;
};

}  // namespace

}  // namespace snare::study

/// What the command looks for. Called once; the caller owns the result.
extern "C" __attribute__((visibility("default"))) snare::study::Ranks* snare_make_ranks() {
  return new snare::study::MpiRanks;
}
