#include "boards/virtual/usb/usbip_server.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "host/client/local/interruption.hpp"

#include "boards/virtual/usb/usbip_replies.hpp"

namespace inkwell::virtual_board {

namespace {
constexpr std::size_t connections_maximum = 16;
/// Largest number of simultaneous importers of the device (SharedPort).
constexpr std::size_t importers_maximum = 8;
constexpr std::size_t receive_bytes = 256 * 1024;
/// Largest number of unsent bytes per client. A client above this limit is disconnected.
constexpr std::size_t unsent_maximum = 64u << 20;

}  // namespace

UsbIpServer::UsbIpServer(const local::SocketAddress& where, std::function<void()> on_order)
    : on_order_(std::move(on_order)), listener_(where, "--usbip"), wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (!wake_.is_open()) throw std::runtime_error(std::string("--usbip: no event descriptor: ") + std::strerror(errno));
  ::fcntl(listener_.descriptor(), F_SETFL, O_NONBLOCK);
  thread_ = std::thread([this] { run(); });
}

UsbIpServer::~UsbIpServer() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake();
  thread_.join();
}

// --- Simulation thread -------------------------------------------------------------------------------------

void UsbIpServer::take(std::vector<Order>& orders) {
  if (!orders_waiting_.load(std::memory_order_acquire)) return;
  const std::lock_guard lock(mutex_);
  std::move(orders_.begin(), orders_.end(), std::back_inserter(orders));
  orders_.clear();
  orders_waiting_.store(false, std::memory_order_release);
}

void UsbIpServer::exchange_all() {
  std::unique_lock lock(mutex_);
  const std::uint64_t mine = ++exchanges_requested_;
  wake();
  exchanged_.wait(lock, [&] { return exchanges_done_ >= mine; });
}

bool UsbIpServer::wait_for_order(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  return order_arrived_.wait_until(lock, deadline, [this] { return !orders_.empty(); });
}

void UsbIpServer::answer(Result&& result) {
  bool first = false;
  {
    const std::lock_guard lock(mutex_);
    first = results_.empty();
    results_.push_back(std::move(result));
  }
  if (first) wake();
}

void UsbIpServer::offer(const DeviceDescription& device) {
  const std::lock_guard lock(mutex_);
  offered_ = device;
}

void UsbIpServer::withdraw() {
  {
    const std::lock_guard lock(mutex_);
    offered_.reset();
    withdrawn_ = true;
  }
  wake();
}

// --- Server thread -----------------------------------------------------------------------------------------

void UsbIpServer::wake() {
  const std::uint64_t one = 1;
  // A failed write is ignored, because a full counter wakes the thread.
  local::repeat_interrupted([&] { return ::write(wake_.number(), &one, sizeof one); });
}

std::optional<DeviceDescription> UsbIpServer::offered() {
  const std::lock_guard lock(mutex_);
  return withdrawn_ ? std::nullopt : offered_;
}

void UsbIpServer::give(Order&& order) {
  {
    const std::lock_guard lock(mutex_);
    orders_.push_back(std::move(order));
    orders_waiting_.store(true, std::memory_order_release);
  }
  order_arrived_.notify_one();
  on_order_();
}

void UsbIpServer::run() {
  std::vector<pollfd> descriptors;
  std::uint64_t exchange = 0;  // number of the exchange in progress
  while (true) {
    descriptors.clear();
    descriptors.push_back({wake_.number(), POLLIN, 0});
    // The listener is polled only if a client can be accepted. A client that cannot be accepted would keep the listener
    // readable, and the wait for remaining data would never finish.
    const bool accepts = accepts_now();
    descriptors.push_back({accepts ? listener_.descriptor() : -1, POLLIN, 0});
    for (const Connection& connection : connections_) {
      const bool unsent = connection.sent < connection.to_send.size();
      descriptors.push_back({connection.socket.number(), static_cast<short>(POLLIN | (unsent ? POLLOUT : 0)), 0});
    }
    const bool is_exchanging = exchange != 0;
    const int wait_ms = is_exchanging ? 0 : accepts ? -1 : static_cast<int>(local::accept_rest.count());
    const int ready =
        local::repeat_interrupted([&] { return ::poll(descriptors.data(), descriptors.size(), wait_ms); });
    if (ready < 0 || (ready == 0 && !is_exchanging)) continue;
    if (ready == 0) {  // all data is received
      const std::lock_guard lock(mutex_);
      exchanges_done_ = std::exchange(exchange, 0);
      exchanged_.notify_one();
      continue;
    }
    if (descriptors[0].revents != 0) {
      std::uint64_t count = 0;
      local::repeat_interrupted([&] { return ::read(wake_.number(), &count, sizeof count); });
      const std::lock_guard lock(mutex_);
      if (stop_) return;
      exchange = exchanges_requested_;
    }
    deliver_results();
    std::size_t index = 2;
    for (Connection& connection : connections_) {
      const short events = descriptors[index++].revents;
      if ((events & (POLLIN | POLLHUP | POLLERR)) != 0 && !connection.dead) receive(connection);
      send(connection);
    }
    connections_.remove_if([](const Connection& connection) { return connection.dead; });
    if (descriptors[1].revents != 0) accept_connections();
  }
}

