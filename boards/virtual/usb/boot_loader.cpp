// Endpoint 0 of the boot loader: descriptors (AN2606, STM32F405), standard requests and transfer stages.
#include "boards/virtual/usb/boot_loader.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <string_view>
#include <utility>

namespace inkwell::virtual_board {
namespace {

constexpr std::size_t packet_bytes = 64;
constexpr std::uint8_t configuration_value = 1;
namespace standard_request {
constexpr std::uint8_t get_status = 0, set_address = 5, get_descriptor = 6, get_configuration = 8,
                       set_configuration = 9, get_interface = 10, set_interface = 11;
}
constexpr std::uint8_t class_out = 0x21, class_in = 0xA1;

/// Memory areas, one string per alternate setting (UM0424, "DfuSe memory layout").
constexpr std::string_view alternates[] = {
    "@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg",
    "@Option Bytes  /0x1FFFC000/01*016 e",
    "@OTP Memory /0x1FFF7800/01*512 e,01*016 e",
    "@Device Feature/0xFFFF0000/01*004 e",
};
enum Text : std::uint8_t { language, manufacturer, product, serial_number, first_alternate };

constexpr std::uint8_t device_descriptor[] = {18,           1,       0x00,          0x01, 0,    0,    0,
                                              packet_bytes, 0x83,    0x04,          0x11, 0xDF, 0x00, 0x22,
                                              manufacturer, product, serial_number, 1};

std::vector<std::byte> bytes_of(std::span<const std::uint8_t> numbers) {
  const auto bytes = std::as_bytes(numbers);
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> configuration_descriptor() {
  constexpr std::uint8_t application_class = 0xFE, firmware_update = 1, dfu_mode = 2;
  constexpr auto total = static_cast<std::uint8_t>(9 + 9 * std::size(alternates) + 9);
  std::vector<std::uint8_t> bytes{9, 2, total, 0, 1, configuration_value, 0, 0xC0, 50};
  for (std::uint8_t i = 0; i < std::size(alternates); ++i)
    for (const std::uint8_t byte :
         {std::uint8_t{9}, std::uint8_t{4}, std::uint8_t{0}, i, std::uint8_t{0}, application_class, firmware_update,
          dfu_mode, static_cast<std::uint8_t>(first_alternate + i)})
      bytes.push_back(byte);
  // The DFU attributes are bitCanDnload, bitCanUpload and bitWillDetach.
  for (const unsigned byte : {9u, 0x21u, 0x0Bu, 255u, 0u, BootLoaderDfu::transfer_bytes & 0xFFu,
                              unsigned{BootLoaderDfu::transfer_bytes} >> 8, 0x1Au, 0x01u})
    bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes_of(bytes);
}

std::vector<std::byte> string_descriptor(std::string_view text) {
  std::vector<std::byte> bytes{std::byte(2 + 2 * text.size()), std::byte{3}};
  for (const char each : text) {
    bytes.push_back(std::byte(each));
    bytes.push_back(std::byte{0});
  }
  return bytes;
}

/// Derives the serial number from the chip's unique identifier, with the algorithm of ST's device library.
std::string serial_of(DebugPort& memory) {
  std::array<std::uint32_t, 3> id{};
  std::array<std::uint8_t, sizeof id> bytes{};
  memory.read(0x1FFF'7A10, bytes);
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<std::uint8_t*>(id.data()));
  char text[16];
  std::snprintf(text, sizeof text, "%08X%04X", id[0] + id[2], id[1] >> 16);
  return text;
}

}  // namespace

LoaderOrder BootLoader::next_order(DebugPort& memory) {
  if (!is_running_) {
    is_running_ = true;
    ++attachments_;
    serial_number_ = serial_of(memory);
    dfu_.start();
    begin_reset();
  }
  // The host must receive the complete answer before the loader starts the program.
  if (is_answering_ && dfu_.is_about_to_leave()) return {};
  const LoaderOrder order = dfu_.next_order(memory);
  if (dfu_.has_left()) stop();
  return order;
}

void BootLoader::begin_reset() {
  is_silent_ = true;
  address_ = 0;
  next_address_.reset();
  configuration_ = alternate_ = 0;
  to_send_.reset();
  is_answering_ = false;
}

bool BootLoader::is_addressed(unsigned address, unsigned endpoint) const {
  return is_running_ && !is_silent_ && address == address_ && endpoint == 0;
}

Handshake BootLoader::setup(unsigned address, unsigned endpoint, std::span<const std::byte, 8> bytes) {
  if (!is_addressed(address, endpoint)) return Handshake::nothing;
  const auto byte = [&](std::size_t i) { return std::to_integer<std::uint8_t>(bytes[i]); };
  const auto word = [&](std::size_t i) { return static_cast<std::uint16_t>(byte(i) | byte(i + 1) << 8); };
  request_ = {byte(0), byte(1), word(2), word(4), word(6)};
  data_.clear();
  to_send_.reset();
  sent_ = on_wire_ = 0;
  data1_ = true;
  is_refused_ = is_taken_ = false;
  is_answering_ = (request_.type & 0x80) != 0;
  return Handshake::ack;
}

/// Returns true if the request must wait. Only class requests wait until the running operation has finished.
bool BootLoader::has_to_wait() const { return (request_.type & 0x60) != 0 && dfu_.is_busy(); }

Handshake BootLoader::out(unsigned address, unsigned endpoint, bool data1, std::span<const std::byte> data) {
  if (!is_addressed(address, endpoint)) return Handshake::nothing;
  if (is_refused_) return Handshake::stall;
  if ((request_.type & 0x80) != 0) {  // status stage of a request for data
    is_answering_ = false;
    return Handshake::ack;
  }
  if (has_to_wait()) return Handshake::nak;
  if (data1 != data1_) return Handshake::ack;  // repeated packet
  data1_ = !data1_;
  if (data_.size() + data.size() > std::min<std::size_t>(request_.length, BootLoaderDfu::transfer_bytes)) {
    is_refused_ = true;
    return Handshake::stall;
  }
  data_.insert(data_.end(), data.begin(), data.end());
  return Handshake::ack;
}

InReply BootLoader::in(unsigned address, unsigned endpoint, std::span<std::byte, full_speed_packet_maximum> packet) {
  if (!is_addressed(address, endpoint)) return {};
  if (is_refused_) return {.handshake = Handshake::stall};
  if (has_to_wait()) return {.handshake = Handshake::nak};
  if ((request_.type & 0x80) == 0) {  // status stage of a request without data or with OUT data
    if (!std::exchange(is_taken_, true) && !take()) {
      is_refused_ = true;
      return {.handshake = Handshake::stall};
    }
    on_wire_ = 0;
    return {.handshake = Handshake::ack, .data1 = true};
  }
  if (!to_send_) {
    to_send_ = answer();
    if (has_to_wait() && to_send_ && to_send_->empty()) {  // the answer must be read from memory first
      to_send_.reset();
      return {.handshake = Handshake::nak};
    }
    if (!to_send_) {
      is_refused_ = true;
      return {.handshake = Handshake::stall};
    }
    if (to_send_->size() > request_.length) to_send_->resize(request_.length);
  }
  on_wire_ = std::min(packet_bytes, to_send_->size() - sent_);
  std::copy_n(to_send_->begin() + static_cast<std::ptrdiff_t>(sent_), on_wire_, packet.begin());
  return {.handshake = Handshake::ack, .data1 = data1_, .length = on_wire_};
}

bool BootLoader::finish_in(unsigned endpoint) {
  if (!is_running_ || is_silent_ || endpoint != 0) return false;
  sent_ += on_wire_;
  data1_ = !data1_;
  if (next_address_) address_ = *std::exchange(next_address_, std::nullopt);
  return true;
}

std::optional<std::vector<std::byte>> BootLoader::descriptor() const {
  const unsigned index = request_.value & 0xFFu;
  switch (request_.value >> 8) {
    case 1: return bytes_of(device_descriptor);
    case 2: return index == 0 ? std::optional(configuration_descriptor()) : std::nullopt;
    case 3: break;
    default: return {};
  }
  if (index == language) return bytes_of(std::array<std::uint8_t, 4>{4, 3, 0x09, 0x04});
  if (index == manufacturer) return string_descriptor("STMicroelectronics");
  if (index == product) return string_descriptor("STM32  BOOTLOADER");
  if (index == serial_number) return string_descriptor(serial_number_);
  if (index - first_alternate < std::size(alternates)) return string_descriptor(alternates[index - first_alternate]);
  return {};
}

std::optional<std::vector<std::byte>> BootLoader::answer() {
  if (request_.type == class_in) return configuration_ != 0 ? dfu_.answer(request_) : std::nullopt;
  if ((request_.type & 0x60) != 0) return {};
  switch (request_.request) {
    case standard_request::get_descriptor: return descriptor();
    case standard_request::get_status: return std::vector<std::byte>(2);
    case standard_request::get_configuration: return std::vector{std::byte{configuration_}};
    case standard_request::get_interface: return std::vector{std::byte{alternate_}};
    default: return {};
  }
}

bool BootLoader::take() {
  if (request_.type == class_out) return configuration_ != 0 && dfu_.take(request_, data_);
  if ((request_.type & 0x60) != 0) return false;
  switch (request_.request) {
    case standard_request::set_address: next_address_ = request_.value; return true;
    case standard_request::set_configuration:
      if (request_.value > configuration_value) return false;
      configuration_ = static_cast<std::uint8_t>(request_.value);
      alternate_ = 0;
      return true;
    case standard_request::set_interface:
      if (request_.index != 0 || request_.value >= std::size(alternates)) return false;
      alternate_ = static_cast<std::uint8_t>(request_.value);
      return true;
    default: return false;
  }
}

}  // namespace inkwell::virtual_board
