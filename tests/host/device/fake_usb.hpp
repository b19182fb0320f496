// Devices on this computer's USB, for tests. The functions of hidapi and libusb that the device library calls are
// defined beside this, and the linker takes them before those of the libraries: no test touches a real USB.
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

#include <device/transport.hpp>

struct libusb_transfer;

namespace inkwell::tests {

using Bytes = std::vector<std::byte>;

/// A device as both libraries see it. What the test sets and looks at while transfers run is guarded by FakeUsb.
struct FakeUsbDevice {
  std::uint16_t vendor_id = 0x1209;
  std::uint16_t product_id = 0x0001;
  std::wstring product = L"Inkwell haptic arm";
  std::string serial_number;
  Bytes configuration;      ///< descriptor
  int open_result = 0;      ///< of libusb_open
  int claim_result = 0;     ///< of libusb_claim_interface
  bool denies_hid = false;  ///< hidapi lists the device but cannot open it
  bool bulk_fails = false;  ///< every transfer of the scope, and reading the configuration
  std::set<int> taken{};    ///< interfaces that another program has claimed
  std::set<int> claimed{};  ///< interfaces that this program has claimed
  bool unplugged = false;
  bool hides = false;                        ///< hidapi does not list it
  std::map<std::uint8_t, Bytes> features{};  ///< reports by their id; others are stalled
  std::deque<Bytes> reports{};               ///< input reports that wait to be read
  bool repeats_reports = false;              ///< the newest is there to be read again and again
  std::vector<Bytes> written{};              ///< output reports
  std::vector<libusb_transfer*> under_way{};
  std::deque<Bytes> ready{};  ///< what the bulk transfers will bring
  Bytes update_status{};      ///< answer to DFU_GETSTATUS; empty: stalled
  bool stalls_detach = false;
  bool leaves_at_detach = false;
  bool becomes_loader_at_detach = false;
  int detaches = 0;
  int handles = 0;       ///< of libusb
  int denied_opens = 0;  ///< of a boot loader, before libusb_open succeeds
  /// If set, this device carries out the requests for reports instead.
  std::shared_ptr<device::Transport> board{};

  std::string path() const { return "/fake/" + serial_number; }
  device::Endpoint endpoint() const {
    return {device::Endpoint::Kind::usb, serial_number, "Inkwell haptic arm", path(), "", 0};
  }
};

/// What a session asks an arm first.
void answer_as_inkwell(FakeUsbDevice& arm);

/// Name of the environment variable that chooses the operating system of a FakeUsb: "windows", or Linux without it.
inline constexpr char fake_usb_system[] = "INKWELL_FAKE_USB_SYSTEM";

/// The one USB of a test; empty again after it. As Windows it pads reports that a program sends to their declared
/// length, requires a buffer for the largest feature report, admits one handle of libusb, and leaves errno at 0.
class FakeUsb {
 public:
  FakeUsb();
  ~FakeUsb();

  /// An arm whose scope has this interface and endpoint, and whose HID interface has the other number.
  FakeUsbDevice& add_arm(std::string serial_number, std::uint8_t scope_interface = 1,
                         std::uint8_t scope_endpoint = 0x82);

  /// The endpoints of the transfers that are under way.
  std::vector<std::uint8_t> endpoints_under_way(const FakeUsbDevice& device);
  void send_bulk(FakeUsbDevice& device, Bytes data);
  void send_report(FakeUsbDevice& device, Bytes report);
  void unplug(FakeUsbDevice& device);
  /// From now on or no more.
  void set_bulk_fails(FakeUsbDevice& device, bool fails);
  /// Bulk data that no transfer has taken yet.
  std::size_t bulk_left(const FakeUsbDevice& device);

  std::mutex mutex;
  bool is_windows = false;
  std::deque<FakeUsbDevice> devices;
  /// Contexts, handles, claims, transfers and HID devices that were not given back.
  int open_things = 0;
};

}  // namespace inkwell::tests
