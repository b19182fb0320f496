// Tests the state that `inkwell force off` prints.
#include "host/companion/command_line/force_switch.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "host/client/device/transport.hpp"

#include "tests/host/client/device/answered_commands.hpp"

using namespace inkwell;
using protocol::State;

namespace {

/// Poses arrive one by one, so a read without waiting finds no pose.
class SlowPoses final : public device::Transport {
 public:
  explicit SlowPoses(std::vector<State> states) : states_(std::move(states)) {}

  std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds timeout) override {
    if (timeout.count() == 0 || read_ == states_.size()) return 0;
    protocol::PoseReport pose{};
    pose.report_id = protocol::ReportId::pose;
    pose.sequence = static_cast<std::uint32_t>(read_);
    pose.time_periods = pose.sequence * protocol::servo_rate_Hz / 1000;
    pose.state = states_[read_++];
    std::ranges::copy(std::as_bytes(std::span(&pose, 1)), report.begin());
    return sizeof pose;
  }
  void write_report(std::span<const std::byte> report) override { commands_.note(report); }
  std::size_t get_feature(std::span<std::byte> report) override { return commands_.answer(report); }
  void set_feature(std::span<const std::byte>) override {}
  void claim_scope() override {}
  void release_scope() override {}
  std::size_t read_bulk(std::span<std::byte>, std::chrono::milliseconds) override { return 0; }
  const device::Endpoint& endpoint() const override { return endpoint_; }

 private:
  std::vector<State> states_;
  std::size_t read_ = 0;
  tests::AnsweredCommands commands_;
  device::Endpoint endpoint_;
};

State state_after_force_off(std::vector<State> states) {
  device::Device device(std::make_unique<SlowPoses>(std::move(states)));
  return command_line::switch_force_off(device).state;
}

}  // namespace

TEST_CASE("`force off` reports a pose that the board sent after the command") {
  CHECK(state_after_force_off({State::active, State::active, State::ready}) == State::ready);
  CHECK(state_after_force_off({State::active, State::fault, State::ready}) == State::fault);
}

TEST_CASE("after two seconds of board time, `force off` reports the newest state") {
  CHECK(state_after_force_off(std::vector<State>(3000, State::active)) == State::active);
}
