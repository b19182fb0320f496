#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "boards/omni_driver/facts.hpp"
#include "protocol/scope.hpp"

namespace inkwell::virtual_usb_test {

using namespace virtual_board;

namespace {
constexpr std::uint8_t pose_endpoint = 1, report_endpoint = 1, scope_endpoint = 2, controller_endpoint = 3;
}  // namespace

std::filesystem::path flashed_image() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / ".." / "board" / "inkwell.elf";
}

namespace {
virtual_board::ChipOptions without_log(virtual_board::ChipOptions options) {
  options.log = [](const std::string&) {};
  return options;
}
}  // namespace

FirmwareOnBus::FirmwareOnBus(const std::filesystem::path& image, double host_clock_ppm,
                             virtual_board::ChipOptions options)
    : chip(circuit, without_log(std::move(options))),
      connector(chip.connections()),
      registers(connector),
      cable(connector),
      port(chip.connections().scheduler, cable, *this, host_clock_ppm) {
  chip.load_elf(image);
  chip.add_peripheral(OtgFsDevice::base, OtgFsDevice::size, "OTG_FS", registers);
  chip.on_boot_loader = [this] { return connector.boot_loader_order(chip.debug_port()); };
  chip.reset(ResetCause::power_on);
  for (const auto& [letter, number] : {std::pair{'B', 12u}, {'A', 6u}, {'B', 13u}, {'B', 14u}, {'B', 15u}})
    chip.input_pins().drive(letter, number, PinLevel::high);
  plug(true);
}

void FirmwareOnBus::plug(bool in) {
  port.plug(in);
  chip.input_pins().drive(board::omni_driver.usb_supply.port, board::omni_driver.usb_supply.number,
                          in ? PinLevel::high : PinLevel::low);
}

void FirmwareOnBus::connect() {
  for (int i = 0; i < 1000 && !port.enumerated(); ++i) run_for(0.001);
  if (!port.enumerated()) throw std::runtime_error("the device does not enumerate");
  port.import();
  constexpr std::uint8_t set_configuration = 9;
  if (control(0x00, set_configuration, 1, 0, 0).status != 0) throw std::runtime_error("the device is not configured");
}

FirmwareOnBus::Answer FirmwareOnBus::control(std::uint8_t type, std::uint8_t request, std::uint16_t value,
                                             std::uint16_t index, std::uint16_t length, std::vector<std::byte> data) {
  const auto low = [](std::uint16_t word) { return std::byte(word & 0xFF); };
  const auto high = [](std::uint16_t word) { return std::byte(word >> 8); };
  Urb urb;
  urb.sequence = ++sequence_;
  urb.in = (type & 0x80) != 0;
  urb.length = length;
  urb.data = std::move(data);
  urb.setup = {std::byte{type}, std::byte{request}, low(value),  high(value),
               low(index),      high(index),        low(length), high(length)};
  const std::uint32_t wanted = urb.sequence;
  port.submit(std::move(urb));
  for (int i = 0; i < 2000 && !answers_.contains(wanted); ++i) run_for(0.001);
  const auto found = answers_.extract(wanted);
  if (found.empty()) throw std::runtime_error("a control transfer does not end");
  return found.mapped();
}

void FirmwareOnBus::keep_asking_for_poses() {
  asks_for_poses_ = true;
  constexpr int requests_under_way = 3;
  for (int i = 0; i < requests_under_way; ++i) ask(pose_endpoint, sizeof(protocol::PoseReport));
}

void FirmwareOnBus::keep_asking_the_controller() { ask(controller_endpoint, sizeof(protocol::ControllerReport)); }

void FirmwareOnBus::stream_scope(std::span<const protocol::Signal> signals) {
  protocol::CommandReport report{};
  report.command = protocol::Command::select_signals;
  report.token = 1;
  report.selection.count = static_cast<std::uint8_t>(signals.size());
  for (std::size_t i = 0; i < signals.size(); ++i) report.selection.signals[i] = static_cast<std::uint8_t>(signals[i]);
  send_report(report);
  constexpr int requests_under_way = 8;
  for (int i = 0; i < requests_under_way; ++i) ask(scope_endpoint, protocol::scope_frame_maximum);
}

void FirmwareOnBus::send_report(std::span<const std::byte> report) {
  Urb urb;
  urb.sequence = ++sequence_;
  urb.endpoint = report_endpoint;
  urb.length = static_cast<std::uint32_t>(report.size());
  urb.data.assign(report.begin(), report.end());
  port.submit(std::move(urb));
}

void FirmwareOnBus::ask(std::uint8_t endpoint, std::uint32_t length) {
  Urb urb;
  urb.sequence = ++sequence_;
  urb.endpoint = endpoint;
  urb.in = true;
  urb.length = length;
  port.submit(std::move(urb));
}

void FirmwareOnBus::completed(Urb&& urb, std::int32_t status) {
  if (urb.endpoint == 0) {
    answers_[urb.sequence] = {status, std::move(urb.data)};
    return;
  }
  if (status != 0) return;
  if (!urb.in) {
    if (on_report_sent) on_report_sent();
    return;
  }
  if (urb.endpoint != pose_endpoint || asks_for_poses_) ask(urb.endpoint, urb.length);
  if (urb.endpoint == scope_endpoint) {
    if (on_scope_frame) on_scope_frame(urb.data);
  } else if (urb.endpoint == controller_endpoint) {
    if (on_controller_report) on_controller_report(urb.data);
  } else if (on_pose && urb.data.size() == sizeof(protocol::PoseReport)) {
    protocol::PoseReport pose;
    std::memcpy(&pose, urb.data.data(), sizeof pose);
    on_pose(pose);
  }
}

std::vector<std::string> FirmwareOnBus::violations() const {
  std::vector<std::string> sentences;
  for (const Violation& violation : chip.violations()) sentences.push_back(sentence(violation));
  return sentences;
}

}  // namespace inkwell::virtual_usb_test
