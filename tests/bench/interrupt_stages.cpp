#include "tests/bench/interrupt_stages.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "boards/omni_driver/facts.hpp"
#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"
#include "tests/stepped_board.hpp"

namespace inkwell::bench {
namespace {

using namespace std::chrono_literals;
using protocol::Parameter;
using protocol::Signal;

constexpr std::size_t selected = 31;
constexpr auto first_stage = static_cast<std::size_t>(Signal::servo_cycles);
constexpr std::size_t stage_count = static_cast<std::size_t>(Signal::stage_report_cycles) - first_stage + 1;

/// Board time advances in run() and during requests to the device.
class PressedBoard {
 public:
  /// `profile`: see VirtualBoardOptions.
  explicit PressedBoard(device::CyclePricing pricing, const std::filesystem::path& profile = {})
      : board_(options(pricing, profile)), control_(board_.control()) {
    control_.stand_by();
    std::optional<device::Endpoint> endpoint;
    while (!(endpoint = board_.find())) control_.run(slice_s);
    device_ = device::Device::open(*endpoint);
  }

  /// Presses the probe against three walls, then moves the probe back. Returns the largest total duration and the
  /// largest duration of each stage.
  std::array<float, stage_count> press() {
    run(0.5);  // the encoders are referenced
    std::vector<Signal> signals;
    for (std::size_t id = first_stage + stage_count - selected; id < first_stage + stage_count; ++id)
      signals.push_back(static_cast<Signal>(id));
    device_->select_signals(signals);
    device_->send(protocol::Command::enable_force);
    run(0.1);
    longest_ = {};
    take_to({0.0, 0.0, -0.03}, 0.6);
    device_->set_parameters(std::array<device::ParameterChange, 3>{{{Parameter::box_minimum_z_m, -0.02f},
                                                                    {Parameter::box_maximum_x_m, 0.0f},
                                                                    {Parameter::box_maximum_y_m, 0.0f}}});
    take_to({0.02, 0.02, -0.045}, 0.3);
    take_to({0.0, 0.0, -0.03}, 0.3);
    return longest_;
  }
  std::uint32_t longest_interrupt_cycles() { return device_->information().report.servo_cycles_longest; }

 private:
  static constexpr double slice_s = 0.01;

  static device::VirtualBoardOptions options(device::CyclePricing pricing, const std::filesystem::path& profile) {
    auto options = tests::stepped_board(device::SimulationMode::exact, pricing);
    options.profile = profile;
    return options;
  }

  void run(double time_s) {
    for (double passed_s = 0; passed_s < time_s; passed_s += slice_s) {
      control_.run(slice_s);
      while (device_->read_pose(0ms)) {
      }
      while (const auto samples = device_->read_scope(0ms)) keep_longest(*samples);
      device_->send(protocol::Command::heartbeat);
    }
  }

  void take_to(device::Vector3 target_m, double duration_s) {
    run(tests::bring_stylus(control_, target_m, duration_s));
  }

  void keep_longest(const device::ScopeSamples& samples) {
    for (std::size_t i = 0; i < samples.values.size(); ++i) {
      const std::size_t signal = i % selected;
      if (signal < selected - stage_count) continue;
      float& longest = longest_[signal - (selected - stage_count)];
      longest = std::max(longest, samples.values[i]);
    }
  }

  device::VirtualBoard board_;
  device::ControlClient control_;
  std::unique_ptr<device::Device> device_;
  std::array<float, stage_count> longest_{};
};

}  // namespace

void print_interrupt_stages() {
  PressedBoard likely(device::CyclePricing::likely);
  PressedBoard conservative(device::CyclePricing::conservative, INKWELL_BUILD_DIRECTORY "/interrupt.profile");
  const auto likely_cycles = likely.press(), conservative_cycles = conservative.press();
  std::printf("Control interrupt on the virtual board (simulation) with %zu signals.\n", selected);
  std::printf("The probe presses against three walls. A control period has %u cycles.\n", board::servo_cycles);
  std::printf("Longest duration of each stage in cycles:\n");
  std::printf("  %-22s %6s %12s\n", "", "likely", "conservative");
  for (std::size_t i = 0; i < stage_count; ++i) {
    const auto& row = protocol::signal_table[first_stage + i];
    std::printf("  %-22s %6.0f %12.0f\n", row.name.data(), static_cast<double>(likely_cycles[i]),
                static_cast<double>(conservative_cycles[i]));
  }
  std::printf("  %-22s %6u %12u\n\n", "since the start", likely.longest_interrupt_cycles(),
              conservative.longest_interrupt_cycles());
  std::fflush(stdout);
}

}  // namespace inkwell::bench
