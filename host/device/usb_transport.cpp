#include "transports.hpp"

#include <hidapi/hidapi.h>
#include <libusb-1.0/libusb.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <thread>

#include <fmt/format.h>

#include <protocol/plain_text.hpp>
#include <protocol/usb_identity.hpp>

#include "transfer_queue.hpp"
#include "usb_descriptors.hpp"
#include "usb_handle.hpp"

namespace inkwell::device {
namespace {

namespace identity = protocol::usb;

/// Of the interface for poses and commands; that of the controller has another.
constexpr unsigned short vendor_usage_page = 0xFF00;

std::string narrow(const wchar_t* text) {
  std::string result;
  for (; text != nullptr && *text != 0; ++text) result += *text < 0x7F ? static_cast<char>(*text) : '?';
  return protocol::plain_text(result);
}

/// The bulk interface through libusb. The kernel keeps the HID interface, which hidapi uses.
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
      if (queue_.size() > bulk_kept) queue_.drop_oldest();  // the sequence of the frames shows it
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

class UsbTransport : public Transport {
 public:
  explicit UsbTransport(const Endpoint& endpoint) : endpoint_(endpoint), hid_(open_hid(endpoint.path), &hid_close) {}

  std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds timeout) override {
    return check(hid_read_timeout(hid_.get(), data(report), report.size(), static_cast<int>(timeout.count())));
  }
  void write_report(std::span<const std::byte> report) override {
    check(hid_write(hid_.get(), data(report), report.size()));
  }
  std::size_t get_feature(std::span<std::byte> report) override {
    return check(hid_get_feature_report(hid_.get(), data(report), report.size()));
  }
  void set_feature(std::span<const std::byte> report) override {
    check(hid_send_feature_report(hid_.get(), data(report), report.size()));
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
  static hid_device* open_hid(const std::string& path) {
    if (hid_device* device = hid_open_path(path.c_str())) return device;
    if (access(path.c_str(), R_OK | W_OK) != 0 && errno == EACCES) throw NoPermission(permission_message(path));
    throw Disconnected(unplugged);
  }
  static unsigned char* data(std::span<std::byte> bytes) { return reinterpret_cast<unsigned char*>(bytes.data()); }
  static const unsigned char* data(std::span<const std::byte> bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());
  }
  static std::size_t check(int length) {
    if (length < 0 && errno == EPIPE)
      throw Stalled("The device refused a USB request. Flash the firmware that belongs to this companion.");
    if (length < 0) throw Disconnected(unplugged);
    return static_cast<std::size_t>(length);
  }

  Endpoint endpoint_;
  std::unique_ptr<hid_device, decltype(&hid_close)> hid_;
  TransferQueue bulk_;
  std::unique_ptr<BulkReader> scope_;  ///< while it is claimed
};

}  // namespace

std::unique_ptr<Transport> open_usb_transport(const Endpoint& endpoint) {
  return std::make_unique<UsbTransport>(endpoint);
}

std::vector<Endpoint> find_usb_devices() {
  std::vector<Endpoint> endpoints;
  const std::unique_ptr<hid_device_info, decltype(&hid_free_enumeration)> list(
      hid_enumerate(identity::vendor_id, identity::product_id), &hid_free_enumeration);
  for (const hid_device_info* device = list.get(); device != nullptr; device = device->next) {
    // The identifiers are shared by private tests of other people, so the product's name decides.
    const std::string product = narrow(device->product_string);
    if (product != identity::product || device->usage_page != vendor_usage_page) continue;
    endpoints.push_back({Endpoint::Kind::usb, narrow(device->serial_number), product, device->path, "", 0});
  }
  return endpoints;
}

}  // namespace inkwell::device
