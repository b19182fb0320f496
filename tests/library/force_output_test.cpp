// Tests that forces and poses are not delayed in a queue.
#include <doctest/doctest.h>

#include <memory>
#include <optional>
#include <semaphore>
#include <thread>

#include "firmware/control/settings.hpp"
#include "host/client/device/device.hpp"
#include "protocol/parameters.hpp"

#include "host/bindings/library/force_output.hpp"
#include "host/bindings/library/pose_reader.hpp"
#include "tests/library/queued_transport.hpp"

namespace inkwell::tests {
namespace {

TEST_CASE("while the device does not accept a force or a command, only the newest force waits") {
  QueuedReports reports;
  device::Device device(std::make_unique<QueuedTransport>(reports));
  library::PoseFeed poses;
  library::ForceOutput output(device, poses);
  output.send({1, 0, 0}, 1);
  reports.wait_for_forces(1);
  device.send(protocol::Command::heartbeat);
  for (int i = 2; i <= 100; ++i) output.send({static_cast<double>(i), 0, 0}, 1);
  reports.accept_one();  // the command is still pending
  output.send({101, 0, 0}, 3);
  reports.accept_one();
  reports.wait_for_forces(2);
  CHECK(reports.forces.size() == 2);
  CHECK(reports.forces.back().force_N[0] == 101.0f);
  CHECK(reports.forces.back().sequence == 1);  // no force counts as lost
}

TEST_CASE("a local model and a force share a report; the model repeats the force for the life of the force") {
  QueuedReports reports;
  device::Device device(std::make_unique<QueuedTransport>(reports));
  library::PoseFeed poses;
  library::ForceOutput output(device, poses);
  const device::LocalModel model;
  constexpr double life_s = 0.05;
  std::size_t sent = 0;
  const auto next = [&] {
    const auto report = reports.wait_for_models(++sent);
    reports.accept_one();
    return report;
  };
  output.send_model(model, 10, life_s);  // no program sends forces
  CHECK(next().mode == protocol::ForceMode::none);
  output.send({1, 0, 0}, 10);
  reports.wait_for_forces(1);
  reports.accept_one();
  // The program answers each pose: the model waits for the force of its pose.
  output.send_model(model, 11, life_s);
  output.send({2, 0, 0}, 11);
  auto report = next();
  CHECK(report.force[0] == 2000);
  CHECK(report.pose_sequence == 11);
  CHECK(report.mode == protocol::ForceMode::instead_of_walls);
  // The program is late: the second model does not wait.
  output.send_model(model, 12, life_s);
  output.send_model(model, 13, life_s);
  report = next();
  CHECK(report.force[0] == 2000);
  CHECK(report.pose_sequence == 13);
  CHECK(report.interval_ms == 1);
  output.send_model(model, 61, life_s);
  CHECK(next().mode == protocol::ForceMode::instead_of_walls);
  output.send_model(model, 62, life_s);
  CHECK(next().mode == protocol::ForceMode::none);
  // A slow program: the rest of the interval remains.
  for (std::uint32_t pose = 70; pose <= 170; pose += 20) {
    output.send({3, 0, 0}, pose);
    reports.wait_for_forces(2 + (pose - 70) / 20);
    reports.accept_one();
  }
  output.send_model(model, 175, life_s);
  CHECK(next().interval_ms == 15);
  output.let_go();
  reports.wait_for_forces(8);
  reports.accept_one();
  output.send_model(model, 176, life_s);
  CHECK(next().mode == protocol::ForceMode::none);
  CHECK(reports.forces.size() == 8);
}

TEST_CASE("a thread that reads poses can request the driver without waiting for the request of another thread") {
  QueuedReports reports;
  std::binary_semaphore is_asked(0), may_answer(0);
  reports.on_feature_request = [&] {
    is_asked.release();
    may_answer.acquire();
  };
  device::Device device(std::make_unique<QueuedTransport>(reports));
  std::thread asks([&] { CHECK_THROWS_AS(device.bus_frame(), device::Error); });
  is_asked.acquire();
  std::optional<device::Driver> driver;
  CHECK_FALSE(device.try_driver(driver));
  may_answer.release();
  asks.join();
}

TEST_CASE("a reader that was late passes on the newest pose, with the velocity of the whole path") {
  QueuedReports reports;
  device::Device device(std::make_unique<QueuedTransport>(reports));
  const control::Arm geometry = control::prepare(protocol::default_parameters()).arm;
  library::PoseReader reader;
  CHECK_FALSE(reader.read_newest(device, std::chrono::milliseconds(0), geometry));
  constexpr std::uint32_t count = 20;
  for (std::uint32_t i = 1; i <= count; ++i) {
    protocol::PoseReport pose{};
    pose.sequence = i;
    pose.time_periods = i * (protocol::servo_rate_Hz / 1000);
    pose.is_referenced = 1;
    pose.position_m[0] = 0.0001f * static_cast<float>(i);
    reports.poses.push_back(pose);
  }
  const auto newest = reader.read_newest(device, std::chrono::milliseconds(0), geometry);
  REQUIRE(newest);
  CHECK(newest->is_referenced);
  CHECK(newest->pose.sequence == count);
  CHECK(newest->pose.velocity_m_s[0] == doctest::Approx(0.1).epsilon(0.01));
}

}  // namespace
}  // namespace inkwell::tests
