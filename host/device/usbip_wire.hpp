// The messages of USB/IP as they lie on the wire, all numbers big-endian (kernel documentation, usbip_protocol).
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace inkwell::device::usbip {

/// A number stored big-endian.
template <std::unsigned_integral Number>
class BigEndian {
 public:
  BigEndian(Number value = 0) {
    for (std::size_t i = 0; i < sizeof(Number); ++i)
      bytes_[i] = static_cast<std::uint8_t>(value >> (8 * (sizeof(Number) - 1 - i)));
  }
  operator Number() const {
    Number value = 0;
    for (auto byte : bytes_) value = static_cast<Number>(value << 8 | byte);
    return value;
  }

 private:
  std::uint8_t bytes_[sizeof(Number)];
};
using Big16 = BigEndian<std::uint16_t>;
using Big32 = BigEndian<std::uint32_t>;

inline constexpr std::uint16_t protocol_version = 0x0111;
enum Operation : std::uint16_t {
  request_device_list = 0x8005,
  reply_device_list = 0x0005,
  request_import = 0x8003,
  reply_import = 0x0003,
};
enum Command : std::uint32_t { submit = 1, unlink = 2, return_submit = 3, return_unlink = 4 };
enum Direction : std::uint32_t { out = 0, in = 1 };

#pragma pack(push, 1)
struct OperationHeader {
  Big16 version = protocol_version;
  Big16 operation;
  Big32 status;
};

struct DeviceDescription {
  char path[256];
  char bus_id[32];
  Big32 bus_number;
  Big32 device_number;
  Big32 speed;
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

struct Header {
  Big32 command;
  Big32 sequence;
  Big32 device;
  Big32 direction;
  Big32 endpoint;
};

struct Submit {
  Header header;
  Big32 transfer_flags;
  Big32 length;
  Big32 start_frame;
  Big32 packet_count;
  Big32 interval;
  std::uint8_t setup[8];
};

struct ReturnSubmit {
  Header header;
  Big32 status;  ///< negative errno of Linux, 0 for success
  Big32 actual_length;
  Big32 start_frame;
  Big32 packet_count;
  Big32 error_count;
  std::uint8_t padding[8];
};

struct Unlink {
  Header header;
  Big32 unlinked_sequence;
  std::uint8_t padding[24];
};
#pragma pack(pop)

static_assert(sizeof(OperationHeader) == 8);
static_assert(sizeof(DeviceDescription) == 312);
static_assert(sizeof(Submit) == 48 && sizeof(ReturnSubmit) == 48 && sizeof(Unlink) == 48);
static_assert(std::is_trivially_copyable_v<Submit> && std::is_trivially_copyable_v<DeviceDescription>);

}  // namespace inkwell::device::usbip
