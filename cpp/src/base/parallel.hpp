// SPDX-License-Identifier: BSD-3-Clause
// Work over an index range by threads; who does which part never matters to the result.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "iksel/error.hpp"

namespace iksel {

/// Number of threads that an option means: 0 is one per core. Throws InvalidArgumentError.
inline int resolve_threads(int threads) {
  if (threads < 0 || threads > 1024) {
    throw InvalidArgumentError("threads: " + std::to_string(threads) +
                               " is not in 0 .. 1024 (0: one per core)");
  }
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Calls make_worker() once on each thread, and the worker it returns with (begin, end) of one
/// chunk after another. `on_progress(done)` runs on the calling thread, which works too. The first
/// exception of a worker or of on_progress stops all and is thrown again here.
template <typename MakeWorker, typename OnProgress>
void parallel_for(std::size_t count, std::size_t chunk, int threads, const MakeWorker& make_worker,
                  const OnProgress& on_progress) {
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stop{false};
  std::exception_ptr failure;
  std::mutex failure_mutex;

  const auto run = [&](bool reports) {
    try {
      auto worker = make_worker();
      while (!stop.load(std::memory_order_relaxed)) {
        const std::size_t begin = next.fetch_add(chunk);
        if (begin >= count) break;
        const std::size_t end = std::min(begin + chunk, count);
        worker(begin, end);
        const std::size_t so_far = done.fetch_add(end - begin) + (end - begin);
        if (reports) on_progress(so_far);
      }
    } catch (...) {
      stop = true;
      const std::lock_guard<std::mutex> lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };

  const std::size_t chunks = (count + chunk - 1) / chunk;
  const std::size_t workers =
      std::max<std::size_t>(1, std::min(static_cast<std::size_t>(threads), chunks));
  std::vector<std::thread> pool;
  pool.reserve(workers - 1);
  try {
    for (std::size_t i = 1; i < workers; ++i) pool.emplace_back(run, false);
  } catch (const std::exception&) {
    // The system gives no more threads: those that there are do all.
  }
  run(true);
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

template <typename MakeWorker>
void parallel_for(std::size_t count, std::size_t chunk, int threads,
                  const MakeWorker& make_worker) {
  parallel_for(count, chunk, threads, make_worker, [](std::size_t) {});
}

}  // namespace iksel
