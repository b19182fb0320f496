// Tests the device library and the firmware's USB device with the report lengths of Windows. Windows pads written
// reports and requests the largest report length. The test fails if the firmware refuses the report lengths of Windows.
#include <doctest/doctest.h>

#include <algorithm>
#include <memory>

#include "host/client/device/device.hpp"
#include "protocol/black_box.hpp"
#include "protocol/usb_identity.hpp"
#include "tests/firmware/usb/device_bench.hpp"

#include "tests/host/client/device/fake_usb.hpp"

using namespace inkwell;
using tests::FakeUsb;

namespace {

/// Passes reports to a USB device in this process.
class BenchTransport final : public device::Transport {
 public:
  explicit BenchTransport(test::DeviceBench& bench) : bench_(bench) {
    bench_.configure();
    bench_.link.program.take_shapes();  // the reset removed all shapes
  }

  std::size_t read_report(std::span<std::byte>, std::chrono::milliseconds) override { return 0; }
  void write_report(std::span<const std::byte> report) override {
    REQUIRE(bench_.port.out(protocol::usb::hid_out_endpoint, report) == test::Handshake::ack);
    bench_.device.poll();
    bench_.run(1);
  }
  std::size_t get_feature(std::span<std::byte> report) override {
    const auto result = bench_.control(setup(0xA1, 1, report[0], report.size()));
    return length_of(result, report);
  }
  void set_feature(std::span<const std::byte> report) override {
    const auto result = bench_.control(setup(0x21, 9, report[0], report.size()), report);
    bench_.run(1);
    if (result.stalled) throw device::Stalled("stalled");
  }
  void claim_scope() override {}
  void release_scope() override {}
  std::size_t read_bulk(std::span<std::byte>, std::chrono::milliseconds) override { return 0; }
  const device::Endpoint& endpoint() const override { return endpoint_; }

 private:
  static usb::SetupPacket setup(std::uint8_t type, std::uint8_t request, std::byte id, std::size_t length) {
    constexpr std::uint16_t feature = 3 << 8;
    return test::request(type, request, static_cast<std::uint16_t>(feature | std::to_integer<unsigned>(id)),
                         protocol::usb::hid_interface, static_cast<std::uint16_t>(length));
  }
  static std::size_t length_of(const test::ControlResult& result, std::span<std::byte> report) {
    if (result.stalled) throw device::Stalled("stalled");
    std::ranges::copy(result.data, report.begin());
    return result.data.size();
  }

  test::DeviceBench& bench_;
  device::Endpoint endpoint_{};
};

struct WindowsArm {
  WindowsArm() {
    usb.is_windows = true;
    auto& fake = usb.add_arm("A");
    fake.board = std::make_shared<BenchTransport>(bench);
    endpoint = fake.endpoint();
  }
  test::DeviceBench bench;
  FakeUsb usb;
  device::Endpoint endpoint;
};

}  // namespace

TEST_CASE("Windows: an arm is opened, claimed, and gets parameters") {
  WindowsArm windows;
  const auto arm = device::Device::open(windows.endpoint);
  CHECK(arm->information().report.servo_rate_Hz == protocol::servo_rate_Hz);
  arm->claim();
  CHECK(arm->drives());
  arm->set_parameters(std::vector<device::ParameterChange>{{protocol::Parameter::wall_damping_Ns_per_m, 2.5f}});
  CHECK(arm->parameters()[protocol::Parameter::wall_damping_Ns_per_m] == 2.5f);
  arm->release();
  CHECK_FALSE(arm->driver());
}

TEST_CASE("Windows: a program's shapes are placed") {
  WindowsArm windows;
  const auto arm = device::Device::open(windows.endpoint);
  arm->claim();
  device::Shapes shapes;
  shapes.sphere = device::Sphere{.centre_m = {0, 0, -0.03}, .radius_m = 0.01, .surface = {.stiffness_N_per_m = 300}};
  arm->place_shapes(shapes);
  const auto* placed = windows.bench.link.program.take_shapes();
  REQUIRE(placed != nullptr);
  CHECK(placed->solids[protocol::shape_solids_maximum].radius_m == 0.01f);
}

TEST_CASE("Windows: a program's forces and commands are accepted") {
  WindowsArm windows;
  const auto arm = device::Device::open(windows.endpoint);
  arm->claim();
  arm->carry_out(protocol::Command::heartbeat);
  CHECK(windows.bench.last_command->command == protocol::Command::heartbeat);
  arm->send_force({.force_N = {0, 0, 0.5}});
  const auto counted = arm->information().report;
  CHECK(counted.force_reports == 1);
  CHECK(counted.force_reports_refused == 0);
}

TEST_CASE("Windows: the rows of the black box are chosen and read") {
  WindowsArm windows;
  const auto transport = device::open_transport(windows.endpoint);
  const protocol::BlackBoxRequest request{.first_row = 3};
  transport->set_feature(std::as_bytes(std::span(&request, 1)));
  protocol::BlackBoxRowsReport rows{.report_id = protocol::ReportId::black_box_rows};
  CHECK(transport->get_feature(std::as_writable_bytes(std::span(&rows, 1))) == sizeof rows);
  CHECK(rows.first_row == request.first_row);
}
