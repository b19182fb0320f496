// The messages of USB/IP 1.1.1 (Linux kernel, Documentation/usb/usbip_protocol.rst). Each struct has the memory layout
// of its message. A filled-in struct is an encoded message, and `read` decodes a message.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace inkwell::usbip {

/// A number or an enumeration, stored as big-endian bytes without alignment.
template <class Value>
class BigEndian {
  using Bits = std::conditional_t<sizeof(Value) == 2, std::uint16_t, std::uint32_t>;
  static_assert(sizeof(Value) == sizeof(Bits));

 public:
  constexpr BigEndian() = default;
  constexpr BigEndian(Value value) {
    const auto bits = static_cast<Bits>(value);
    for (std::size_t i = 0; i < sizeof(Bits); ++i)
      bytes_[i] = static_cast<std::uint8_t>(bits >> (8 * (sizeof(Bits) - 1 - i)));
  }
  constexpr operator Value() const {
    Bits bits = 0;
    for (const std::uint8_t byte : bytes_) bits = static_cast<Bits>(bits << 8 | byte);
    return static_cast<Value>(bits);
  }

 private:
  std::array<std::uint8_t, sizeof(Bits)> bytes_{};
};
using Big16 = BigEndian<std::uint16_t>;
using Big32 = BigEndian<std::uint32_t>;

/// Zero-terminated text in a field of `size` bytes.
template <std::size_t size>
class Text {
 public:
  constexpr Text() = default;
  /// Truncates a longer text.
  constexpr Text(std::string_view text) {
    std::copy_n(text.begin(), std::min(text.size(), size - 1), characters_.begin());
  }
  /// Returns the text up to the first zero, or the whole field if the field has no zero.
  constexpr std::string_view view() const {
    const auto end = std::find(characters_.begin(), characters_.end(), '\0');
    return {characters_.data(), static_cast<std::size_t>(end - characters_.begin())};
  }

 private:
  std::array<char, size> characters_{};
};

// --- Device lists and imports --------------------------------------------------------------------------------

inline constexpr std::uint16_t protocol_version = 0x0111;

enum class Operation : std::uint16_t {
  request_device_list = 0x8005,
  reply_device_list = 0x0005,
  request_import = 0x8003,
  reply_import = 0x0003,
};

/// Status of a reply; 0 in requests. The Linux usbip tools define the values (ST_OK, ST_DEV_BUSY, ST_NODEV).
enum class OperationStatus : std::uint32_t { success = 0, busy = 2, no_device = 4 };

struct OperationHeader {
  Big16 version = protocol_version;
  BigEndian<Operation> operation;
  BigEndian<OperationStatus> status = OperationStatus::success;
};

using BusId = Text<32>;

struct ImportRequest {
  OperationHeader header{.operation = Operation::request_import};
  BusId bus_id;
};

/// Values of the Linux enum usb_device_speed.
enum class Speed : std::uint32_t { full = 2 };

/// This struct follows the OperationHeader in the reply to a successful import.
struct Device {
  Text<256> path;  ///< on the server
  BusId bus_id;
  Big32 bus_number;
  Big32 device_number;
  BigEndian<Speed> speed;
  Big16 vendor_id;
  Big16 product_id;
  Big16 device_release;
  std::uint8_t device_class;
  std::uint8_t device_subclass;
  std::uint8_t device_protocol;
  std::uint8_t configuration;
  std::uint8_t configuration_count;
  std::uint8_t interface_count;
};

struct Interface {
  std::uint8_t interface_class;
  std::uint8_t interface_subclass;
  std::uint8_t interface_protocol;
  std::uint8_t padding = 0;
};

/// `device_count` devices follow. Each Device is followed by its `interface_count` interfaces.
struct DeviceListReply {
  OperationHeader header{.operation = Operation::reply_device_list};
  Big32 device_count;
};

// --- Transfers of the imported device ------------------------------------------------------------------------

enum class Command : std::uint32_t { submit = 1, unlink = 2, return_submit = 3, return_unlink = 4 };
enum class Direction : std::uint32_t { out = 0, in = 1 };

