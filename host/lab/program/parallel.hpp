// Runs tasks on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace inkwell::lab {

/// Calls `task(i)` for each i below `count`, on `jobs` threads. Stops after a task has returned false. A task must not
/// throw, because an exception that leaves a thread terminates the program.
template <class Task>
void run_in_parallel(unsigned jobs, std::size_t count, const Task& task) {
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::min<std::size_t>(jobs, count); ++i)
    threads.emplace_back([&] {
      for (std::size_t k; (k = next++) < count;)
        if (!task(k)) next = count;
    });
  for (auto& thread : threads) thread.join();
}

}  // namespace inkwell::lab
