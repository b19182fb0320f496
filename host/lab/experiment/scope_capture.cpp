#include "host/lab/experiment/scope_capture.hpp"

#include <chrono>

#include <fmt/format.h>

namespace inkwell::experiment {
namespace {

using namespace std::chrono_literals;

constexpr double arrival_limit_s = 2.0;  // the scope's ring buffer covers a fraction of this time

}  // namespace

ScopeCapture::ScopeCapture(PacedDevice& device, const recording::Information& information)
    : device_(device), recording_(recording::Recording::without_samples(information)) {
  thread_ = std::thread([this] {
    try {
      while (!stopping_) {
        const auto samples = device_.device().read_scope(10ms);
        if (!samples || samples->signals != recording_.information.signals) continue;
        const std::lock_guard lock(mutex_);
        recording_.append(*samples);
      }
    } catch (const device::Error& error) {
      const std::lock_guard lock(mutex_);
      failure_ = error.what();
    }
  });
  try {
    device_.select_signals(information.signals);
  } catch (...) {
    stopping_ = true;
    thread_.join();
    throw;
  }
}

ScopeCapture::~ScopeCapture() {
  stopping_ = true;
  thread_.join();
}

std::size_t ScopeCapture::size() const {
  const std::lock_guard lock(mutex_);
  return recording_.size();
}

void ScopeCapture::check() const {
  const std::lock_guard lock(mutex_);
  if (failure_) throw device::Error(*failure_);
  if (recording_.lost() > 0)
    throw device::Error(
        fmt::format("{} samples of the scope were lost, so the recording has gaps. Close other programs that load this "
                    "computer and run the experiment again.",
                    recording_.lost()));
}

recording::Recording ScopeCapture::take(std::size_t samples) {
  const auto arrived = [&] {
    check();
    return size() >= samples;
  };
  device_.wait_until(arrived, arrival_limit_s,
                     "The scope does not send its samples. Reset the board and run the experiment again.");
  device_.select_signals({});
  const std::lock_guard lock(mutex_);
  recording::Recording taken = recording_;
  taken.keep(0, samples);
  return taken;
}

}  // namespace inkwell::experiment