/// The first bytes of every command and answer. In answers, all fields after `sequence` are 0.
struct TransferHeader {
  BigEndian<Command> command;
  Big32 sequence;  ///< chosen by the client; the answer repeats it
  Big32 device;    ///< device_of() the imported device
  BigEndian<Direction> direction;
  Big32 endpoint;  ///< number, 0 to 15, without the direction bit
};

/// Returns the device number for transfer headers.
constexpr std::uint32_t device_of(std::uint32_t bus_number, std::uint32_t device_number) {
  return bus_number << 16 | device_number;
}

/// `packet_count` of a transfer that is not isochronous. Linux itself sends 0.
inline constexpr std::uint32_t not_isochronous = 0xFFFF'FFFF;

/// If the direction is OUT, `length` bytes of data follow this struct. `packet_count` entries of IsochronousPacket
/// follow the data.
struct Submit {
  TransferHeader header{.command = Command::submit};
  Big32 transfer_flags;  ///< Linux URB_ flags
  Big32 length;          ///< bytes of data (OUT), or size of the buffer (IN)
  Big32 start_frame;
  Big32 packet_count;
  Big32 interval;
  std::array<std::byte, 8> setup{};  ///< setup packet of a control transfer, little-endian as on USB
};

/// If the direction of the transfer was IN, `actual_length` bytes of data follow this struct. The packets of an
/// isochronous transfer follow the data.
struct ReturnSubmit {
  TransferHeader header{.command = Command::return_submit};
  BigEndian<std::int32_t> status;  ///< 0, or a negative errno value of Linux
  Big32 actual_length;
  Big32 start_frame;
  Big32 packet_count;
  Big32 error_count;
  std::array<std::byte, 8> padding{};
};

struct IsochronousPacket {
  Big32 offset;  ///< offset in the data of the transfer, in bytes
  Big32 length;
  Big32 actual_length;
  BigEndian<std::int32_t> status;  ///< as in ReturnSubmit
};

struct Unlink {
  TransferHeader header{.command = Command::unlink};
  Big32 unlinked_sequence;  ///< sequence of the transfer to cancel
  std::array<std::byte, 24> padding{};
};

struct ReturnUnlink {
  TransferHeader header{.command = Command::return_unlink};
  BigEndian<std::int32_t> status;  ///< -ECONNRESET if the transfer was canceled, 0 if it had already been answered
  std::array<std::byte, 24> padding{};
};

// --- Bytes -----------------------------------------------------------------------------------------------

template <class Message>
inline constexpr bool has_wire_layout = std::is_trivially_copyable_v<Message> && alignof(Message) == 1;

static_assert(sizeof(OperationHeader) == 8 && has_wire_layout<OperationHeader>);
static_assert(sizeof(ImportRequest) == 40 && has_wire_layout<ImportRequest>);
static_assert(sizeof(DeviceListReply) == 12 && has_wire_layout<DeviceListReply>);
static_assert(sizeof(Device) == 312 && has_wire_layout<Device>);
static_assert(sizeof(Interface) == 4 && has_wire_layout<Interface>);
static_assert(sizeof(TransferHeader) == 20 && has_wire_layout<TransferHeader>);
static_assert(sizeof(Submit) == 48 && has_wire_layout<Submit>);
static_assert(sizeof(ReturnSubmit) == 48 && has_wire_layout<ReturnSubmit>);
static_assert(sizeof(IsochronousPacket) == 16 && has_wire_layout<IsochronousPacket>);
static_assert(sizeof(Unlink) == 48 && has_wire_layout<Unlink>);
static_assert(sizeof(ReturnUnlink) == 48 && has_wire_layout<ReturnUnlink>);

/// Returns the bytes of a message. The message must outlive the result.
template <class Message>
requires has_wire_layout<Message> std::span<const std::byte, sizeof(Message)> bytes_of(const Message& message) {
  return std::as_bytes(std::span<const Message, 1>(&message, 1));
}

/// Returns the message at the beginning of `bytes`, which must contain the complete message.
template <class Message>
requires has_wire_layout<Message> Message read(std::span<const std::byte> bytes) {
  Message message;
  std::memcpy(&message, bytes.data(), sizeof message);
  return message;
}

}  // namespace inkwell::usbip
