#include "usbip_connection.hpp"

#include <array>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "thread_precedence.hpp"

namespace inkwell::device {
namespace {

using namespace std::chrono_literals;

constexpr auto reply_timeout = 3s;

template <class Message>
Message receive(Socket& socket) {
  Message message;
  socket.receive(std::as_writable_bytes(std::span(&message, 1)));
  return message;
}

/// A reply before the import. What is no USB/IP server may wait for something else for ever.
usbip::OperationHeader receive_reply(Socket& socket, usbip::Operation operation) {
  socket.wait_at_most(reply_timeout);
  const auto reply = receive<usbip::OperationHeader>(socket);
  if (reply.version != usbip::protocol_version || reply.operation != operation)
    throw Error(
        "What answers at this port does not speak USB/IP 1.1.1. Give the USB/IP port that virtual-board printed.");
  return reply;
}

}  // namespace

std::vector<UsbipDevice> list_usbip_devices(const std::string& host, std::uint16_t port) {
  Socket socket(host, port);
  socket.send(usbip::bytes_of(usbip::OperationHeader{.operation = usbip::Operation::request_device_list}));
  receive_reply(socket, usbip::Operation::reply_device_list);
  const std::uint32_t count = receive<usbip::Big32>(socket);
  std::vector<UsbipDevice> devices;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto device = receive<usbip::Device>(socket);
    for (int j = 0; j < device.interface_count; ++j) receive<usbip::Interface>(socket);
    devices.push_back(
        {std::string(device.path.view()), std::string(device.bus_id.view()), device.vendor_id, device.product_id});
  }
  return devices;
}

UsbipConnection::UsbipConnection(const std::string& host, std::uint16_t port, const std::string& bus_id,
                                 std::chrono::milliseconds timeout)
    : timeout_(timeout), socket_(host, port) {
  socket_.send(usbip::bytes_of(usbip::ImportRequest{.bus_id = {bus_id}}));
  const auto reply = receive_reply(socket_, usbip::Operation::reply_import);
  if (reply.status != usbip::OperationStatus::success)
    throw Error(
        fmt::format("The device {} at {}:{} cannot be taken: another program uses it, or its cable is out. "
                    "Close the other program.",
                    bus_id, host, port));
  const auto device = receive<usbip::Device>(socket_);
  device_ = usbip::device_of(device.bus_number, device.device_number);
  socket_.wait_at_most(std::nullopt);  // from here on silence is a device with nothing to say
}

UsbipConnection::~UsbipConnection() { close(); }

void UsbipConnection::start(std::function<void(const std::string&)> on_disconnect) {
  on_disconnect_ = std::move(on_disconnect);
  receiver_ = std::thread([this] { receive_answers(); });
}

void UsbipConnection::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  socket_.shut_down();
  if (receiver_.joinable()) receiver_.join();
}

std::uint32_t UsbipConnection::submit(usbip::Direction direction, std::uint8_t endpoint, const Setup* setup,
                                      std::uint32_t length, std::span<const std::byte> data,
                                      OnCompletion on_completion) {
  usbip::Submit message{.length = length};
  message.header.device = device_;
  message.header.direction = direction;
  message.header.endpoint = endpoint & 0x0Fu;
  if (setup != nullptr) std::memcpy(message.setup.data(), setup, sizeof *setup);  // little-endian, as USB is

  const std::lock_guard lock(mutex_);
  if (closed_) throw Disconnected("The device is gone. Connect it again.");
  const std::uint32_t sequence = ++sequence_;
  message.header.sequence = sequence;
  pending_.emplace(sequence, Pending{direction, length, std::move(on_completion)});
  const auto bytes = usbip::bytes_of(message);
  std::vector<std::byte> packet(bytes.begin(), bytes.end());
  packet.insert(packet.end(), data.begin(), data.end());
  socket_.send(packet);
  return sequence;
}

std::uint32_t UsbipConnection::submit_in(std::uint8_t endpoint, std::uint32_t length, OnCompletion on_completion) {
  return submit(usbip::Direction::in, endpoint, nullptr, length, {}, std::move(on_completion));
}

