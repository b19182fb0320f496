#include "host/client/device/usbip_connection.hpp"

#include <array>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/thread_precedence.hpp"

namespace inkwell::device {
namespace {

using namespace std::chrono_literals;

/// A peer that is not a USB/IP server may never answer.
constexpr auto reply_timeout = 3s;

ReceiveBytes from(Socket& socket) {
  return [&socket](std::span<std::byte> bytes) { socket.receive(bytes); };
}

}  // namespace

std::vector<UsbipDevice> list_usbip_devices(const SocketAddress& server) {
  Socket socket(server);
  socket.send(usbip::bytes_of(usbip::OperationHeader{.operation = usbip::Operation::request_device_list}));
  socket.wait_at_most(reply_timeout);
  return receive_device_list(from(socket));
}

UsbipConnection::UsbipConnection(const SocketAddress& server, const std::string& bus_id,
                                 std::chrono::milliseconds timeout)
    : timeout_(timeout),
      gone_(fmt::format("The arm at {} was disconnected: its board has exited or restarted, or its cable was "
                        "unplugged. Start the board, or plug the cable in and clear the fault of the board.",
                        server.text())),
      socket_(server) {
  socket_.send(usbip::bytes_of(usbip::ImportRequest{.bus_id = {bus_id}}));
  socket_.wait_at_most(reply_timeout);
  const auto device = receive_import(from(socket_));
  if (!device)
    throw Error(
        fmt::format("The device {} at {} is not available: another program uses it, or its cable is unplugged. Close "
                    "the other program, or plug the cable in.",
                    bus_id, server.text()));
  device_ = *device;
  socket_.wait_at_most(std::nullopt);  // an imported device may send no data for a long time
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
  if (setup != nullptr) std::memcpy(message.setup.data(), setup, sizeof *setup);  // setup packets are little-endian

  const std::lock_guard lock(mutex_);
  if (closed_) throw Disconnected("The device was disconnected. Connect the device again.");
  const std::uint32_t sequence = ++sequence_;
  message.header.sequence = sequence;
  open_.add(sequence, {direction, length, std::move(on_completion)});
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
  if (closed_ || !open_.contains(sequence)) return;
  usbip::Unlink message{.unlinked_sequence = sequence};
  message.header.sequence = ++sequence_;
  open_.unlink(sequence_, sequence);
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
  const auto waiting = std::make_shared<Waiting>();  // outlives this call after a time-out
  const auto sequence = submit(direction, 0, &setup, setup.length, data, [waiting](Completion completion) {
    const std::lock_guard lock(waiting->mutex);
    waiting->completion = std::move(completion);
    waiting->changed.notify_one();
  });
  const auto is_over = [&] { return waiting->completion.has_value(); };
  const auto is_over_in_turn = [&] {
    const std::lock_guard lock(waiting->mutex);
    return is_over();
  };
  const auto wait = [&] {
    if (lock_step_ != nullptr && lock_step_->is_in_step()) return lock_step_->wait(is_over_in_turn, timeout_);
    std::unique_lock lock(waiting->mutex);
    return waiting->changed.wait_for(lock, timeout_, is_over);
  };
  if (!wait()) {
    unlink(sequence);
    throw Error(
        fmt::format("The device did not answer a request in {} s. Reset the board, or let a paused virtual board run.",
                    std::chrono::duration<double>(timeout_).count()));
  }
  Completion completion = std::move(*waiting->completion);
  if (completion.status == -EPIPE)
    throw Stalled("The device refused a USB request. Flash the firmware that belongs to this companion.");
  if (completion.status != 0) throw Disconnected("The device was unplugged. Connect the device again.");
  return completion;
}

std::vector<std::byte> UsbipConnection::control_in(const Setup& setup) {
  return control(usbip::Direction::in, setup, {}).data;
}

void UsbipConnection::control_out(const Setup& setup, std::span<const std::byte> data) {
  control(usbip::Direction::out, setup, data);
}

void UsbipConnection::receive_answers() {
  request_priority();
  std::string reason;
  try {
    for (;;) receive_answer();
  } catch (const Error& error) {
    reason = error.what();
  }
  std::vector<UsbipTransfer> abandoned;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    abandoned = open_.take_all();
  }
  on_disconnect_(reason);
  for (const auto& transfer : abandoned) transfer.on_completion({-ENODEV, 0, {}});
}

/// The server closes the connection when the device disappears or the server exits.
void UsbipConnection::receive(std::span<std::byte> bytes) {
  try {
    socket_.receive(bytes);
  } catch (const Disconnected&) {
    throw Disconnected(gone_);
  }
}

void UsbipConnection::receive_answer() {
  const auto answer = receive_message<usbip::ReturnSubmit>([this](std::span<std::byte> bytes) { receive(bytes); });
  // The transfer stays open until its answer is complete. If the connection fails earlier, the waiting call also fails.
  std::vector<std::byte> data;
  {
    const std::lock_guard lock(mutex_);
    data.resize(open_.data_length_of(answer));
  }
  receive(data);
  std::optional<OpenTransfers::Ended> ended;
  {
    const std::lock_guard lock(mutex_);
    ended = open_.take(answer, std::move(data));
  }
  if (ended) ended->on_completion(std::move(ended->completion));
}

}  // namespace inkwell::device
