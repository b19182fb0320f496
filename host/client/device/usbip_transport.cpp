#include "host/client/device/transports.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <list>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "protocol/usb_identity.hpp"

#include "host/client/device/transfer_queue.hpp"
#include "host/client/device/usbip_connection.hpp"

namespace inkwell::device {
namespace {

using namespace std::chrono_literals;
namespace identity = protocol::usb;

constexpr int report_transfers = 32;
constexpr std::size_t reports_kept = 1024;  // poses of one second; a full queue drops the oldest report
constexpr std::size_t writes_under_way = 16;
constexpr std::size_t writes_in_lock_step = 1024;
// A pending command is considered refused after this number of reports, or after this wall time without reports.
constexpr unsigned reports_without_a_taken_write = 1000;
constexpr auto silence = 3s;
constexpr char takes_no_commands[] = "The device accepts no commands, although it sends poses. Reset the board.";

class UsbipTransport : public Transport {
 public:
  explicit UsbipTransport(const Endpoint& endpoint) : endpoint_(endpoint), connection_(endpoint.server, endpoint.path) {
    if (endpoint.lock_step != nullptr) connection_.wait_in_lock_step(*endpoint.lock_step);
    connection_.start([this](const std::string& reason) { lose(reason); });
    try {
      configure();
      if (!is_in_lock_step())
        for (int i = 0; i < report_transfers; ++i) request_report();
    } catch (...) {
      close();
      throw;
    }
  }

  ~UsbipTransport() override { close(); }

  std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds timeout) override {
    reads_reports_ = true;
    if (is_in_lock_step() && timeout > 0ms && !is_report_to_come()) request_report();
    return read(reports_, report, timeout);
  }

  void write_report(std::span<const std::byte> report) override {
    std::unique_lock lock(writes_mutex_);
    wait_for_room(lock);
    if (writes_++ == 0) reports_since_taken_ = 0;
    lock.unlock();
    connection_.submit_out(layout_.hid_out_endpoint, report, [this](UsbipConnection::Completion completion) {
      const std::lock_guard done(writes_mutex_);
      --writes_;
      reports_since_taken_ = 0;
      if (completion.status != 0) lost_ = true;
      writes_changed_.notify_all();
    });
  }

  bool wait_until_written(std::chrono::milliseconds timeout) override {
    std::unique_lock lock(writes_mutex_);
    writes_changed_.wait_for(lock, timeout, [&] { return writes_ == 0 || lost_ || accepts_no_writes(); });
    if (lost_) throw Disconnected(unplugged);
    if (accepts_no_writes()) throw Error(takes_no_commands);
    return writes_ == 0;
  }

  std::size_t get_feature(std::span<std::byte> report) override {
    const auto id = std::to_integer<std::uint8_t>(report[0]);
    const auto data = carry_out([&] {
      return connection_.control_in(
          setup::get_feature_report(layout_.hid_interface, id, static_cast<std::uint16_t>(report.size())));
    });
    std::copy_n(data.begin(), std::min(data.size(), report.size()), report.begin());
    return data.size();
  }

  void set_feature(std::span<const std::byte> report) override {
    const auto id = std::to_integer<std::uint8_t>(report[0]);
    carry_out([&] {
      connection_.control_out(
          setup::set_feature_report(layout_.hid_interface, id, static_cast<std::uint16_t>(report.size())), report);
    });
  }

  void claim_scope() override {
    {
      const std::lock_guard lock(bulk_mutex_);
      if (scope_claimed_) return;
      bulk_denied_ = false;
      scope_claimed_ = true;
      request_bulk();
    }
    // The server answers in order. Its refusal of the bulk request therefore arrives before the answer to this request.
    try {
      carry_out([&] { connection_.control_in(setup::get_descriptor(setup::DescriptorType::device, 0, 18)); });
    } catch (...) {
      release_scope();
      throw;
    }
    const std::lock_guard lock(bulk_mutex_);
    if (bulk_denied_) {
      scope_claimed_ = false;
      throw InUse(scope_in_use);
    }
    for (int i = 1; i < bulk_transfers; ++i) request_bulk();
  }

