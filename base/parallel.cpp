#include "base/parallel.hpp"

#include "base/inputs.hpp"

#include <omp.h>

#include <atomic>
#include <exception>
#include <limits>

namespace snare::base {

void parallel_for(std::size_t count, const std::function<void(std::size_t index)>& body) {
  std::atomic<bool> failed{false};
  std::exception_ptr failure;
  std::size_t failed_at = std::numeric_limits<std::size_t>::max();
  const auto end = static_cast<std::ptrdiff_t>(count);
  const std::shared_ptr<Inputs> inputs = current_inputs();
#pragma omp parallel for schedule(dynamic, 1)
  for (std::ptrdiff_t i = 0; i < end; ++i) {
    if (failed) continue;
    const InputScope scope(inputs);
    const auto index = static_cast<std::size_t>(i);
    try {
      body(index);
    } catch (...) {  // an exception must not leave the loop
#pragma omp critical(snare_parallel_for)
      if (index < failed_at) {
        failed_at = index;
        failure = std::current_exception();
      }
      failed = true;
    }
  }
  if (failure) std::rethrow_exception(failure);
}

void set_thread_count(int threads) {
  omp_set_num_threads(threads > 0 ? threads : omp_get_num_procs());
}

}  // namespace snare::base
