// Tests commands and waiting times with a slow device.
#include <doctest/doctest.h>

#include <cstring>
#include <deque>
#include <memory>

#include "host/client/device/transport.hpp"
#include "host/lab/experiment/paced_device.hpp"
#include "protocol/reports.hpp"

using namespace inkwell;
using namespace inkwell::experiment;
using protocol::Command;

namespace {

/// This device executes each command `latency` poses after the command's arrival. Two poses are 10 ms apart, so the
/// host has to send a heartbeat for each pose.
class SlowTransport final : public device::Transport {
 public:
  SlowTransport(int latency, std::deque<protocol::CommandReport>& received) : latency_(latency), received_(received) {}

  std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds timeout) override {
    if (timeout.count() == 0) return 0;  // one pose per slice
    ++pose_.sequence;
    pose_.time_periods += 200;
    for (; !waiting_.empty() && waiting_.front().due <= pose_.sequence; waiting_.pop_front())
      pose_.command_token = waiting_.front().token;
    std::memcpy(report.data(), &pose_, sizeof pose_);
    return sizeof pose_;
  }
  void write_report(std::span<const std::byte> report) override {
    protocol::CommandReport command;
    std::memcpy(&command, report.data(), sizeof command);
    received_.push_back(command);
    // The board executes all commands of one bus frame together and reports only the last token.
    const std::uint32_t due = pose_.sequence + static_cast<std::uint32_t>(latency_);
    if (latency_ > 0) waiting_.push_back({due - due % 2, command.token});
  }
  std::size_t get_feature(std::span<std::byte>) override { return 0; }
  void set_feature(std::span<const std::byte>) override {}
  void claim_scope() override {}
  void release_scope() override {}
  std::size_t read_bulk(std::span<std::byte>, std::chrono::milliseconds) override { return 0; }
  const device::Endpoint& endpoint() const override { return endpoint_; }

 private:
  struct Waiting {
    std::uint32_t due;
    std::uint8_t token;
  };
  int latency_;  ///< 0: no command is executed
  std::deque<protocol::CommandReport>& received_;
  std::deque<Waiting> waiting_;
  protocol::PoseReport pose_{.report_id = protocol::ReportId::pose};
  device::Endpoint endpoint_;
};

}  // namespace

TEST_CASE("a sign of life that overtakes a command's answer does not hide it") {
  std::deque<protocol::CommandReport> received;
  device::Device device(std::make_unique<SlowTransport>(4, received));
  PacedDevice paced(device, nullptr);
  std::size_t enabled = 0;
  // The number of commands exceeds the number of tokens, so that the tokens wrap.
  for (int i = 0; i < 300; ++i) paced.command(Command::enable_force);
  for (const auto& report : received) enabled += report.command == Command::enable_force;
  CHECK(enabled == 300);
  CHECK(received.size() > 600);
}

TEST_CASE("a device that carries nothing out is noticed") {
  std::deque<protocol::CommandReport> received;
  device::Device device(std::make_unique<SlowTransport>(0, received));
  PacedDevice paced(device, nullptr);
  try {
    paced.command(Command::enable_force);
    FAIL("a command was carried out by nobody");
  } catch (const device::Error& error) {
    CHECK(std::string(error.what()).find("does not execute commands") != std::string::npos);
  }
}
