#include "host/client/device/transports.hpp"

#include <hidapi/hidapi.h>
#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "host/client/local/interruption.hpp"
#include "host/client/process/fork.hpp"
#include "protocol/plain_text.hpp"
#include "protocol/report_table.hpp"
#include "protocol/usb_identity.hpp"

#include "host/client/device/transfer_queue.hpp"
#include "host/client/device/usb_descriptors.hpp"
#include "host/client/device/usb_handle.hpp"
#include "host/client/device/usb_rules.hpp"

namespace inkwell::device {
namespace {

namespace identity = protocol::usb;

/// The game controller interface has another usage page.
constexpr unsigned short vendor_usage_page = 0xFF00;

constexpr std::size_t feature_report_maximum = protocol::longest_report(protocol::ReportKind::feature);

std::string narrow(const wchar_t* text) {
  std::string result;
  for (; text != nullptr && *text != 0; ++text) result += *text < 0x7F ? static_cast<char>(*text) : '?';
  return protocol::plain_text(result);
}

/// Reads the bulk interface through libusb. hidapi uses the HID interface through the kernel driver.
class BulkReader {
 public:
  BulkReader(const std::string& serial_number, TransferQueue& queue)
      : handle_(identity::vendor_id, identity::product_id, serial_number), queue_(queue) {
    try {
      open();
      start();
    } catch (...) {
      stop();
      throw;
    }
  }
  ~BulkReader() { stop(); }
  BulkReader(const BulkReader&) = delete;
  BulkReader& operator=(const BulkReader&) = delete;

 private:
  struct Slot {
    BulkReader* reader = nullptr;
    libusb_transfer* transfer = nullptr;
    std::array<unsigned char, protocol::scope_frame_maximum> buffer{};
  };

  void open() {
    std::array<unsigned char, 1024> descriptor{};
    const int length = libusb_get_descriptor(handle_.get(), LIBUSB_DT_CONFIG, 0, descriptor.data(),
                                             static_cast<int>(descriptor.size()));
    if (length < 0) throw Disconnected(unplugged);
    layout_ = parse_configuration(std::as_bytes(std::span(descriptor.data(), static_cast<std::size_t>(length))));
    handle_.claim(layout_.scope_interface, scope_in_use);
  }

  void start() {
    for (auto& slot : slots_) {
      slot.reader = this;
      slot.transfer = libusb_alloc_transfer(0);
      libusb_fill_bulk_transfer(slot.transfer, handle_.get(), layout_.scope_in_endpoint, slot.buffer.data(),
                                static_cast<int>(slot.buffer.size()), &BulkReader::on_transfer, &slot, 0);
      if (libusb_submit_transfer(slot.transfer) != 0) throw Disconnected(unplugged);
      ++under_way_;
    }
    thread_ = std::thread([this] { handle_events([this] { return !stopping_; }); });
  }

  template <class Wanted>
  void handle_events(Wanted wanted) {
    while (wanted()) {
      timeval wait{0, 50'000};
      libusb_handle_events_timeout(handle_.context(), &wait);
    }
  }

  void stop() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    for (auto& slot : slots_)
      if (slot.transfer != nullptr) libusb_cancel_transfer(slot.transfer);
    handle_events([this] { return under_way_ > 0; });
    for (auto& slot : slots_) libusb_free_transfer(slot.transfer);
  }

  static void LIBUSB_CALL on_transfer(libusb_transfer* transfer) {
    auto& slot = *static_cast<Slot*>(transfer->user_data);
    slot.reader->finish(*transfer);
  }

  void finish(libusb_transfer& transfer) {
    if (transfer.status == LIBUSB_TRANSFER_COMPLETED && transfer.actual_length > 0) {
      const auto* begin = reinterpret_cast<const std::byte*>(transfer.buffer);
      queue_.push({begin, begin + transfer.actual_length});
      if (queue_.size() > bulk_kept) queue_.drop_oldest();  // the frame sequence shows the loss
    }
    const bool goes_on = transfer.status == LIBUSB_TRANSFER_COMPLETED && !stopping_;
    if (goes_on && libusb_submit_transfer(&transfer) == 0) return;
    --under_way_;
    if (!stopping_) queue_.close(unplugged);
  }

  UsbHandle handle_;
  UsbLayout layout_;
  std::array<Slot, bulk_transfers> slots_{};
  std::atomic<int> under_way_ = 0;
  std::atomic<bool> stopping_ = false;
  TransferQueue& queue_;
  std::thread thread_;
};

/// All hidapi functions without a handle argument share one error text.
std::mutex hidapi_mutex;
const process::HeldAtFork hidapi_at_fork(hidapi_mutex);

using DeviceList = std::unique_ptr<hid_device_info, decltype(&hid_free_enumeration)>;

DeviceList list_devices() {
  const std::lock_guard lock(hidapi_mutex);
  return {hid_enumerate(identity::vendor_id, identity::product_id), &hid_free_enumeration};
}

bool is_listed(const std::string& path) {
  const auto list = list_devices();
  for (const hid_device_info* device = list.get(); device != nullptr; device = device->next)
    if (path == device->path) return true;
  return false;
}

/// hidapi stores one error text per handle, so each thread needs a separate handle.
class HidHandle {
 public:
  explicit HidHandle(const std::string& path) : device_(open(path), &hid_close) {}

