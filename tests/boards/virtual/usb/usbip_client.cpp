#include "tests/boards/virtual/usb/usbip_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <stdexcept>

namespace inkwell::virtual_usb_test {

LiveBoard::LiveBoard(const local::SocketAddress& where)
    : usb(
          {scheduler, interrupts, log, log, state, triggers}, where, 0.0, [] {}, [this] { return is_ending.load(); }),
      firmware(usb.connector().core(), scheduler) {
  firmware.start();
  thread_ = std::thread([this] { run(); });
}

LiveBoard::~LiveBoard() {
  call([this] { stop_ = true; });
  thread_.join();
}

void LiveBoard::call(std::function<void()> action) {
  std::promise<void> done;
  {
    const std::lock_guard lock(mutex_);
    calls_.emplace_back(&action, &done);
  }
  done.get_future().wait();
}

void LiveBoard::run() {
  while (!stop_) {
    decltype(calls_) calls;
    {
      const std::lock_guard lock(mutex_);
      calls.swap(calls_);
    }
    for (auto& [action, done] : calls) {
      (*action)();
      done->set_value();
    }
    if (paused_) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      continue;
    }
    usb.serve();
    const Ticks end = scheduler.now() + virtual_board::ticks(0.001);
    while (scheduler.run_one(end))
      for (int i = 0; interrupts.asserted() && i < 20; ++i) firmware.handle_interrupt();
    scheduler.pass_until(end);
    std::this_thread::yield();
  }
}

bool LiveBoard::wait_until_enumerated() {
  for (int i = 0; i < 10'000; ++i) {
    bool enumerated = false;
    call([&] { enumerated = usb.enumerated() && !usb.imported(); });
    if (enumerated) return true;
  }
  return false;
}

UsbIpClient::UsbIpClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval limit{60, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  const int yes = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);  // settle() requires immediate transmission
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("the server does not listen");
}

UsbIpClient::~UsbIpClient() { ::close(socket_); }

void UsbIpClient::send(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

Bytes UsbIpClient::receive(std::size_t length) {
  Bytes bytes(length);
  std::size_t received = 0;
  while (received < length) {
    const ssize_t count = ::recv(socket_, bytes.data() + received, length - received, 0);
    if (count <= 0) {
      closed_ = count == 0 || errno == ECONNRESET;
      break;
    }
    received += static_cast<std::size_t>(count);
  }
  bytes.resize(received);
  return bytes;
}

void UsbIpClient::ask_for_list() {
  send(usbip::bytes_of(usbip::OperationHeader{.operation = usbip::Operation::request_device_list}));
}

usbip::OperationStatus UsbIpClient::import(const std::string& bus_id) {
  send(usbip::bytes_of(usbip::ImportRequest{.bus_id = {bus_id}}));
  const auto reply = receive<usbip::OperationHeader>();
  if (reply.operation != usbip::Operation::reply_import) throw std::runtime_error("no reply to the import");
  if (reply.status == usbip::OperationStatus::success && receive(sizeof(usbip::Device)).size() != sizeof(usbip::Device))
    throw std::runtime_error("the reply to the import is cut off");
  return reply.status;
}

void UsbIpClient::submit(std::uint32_t sequence, unsigned endpoint, bool in, std::uint32_t length, Bytes out_data,
                         std::array<std::uint8_t, 8> setup) {
  usbip::Submit submit{.length = length, .packet_count = usbip::not_isochronous};
  submit.header.sequence = sequence;
  submit.header.device = exported_device;
  submit.header.direction = in ? usbip::Direction::in : usbip::Direction::out;
  submit.header.endpoint = endpoint;
  std::memcpy(submit.setup.data(), setup.data(), setup.size());
  send(usbip::bytes_of(submit));
  send(out_data);
}

void UsbIpClient::unlink(std::uint32_t sequence, std::uint32_t victim) {
  usbip::Unlink unlink{.unlinked_sequence = victim};
  unlink.header.sequence = sequence;
  unlink.header.device = exported_device;
  send(usbip::bytes_of(unlink));
}

}  // namespace inkwell::virtual_usb_test
