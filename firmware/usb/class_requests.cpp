// Requests of the HID class (HID 1.11, section 7.2), of the class for firmware updates (DFU 1.1) and of Windows.
#include <algorithm>
#include <cstring>
#include <new>

#include <control/installed_force_law.hpp>
#include <protocol/black_box.hpp>
#include <protocol/driver.hpp>
#include <protocol/usb_identity.hpp>
#include <usb/device.hpp>

#include "controller_report.hpp"
#include "descriptors.hpp"

namespace inkwell::usb {

namespace {

using protocol::ReportId;

enum HidRequest : std::uint8_t {
  get_report_request = 1,
  get_idle_request = 2,
  set_report_request = 9,
  set_idle_request = 10,
};
enum FirmwareUpdateRequest : std::uint8_t {
  detach_request = 0,
  get_update_status_request = 3,
  get_state_request = 5,
};
enum ReportType : std::uint8_t { input_report = 1, output_report_type = 2, feature_report = 3 };

constexpr std::uint8_t class_interface_out = 0x21, class_interface_in = 0xA1, vendor_device_in = 0xC0;

/// wValue of GET_REPORT and SET_REPORT.
constexpr std::uint16_t report_value(ReportType type, ReportId id) {
  return static_cast<std::uint16_t>(type << 8 | static_cast<std::uint8_t>(id));
}

}  // namespace

Answer Device::class_request(const SetupPacket& setup) {
  if (!configured()) return Answer::stall();
  switch (setup.index) {
    case protocol::usb::hid_interface:
    case protocol::usb::controller_interface: return hid_request(setup);
    case protocol::usb::firmware_update_interface: return firmware_update_request(setup);
    default: return Answer::stall();
  }
}

Answer Device::hid_request(const SetupPacket& setup) {
  const bool is_controller = setup.index == protocol::usb::controller_interface;
  if (setup.request_type == class_interface_in) {
    if (setup.request == get_report_request) return is_controller ? get_controller_report(setup) : get_report(setup);
    if (setup.request == get_idle_request) return send_byte(idle_rates_[setup.index]);
  } else if (setup.request_type == class_interface_out) {
    if (setup.request == set_report_request && !is_controller) {
      const bool known = setup.value == report_value(output_report_type, ReportId::command) ||
                         setup.value == report_value(output_report_type, ReportId::force) ||
                         setup.value == report_value(feature_report, ReportId::parameters) ||
                         setup.value == report_value(feature_report, ReportId::shapes) ||
                         setup.value == report_value(feature_report, ReportId::black_box_rows) ||
                         setup.value == report_value(feature_report, ReportId::driver);
      return known && setup.length != 0 ? Answer::receive() : Answer::stall();
    }
    if (setup.request == set_idle_request && setup.length == 0) {
      idle_rates_[setup.index] = setup.value_high();  // reports are always new: there is never an idle time to fill
      return Answer::done();
    }
  }
  return Answer::stall();  // SET_PROTOCOL and GET_PROTOCOL are for boot devices
}

Answer Device::get_report(const SetupPacket& setup) {
  const std::span<std::byte> buffer = control_.buffer();
  const auto send = [&](const auto& report) {
    static_assert(sizeof report <= ControlEndpoint::buffer_size);
    std::memcpy(buffer.data(), &report, sizeof report);
    return Answer::send(buffer.first(sizeof report));
  };
  switch (setup.value) {
    case report_value(input_report, ReportId::pose): {
      protocol::PoseReport pose;
      if (!link_.poses.read(pose)) return Answer::stall();
      pose.sequence = pose_sequence_;
      pose.driver_parity = driver_parity();
      return send(pose);
    }
    case report_value(feature_report, ReportId::information): return send(information());
    case report_value(feature_report, ReportId::frame): {
      const auto report = frame_report();
      return report ? send(*report) : Answer::stall();
    }
    case report_value(feature_report, ReportId::transaction): return send(link_.parameters.result());
    case report_value(feature_report, ReportId::parameters): {
      auto* report = new (buffer.data()) protocol::ParametersReport;
      return Answer::send(buffer.first(link_.parameters.read(*report)));
    }
    case report_value(feature_report, ReportId::force_law):
      return Answer::send(std::span(control::installed_force_law.report, control::installed_force_law.report_size));
    case report_value(feature_report, ReportId::self_test): return send(link_.self_test.report());
    case report_value(feature_report, ReportId::store): return send(link_.stored.report(link_.parameters.values()));
    case report_value(feature_report, ReportId::stored): {
      auto* report = new (buffer.data()) protocol::ParametersReport;
      return Answer::send(buffer.first(link_.stored.read(*report)));
    }
    case report_value(feature_report, ReportId::driver): return send(link_.driver.report(link_.poses.newest_periods()));
    case report_value(feature_report, ReportId::request_results):
      return send(link_.request_results.report(link_.status.state(), link_.poses.newest_periods()));
    case report_value(feature_report, ReportId::black_box): return send(link_.black_box.report());
    case report_value(feature_report, ReportId::black_box_rows): return send(link_.black_box.rows());
    default: return Answer::stall();
  }
}

Answer Device::get_controller_report(const SetupPacket& setup) {
  protocol::PoseReport pose;
  if (setup.value != input_report << 8 || !link_.poses.read(pose)) return Answer::stall();
  const auto report = controller_report(pose);
  std::memcpy(control_.buffer().data(), &report, sizeof report);
  return Answer::send(control_.buffer().first(sizeof report));
}

bool Device::data_received(const SetupPacket& setup, std::span<const std::byte> data) {
  if (data[0] != static_cast<std::byte>(setup.value_low())) return false;  // the report's id, once more
  if (setup.value == report_value(output_report_type, ReportId::command)) {
    return pass_on(link::decode_command(data));  // a stall tells the host to try again
  }
  if (setup.value == report_value(output_report_type, ReportId::force)) {
    take_force(data);
    return true;
  }
  if (setup.value == report_value(feature_report, ReportId::shapes)) {
    const std::uint32_t claim = link::claim_of_shapes(data);
    return is_permitted(claim) && link_.driver.is_held_by(claim) && link_.program.accept_shapes(data);
  }
  if (setup.value == report_value(feature_report, ReportId::driver)) {
    if (link_.driver.accept(data, link_.poses.newest_periods())) driver_gone();
    return true;
  }
  if (setup.value == report_value(feature_report, ReportId::black_box_rows)) return link_.black_box.select_rows(data);
  // The TransactionReport states the error of a transaction; a stall could not.
  if (is_permitted(link::header_of(data).claim))
    link_.parameters.accept(data, force_is_on(), link_.stored.restorable());
  else
    link_.parameters.refuse(data);
  return true;
}

bool Device::force_is_on() const {
  // In this order: were the state read first, the interrupt could take the command in between.
  return link_.commands.waiting(protocol::Command::enable_force) || protocol::force_is_on(link_.status.state());
}

bool Device::may_store() const {
  using protocol::Command;
  for (const Command before : {Command::enable_force, Command::self_test, Command::test_current, Command::test_voltage})
    if (link_.commands.waiting(before)) return false;
  return protocol::may_store(link_.status.state());
}

// DFU 1.1, section 5.1 and appendix A.2: idle, then detaching as soon as the status stage is over. Not while the hand
// feels a force: it would go without the user having asked for that.
Answer Device::firmware_update_request(const SetupPacket& setup) {
  constexpr std::byte application_idle{0}, application_detach{1};
  const std::byte state = detach_asked_ ? application_detach : application_idle;
  if (setup.request_type == class_interface_out && setup.request == detach_request && setup.length == 0) {
    if (force_is_on()) return Answer::stall();
    detach_asked_ = true;
    link_.update_asked.store(true);
    return Answer::done();
  }
  if (setup.request_type != class_interface_in) return Answer::stall();
  const auto buffer = control_.buffer();
  if (setup.request == get_state_request) {
    buffer[0] = state;
    return Answer::send(buffer.first(1));
  }
  if (setup.request == get_update_status_request) {
    const auto status = buffer.first<6>();  // no error, no time to wait, the state, no text
    std::ranges::fill(status, std::byte{0});
    status[4] = state;
    return Answer::send(status);
  }
  return Answer::stall();
}

protocol::InformationReport Device::information() const {
  protocol::InformationReport report{};
  std::memcpy(report.firmware_version, identity_.firmware_version.data(), identity_.firmware_version.size());
  identity_.board.copy(report.board, protocol::board_name_maximum);
  report.parameter_table_hash = protocol::parameter_table_hash;
  report.signal_table_hash = protocol::signal_table_hash;
  report.servo_rate_Hz = protocol::servo_rate_Hz;
  report.processor_clock_Hz = identity_.processor_clock_Hz;
  report.servo_cycles_longest = link_.status.longest_cycles();
  report.scope_samples_dropped = link_.scope.samples_dropped();
  report.pose_reports_dropped = poses_dropped_;
  report.servo_overruns = link_.status.overruns();
  report.force_reports = link_.program.forces_received();
  report.force_reports_lost = link_.program.forces_lost();
  report.force_reports_late = link_.status.late_force_reports();
  report.force_reports_refused = link_.program.forces_refused();
  report.reset_cause = identity_.reset_cause;
  for (std::size_t i = 0; i < 3; ++i) report.motor_heat[i] = link_.status.motor_heat(i);
  return report;
}

std::optional<protocol::FrameReport> Device::frame_report() {
  const std::optional<BusFrame> frame = port_.frame();
  if (!frame) return std::nullopt;
  const auto time = link_.poses.time_of(frame->begin_cycles);
  if (!time) return std::nullopt;
  protocol::FrameReport report{};
  report.frame_number = frame->number;
  report.sequence = frame->count;
  report.time_periods = time->periods;
  report.time_cycles = time->cycles;
  return report;
}

Answer Device::vendor_request(const SetupPacket& setup) {
  if (setup.request_type == vendor_device_in && setup.request == microsoft_request &&
      setup.index == microsoft_descriptor_index && setup.value == 0)
    return Answer::send(microsoft_descriptor_set());
  return Answer::stall();
}

}  // namespace inkwell::usb
