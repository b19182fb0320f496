// Fake USB devices for tests. This file's .cpp defines the functions of hidapi and libusb that the device library
// calls. The linker prefers these functions to the functions of the libraries, so no test accesses real USB devices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "host/client/device/transport.hpp"

struct libusb_transfer;

namespace inkwell::tests {

using Bytes = std::vector<std::byte>;

/// A fake device for hidapi and libusb. While transfers run, the test must access the members through FakeUsb.
struct FakeUsbDevice {
  std::uint16_t vendor_id = 0x1209;
  std::uint16_t product_id = 0x0001;
  std::wstring product = L"Inkwell haptic arm";
  std::string serial_number;
  Bytes configuration;      ///< descriptor
  int open_result = 0;      ///< result of libusb_open
  int claim_result = 0;     ///< result of libusb_claim_interface
  bool denies_hid = false;  ///< hidapi lists the device but cannot open it
  bool bulk_fails = false;  ///< every scope transfer fails, and reading the configuration fails
  std::set<int> taken{};    ///< interfaces that another program has claimed
  std::set<int> claimed{};  ///< interfaces that this program has claimed
  bool unplugged = false;
  bool hides = false;                        ///< hidapi does not list it
  std::map<std::uint8_t, Bytes> features{};  ///< reports by their id; others are stalled
  std::deque<Bytes> reports{};               ///< input reports that have not been read
  int interruptions = 0;                     ///< number of transfers that a signal interrupts
  bool repeats_reports = false;              ///< the newest input report can be read repeatedly
  std::vector<Bytes> written{};              ///< output reports
  std::vector<libusb_transfer*> under_way{};
  std::deque<Bytes> ready{};  ///< data of the next bulk transfers
  Bytes update_status{};      ///< answer to DFU_GETSTATUS; empty: stalled
  bool stalls_detach = false;
  bool leaves_at_detach = false;
  bool becomes_loader_at_detach = false;
  int detaches = 0;
  int handles = 0;       ///< open libusb handles
  int denied_opens = 0;  ///< number of denied opens of a boot loader before libusb_open succeeds
  /// If set, this board carries out the report requests.
  std::shared_ptr<device::Transport> board{};

  std::string path() const { return "/fake/" + serial_number; }
  device::Endpoint endpoint() const {
    return {device::Endpoint::Kind::usb, serial_number, "Inkwell haptic arm", path(), "", 0};
  }
};

/// Sets the answers that a session needs to open an arm.
void answer_as_inkwell(FakeUsbDevice& arm);

/// If this environment variable is "windows", FakeUsb behaves like Windows; by default it behaves like Linux.
inline constexpr char fake_usb_system[] = "INKWELL_FAKE_USB_SYSTEM";

/// The fake USB of one test. The devices exist until the end of the test. The Windows variant pads written reports to
/// their declared length and requires a buffer for the largest feature report. The Windows variant allows one libusb
/// handle at a time and does not set errno.
class FakeUsb {
 public:
  FakeUsb();
  ~FakeUsb();

  /// Adds an arm whose scope has this interface and endpoint. The HID interface has the remaining interface number, 0
  /// or 1.
  FakeUsbDevice& add_arm(std::string serial_number, std::uint8_t scope_interface = 1,
                         std::uint8_t scope_endpoint = 0x82);

  /// The endpoints of the pending transfers.
  std::vector<std::uint8_t> endpoints_under_way(const FakeUsbDevice& device);
  void send_bulk(FakeUsbDevice& device, Bytes data);
  void send_report(FakeUsbDevice& device, Bytes report);
  void unplug(FakeUsbDevice& device);
  /// If `fails` is true, all bulk transfers fail.
  void set_bulk_fails(FakeUsbDevice& device, bool fails);
  /// Amount of bulk data that no transfer has read yet.
  std::size_t bulk_left(const FakeUsbDevice& device);

  std::mutex mutex;
  bool is_windows = false;
  std::deque<FakeUsbDevice> devices;
  /// Number of contexts, handles, claims, transfers and HID devices that are not released.
  int open_things = 0;
};

}  // namespace inkwell::tests
