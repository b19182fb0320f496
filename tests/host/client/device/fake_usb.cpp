#include "tests/host/client/device/fake_usb.hpp"

#include <hidapi/hidapi.h>
#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>
#include <thread>

#include "firmware/control/signal_path/installed_force_law.hpp"
#include "firmware/usb/descriptors.hpp"
#include "protocol/driver.hpp"
#include "protocol/parameters.hpp"
#include "protocol/reports.hpp"
#include "protocol/store.hpp"
#include "protocol/usb_identity.hpp"

#include "tests/host/client/device/fake_usbip_server.hpp"

using inkwell::tests::Bytes;
using inkwell::tests::FakeUsb;
using inkwell::tests::FakeUsbDevice;

// The headers of the libraries declare these types but do not define them.
struct libusb_context {};
struct libusb_device {
  FakeUsbDevice* device;
};
struct libusb_device_handle {
  FakeUsbDevice* device;
};
struct hid_device_ {
  FakeUsbDevice* device;
};

namespace {

FakeUsb* current = nullptr;
std::mutex no_usb;  // used while no instance exists

std::unique_lock<std::mutex> lock_usb() { return std::unique_lock(current != nullptr ? current->mutex : no_usb); }

void count(int things) {
  const auto lock = lock_usb();
  if (current != nullptr) current->open_things += things;
}

/// Copies as many bytes as the buffer holds, and returns their number.
int give(const Bytes& bytes, unsigned char* data, std::size_t room) {
  const std::size_t length = std::min(bytes.size(), room);
  std::copy_n(bytes.begin(), length, reinterpret_cast<std::byte*>(data));  // memcpy does not accept a null pointer
  return static_cast<int>(length);
}

Bytes to_bytes(const unsigned char* data, std::size_t length) {
  const auto* begin = reinterpret_cast<const std::byte*>(data);
  return {begin, begin + length};
}

int fail(int reason) {
  errno = current->is_windows ? 0 : reason;
  return -1;
}

/// Returns true if a signal interrupts the transfer.
bool interrupt(FakeUsbDevice& device) {
  if (device.interruptions == 0) return false;
  --device.interruptions;
  errno = EINTR;
  return true;
}

enum class ReportKind : std::uint8_t { output = 0x90, feature = 0xB0 };

/// Reads the lengths of all reports of this kind from the firmware's report descriptor (HID 1.11, section 6.2.2).
std::map<std::uint8_t, std::size_t> declared_lengths(ReportKind kind) {
  constexpr std::uint8_t report_id = 0x84, report_count = 0x94, kind_bits = 0xFC;
  const auto descriptor = inkwell::usb::hid_report_descriptor(inkwell::protocol::usb::hid_interface);
  std::map<std::uint8_t, std::size_t> lengths;
  std::uint8_t id = 0;
  std::size_t number = 0, count = 0;
  for (std::size_t at = 0; at < descriptor.size();) {
    const auto item = std::to_integer<std::uint8_t>(descriptor[at]);
    const std::size_t size = (item & 3u) == 3 ? 4 : item & 3u;
    number = 0;
    for (std::size_t i = 0; i < size; ++i) number |= std::to_integer<std::size_t>(descriptor[at + 1 + i]) << 8 * i;
    at += 1 + size;
    const auto tag = static_cast<std::uint8_t>(item & kind_bits);
    if (tag == report_id) id = static_cast<std::uint8_t>(number);
    if (tag == report_count) count = number;
    if (tag == static_cast<std::uint8_t>(kind)) lengths[id] = 1 + count;
  }
  return lengths;
}

std::size_t longest(const std::map<std::uint8_t, std::size_t>& lengths) {
  return std::ranges::max_element(lengths, {}, [](const auto& each) { return each.second; })->second;
}

/// Returns the report as sent on the bus. On Windows, hidapi pads an output report to the length of the longest output
/// report. A feature report has the declared length of its id.
Bytes on_the_bus(const unsigned char* data, std::size_t length, ReportKind kind) {
  Bytes report = to_bytes(data, length);
  if (!current->is_windows) return report;
  const auto lengths = declared_lengths(kind);
  const auto found = lengths.find(data[0]);
  if (kind == ReportKind::output)
    report.resize(std::max(length, longest(lengths)));
  else if (found != lengths.end())
    report.resize(std::max(length, found->second));
  return report;
}

/// Calls a board function and returns the result like a hidapi function.
template <class Call>
int carry_out(Call call) {
  try {
    return static_cast<int>(call());
  } catch (const inkwell::device::Stalled&) {
    return fail(EPIPE);
  } catch (const inkwell::device::Error&) {
    return fail(ENODEV);
  }
}

std::shared_ptr<inkwell::device::Transport> board_of(hid_device* hid) {
  const auto lock = lock_usb();
  return hid->device->board;
}

std::span<std::byte> writable(unsigned char* data, std::size_t length) {
  return {reinterpret_cast<std::byte*>(data), length};
}

/// Completes a pending transfer, if there is one. The callback runs without the lock, because it submits the next
/// transfer.
bool complete_one() {
  libusb_transfer* ended = nullptr;
  {
    const auto lock = lock_usb();
    for (FakeUsbDevice& device : current->devices) {
      for (libusb_transfer* transfer : device.under_way) {
        if (transfer->status == LIBUSB_TRANSFER_CANCELLED) {
          ended = transfer;
        } else if (!device.ready.empty()) {
          ended = transfer;
          ended->actual_length =
              give(device.ready.front(), transfer->buffer, static_cast<std::size_t>(transfer->length));
          device.ready.pop_front();
        } else if (device.unplugged || device.bulk_fails) {
          ended = transfer;
          ended->status = LIBUSB_TRANSFER_NO_DEVICE;
        }
        if (ended != nullptr) break;
      }
      if (ended == nullptr) continue;
      std::erase(device.under_way, ended);
      break;
    }
  }
  if (ended == nullptr) return false;
  ended->callback(ended);
  return true;
}

}  // namespace

