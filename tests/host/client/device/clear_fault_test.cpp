// Tests how long clear_fault() observes the board state.
#include "host/client/device/clear_fault.hpp"

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>

#include <doctest/doctest.h>

#include "host/client/device/transport.hpp"

#include "tests/host/client/device/answered_commands.hpp"

using namespace inkwell;
using device::ShownFault;
using protocol::Fault;
using protocol::State;

namespace {

class CountingTransport final : public device::Transport {
 public:
  explicit CountingTransport(unsigned& written) : written_(written) {}
  std::size_t read_report(std::span<std::byte>, std::chrono::milliseconds) override { return 0; }
  void write_report(std::span<const std::byte> report) override {
    ++written_;
    commands_.note(report);
  }
  std::size_t get_feature(std::span<std::byte> report) override { return commands_.answer(report); }
  void set_feature(std::span<const std::byte>) override {}
  void claim_scope() override {}
  void release_scope() override {}
  std::size_t read_bulk(std::span<std::byte>, std::chrono::milliseconds) override { return 0; }
  const device::Endpoint& endpoint() const override { return endpoint_; }

 private:
  unsigned& written_;
  tests::AnsweredCommands commands_;
  device::Endpoint endpoint_;
};

constexpr std::uint32_t ms_periods = protocol::servo_rate_Hz / 1000;

/// Returns the waiting time of clear_fault() in milliseconds; `shown(ms)` is the board state.
template <class Shown>
unsigned cleared_after_ms(std::int64_t begin_periods, State first, Shown shown) {
  unsigned written = 0, ms = 0;
  device::Device device(std::make_unique<CountingTransport>(written));
  const auto fault = [](State state) { return state == State::fault ? Fault::bridge_fault : Fault::none; };
  device::clear_fault(device, {begin_periods, first, fault(first)}, [&] {
    ++ms;
    const State state = shown(ms);
    return ShownFault{begin_periods + ms * ms_periods, state, fault(state)};
  });
  CHECK(written == 1);
  return ms;
}

}  // namespace

TEST_CASE("without a fault clearing waits for nothing, with one for a fifth of a second of the board") {
  const auto ready = [](unsigned) { return State::ready; };
  CHECK(cleared_after_ms(1000, State::ready, ready) == 0);
  CHECK(cleared_after_ms(1000, State::fault, ready) == 200);
  CHECK(cleared_after_ms(0xFFFF'FFF0, State::fault, ready) == 200);  // the board's counter wraps during the wait
}

TEST_CASE("clearing a fault waits for a self-test for a limited time, and reports a fault that remains") {
  const auto tests_until = [](unsigned end_ms, State then) {
    return [end_ms, then](unsigned ms) { return ms < end_ms ? State::testing : then; };
  };
  CHECK(cleared_after_ms(1000, State::fault, tests_until(350, State::ready)) == 350);
  CHECK(cleared_after_ms(1000, State::fault, tests_until(5000, State::ready)) == 1000);
  CHECK_THROWS_WITH_AS(cleared_after_ms(1000, State::fault, tests_until(350, State::fault)),
                       doctest::Contains("The board has raised the fault again. bridge_fault: "), device::FaultStays);
}