void UsbIpServer::accept_connections() {
  while (true) {
    local::Descriptor socket(local::repeat_interrupted(
        [&] { return ::accept4(listener_.descriptor(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC); }));
    if (!socket.is_open()) {
      if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM)
        accept_again_at_ = std::chrono::steady_clock::now() + local::accept_rest;
      return;
    }
    if (connections_.size() >= connections_maximum) make_room();
    const int yes = 1;
    ::setsockopt(socket.number(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    connections_.emplace_back().socket = std::move(socket);
  }
}

// Disconnects the oldest client that has not imported the device, so that idle connections do not block new clients.
void UsbIpServer::make_room() {
  const auto oldest = std::find_if(connections_.begin(), connections_.end(),
                                   [](const Connection& connection) { return !connection.import; });
  std::cerr << "USB/IP: the oldest of " << connections_.size() << " clients is disconnected to make room.\n";
  connections_.erase(oldest);
}

// Queues the release order immediately, so that the release precedes the next import.
void UsbIpServer::end(Connection& connection) {
  connection.dead = true;
  if (!connection.import) return;
  give({Order::Kind::release, connection.import->session(), {}});
  connection.import.reset();
}

void UsbIpServer::receive(Connection& connection) {
  std::array<std::byte, receive_bytes> buffer;
  const ssize_t count =
      local::repeat_interrupted([&] { return ::recv(connection.socket.number(), buffer.data(), buffer.size(), 0); });
  if (count == 0 || (count < 0 && errno != EAGAIN)) {
    end(connection);
    return;
  }
  if (count < 0 || connection.closing) return;
  connection.requests.feed(std::span(buffer).first(static_cast<std::size_t>(count)));
  try {
    handle_received(connection);
  } catch (const std::exception& error) {
    std::cerr << "USB/IP: a client is disconnected because " << error.what() << ".\n";
    end(connection);
  }
}

void UsbIpServer::send(Connection& connection) {
  while (!connection.dead && connection.sent < connection.to_send.size()) {
    const ssize_t count = local::repeat_interrupted([&] {
      return ::send(connection.socket.number(), connection.to_send.data() + connection.sent,
                    connection.to_send.size() - connection.sent, MSG_NOSIGNAL);
    });
    if (count < 0) {
      if (errno != EAGAIN) end(connection);
      break;
    }
    connection.sent += static_cast<std::size_t>(count);
  }
  if (connection.sent == connection.to_send.size()) {
    connection.to_send.clear();
    connection.sent = 0;
    if (connection.closing) end(connection);
  } else if (connection.to_send.size() - connection.sent > unsent_maximum) {
    std::cerr << "USB/IP: a client is disconnected because it does not read.\n";
    end(connection);
  }
}

void UsbIpServer::handle_received(Connection& connection) {
  bool goes_on = true;
  while (goes_on && !connection.closing)
    goes_on = connection.import ? handle_transfer(connection) : handle_operation(connection);
}

bool UsbIpServer::handle_operation(Connection& connection) {
  const auto operation = connection.requests.take_operation();
  if (!operation) return false;
  if (const auto* const wanted = std::get_if<UsbIpRequests::Import>(&*operation)) {
    handle_import(connection, wanted->bus_id);
  } else {
    const std::optional<DeviceDescription> device = offered();
    append_device_list(connection.to_send, device ? &*device : nullptr);
  }
  return true;
}

void UsbIpServer::handle_import(Connection& connection, std::string_view bus_id) {
  const std::optional<DeviceDescription> device = offered();
  const bool known = device && bus_id == exported_bus_id;
  const auto importers = std::count_if(connections_.begin(), connections_.end(),
                                       [](const Connection& other) { return other.import.has_value(); });
  const bool busy = static_cast<std::size_t>(importers) >= importers_maximum;
  if (!known || busy) {
    append_import_refused(connection.to_send, known ? usbip::OperationStatus::busy : usbip::OperationStatus::no_device);
    connection.closing = true;
    return;
  }
  append_imported(connection.to_send, *device);
  connection.import.emplace(++sessions_);
  give({.kind = Order::Kind::import, .session = sessions_, .urb = {}, .client = peer_of(connection.socket.number())});
}

bool UsbIpServer::handle_transfer(Connection& connection) {
  auto transfer = connection.requests.take_transfer();
  if (!transfer) return false;
  const std::uint32_t session = connection.import->session();
  if (const auto* const unlink = std::get_if<UsbIpRequests::Unlink>(&*transfer)) {
    Urb urb;
    urb.sequence = unlink->sequence;
    connection.import->add_unlink();
    give({Order::Kind::unlink, session, std::move(urb), unlink->unlinked_sequence});
    return true;
  }
  auto& urb = std::get<Urb>(*transfer);
  connection.import->add(urb);
  give({Order::Kind::submit, session, std::move(urb)});
  return true;
}

void UsbIpServer::deliver_results() {
  std::vector<Result> results;
  bool withdrawn = false;
  {
    const std::lock_guard lock(mutex_);
    results.swap(results_);
    withdrawn = std::exchange(withdrawn_, false);
  }
  for (const Result& result : results) {
    const auto importer = std::find_if(connections_.begin(), connections_.end(), [&](const Connection& one) {
      return one.import && one.import->session() == result.session;
    });
    if (importer == connections_.end()) continue;
    if (result.kind == Result::Kind::submitted) {
      importer->import->forget(result.urb.sequence);
      append_submitted(importer->to_send, result.urb, result.status);
    } else {
      importer->import->forget_unlink();
      if (result.status == transfer_status::unlinked) importer->import->forget(result.unlink_sequence);
      append_unlinked(importer->to_send, result.urb.sequence, result.status);
    }
  }
  if (!withdrawn) return;
  for (Connection& importer : connections_) {
    if (!importer.import) continue;
    send(importer);  // as much as possible without waiting
    if (!importer.dead) end(importer);
  }
}

}  // namespace inkwell::virtual_board
