// Exports the device through USB/IP, at a local TCP port or a Unix socket.
//
// All blocking calls run on the server thread. The simulation thread exchanges orders and results with the server
// thread through two queues and never waits for a socket.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

#include "boards/virtual/usb/client_name.hpp"
#include "boards/virtual/usb/descriptors.hpp"
#include "boards/virtual/usb/urb.hpp"
#include "boards/virtual/usb/usbip_requests.hpp"
#include "host/client/local/descriptor.hpp"
#include "host/client/local/listener.hpp"

#include "boards/virtual/usb/usbip_import.hpp"

namespace inkwell::virtual_board {

class UsbIpServer {
 public:
  /// A request of an importer. `session` is the import number, which identifies late answers.
  struct Order {
    enum class Kind : std::uint8_t { import, release, submit, unlink };
    Kind kind;
    std::uint32_t session;
    Urb urb;  ///< of a submit; its `sequence` is also used for an unlink
    std::uint32_t unlink_sequence = 0;
    Peer client{};  ///< of an import
  };
  struct Result {
    enum class Kind : std::uint8_t { submitted, unlinked };
    Kind kind;
    std::uint32_t session;
    Urb urb;
    std::int32_t status;
    std::uint32_t unlink_sequence = 0;
  };

  /// Throws std::runtime_error if the server cannot listen. The error sentence names --usbip. The server thread calls
  /// `on_order` when orders are ready for take().
  UsbIpServer(const local::SocketAddress& where, std::function<void()> on_order);
  ~UsbIpServer();
  UsbIpServer(const UsbIpServer&) = delete;
  UsbIpServer& operator=(const UsbIpServer&) = delete;

  const local::SocketAddress& address() const { return listener_.address(); }

  // For the simulation thread.
  /// Appends the received orders to `orders`. The call is fast if no orders have been received.
  void take(std::vector<Order>& orders);
  /// Waits until all queued answers are sent and all received data is converted to orders.
  void exchange_all();
  /// Waits for orders. Returns false if no order has been received before `deadline`.
  bool wait_for_order(std::chrono::steady_clock::time_point deadline);
  void answer(Result&& result);
  void offer(const DeviceDescription& device);
  /// Call this function when the device is removed. All importers are disconnected.
  void withdraw();

 private:
  struct Connection {
    local::Descriptor socket;
    UsbIpRequests requests;
    std::vector<std::byte> to_send;
    std::size_t sent = 0;
    std::optional<UsbIpImport> import;  ///< set if this client has imported the device
    bool closing = false;               ///< disconnect after all data is sent
    bool dead = false;
  };

  void run();
  bool accepts_now() const { return std::chrono::steady_clock::now() >= accept_again_at_; }
  void accept_connections();
  void make_room();
  void end(Connection& connection);
  void receive(Connection& connection);
  void send(Connection& connection);
  void handle_received(Connection& connection);
  bool handle_operation(Connection& connection);
  bool handle_transfer(Connection& connection);
  void handle_import(Connection& connection, std::string_view bus_id);
  void deliver_results();
  std::optional<DeviceDescription> offered();
  void give(Order&& order);
  void wake();

  std::function<void()> on_order_;
  local::Listener listener_;
  local::Descriptor wake_;  // eventfd

  std::mutex mutex_;  // guards the next seven members
  std::vector<Order> orders_;
  std::vector<Result> results_;
  std::optional<DeviceDescription> offered_;
  bool withdrawn_ = false;
  bool stop_ = false;
  std::uint64_t exchanges_requested_ = 0, exchanges_done_ = 0;
  std::condition_variable order_arrived_, exchanged_;
  std::atomic<bool> orders_waiting_ = false;

  // Only the server thread accesses the members below.
  std::list<Connection> connections_;
  std::uint32_t sessions_ = 0;
  std::chrono::steady_clock::time_point accept_again_at_{};

  std::thread thread_;
};

}  // namespace inkwell::virtual_board
