#include "tests/boards/virtual/usb/force_timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "protocol/driver.hpp"
#include "protocol/scope.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using protocol::Signal;

/// The force rises from first_N to last_N during the measurement, so a force value identifies the time of its pose.
constexpr float first_N = -3.0f, last_N = 3.0f;

constexpr std::uint32_t claim_number = 7;

/// Only the driver may send forces.
void claim_arm(FirmwareOnBus& bus) {
  const protocol::ClaimReport claim{
      .operation = protocol::ClaimOperation::claim, .claim = claim_number, .process_id = 1, .program = "forces"};
  const auto bytes = std::as_bytes(std::span(&claim, 1));
  const auto answer = bus.control(0x21, 9, 0x0300 | static_cast<std::uint16_t>(protocol::ReportId::driver), 0,
                                  sizeof claim, {bytes.begin(), bytes.end()});
  if (answer.status != 0) throw std::runtime_error("the claim is refused");
}

struct Program {
  Program(FirmwareOnBus& the_bus, double host_clock_ppm, double time_s)
      : bus(the_bus),
        bus_frame_ticks(ticks(1e-3 / (1.0 + 1e-6 * host_clock_ppm))),
        N_per_period((last_N - first_N) / (time_s * protocol::servo_rate_Hz)) {}

  void answer(const protocol::PoseReport& pose) {
    if (!begin_periods) begin_periods = pose.time_periods;
    protocol::ForceReport report{};
    report.mode = protocol::ForceMode::beside_walls;
    report.interval_ms = 1;
    report.claim = claim_number;
    report.pose_sequence = pose.sequence;
    report.sequence = static_cast<std::uint32_t>(timing.sent++);
    report.force_N[0] = static_cast<float>(first_N + N_per_period * (pose.time_periods - *begin_periods));
    bus.send_report(report);
  }

  void sent() {
    const Ticks now = bus.chip.now();
    if (sent_at)
      count_deviation(1e6 * (static_cast<double>(now - *sent_at) - static_cast<double>(bus_frame_ticks)) /
                      static_cast<double>(ticks(1.0)));
    sent_at = now;
  }

  void count_deviation(double deviation_us) {
    const auto& bounds = ForceTiming::deviation_bounds_us;
    const auto beyond = std::upper_bound(bounds.begin(), bounds.end(), std::abs(deviation_us)) - bounds.begin();
    const auto middle = static_cast<std::ptrdiff_t>(bounds.size());
    ++timing.deviations[static_cast<std::size_t>(deviation_us < 0 ? middle - beyond : middle + beyond)];
  }

  void read_scope_frame(std::span<const std::byte> frame_bytes) {
    protocol::ScopeFrameHeader header;
    if (frame_bytes.size() < sizeof header) throw std::runtime_error("a scope frame is too short");
    std::memcpy(&header, frame_bytes.data(), sizeof header);
    constexpr std::uint32_t start_periods = protocol::servo_rate_Hz / 100;
    for (std::uint32_t i = 0; i < header.sample_count; ++i) {
      float force_N = 0;
      std::memcpy(&force_N, &frame_bytes[sizeof header + i * sizeof force_N], sizeof force_N);
      const std::uint32_t period = header.first_period + i;
      if (!begin_periods || period < *begin_periods + start_periods) continue;
      ++timing.samples;
      const double pose_periods = (force_N - first_N) / N_per_period + *begin_periods;
      timing.longest_pose_to_force_periods = std::max(timing.longest_pose_to_force_periods, period - pose_periods);
    }
  }

  FirmwareOnBus& bus;
  Ticks bus_frame_ticks;
  double N_per_period;
  ForceTiming timing;
  std::optional<std::uint32_t> begin_periods;
  std::optional<Ticks> sent_at;
};

}  // namespace

ForceTiming measure_forces(const std::filesystem::path& image, double host_clock_ppm, double time_s) {
  FirmwareOnBus bus(image, host_clock_ppm);
  Program program(bus, host_clock_ppm, time_s);
  bus.connect();
  bus.stream_scope(std::array{Signal::program_force_x_N});
  bus.keep_asking_for_poses();
  claim_arm(bus);
  bus.run_for(0.1);
  bus.on_scope_frame = [&](std::span<const std::byte> scope_frame) { program.read_scope_frame(scope_frame); };
  bus.on_report_sent = [&] { program.sent(); };
  bus.on_pose = [&](const protocol::PoseReport& pose) { program.answer(pose); };
  bus.run_for(time_s);
  bus.on_pose = nullptr;
  bus.on_scope_frame = nullptr;
  bus.run_for(0.01);  // the last force arrives
  const auto answer = bus.control(0xA1, 1, 0x0300 | static_cast<std::uint16_t>(protocol::ReportId::information), 0,
                                  sizeof(protocol::InformationReport));
  protocol::InformationReport information;
  if (answer.data.size() != sizeof information) throw std::runtime_error("the information report is not whole");
  std::memcpy(&information, answer.data.data(), sizeof information);
  program.timing.received = information.force_reports;
  program.timing.lost = information.force_reports_lost;
  program.timing.late = information.force_reports_late;
  program.timing.refused = information.force_reports_refused;
  if (const auto broken = bus.violations(); !broken.empty()) throw std::runtime_error(broken.front());
  return program.timing;
}

}  // namespace inkwell::virtual_usb_test
