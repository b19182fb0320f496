#include "boards/virtual/usb/root_port.hpp"

#include <algorithm>

namespace inkwell::virtual_board {

namespace {
// Times of the host port, in frames of 1 ms (USB 2.0, sections 7.1.7 and 9.2.6).
constexpr unsigned debounce_frames = 100;
constexpr unsigned reset_frames = 20;
constexpr unsigned reset_recovery_frames = 10;
constexpr unsigned before_second_reset_frames = 1;  ///< time for the device to process the end of its first transfer
constexpr unsigned address_recovery_frames = 2;
constexpr unsigned answer_frames = 500;

constexpr unsigned device_address = 2;
constexpr std::uint16_t configuration_header = 9;

namespace request {
constexpr std::uint8_t clear_feature = 1, set_address = 5, get_descriptor = 6, set_configuration = 9,
                       set_interface = 11;
constexpr std::uint8_t to_device = 0x00, to_interface = 0x01, to_endpoint = 0x02, from_device = 0x80;
}  // namespace request
namespace descriptor {
constexpr std::uint8_t device = 1, configuration = 2;
}

std::uint8_t setup_byte(const Urb& urb, std::size_t index) { return std::to_integer<std::uint8_t>(urb.setup[index]); }
}  // namespace

RootPort::RootPort(Scheduler& scheduler, BusDevice& device, Client& client, double host_clock_ppm)
    : device_(device), client_(client), controller_(scheduler, device, *this, host_clock_ppm) {}

void RootPort::plug(bool in) {
  if (in == plugged_) return;
  plugged_ = in;
  if (!in) detach();
  device_.set_bus_power(in);
}

void RootPort::import() {
  if (state_ != State::suspended) return;
  controller_.run_frames(true);
  begin_reset(State::import_reset);
}

void RootPort::release() {
  held_.clear();
  if (!imported()) return;
  controller_.cancel_all();
  controller_.configure(nullptr);
  configuration_ = nullptr;
  if (bus_in_reset_) end_reset(State::suspended);
  controller_.run_frames(false);
  enter(State::suspended, 0);
}

void RootPort::submit(Urb&& urb) {
  if (state_ != State::in_use) {
    if (imported()) held_.push_back(std::move(urb));
    return;
  }
  const bool sets_address =
      urb.endpoint == 0 && setup_byte(urb, 0) == request::to_device && setup_byte(urb, 1) == request::set_address;
  if (sets_address)
    client_.completed(std::move(urb), transfer_status::success);  // this port has already set the address
  else
    controller_.submit(std::move(urb));
}

std::optional<Urb> RootPort::unlink(std::uint32_t sequence) {
  const auto held = std::find_if(held_.begin(), held_.end(), [&](const Urb& urb) { return urb.sequence == sequence; });
  if (held == held_.end()) return controller_.unlink(sequence);
  std::optional<Urb> taken_back = std::move(*held);
  held_.erase(held);
  return taken_back;
}

void RootPort::between_transactions() {
  // A hub detects an interruption of the pull-up that is shorter than a frame.
  const std::uint32_t attachment = plugged_ ? device_.attachment() : 0;
  if (attachment != attachment_) {
    detach();
    attachment_ = attachment;
    if (attachment != 0) enter(State::debouncing, debounce_frames);
  }
  client_.between_transactions();
}

void RootPort::frame() {
  if (frames_left_ != 0 && --frames_left_ == 0) time_over();
}

void RootPort::detach() {
  const bool was_known = enumerated();
  attachment_ = 0;
  bus_in_reset_ = false;
  held_.clear();
  controller_.cancel_all();
  controller_.configure(nullptr);
  controller_.run_frames(false);
  configuration_ = nullptr;
  enter(State::detached, 0);
  if (was_known) client_.detached();
}

void RootPort::enter(State state, unsigned frames) {
  state_ = state;
  frames_left_ = frames;
}

// The bus has no frames during a reset.
void RootPort::begin_reset(State state) {
  controller_.cancel_all();
  controller_.configure(nullptr);
  configuration_ = nullptr;
  controller_.run_frames(false);
  controller_.address_device(0, control_packet_maximum_);
  bus_in_reset_ = true;
  device_.begin_reset();
  enter(state, reset_frames);
}

void RootPort::end_reset(State recovery) {
  bus_in_reset_ = false;
  device_.end_reset();
  controller_.run_frames(true);
  enter(recovery, reset_recovery_frames);
}

void RootPort::start_control_transfer(std::uint8_t request_type, std::uint8_t request, std::uint16_t value,
                                      std::uint16_t length) {
  Urb urb;
  urb.internal = true;
  urb.in = (request_type & 0x80) != 0;
  urb.length = length;
  const auto low = [](std::uint16_t word) { return std::byte(word & 0xFF); };
  const auto high = [](std::uint16_t word) { return std::byte(word >> 8); };
  urb.setup = {std::byte(request_type), std::byte(request), low(value), high(value), {}, {}, low(length), high(length)};
  controller_.submit(std::move(urb));
  frames_left_ = answer_frames;
}

void RootPort::request_descriptor(std::uint8_t type, std::uint8_t index, std::uint16_t length) {
  start_control_transfer(request::from_device, request::get_descriptor, static_cast<std::uint16_t>(type << 8 | index),
                         length);
}

void RootPort::time_over() {
  switch (state_) {
    case State::debouncing:
      control_packet_maximum_ = 64;
      begin_reset(State::first_reset);
      break;
    case State::first_reset: end_reset(State::first_recovery); break;
    case State::first_recovery:
      enter(State::reading_packet_size, 0);
      request_descriptor(descriptor::device, 0, 64);
      break;
    case State::packet_size_known: begin_reset(State::second_reset); break;
    case State::second_reset: end_reset(State::second_recovery); break;
    case State::second_recovery:
    case State::import_recovery:
      enter(state_ == State::second_recovery ? State::addressing : State::import_addressing, 0);
      start_control_transfer(request::to_device, request::set_address, device_address, 0);
      break;
    case State::import_reset: end_reset(State::import_recovery); break;
    case State::address_recovery:
      description_ = {};
      enter(State::reading_device, 0);
      request_descriptor(descriptor::device, 0, 18);
      break;
    case State::import_address_recovery: {
      enter(State::in_use, 0);
      std::vector<Urb> held = std::move(held_);
      held_.clear();
      for (Urb& urb : held) submit(std::move(urb));
      break;
    }
    case State::import_addressing:  // the device no longer answers, and the importer must be notified
    default:
      if (enumerated()) client_.detached();
      held_.clear();
      control_packet_maximum_ = 64;
      begin_reset(State::first_reset);
      break;
  }
}

void RootPort::completed(Urb&& urb, std::int32_t status) {
  if (urb.internal) {
    if (status == transfer_status::success)
      answered(urb);
    else
      enter(state_, debounce_frames);  // then the enumeration restarts
    return;
  }
  if (status == transfer_status::success && urb.endpoint == 0) follow_standard_request(urb);
  client_.completed(std::move(urb), status);
}

void RootPort::answered(const Urb& urb) {
  const auto byte = [&](std::size_t index) {
    return index < urb.data.size() ? std::to_integer<unsigned>(urb.data[index]) : 0u;
  };
  const auto read_next_configuration = [&] {
    if (description_.configurations.size() == description_.configuration_count()) {
      controller_.run_frames(false);
      enter(State::suspended, 0);
      client_.enumerated(description_);
      return;
    }
    enter(State::reading_configuration_length, 0);
    request_descriptor(descriptor::configuration, static_cast<std::uint8_t>(description_.configurations.size()),
                       configuration_header);
  };
  switch (state_) {
    case State::reading_packet_size:
      if (urb.data.size() < 8) {
        enter(state_, debounce_frames);
        break;
      }
      control_packet_maximum_ = static_cast<std::uint16_t>(byte(7));
      enter(State::packet_size_known, before_second_reset_frames);
      break;
    case State::addressing:
    case State::import_addressing:
      controller_.address_device(device_address, control_packet_maximum_);
      enter(state_ == State::addressing ? State::address_recovery : State::import_address_recovery,
            address_recovery_frames);
      break;
    case State::reading_device:
      if (urb.data.size() != description_.device.size()) {
        enter(state_, debounce_frames);
        break;
      }
      std::copy(urb.data.begin(), urb.data.end(), description_.device.begin());
      read_next_configuration();
      break;
    case State::reading_configuration_length:
      enter(State::reading_configuration, 0);
      request_descriptor(descriptor::configuration, static_cast<std::uint8_t>(description_.configurations.size()),
                         static_cast<std::uint16_t>(std::max(byte(2) | byte(3) << 8, unsigned{configuration_header})));
      break;
    case State::reading_configuration:
      description_.configurations.push_back(parse_configuration(urb.data));
      read_next_configuration();
      break;
    default: break;
  }
}

// Applies a standard request to the endpoints and data toggles of the host controller.
void RootPort::follow_standard_request(const Urb& urb) {
  const std::uint8_t type = setup_byte(urb, 0);
  const std::uint8_t value = setup_byte(urb, 2);
  const std::uint8_t index = setup_byte(urb, 4);
  if (type == request::to_device && setup_byte(urb, 1) == request::set_configuration) {
    const auto found = std::find_if(description_.configurations.begin(), description_.configurations.end(),
                                    [&](const ConfigurationDescription& one) { return one.value == value; });
    configuration_ = value == 0 || found == description_.configurations.end() ? nullptr : &*found;
    controller_.configure(configuration_);
  } else if (type == request::to_interface && setup_byte(urb, 1) == request::set_interface && configuration_) {
    controller_.select_alternate(*configuration_, index, value);
  } else if (type == request::to_endpoint && setup_byte(urb, 1) == request::clear_feature && value == 0) {
    controller_.reset_toggle(index);
  }
}

}  // namespace inkwell::virtual_board