  struct Result {
    int length;          ///< negative after a failure
    std::string detail;  ///< error text after a failure
  };
  template <class Call>
  Result call(Call call) {
    const std::lock_guard lock(mutex_);
    const int length = local::repeat_interrupted([&] { return call(device_.get()); });
    return {length, length < 0 ? narrow(hid_error(device_.get())) : std::string()};
  }

 private:
  static hid_device* open(const std::string& path) {
    std::string detail;
    {
      const std::lock_guard lock(hidapi_mutex);
      if (hid_device* device = hid_open_path(path.c_str())) return device;
      detail = narrow(hid_error(nullptr));
    }
    if (is_listed(path)) throw_hidapi_refusal(path, detail);
    throw Disconnected(with_detail(unplugged, detail));
  }

  std::mutex mutex_;
  std::unique_ptr<hid_device, decltype(&hid_close)> device_;
};

class UsbTransport : public Transport {
 public:
  explicit UsbTransport(const Endpoint& endpoint)
      : endpoint_(endpoint), inputs_(endpoint.path), outputs_(endpoint.path), features_(endpoint.path) {}

  std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds timeout) override {
    const auto result = inputs_.call([&](hid_device* device) {
      return local::repeat_interrupted(timeout, [&](std::chrono::milliseconds rest) {
        return hid_read_timeout(device, data(report), report.size(), static_cast<int>(rest.count()));
      });
    });
    if (result.length < 0) throw Disconnected(with_detail(unplugged, result.detail));  // only after a disconnection
    return static_cast<std::size_t>(result.length);
  }
  void write_report(std::span<const std::byte> report) override {
    check(outputs_.call([&](hid_device* device) { return hid_write(device, data(report), report.size()); }));
  }
  std::size_t get_feature(std::span<std::byte> report) override {
    std::array<std::byte, feature_report_maximum> buffer;
    const auto received = check(request_feature(std::to_integer<std::uint8_t>(report[0]), buffer));
    const std::size_t length = std::min(received, report.size());
    std::copy_n(buffer.begin(), length, report.begin());
    return length;
  }
  void set_feature(std::span<const std::byte> report) override {
    check(features_.call(
        [&](hid_device* device) { return hid_send_feature_report(device, data(report), report.size()); }));
  }
  void claim_scope() override {
    if (!scope_) scope_ = std::make_unique<BulkReader>(endpoint_.serial_number, bulk_);
  }
  void release_scope() override { scope_.reset(); }
  std::size_t read_bulk(std::span<std::byte> buffer, std::chrono::milliseconds timeout) override {
    const auto transfer = bulk_.pop(timeout);
    if (!transfer) return 0;
    const std::size_t length = std::min(transfer->size(), buffer.size());
    std::copy_n(transfer->begin(), length, buffer.begin());
    return length;
  }
  const Endpoint& endpoint() const override { return endpoint_; }

 private:
  static unsigned char* data(std::span<std::byte> bytes) { return reinterpret_cast<unsigned char*>(bytes.data()); }
  static const unsigned char* data(std::span<const std::byte> bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());
  }

  /// Windows requires a buffer with the size of the largest feature report.
  HidHandle::Result request_feature(std::uint8_t id, std::span<std::byte> buffer) {
    buffer[0] = std::byte{id};
    return features_.call(
        [&](hid_device* device) { return hid_get_feature_report(device, data(buffer), buffer.size()); });
  }

  std::size_t check(const HidHandle::Result& result) {
    if (result.length >= 0) return static_cast<std::size_t>(result.length);
    if (is_present())
      throw Stalled(with_detail("The device refused a USB request. Flash the firmware that belongs to this companion.",
                                result.detail));
    throw Disconnected(with_detail(unplugged, result.detail));
  }

  /// Distinguishes a refusal from a disconnection. A connected device still answers the information request, or it
  /// remains in the system's device list.
  bool is_present() {
    constexpr int attempts = 10;
    std::array<std::byte, feature_report_maximum> buffer;
    if (request_feature(static_cast<std::uint8_t>(protocol::ReportId::information), buffer).length >= 0) return true;
    for (int i = 0; i < attempts; ++i) {
      if (i > 0) std::this_thread::sleep_for(poll_interval);
      if (!is_listed(endpoint_.path)) return false;
    }
    return true;
  }

  static constexpr std::chrono::milliseconds poll_interval{20};

  Endpoint endpoint_;
  HidHandle inputs_, outputs_, features_;
  TransferQueue bulk_;
  std::unique_ptr<BulkReader> scope_;  ///< exists while the scope is claimed
};

}  // namespace

std::unique_ptr<Transport> open_usb_transport(const Endpoint& endpoint) {
  return std::make_unique<UsbTransport>(endpoint);
}

std::vector<Endpoint> find_usb_devices() {
  std::vector<Endpoint> endpoints;
  const auto list = list_devices();
  for (const hid_device_info* device = list.get(); device != nullptr; device = device->next) {
    // Other products use the same USB test identifiers.
    const std::string product = narrow(device->product_string);
    if (product != identity::product || device->usage_page != vendor_usage_page) continue;
    endpoints.push_back({Endpoint::Kind::usb, narrow(device->serial_number), product, device->path, "", 0});
  }
  return endpoints;
}

}  // namespace inkwell::device
