// A device for tests. The test decides which reports arrive and when the device accepts a report.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstring>
#include <deque>
#include <functional>
#include <mutex>
#include <span>
#include <vector>

#include "host/client/device/transport.hpp"
#include "protocol/reports.hpp"

namespace inkwell::tests {

/// Reports that a QueuedTransport has exchanged. The reports remain after the device has destroyed the transport.
struct QueuedReports {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<protocol::PoseReport> poses;          ///< sent by the device
  std::vector<protocol::ForceReport> forces;       ///< written to the device
  std::vector<protocol::LocalModelReport> models;  ///< written to the device
  int under_way = 0;                               ///< number of written reports that are not accepted yet
  std::function<void()> on_feature_request;        ///< called before the request is answered with nothing

  void accept_one() {
    const std::lock_guard lock(mutex);
    --under_way;
    changed.notify_all();
  }
  void wait_for_forces(std::size_t count) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return forces.size() >= count; });
  }
  /// Returns the newest of this number of models.
  protocol::LocalModelReport wait_for_models(std::size_t count) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return models.size() >= count; });
    return models.back();
  }
};

class QueuedTransport final : public device::Transport {
 public:
  explicit QueuedTransport(QueuedReports& reports) : reports_(reports) {}

  std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds) override {
    const std::lock_guard lock(reports_.mutex);
    if (reports_.poses.empty()) return 0;
    std::memcpy(report.data(), &reports_.poses.front(), sizeof(protocol::PoseReport));
    reports_.poses.pop_front();
    return sizeof(protocol::PoseReport);
  }
  void write_report(std::span<const std::byte> report) override {
    const std::lock_guard lock(reports_.mutex);
    ++reports_.under_way;
    if (static_cast<protocol::ReportId>(report[0]) == protocol::ReportId::force)
      std::memcpy(&reports_.forces.emplace_back(), report.data(), sizeof(protocol::ForceReport));
    if (static_cast<protocol::ReportId>(report[0]) == protocol::ReportId::local_model)
      std::memcpy(&reports_.models.emplace_back(), report.data(), sizeof(protocol::LocalModelReport));
    reports_.changed.notify_all();
  }
  bool wait_until_written(std::chrono::milliseconds timeout) override {
    std::unique_lock lock(reports_.mutex);
    return reports_.changed.wait_for(lock, timeout, [&] { return reports_.under_way == 0; });
  }
  std::size_t get_feature(std::span<std::byte>) override {
    if (reports_.on_feature_request) reports_.on_feature_request();
    return 0;
  }
  void set_feature(std::span<const std::byte>) override {}
  void claim_scope() override {}
  void release_scope() override {}
  std::size_t read_bulk(std::span<std::byte>, std::chrono::milliseconds) override { return 0; }
  const device::Endpoint& endpoint() const override { return endpoint_; }

 private:
  QueuedReports& reports_;
  device::Endpoint endpoint_{};
};

}  // namespace inkwell::tests
