#include "firmware/usb/control_endpoint.hpp"

#include <algorithm>
#include <cstring>

namespace inkwell::usb {

namespace {

constexpr std::uint8_t control_out = 0x00;
constexpr std::uint8_t control_in = 0x80;

}  // namespace

void ControlEndpoint::setup(std::span<const std::byte> packet) {
  // A SETUP packet ends the transfer in progress (USB 2.0, section 5.5.5).
  if (stage_ == Stage::data_in || stage_ == Stage::status_in) port_.cancel(control_in);
  stage_ = Stage::idle;
  if (packet.size() != sizeof setup_) return;
  std::memcpy(&setup_, packet.data(), sizeof setup_);

  const Answer answer = requests_.request(setup_);
  switch (answer.kind) {
    case Answer::Kind::stall: stall(); break;
    case Answer::Kind::done: send_status(); break;
    case Answer::Kind::send:
      // If there is no data stage, the status stage is IN, independent of the direction bit.
      if (setup_.length == 0)
        send_status();
      else
        begin_data_in(answer);
      break;
    case Answer::Kind::receive:
      if (setup_.device_to_host() || setup_.length == 0 || setup_.length > receive_maximum) {
        stall();
      } else {
        stage_ = Stage::data_out;
        collected_ = 0;
        port_.receive(control_out);
      }
      break;
  }
}

void ControlEndpoint::received(std::span<const std::byte> packet) {
  switch (stage_) {
    case Stage::data_out: collect(packet); break;
    case Stage::data_in:  // the host starts the status stage early
      port_.cancel(control_in);
      stage_ = Stage::idle;
      break;
    case Stage::status_out: stage_ = Stage::idle; break;
    case Stage::idle:
    case Stage::status_in: break;
  }
}

void ControlEndpoint::sent() {
  if (stage_ == Stage::status_in) {
    stage_ = Stage::idle;
  } else if (stage_ == Stage::data_in) {
    if (!remaining_.empty() || zeros_ != 0 || end_with_empty_packet_)
      send_next_packet();
    else
      stage_ = Stage::status_out;
  }
}

void ControlEndpoint::begin_data_in(const Answer& answer) {
  const std::size_t size = std::min<std::size_t>(std::max(answer.data.size(), answer.padded_size), setup_.length);
  // A short packet ends a transfer that is shorter than wLength. The short packet is empty if the length is a multiple
  // of 64 (USB 2.0, section 8.5.3.2).
  end_with_empty_packet_ = size < setup_.length && size % packet_size_maximum == 0;
  remaining_ = answer.data.first(std::min(answer.data.size(), size));
  zeros_ = size - remaining_.size();
  stage_ = Stage::data_in;
  port_.receive(control_out);
  send_next_packet();
}

void ControlEndpoint::send_next_packet() {
  std::span<const std::byte> packet = remaining_.first(std::min(remaining_.size(), packet_size_maximum));
  remaining_ = remaining_.subspan(packet.size());
  if (zeros_ != 0 && packet.size() < packet_size_maximum) {
    const std::size_t added = std::min(zeros_, packet_size_maximum - packet.size());
    zeros_ -= added;
    padded_packet_ = {};
    std::ranges::copy(packet, padded_packet_.begin());
    packet = std::span(padded_packet_).first(packet.size() + added);
  }
  if (packet.empty()) end_with_empty_packet_ = false;
  port_.send(control_in, packet);
}

void ControlEndpoint::collect(std::span<const std::byte> packet) {
  const std::size_t wanted = setup_.length - collected_;
  if (packet.size() > wanted) return stall();
  const auto destination = std::span(buffer_).subspan(std::min(collected_, buffer_size));
  std::ranges::copy(packet.first(std::min(packet.size(), destination.size())), destination.begin());
  collected_ += packet.size();
  if (collected_ == setup_.length) {
    if (requests_.data_received(setup_, std::span(buffer_).first(std::min(collected_, buffer_size))))
      send_status();
    else
      stall();
  } else if (packet.size() < packet_size_maximum) {
    stall();  // shorter than wLength
  } else {
    port_.receive(control_out);
  }
}

void ControlEndpoint::send_status() {
  stage_ = Stage::status_in;
  port_.send(control_in, {});
}

void ControlEndpoint::stall() {
  stage_ = Stage::idle;
  port_.stall(control_in);
}

}  // namespace inkwell::usb
