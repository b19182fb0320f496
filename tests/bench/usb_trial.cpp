// Runs the flashed firmware with a USB host for a given duration.
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"
#include "tests/boards/virtual/usb/force_timing.hpp"
#include "tests/boards/virtual/usb/hostile_host.hpp"
#include "tests/boards/virtual/usb/pose_timing.hpp"

namespace {

using namespace inkwell;
using namespace inkwell::virtual_usb_test;

int poses(const std::filesystem::path& image, double host_clock_ppm, double time_s, std::uint8_t scope_signals) {
  const PoseTiming timing = measure_poses(image, host_clock_ppm, time_s, scope_signals);
  const auto microseconds = [](std::uint64_t cycles) {
    return 1e6 * static_cast<double>(cycles) / board::processor_Hz;
  };
  fmt::print("host clock {:+} ppm, {} s of board time: {} frames, {} without a new pose, {} reports missing\n",
             host_clock_ppm, time_s, timing.frames, timing.empty_frames, timing.gaps);
  fmt::print(
      "{} encoder edges: at most {:.1f} us to the host's token, {:.1f} us to the end of the packet; "
      "{} periods between two reports\n",
      timing.edges, microseconds(timing.longest_edge_to_token), microseconds(timing.longest_edge_to_packet),
      timing.longest_pause_periods);
  return timing.empty_frames == 0 && timing.gaps == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

int forces(const std::filesystem::path& image, double host_clock_ppm, double time_s) {
  const ForceTiming timing = measure_forces(image, host_clock_ppm, time_s);
  fmt::print("host clock {:+} ppm, {} s of board time: {} forces sent, {} received; {} lost, {} late, {} refused\n",
             host_clock_ppm, time_s, timing.sent, timing.received, timing.lost, timing.late, timing.refused);
  fmt::print("from pose to force at most {:.2f} ms\n",
             1e3 * timing.longest_pose_to_force_periods / protocol::servo_rate_Hz);
  fmt::print("time from one force to the next, beside a millisecond of the host:\n");
  const auto& bounds = ForceTiming::deviation_bounds_us;
  const auto row = [](const std::string& what, std::uint64_t count) { fmt::print("  {:<22}{:>10}\n", what, count); };
  const auto middle = bounds.size();
  row(fmt::format("over {} us sooner", bounds.back()), timing.deviations.front());
  for (std::size_t i = bounds.size() - 1; i > 0; --i)
    row(fmt::format("{} to {} us sooner", bounds[i - 1], bounds[i]), timing.deviations[middle - i]);
  row(fmt::format("within {} us", bounds.front()), timing.deviations[middle]);
  for (std::size_t i = 1; i < bounds.size(); ++i)
    row(fmt::format("{} to {} us later", bounds[i - 1], bounds[i]), timing.deviations[middle + i]);
  row(fmt::format("over {} us later", bounds.back()), timing.deviations.back());
  return timing.received == timing.sent && timing.lost == 0 && timing.late == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

int hostile(const std::filesystem::path& image, std::uint64_t from, std::uint64_t cases, std::uint64_t seed) {
  const HostileOutcome outcome = be_hostile(image, from, from + cases, seed);
  fmt::print(
      "{} cases; a SETUP upon another was answered {} times, {} of them with the other's answer, {} times refused as "
      "the other and {} times not answered at all\n",
      outcome.cases, outcome.answers, outcome.wrong_answers, outcome.stalled_answers, outcome.missing_answers);
  for (const auto& failure : outcome.failures) fmt::print("{}\n", failure);
  return outcome.failures.empty() && outcome.wrong_answers == 0 && outcome.missing_answers == 0 ? EXIT_SUCCESS
                                                                                                : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "The firmware that would be flashed, on the virtual chip, against a USB host. Everything is simulation."};
  std::filesystem::path image = flashed_image();
  app.add_option("--elf", image, "firmware to run")->type_name("FILE");
  app.require_subcommand(1);
  double host_clock_ppm = 0.0, time_s = 10.0;
  auto* poses_command = app.add_subcommand("poses", "Are poses lost, and how old are they when the host gets them?");
  poses_command->add_option("--host-clock-ppm", host_clock_ppm, "how much faster than board time the host's clock is");
  poses_command->add_option("--seconds", time_s, "of board time")->capture_default_str();
  std::uint8_t scope_signals = 0;
  poses_command->add_option("--scope-signals", scope_signals, "signals of the scope that the host reads too")
      ->check(CLI::Range(0, 32).description(""))
      ->capture_default_str();
  auto* forces_command = app.add_subcommand("forces", "Does a program's force arrive each millisecond, and how soon?");
  forces_command->add_option("--host-clock-ppm", host_clock_ppm, "how much faster than board time the host's clock is");
  forces_command->add_option("--seconds", time_s, "of board time")->capture_default_str();
  std::uint64_t from = 0, cases = 10'000, seed = 1;
  auto* hostile_command = app.add_subcommand("hostile", "Does the device survive a host that keeps to no rule?");
  hostile_command
      ->add_option("--from", from, "the first case; those before it in its row of 10000 are gone through too")
      ->capture_default_str();
  hostile_command->add_option("--cases", cases, "single cases")->capture_default_str();
  hostile_command->add_option("--seed", seed, "of the cases")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    if (*forces_command) return forces(image, host_clock_ppm, time_s);
    if (*hostile_command) return hostile(image, from, cases, seed);
    return poses(image, host_clock_ppm, time_s, scope_signals);
  } catch (const std::exception& error) {
    std::cerr << "usb-trial: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
