#pragma once

#include <cstddef>
#include <functional>

namespace vigia::evaluation {

/// Calls @p job with 0 … count − 1, each once, in that order of beginning, on @p threads threads of
/// which the caller is one. A thread takes the next job when it is done with its last. The first
/// exception ends the queue and is thrown here.
void work_off(std::size_t count, int threads, const std::function<void(std::size_t)>& job);

}  // namespace vigia::evaluation
