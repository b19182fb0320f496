#include "host/bindings/library/parameter_watch.hpp"

#include <chrono>

namespace inkwell::library {

ParameterWatch::~ParameterWatch() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void ParameterWatch::begin() {
  const std::lock_guard lock(mutex_);
  is_watching_ = true;
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  changed_.notify_all();
}

void ParameterWatch::end() {
  std::unique_lock lock(mutex_);
  is_watching_ = false;
  changed_.notify_all();
  changed_.wait(lock, [this] { return !is_checking_; });
}

void ParameterWatch::run() {
  using namespace std::chrono_literals;
  constexpr auto interval = 500ms;
  std::unique_lock lock(mutex_);
  while (!stops_) {
    if (!is_watching_) {
      changed_.wait(lock, [this] { return stops_ || is_watching_; });
      continue;
    }
    if (changed_.wait_for(lock, interval, [this] { return stops_ || !is_watching_; })) continue;
    is_checking_ = true;
    lock.unlock();
    check_();
    lock.lock();
    is_checking_ = false;
    changed_.notify_all();
  }
}

}  // namespace inkwell::library
