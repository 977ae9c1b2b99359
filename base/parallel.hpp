#pragma once

#include <cstddef>
#include <functional>

namespace snare::base {

/// Calls body(0) ... body(count - 1), each once, shared out one at a time among the threads. What a call
/// computes must not depend on the others, so that results are the same for any number of threads. When calls
/// throw, no further ones begin, and of the exceptions that of the lowest index is thrown.
void parallel_for(std::size_t count, const std::function<void(std::size_t index)>& body);

/// Number of threads of the loops to come, >= 1; 0: one a processor.
void set_thread_count(int threads);

}  // namespace snare::base