std::uint32_t UsbipConnection::submit_out(std::uint8_t endpoint, std::span<const std::byte> data,
                                          OnCompletion on_completion) {
  return submit(usbip::Direction::out, endpoint, nullptr, static_cast<std::uint32_t>(data.size()), data,
                std::move(on_completion));
}

void UsbipConnection::unlink(std::uint32_t sequence) {
  const std::lock_guard lock(mutex_);
  if (closed_ || pending_.find(sequence) == pending_.end()) return;
  // The server may have sent the answer already, so the transfer stays pending until the unlink is answered.
  usbip::Unlink message{.unlinked_sequence = sequence};
  message.header.sequence = ++sequence_;
  unlinks_.emplace(sequence_, sequence);
  message.header.device = device_;
  socket_.send(usbip::bytes_of(message));
}

UsbipConnection::Completion UsbipConnection::control(usbip::Direction direction, const Setup& setup,
                                                     std::span<const std::byte> data) {
  struct Waiting {
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<Completion> completion;
  };
  const auto waiting = std::make_shared<Waiting>();  // outlives this call if the answer comes after the time-out
  const auto sequence = submit(direction, 0, &setup, setup.length, data, [waiting](Completion completion) {
    const std::lock_guard lock(waiting->mutex);
    waiting->completion = std::move(completion);
    waiting->changed.notify_one();
  });
  std::unique_lock lock(waiting->mutex);
  if (!waiting->changed.wait_for(lock, timeout_, [&] { return waiting->completion.has_value(); })) {
    lock.unlock();
    unlink(sequence);
    throw Error(
        fmt::format("The device did not answer a request in {} s. Reset the board, or let a paused virtual board run.",
                    std::chrono::duration<double>(timeout_).count()));
  }
  Completion completion = std::move(*waiting->completion);
  if (completion.status == -EPIPE)
    throw Stalled("The device refused a USB request. Flash the firmware that belongs to this companion.");
  if (completion.status != 0) throw Disconnected("The device was unplugged. Connect it again.");
  return completion;
}

std::vector<std::byte> UsbipConnection::control_in(const Setup& setup) {
  return control(usbip::Direction::in, setup, {}).data;
}

void UsbipConnection::control_out(const Setup& setup, std::span<const std::byte> data) {
  control(usbip::Direction::out, setup, data);
}

void UsbipConnection::receive_answers() {
  ask_for_precedence();
  std::string reason;
  try {
    for (;;) receive_answer();
  } catch (const Error& error) {
    reason = error.what();
  }
  std::unordered_map<std::uint32_t, Pending> abandoned;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    abandoned.swap(pending_);
  }
  on_disconnect_(reason);
  for (auto& [sequence, pending] : abandoned) pending.on_completion({-ENODEV, 0, {}});
}

void UsbipConnection::receive_answer() {
  const auto answer = receive<usbip::ReturnSubmit>(socket_);
  const std::uint32_t sequence = answer.header.sequence;
  if (answer.header.command == usbip::Command::return_unlink) {
    OnCompletion on_completion;
    {
      const std::lock_guard lock(mutex_);
      const auto unlinked = unlinks_.extract(sequence);
      const auto taken_back = unlinked ? pending_.extract(unlinked.mapped()) : decltype(pending_)::node_type{};
      if (taken_back) on_completion = std::move(taken_back.mapped().on_completion);
    }
    if (on_completion) on_completion({-ECONNRESET, 0, {}});
    return;
  }
  if (answer.header.command != usbip::Command::return_submit)
    throw Disconnected("The USB/IP server sent a message that is not of the protocol. Start the board again.");
  Pending pending;
  {
    const std::lock_guard lock(mutex_);
    const auto found = pending_.find(sequence);
    if (found == pending_.end() || answer.actual_length > found->second.length)
      throw Disconnected("The USB/IP server answered a transfer that was not asked for. Start the board again.");
    pending = std::move(found->second);
    pending_.erase(found);
  }
  Completion completion{answer.status, answer.actual_length, {}};
  if (pending.direction == usbip::Direction::in) {
    completion.data.resize(answer.actual_length);
    socket_.receive(completion.data);
  }
  pending.on_completion(std::move(completion));
}

}  // namespace inkwell::device