  /// The server releases the scope only after a transfer was canceled and no transfer is pending.
  void release_scope() override {
    std::unique_lock lock(bulk_mutex_);
    if (!std::exchange(scope_claimed_, false)) return;
    bulk_owed_ = 0;
    bulk_taken_back_ = bulk_denied_ = false;
    const auto is_over = [this] { return bulk_lost_ || bulk_under_way_.empty(); };
    const auto deadline = std::chrono::steady_clock::now() + silence;
    retry([&] {
      while (!bulk_lost_ && !bulk_taken_back_ && !bulk_denied_) {
        if (bulk_under_way_.empty()) request_bulk();
        for (const auto sequence : bulk_under_way_) connection_.unlink(sequence);
        if (!bulk_changed_.wait_until(lock, deadline, is_over)) return;
      }
    });
  }

  std::size_t read_bulk(std::span<std::byte> transfer, std::chrono::milliseconds timeout) override {
    const std::size_t length = read(bulk_, transfer, timeout);
    const std::lock_guard lock(bulk_mutex_);
    for (; bulk_owed_ > 0 && bulk_.size() < bulk_kept; --bulk_owed_) request_bulk();
    return length;
  }

  const Endpoint& endpoint() const override { return endpoint_; }

 private:
  bool is_in_lock_step() const { return endpoint_.lock_step != nullptr; }
  bool is_report_to_come() const { return reports_requested_ > 0 || reports_.size() > 0; }

  /// Executes a control transfer. In lock step, board time passes only while a report is requested. The thread that
  /// reads reports cannot request one during its control transfer, so this function requests a report.
  template <class Transfer>
  std::invoke_result_t<Transfer> carry_out(Transfer transfer) {
    const bool is_out_of_step = is_in_lock_step() && reads_reports_ && !endpoint_.lock_step->is_in_step();
    if (!is_out_of_step) return transfer();
    struct Count {
      std::atomic<int>& count;
      explicit Count(std::atomic<int>& one) : count(one) { ++count; }
      ~Count() { --count; }
    } const counted(requests_out_of_step_);
    if (!is_report_to_come()) request_report();
    return transfer();
  }

  void configure() {
    using setup::DescriptorType;
    const auto device = connection_.control_in(setup::get_descriptor(DescriptorType::device, 0, 18));
    if (device.size() != 18) throw Error("The device's USB descriptor is damaged. Flash its firmware again.");
    const auto index_of_string = [&](std::size_t i) { return std::to_integer<std::uint8_t>(device[i]); };
    const auto text = [&](std::uint8_t index) {
      return parse_string(connection_.control_in(setup::get_descriptor(DescriptorType::string, index, 255)));
    };
    endpoint_.product = text(index_of_string(15));
    endpoint_.serial_number = text(index_of_string(16));
    layout_ =
        parse_configuration(connection_.control_in(setup::get_descriptor(DescriptorType::configuration, 0, 1024)));
    connection_.control_out(setup::set_configuration(layout_.configuration), {});
  }

  /// Requires writes_mutex_.
  bool accepts_no_writes() const { return writes_ > 0 && reports_since_taken_ >= reports_without_a_taken_write; }

  void wait_for_room(std::unique_lock<std::mutex>& lock) {
    if (is_in_lock_step()) {  // A wait could block the thread that lets board time pass.
      if (lost_) throw Disconnected(unplugged);
      if (writes_ >= writes_in_lock_step)
        throw Error(
            "1024 commands wait for board time to pass. Send fewer commands, or wait for poses between the commands.");
      return;
    }
    const auto has_room = [&] { return writes_ < writes_under_way; };
    for (std::uint64_t known = reports_come_; !has_room() && !lost_ && !accepts_no_writes(); known = reports_come_) {
      const bool changed =
          writes_changed_.wait_for(lock, silence, [&] { return has_room() || lost_ || accepts_no_writes(); });
      if (!changed && reports_come_ == known)
        throw Error(
            "The device accepts no commands and is silent. Reset the board, or let a paused virtual board run.");
    }
    if (lost_) throw Disconnected(unplugged);
    if (!has_room()) throw Error(takes_no_commands);
  }

  void count_report() {
    const std::lock_guard lock(writes_mutex_);
    ++reports_come_;
    if (++reports_since_taken_ == reports_without_a_taken_write) writes_changed_.notify_all();
  }

  void request_report() {
    ++reports_requested_;
    connection_.submit_in(layout_.hid_in_endpoint, identity::packet_size, [this](UsbipConnection::Completion done) {
      if (done.status != 0) return lose(unplugged);
      count_report();
      const bool is_empty = done.data.empty();
      if (!is_empty) reports_.push(std::move(done.data));
      if (reports_.size() > reports_kept) reports_.drop_oldest();
      --reports_requested_;
      if (is_empty || !is_in_lock_step() || requests_out_of_step_ > 0) retry([this] { request_report(); });
    });
  }