// --- libusb -----------------------------------------------------------------------------------------------

extern "C" {

int LIBUSB_CALL libusb_init(libusb_context** context) {
  *context = new libusb_context;
  count(+1);
  return 0;
}

void LIBUSB_CALL libusb_exit(libusb_context* context) {
  delete context;
  count(-1);
}

// The fake has no file descriptors that a forked child must close.
const libusb_pollfd** LIBUSB_CALL libusb_get_pollfds(libusb_context*) { return nullptr; }
void LIBUSB_CALL libusb_free_pollfds(const libusb_pollfd**) {}

ssize_t LIBUSB_CALL libusb_get_device_list(libusb_context*, libusb_device*** list) {
  const auto lock = lock_usb();
  *list = new libusb_device*[current->devices.size()];
  for (std::size_t i = 0; i < current->devices.size(); ++i) (*list)[i] = new libusb_device{&current->devices[i]};
  ++current->open_things;
  return static_cast<ssize_t>(current->devices.size());
}

void LIBUSB_CALL libusb_free_device_list(libusb_device** list, int) {
  const auto lock = lock_usb();
  for (std::size_t i = 0; i < current->devices.size(); ++i) delete list[i];
  delete[] list;
  --current->open_things;
}

int LIBUSB_CALL libusb_get_device_descriptor(libusb_device* device, libusb_device_descriptor* descriptor) {
  descriptor->idVendor = device->device->vendor_id;
  descriptor->idProduct = device->device->product_id;
  descriptor->iSerialNumber = 3;
  return 0;
}

int LIBUSB_CALL libusb_open(libusb_device* device, libusb_device_handle** handle) {
  const auto lock = lock_usb();
  if (device->device->open_result != 0) return device->device->open_result;
  if (current->is_windows && device->device->handles > 0) return LIBUSB_ERROR_ACCESS;
  const bool is_loader = device->device->vendor_id == inkwell::protocol::usb::boot_loader_vendor_id;
  if (is_loader && device->device->denied_opens > 0) {
    --device->device->denied_opens;
    return LIBUSB_ERROR_ACCESS;
  }
  *handle = new libusb_device_handle{device->device};
  ++device->device->handles;
  ++current->open_things;
  return 0;
}

void LIBUSB_CALL libusb_close(libusb_device_handle* handle) {
  const auto lock = lock_usb();
  --handle->device->handles;
  delete handle;
  --current->open_things;
}

int LIBUSB_CALL libusb_get_string_descriptor_ascii(libusb_device_handle* handle, std::uint8_t index,
                                                   unsigned char* data, int length) {
  if (index != 3) return LIBUSB_ERROR_INVALID_PARAM;
  const std::string& text = handle->device->serial_number;
  return give(to_bytes(reinterpret_cast<const unsigned char*>(text.data()), text.size()), data,
              static_cast<std::size_t>(length));
}

int LIBUSB_CALL libusb_control_transfer(libusb_device_handle* handle, std::uint8_t type, std::uint8_t request,
                                        std::uint16_t value, std::uint16_t, unsigned char* data, std::uint16_t length,
                                        unsigned int) {
  constexpr std::uint8_t get_descriptor = 6, class_out = 0x21, class_in = 0xA1, detach = 0, get_status = 3;
  const auto lock = lock_usb();
  FakeUsbDevice& addressed = *handle->device;
  if (addressed.bulk_fails) return LIBUSB_ERROR_IO;
  if (addressed.unplugged) return LIBUSB_ERROR_NO_DEVICE;
  if (type == class_out && request == detach) {
    if (addressed.stalls_detach) return LIBUSB_ERROR_PIPE;
    ++addressed.detaches;
    addressed.unplugged = addressed.leaves_at_detach;
    if (addressed.becomes_loader_at_detach) {
      addressed.vendor_id = inkwell::protocol::usb::boot_loader_vendor_id;
      addressed.product_id = inkwell::protocol::usb::boot_loader_product_id;
    }
    return 0;
  }
  if (type == class_in && request == get_status && !addressed.update_status.empty())
    return give(addressed.update_status, data, length);
  if (type != 0x80 || request != get_descriptor || value != 0x0200) return LIBUSB_ERROR_PIPE;
  return give(handle->device->configuration, data, length);
}

int LIBUSB_CALL libusb_claim_interface(libusb_device_handle* handle, int number) {
  const auto lock = lock_usb();
  if (handle->device->claim_result != 0) return handle->device->claim_result;
  if (handle->device->taken.contains(number) || !handle->device->claimed.insert(number).second)
    return LIBUSB_ERROR_BUSY;
  ++current->open_things;
  return 0;
}

int LIBUSB_CALL libusb_release_interface(libusb_device_handle* handle, int number) {
  const auto lock = lock_usb();
  if (handle->device->claimed.erase(number) == 0) return LIBUSB_ERROR_NOT_FOUND;
  --current->open_things;
  return 0;
}

libusb_transfer* LIBUSB_CALL libusb_alloc_transfer(int) {
  count(+1);
  return new libusb_transfer{};
}

void LIBUSB_CALL libusb_free_transfer(libusb_transfer* transfer) {
  if (transfer == nullptr) return;
  delete transfer;
  count(-1);
}

int LIBUSB_CALL libusb_submit_transfer(libusb_transfer* transfer) {
  const auto lock = lock_usb();
  FakeUsbDevice& device = *transfer->dev_handle->device;
  if (device.unplugged) return LIBUSB_ERROR_NO_DEVICE;
  transfer->status = LIBUSB_TRANSFER_COMPLETED;
  transfer->actual_length = 0;
  device.under_way.push_back(transfer);
  return 0;
}

int LIBUSB_CALL libusb_cancel_transfer(libusb_transfer* transfer) {
  const auto lock = lock_usb();
  const auto& under_way = transfer->dev_handle->device->under_way;
  if (std::find(under_way.begin(), under_way.end(), transfer) == under_way.end()) return LIBUSB_ERROR_NOT_FOUND;
  transfer->status = LIBUSB_TRANSFER_CANCELLED;
  return 0;
}

int LIBUSB_CALL libusb_handle_events_timeout(libusb_context*, timeval*) {
  if (!complete_one()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return 0;
}

// --- hidapi -----------------------------------------------------------------------------------------------

hid_device_info* hid_enumerate(unsigned short vendor_id, unsigned short product_id) {
  const auto lock = lock_usb();
  hid_device_info* list = nullptr;
  if (current == nullptr) return list;
  for (FakeUsbDevice& device : current->devices) {
    if (device.unplugged || device.hides || device.vendor_id != vendor_id || device.product_id != product_id) continue;
    const std::wstring serial_number(device.serial_number.begin(), device.serial_number.end());
    for (const bool is_controller : {false, true}) {
      auto* info = new hid_device_info{};
      info->path = strdup((device.path() + (is_controller ? "-controller" : "")).c_str());
      info->serial_number = wcsdup(serial_number.c_str());
      info->product_string = wcsdup(device.product.c_str());
      info->usage_page = is_controller ? 0x0001 : 0xFF00;
      info->next = list;
      list = info;
      ++current->open_things;
    }
  }
  return list;
}

void hid_free_enumeration(hid_device_info* list) {
  while (list != nullptr) {
    hid_device_info* next = list->next;
    std::free(list->path);
    std::free(list->serial_number);
    std::free(list->product_string);
    delete list;
    count(-1);
    list = next;
  }
}

hid_device* hid_open_path(const char* path) {
  const auto lock = lock_usb();
  for (FakeUsbDevice& device : current->devices) {
    if (device.path() != path || device.unplugged || device.denies_hid) continue;
    ++current->open_things;
    return new hid_device_{&device};
  }
  return nullptr;
}

void hid_close(hid_device* hid) {
  delete hid;
  count(-1);
}

const wchar_t* hid_error(hid_device* hid) { return hid == nullptr ? L"not opened" : L"not transferred"; }

int hid_read_timeout(hid_device* hid, unsigned char* data, std::size_t length, int timeout_ms) {
  if (const auto board = board_of(hid))
    return carry_out([&] { return board->read_report(writable(data, length), std::chrono::milliseconds(timeout_ms)); });
  {
    const auto lock = lock_usb();
    FakeUsbDevice& device = *hid->device;
    if (interrupt(device)) return -1;
    if (!device.reports.empty()) {
      const int given = give(device.reports.front(), data, length);
      if (!device.repeats_reports || device.reports.size() > 1) device.reports.pop_front();
      return given;
    }
    if (device.unplugged) return fail(ENODEV);
  }
  if (timeout_ms < 0) return fail(EDEADLK);  // the call would block indefinitely
  std::this_thread::sleep_for(std::chrono::milliseconds(std::min(timeout_ms, 1)));
  return 0;
}

int hid_write(hid_device* hid, const unsigned char* data, std::size_t length) {
  const Bytes report = on_the_bus(data, length, ReportKind::output);
  if (const auto board = board_of(hid)) return carry_out([&] { return board->write_report(report), report.size(); });
  const auto lock = lock_usb();
  if (interrupt(*hid->device)) return -1;
  if (hid->device->unplugged) return fail(ENODEV);
  hid->device->written.push_back(report);
  return static_cast<int>(report.size());
}

int hid_get_feature_report(hid_device* hid, unsigned char* data, std::size_t length) {
  if (current->is_windows && length < longest(declared_lengths(ReportKind::feature))) return fail(EINVAL);
  if (const auto board = board_of(hid)) return carry_out([&] { return board->get_feature(writable(data, length)); });
  const auto lock = lock_usb();
  if (hid->device->unplugged) return fail(ENODEV);
  const auto found = hid->device->features.find(data[0]);
  return found == hid->device->features.end() ? fail(EPIPE) : give(found->second, data, length);
}

int hid_send_feature_report(hid_device* hid, const unsigned char* data, std::size_t length) {
  const Bytes report = on_the_bus(data, length, ReportKind::feature);
  if (const auto board = board_of(hid)) return carry_out([&] { return board->set_feature(report), length; });
  const auto lock = lock_usb();
  if (hid->device->unplugged) return fail(ENODEV);
  if (!hid->device->features.contains(data[0])) return fail(EPIPE);
  hid->device->features[data[0]] = report;
  return static_cast<int>(length);
}

}  // extern "C"

namespace inkwell::tests {

FakeUsb::FakeUsb() {
  const char* const system = std::getenv(fake_usb_system);
  is_windows = system != nullptr && std::string_view(system) == "windows";
  current = this;
}
FakeUsb::~FakeUsb() { current = nullptr; }

FakeUsbDevice& FakeUsb::add_arm(std::string serial_number, std::uint8_t scope_interface, std::uint8_t scope_endpoint) {
  const unsigned hid_interface = 1u - scope_interface;
  const std::vector<unsigned> hid{9, 4, hid_interface, 0, 2,  3, 0, 0, 0,  //
                                  7, 5, 0x81,          3, 64, 0, 1, 7, 5, 0x01, 3, 64, 0, 1};
  const std::vector<unsigned> scope{9, 4, scope_interface, 0, 1, 0xFF, 0, 0, 0, 7, 5, scope_endpoint, 2, 64, 0, 0};
  FakeUsbDevice arm{.serial_number = std::move(serial_number)};
  const auto append = [&](const std::vector<unsigned>& bytes) {
    std::transform(bytes.begin(), bytes.end(), std::back_inserter(arm.configuration),
                   [](unsigned byte) { return static_cast<std::byte>(byte); });
  };
  append({9, 2, 48, 0, 2, 1, 0, 0x80, 50});
  append(scope_interface == 0 ? scope : hid);
  append(scope_interface == 0 ? hid : scope);
  const std::lock_guard lock(mutex);
  return devices.emplace_back(std::move(arm));
}

std::vector<std::uint8_t> FakeUsb::endpoints_under_way(const FakeUsbDevice& device) {
  const std::lock_guard lock(mutex);
  std::vector<std::uint8_t> endpoints;
  for (const libusb_transfer* transfer : device.under_way) endpoints.push_back(transfer->endpoint);
  return endpoints;
}

void FakeUsb::send_bulk(FakeUsbDevice& device, Bytes data) {
  const std::lock_guard lock(mutex);
  device.ready.push_back(std::move(data));
}

void FakeUsb::send_report(FakeUsbDevice& device, Bytes report) {
  const std::lock_guard lock(mutex);
  device.reports.push_back(std::move(report));
}

void FakeUsb::unplug(FakeUsbDevice& device) {
  const std::lock_guard lock(mutex);
  device.unplugged = true;
}

void FakeUsb::set_bulk_fails(FakeUsbDevice& device, bool fails) {
  const std::lock_guard lock(mutex);
  device.bulk_fails = fails;
}

std::size_t FakeUsb::bulk_left(const FakeUsbDevice& device) {
  const std::lock_guard lock(mutex);
  return device.ready.size();
}

void answer_as_inkwell(FakeUsbDevice& arm) {
  protocol::InformationReport information{};
  information.report_id = protocol::ReportId::information;
  information.version = protocol::protocol_version;
  information.parameter_table_hash = protocol::parameter_table_hash;
  information.signal_table_hash = protocol::signal_table_hash;
  arm.features[static_cast<std::uint8_t>(protocol::ReportId::information)] = bytes_of(information);
  const auto& law = control::installed_force_law;
  arm.features[static_cast<std::uint8_t>(protocol::ReportId::force_law)] =
      Bytes(law.report, law.report + law.report_size);
  protocol::ParametersReport parameters{};
  parameters.report_id = protocol::ReportId::parameters;
  parameters.version = protocol::protocol_version;
  parameters.count = protocol::parameter_count;
  for (std::size_t i = 0; i < protocol::parameter_count; ++i)
    parameters.entries[i] = {protocol::parameter_table[i].id, 0, protocol::default_parameters().values[i]};
  arm.features[static_cast<std::uint8_t>(protocol::ReportId::parameters)] = bytes_of(parameters);
  parameters.report_id = protocol::ReportId::stored;
  arm.features[static_cast<std::uint8_t>(protocol::ReportId::stored)] = bytes_of(parameters);
  arm.features[static_cast<std::uint8_t>(protocol::ReportId::driver)] = bytes_of(protocol::DriverReport{});
  arm.features[static_cast<std::uint8_t>(protocol::ReportId::request_results)] =
      bytes_of(protocol::RequestResultsReport{});
  protocol::FrameReport bus_frame{};
  bus_frame.report_id = protocol::ReportId::frame;
  arm.features[static_cast<std::uint8_t>(protocol::ReportId::frame)] = bytes_of(bus_frame);
  const protocol::StoreReport store{};
  arm.features[static_cast<std::uint8_t>(protocol::ReportId::store)] = bytes_of(store);
}

}  // namespace inkwell::tests
