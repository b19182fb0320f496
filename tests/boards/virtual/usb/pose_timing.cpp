#include "tests/boards/virtual/usb/pose_timing.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using namespace virtual_board;

constexpr Ticks ticks_per_cycle = ticks_per_s / board::processor_Hz;

struct Measurement {
  explicit Measurement(FirmwareOnBus& the_bus) : bus(the_bus) {}

  void start_of_frame() {
    if (counting && asked) {
      ++timing.frames;
      if (!got_new) ++timing.empty_frames;
    }
    asked = got_new = false;
  }

  void in(unsigned endpoint, const InReply& reply, std::span<const std::byte> data) {
    if (endpoint != 1) return;
    asked = true;
    token_at = bus.chip.now();
    is_pose = reply.handshake == Handshake::ack && data.size() == sizeof pose;
    if (is_pose) std::memcpy(&pose, data.data(), sizeof pose);
  }

  void finished(unsigned endpoint, bool done) {
    if (endpoint != 1 || !done || !is_pose) return;
    if (last && counting) {
      timing.gaps += pose.sequence - last->sequence - 1;
      timing.longest_pause_periods =
          std::max<std::uint64_t>(timing.longest_pause_periods, pose.time_periods - last->time_periods);
    }
    got_new = !last || pose.time_periods != last->time_periods;
    if (edge_at && last && pose.joint_rad[0] != last->joint_rad[0]) {
      const auto cycles_since = [this](Ticks when) { return (when - *edge_at) / ticks_per_cycle; };
      if (token_at < *edge_at) throw std::runtime_error("a pose shows an edge of the encoder that is still to come");
      ++timing.edges;
      timing.longest_edge_to_token = std::max(timing.longest_edge_to_token, cycles_since(token_at));
      timing.longest_edge_to_packet = std::max(timing.longest_edge_to_packet, cycles_since(bus.chip.now()));
      edge_at.reset();
    }
    last = pose;
  }

  /// Moves the first encoder back and forth by one edge at random times. Each edge waits until the host has received
  /// the previous edge.
  void plan_edge() {
    const Ticks pause = std::uniform_int_distribution<Ticks>(ticks_per_s / 10'000, ticks_per_s / 500)(random);
    bus.chip.connections().scheduler.at(bus.chip.now() + pause, [this] {
      if (!edge_at) {
        is_high = !is_high;
        bus.chip.input_pins().drive(board::omni_driver.encoders[0].a.pin.port,
                                    board::omni_driver.encoders[0].a.pin.number,
                                    is_high ? PinLevel::high : PinLevel::low);
        edge_at = bus.chip.now();
      }
      plan_edge();
    });
  }

  FirmwareOnBus& bus;
  PoseTiming timing;
  bool counting = false, asked = false, got_new = false, is_pose = false, is_high = false;
  Ticks token_at = 0;
  std::optional<Ticks> edge_at;
  protocol::PoseReport pose{};
  std::optional<protocol::PoseReport> last;
  std::mt19937_64 random{1};
};

constexpr std::uint16_t parameters_feature = 0x0300 | static_cast<std::uint16_t>(protocol::ReportId::parameters);

/// Sets all parameters to their current values repeatedly for `time_s`.
void storm(FirmwareOnBus& bus, double time_s) {
  auto answer = bus.control(0xA1, 1, parameters_feature, 0, sizeof(protocol::ParametersReport));
  protocol::ParametersReport report{};
  std::memcpy(&report, answer.data.data(), answer.data.size());
  if (report.count != protocol::parameter_count) throw std::runtime_error("the board does not tell all its parameters");
  report.operation = protocol::ParameterOperation::set;
  const std::size_t size = protocol::parameters_report_size(report.count);
  std::vector<std::byte> set(size);
  std::memcpy(set.data(), &report, size);
  for (const Ticks end = bus.chip.now() + ticks(time_s); bus.chip.now() < end;)
    if (bus.control(0x21, 9, parameters_feature, 0, static_cast<std::uint16_t>(size), set).status != 0)
      throw std::runtime_error("the board refuses its own parameters");
}

}  // namespace

PoseTiming measure_poses(const std::filesystem::path& image, double host_clock_ppm, double time_s,
                         std::uint8_t scope_signals, Beside beside) {
  FirmwareOnBus bus(image, host_clock_ppm);
  Measurement measurement(bus);
  bus.chip.input_pins().drive(board::omni_driver.encoders[0].a.pin.port, board::omni_driver.encoders[0].a.pin.number,
                              PinLevel::low);
  bus.chip.input_pins().drive(board::omni_driver.encoders[0].b.pin.port, board::omni_driver.encoders[0].b.pin.number,
                              PinLevel::low);
  bus.connect();
  bus.cable.on_start_of_frame = [&](std::uint16_t) { measurement.start_of_frame(); };
  bus.cable.on_in = [&](unsigned endpoint, const InReply& reply, std::span<const std::byte> data) {
    measurement.in(endpoint, reply, data);
  };
  bus.cable.on_finished_in = [&](unsigned endpoint, bool done) { measurement.finished(endpoint, done); };
  bus.keep_asking_for_poses();
  std::vector<protocol::Signal> signals;
  for (std::uint8_t i = 0; i < scope_signals; ++i) signals.push_back(static_cast<protocol::Signal>(i));
  if (!signals.empty()) bus.stream_scope(signals);
  bus.run_for(0.1);  // the state of the encoder settles
  measurement.plan_edge();
  measurement.counting = true;
  if (beside == Beside::storm_of_parameters)
    storm(bus, time_s);
  else
    bus.run_for(time_s);
  if (const auto broken = bus.violations(); !broken.empty()) throw std::runtime_error(broken.front());
  return measurement.timing;
}

}  // namespace inkwell::virtual_usb_test
