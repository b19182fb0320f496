// Exports the one device by USB/IP, on a TCP port of this computer or on a Unix socket.
//
// The server's own thread does all that can wait. The simulation's thread exchanges orders and results with
// it through two queues and never waits for a socket.
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

#include <local/descriptor.hpp>
#include <local/listener.hpp>
#include <virtual_usb/client_name.hpp>
#include <virtual_usb/descriptors.hpp>
#include <virtual_usb/urb.hpp>
#include <virtual_usb/usbip_requests.hpp>

#include "usbip_import.hpp"

namespace inkwell::virtual_board {

class UsbIpServer {
 public:
  /// What the importer asks of the bus. `session` counts imports, so that late answers find nobody.
  struct Order {
    enum class Kind : std::uint8_t { import, release, submit, unlink };
    Kind kind;
    std::uint32_t session;
    Urb urb;  ///< of a submit; its `sequence` is also that of an unlink
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

  /// Throws std::runtime_error with a sentence that names --usbip if it cannot listen there.
  /// `on_order` is called from the server's thread when there is something to take.
  UsbIpServer(const local::SocketAddress& where, std::function<void()> on_order);
  ~UsbIpServer();
  UsbIpServer(const UsbIpServer&) = delete;
  UsbIpServer& operator=(const UsbIpServer&) = delete;

  const local::SocketAddress& address() const { return listener_.address(); }

  // For the simulation's thread.
  /// Appends the orders that came in to `orders`; costs next to nothing if there are none.
  void take(std::vector<Order>& orders);
  /// Returns once everything that clients had sent before this call is among the orders, and everything that was
  /// answered before it is on its way to them.
  void exchange_all();
  /// Waits until there are orders to take; false if there are none at `give_up_at`.
  bool wait_for_order(std::chrono::steady_clock::time_point give_up_at);
  void answer(Result&& result);
  /// Offers a device for import.
  void offer(const DeviceDescription& device);
  /// The device is gone: its importers are disconnected.
  void withdraw();

 private:
  struct Connection {
    local::Descriptor socket;
    UsbIpRequests requests;
    std::vector<std::byte> to_send;
    std::size_t sent = 0;
    std::optional<UsbIpImport> import;  ///< of the device, by this client
    bool closing = false;               ///< once everything is sent
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

  std::mutex mutex_;  // guards the next seven
  std::vector<Order> orders_;
  std::vector<Result> results_;
  std::optional<DeviceDescription> offered_;
  bool withdrawn_ = false;
  bool stop_ = false;
  std::uint64_t exchanges_asked_ = 0, exchanges_done_ = 0;
  std::condition_variable order_given_, exchanged_;
  std::atomic<bool> orders_waiting_ = false;

  // Only for the server's thread.
  std::list<Connection> connections_;
  std::uint32_t sessions_ = 0;
  std::chrono::steady_clock::time_point accept_again_at_{};

  std::thread thread_;
};

}  // namespace inkwell::virtual_board
