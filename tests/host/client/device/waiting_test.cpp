// Time limits of reads from a device.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <span>
#include <vector>

#include "host/client/device/device.hpp"
#include "host/client/device/transport.hpp"

using namespace inkwell;
using namespace std::chrono_literals;

namespace {

/// A read from this device always times out.
class SilentTransport final : public device::Transport {
 public:
  explicit SilentTransport(std::vector<std::chrono::milliseconds>& waited) : waited_(waited) {}
  std::size_t read_report(std::span<std::byte>, std::chrono::milliseconds timeout) override { return wait(timeout); }
  std::size_t read_bulk(std::span<std::byte>, std::chrono::milliseconds timeout) override { return wait(timeout); }
  std::size_t get_feature(std::span<std::byte>) override { return 0; }
  void set_feature(std::span<const std::byte>) override {}
  void write_report(std::span<const std::byte>) override {}
  void claim_scope() override {}
  void release_scope() override {}
  const device::Endpoint& endpoint() const override { return endpoint_; }

 private:
  std::size_t wait(std::chrono::milliseconds timeout) {
    waited_.push_back(timeout);
    return 0;
  }
  std::vector<std::chrono::milliseconds>& waited_;
  device::Endpoint endpoint_;
};

}  // namespace

// The remaining time is a fraction of a millisecond. Rounding this time down to 0 would cause a busy loop.
TEST_CASE("a device is waited for also in the last millisecond") {
  std::vector<std::chrono::milliseconds> waited;
  device::Device device(std::make_unique<SilentTransport>(waited));
  const auto waits = [&](const auto& read) {
    waited.clear();
    for (int i = 0; i < 100; ++i) CHECK_FALSE(read());  // a busy computer may use up the millisecond
    return std::ranges::count(waited, 1ms) > 0;
  };
  CHECK(waits([&] { return device.read_pose(1ms); }));
  CHECK(waits([&] { return device.read_scope(1ms); }));
  CHECK_FALSE(waits([&] { return device.read_pose(0ms); }));
  CHECK_FALSE(waits([&] { return device.read_scope(0ms); }));
}
