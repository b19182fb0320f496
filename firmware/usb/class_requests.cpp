// Requests of the HID class (HID 1.11, section 7.2), the firmware update class (DFU 1.1) and Windows.
#include <algorithm>
#include <cstring>
#include <new>

#include "firmware/control/signal_path/installed_force_law.hpp"
#include "firmware/usb/device.hpp"
#include "protocol/report_table.hpp"
#include "protocol/usb_identity.hpp"

#include "firmware/usb/controller_report.hpp"
#include "firmware/usb/descriptors.hpp"

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
constexpr std::uint8_t class_interface_out = 0x21, class_interface_in = 0xA1, vendor_device_in = 0xC0;

constexpr std::uint16_t controller_value = static_cast<std::uint16_t>(protocol::ReportKind::input) << 8;  // no id

/// Returns the report that wValue selects, or null.
const protocol::ReportInfo* report_in(const SetupPacket& setup) {
  return protocol::find_report(static_cast<protocol::ReportKind>(setup.value_high()),
                               static_cast<ReportId>(setup.value_low()));
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
      const protocol::ReportInfo* report = report_in(setup);
      const bool is_accepted = report != nullptr && protocol::is_accepted_length(*report, setup.length);
      return is_accepted ? Answer::receive() : Answer::stall();
    }
    if (setup.request == set_idle_request && setup.length == 0) {
      idle_rates_[setup.index] = setup.value_high();  // stored but not used, because every report contains new data
      return Answer::done();
    }
  }
  return Answer::stall();  // SET_PROTOCOL and GET_PROTOCOL are only for boot devices
}

Answer Device::get_report(const SetupPacket& setup) {
  const protocol::ReportInfo* report = report_in(setup);
  if (report == nullptr || !report->can_be_read) return Answer::stall();
  return Answer::send(compose(report->id), report->bytes);
}

std::span<const std::byte> Device::compose(ReportId id) {
  const std::span<std::byte> buffer = control_.buffer();
  const auto put = [&](const auto& report) {
    static_assert(sizeof report <= ControlEndpoint::buffer_size);
    std::memcpy(buffer.data(), &report, sizeof report);
    return buffer.first(sizeof report);
  };
  switch (id) {
    case ReportId::pose: return put(newest_pose());
    case ReportId::information: return put(information());
    case ReportId::frame: return put(frame_report());
    case ReportId::transaction: return put(link_.parameters.result());
    case ReportId::parameters: {
      auto* report = new (buffer.data()) protocol::ParametersReport;
      return buffer.first(link_.parameters.read(*report));
    }
    case ReportId::force_law:
      return std::span(control::installed_force_law.report, control::installed_force_law.report_size);
    case ReportId::self_test: return put(link_.self_test.report());
    case ReportId::store: return put(link_.stored.report(link_.parameters.values()));
    case ReportId::stored: {
      auto* report = new (buffer.data()) protocol::ParametersReport;
      return buffer.first(link_.stored.read(*report));
    }
    case ReportId::driver: return put(link_.driver.report(link_.poses.newest_periods()));
    case ReportId::request_results:
      return put(link_.request_results.report(link_.status.state(), link_.poses.newest_periods()));
    case ReportId::black_box: return put(link_.black_box.report());
    case ReportId::black_box_rows: return put(link_.black_box.rows());
    case ReportId::command:
    case ReportId::force:
    case ReportId::local_model:
    case ReportId::shapes: break;  // not readable
  }
  return {};
}

Answer Device::get_controller_report(const SetupPacket& setup) {
  if (setup.value != controller_value) return Answer::stall();
  const auto report = controller_report(newest_pose());
  std::memcpy(control_.buffer().data(), &report, sizeof report);
  return Answer::send(control_.buffer().first(sizeof report));
}

// GET_REPORT of an input report is mandatory (HID 1.11, section 7.2.1), so the device must answer before the first
// control period.
protocol::PoseReport Device::newest_pose() {
  protocol::PoseReport pose{};
  if (!link_.poses.read(pose)) pose.state = link_.status.state();
  pose.sequence = pose_sequence_;
  pose.driver_parity = driver_parity();
  return pose;
}

bool Device::data_received(const SetupPacket& setup, std::span<const std::byte> data) {
  if (data[0] != static_cast<std::byte>(setup.value_low())) return false;  // the data repeats the report id
  switch (static_cast<ReportId>(setup.value_low())) {
    case ReportId::command: {
      const auto command = read_command(data);
      if (command && !pass_on(command)) link_.request_results.note_dropped(*command, protocol::RequestResult::busy);
      break;
    }
    case ReportId::force: take_force(data); break;
    case ReportId::local_model: take_local_model(data); break;
    case ReportId::shapes: take_shapes(data); break;
    case ReportId::driver:
      if (link_.driver.accept(data, link_.poses.newest_periods())) driver_gone();
      break;
    case ReportId::black_box_rows: link_.black_box.select_rows(data); break;
    default:  // parameters
      if (check_claim(link::header_of(data).claim))
        link_.parameters.accept(data, force_is_on(), link_.stored.restorable());
      else
        link_.parameters.refuse(data);
      break;
  }
  return true;
}

bool Device::force_is_on() const {
  // The queue must be checked first, because the interrupt may execute a queued command between the checks.
  return link_.commands.waiting(protocol::Command::enable_force) || protocol::force_is_on(link_.status.state());
}

bool Device::may_store() const {
  using protocol::Command;
  for (const Command before : {Command::enable_force, Command::self_test, Command::test_current, Command::test_voltage})
    if (link_.commands.waiting(before)) return false;
  return protocol::may_store(link_.status.state());
}

// Detach request (DFU 1.1, section 5.1 and appendix A.2). The DFU state changes from idle to detaching after the status
// stage. A detach request is refused while the force is on, because a detach removes the force. After a refusal,
// GETSTATUS reports errVENDOR (section 6.1.2) until a request is accepted.
Answer Device::firmware_update_request(const SetupPacket& setup) {
  constexpr std::byte application_idle{0}, application_detach{1};
  constexpr std::byte no_error{0}, vendor_error{0x0B};
  const std::byte state = detach_requested_ ? application_detach : application_idle;
  if (setup.request_type == class_interface_out && setup.request == detach_request && setup.length == 0) {
    detach_was_refused_ = !detach_requested_ && force_is_on();
    if (!detach_was_refused_) {
      detach_requested_ = true;
      link_.update_requested.store(true);
    }
    return Answer::done();
  }
  if (setup.request_type != class_interface_in) return Answer::stall();
  const auto buffer = control_.buffer();
  if (setup.request == get_state_request) {
    buffer[0] = state;
    return Answer::send(buffer.first(1));
  }
  if (setup.request == get_update_status_request) {
    const auto status = buffer.first<6>();  // status, poll timeout of 0, state, no text
    std::ranges::fill(status, std::byte{0});
    status[0] = detach_was_refused_ ? vendor_error : no_error;
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
  report.image_check = identity_.image_check;
  for (std::size_t i = 0; i < 3; ++i) report.motor_heat[i] = link_.status.motor_heat(i);
  return report;
}

protocol::FrameReport Device::frame_report() {
  protocol::FrameReport report{};
  const std::optional<BusFrame> bus_frame = port_.bus_frame();
  const auto time = bus_frame ? link_.poses.time_of(bus_frame->begin_cycles) : std::nullopt;
  if (!time) return report;
  report.is_known = 1;
  report.frame_number = bus_frame->number;
  report.sequence = bus_frame->count;
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