  void request_bulk() {
    const auto slot = bulk_under_way_.insert(bulk_under_way_.end(), 0);
    try {
      *slot =
          connection_.submit_in(layout_.scope_in_endpoint, protocol::scope_frame_maximum,
                                [this, slot](UsbipConnection::Completion done) { take_bulk(std::move(done), slot); });
    } catch (...) {
      bulk_under_way_.erase(slot);
      throw;
    }
  }

  void take_bulk(UsbipConnection::Completion done, std::list<std::uint32_t>::iterator slot) {
    const std::lock_guard lock(bulk_mutex_);
    bulk_under_way_.erase(slot);
    bulk_taken_back_ = bulk_taken_back_ || done.status == -ECONNRESET;
    bulk_changed_.notify_one();
    if (done.status == -EBUSY) {
      bulk_denied_ = true;
      return;
    }
    if (done.status != 0 && done.status != -ECONNRESET) {
      bulk_lost_ = true;
      return lose(unplugged);
    }
    if (!scope_claimed_) return;
    if (!done.data.empty()) bulk_.push(std::move(done.data));
    if (bulk_.size() < bulk_kept) return retry([this] { request_bulk(); });
    // A virtual board waits for a silent host, because the computer may be busy. The board does not wait after a
    // canceled transfer.
    if (bulk_owed_++ == 0 && !bulk_under_way_.empty()) retry([this] { connection_.unlink(bulk_under_way_.back()); });
  }

  /// Ignores a failed connection, because `lose` reports the failure.
  template <class Retried>
  void retry(Retried retried) {
    try {
      retried();
    } catch (const Disconnected&) {
    }
  }

  static std::size_t read(TransferQueue& queue, std::span<std::byte> buffer, std::chrono::milliseconds timeout) {
    const auto transfer = queue.pop(timeout);
    if (!transfer) return 0;
    const std::size_t length = std::min(transfer->size(), buffer.size());
    std::copy_n(transfer->begin(), length, buffer.begin());
    return length;
  }

  void lose(const std::string& reason) {
    reports_.close(reason);
    bulk_.close(reason);
    const std::lock_guard lock(writes_mutex_);
    lost_ = true;
    writes_changed_.notify_all();
  }

  void close() {
    lose("The connection was closed.");
    connection_.close();
  }

  Endpoint endpoint_;
  UsbLayout layout_;
  TransferQueue reports_, bulk_;
  std::atomic<int> reports_requested_ = 0;  ///< number of pending requests
  std::atomic<bool> reads_reports_ = false;
  std::atomic<int> requests_out_of_step_ = 0;
  std::mutex bulk_mutex_;  ///< guards the next seven members
  std::condition_variable bulk_changed_;
  bool scope_claimed_ = false;
  bool bulk_denied_ = false;                 ///< another program has claimed the scope
  bool bulk_lost_ = false;                   ///< the device was disconnected
  bool bulk_taken_back_ = false;             ///< a transfer was canceled after the request to release the scope
  int bulk_owed_ = 0;                        ///< transfers to submit after the reader has read more data
  std::list<std::uint32_t> bulk_under_way_;  ///< sequence numbers of the pending transfers, newest last
  std::mutex writes_mutex_;
  std::condition_variable writes_changed_;
  std::size_t writes_ = 0;
  unsigned reports_since_taken_ = 0;
  std::uint64_t reports_come_ = 0;
  bool lost_ = false;
  UsbipConnection connection_;  ///< declared last, because its thread uses all other members
};

}  // namespace

std::unique_ptr<Transport> open_usbip_transport(const Endpoint& endpoint) {
  return std::make_unique<UsbipTransport>(endpoint);
}

// Device path that the USB/IP server of a virtual board reports.
constexpr char virtual_board_path[] = "/inkwell_virtual_board/";

std::vector<Endpoint> find_usbip_devices(const SocketAddress& server) {
  std::vector<Endpoint> endpoints;
  for (const auto& device : list_usbip_devices(server)) {
    if (device.vendor_id != identity::vendor_id || device.product_id != identity::product_id) continue;
    const bool is_virtual = device.path.find(virtual_board_path) != std::string::npos;
    endpoints.push_back({Endpoint::Kind::usbip, "", identity::product, device.bus_id, server, is_virtual});
  }
  return endpoints;
}

}  // namespace inkwell::device
