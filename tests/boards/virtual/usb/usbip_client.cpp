#include "usbip_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace inkwell::virtual_usb_test {

LiveBoard::LiveBoard() : usb({scheduler, interrupts, log, log, state}, 0, [] {}), firmware(usb.core(), scheduler) {
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
  const timeval limit{5, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
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

namespace {
void append_32(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(std::byte(value >> shift & 0xFF));
}
}  // namespace

void UsbIpClient::send_operation(std::uint16_t code, std::uint16_t version) {
  Bytes bytes;
  append_32(bytes, std::uint32_t{version} << 16 | code);
  append_32(bytes, 0);
  send(bytes);
}

std::uint32_t UsbIpClient::import(const std::string& bus_id) {
  send_operation(0x8003);
  Bytes name(32);
  std::transform(bus_id.begin(), bus_id.end(), name.begin(), [](char c) { return std::byte(c); });
  send(name);
  const Bytes header = receive(8);
  if (header.size() != 8 || read_32(header, 0) != 0x0111'0003) throw std::runtime_error("no reply to the import");
  const std::uint32_t status = read_32(header, 4);
  if (status == 0 && receive(312).size() != 312) throw std::runtime_error("the reply to the import is cut off");
  return status;
}

void UsbIpClient::send_header(const std::array<std::uint32_t, 10>& words, std::array<std::uint8_t, 8> setup) {
  Bytes bytes;
  for (const std::uint32_t word : words) append_32(bytes, word);
  for (const std::uint8_t byte : setup) bytes.push_back(std::byte(byte));
  send(bytes);
}

void UsbIpClient::submit(std::uint32_t sequence, unsigned endpoint, bool in, std::uint32_t length, Bytes out_data,
                         std::array<std::uint8_t, 8> setup) {
  send_header({1, sequence, 0x0001'0002, in ? 1u : 0u, endpoint, 0, length, 0, 0xFFFF'FFFF, 0}, setup);
  send(out_data);
}

void UsbIpClient::unlink(std::uint32_t sequence, std::uint32_t victim) {
  send_header({2, sequence, 0x0001'0002, 0, 0, victim, 0, 0, 0, 0});
}

Reply UsbIpClient::read_reply() {
  const Bytes header = receive(48);
  if (header.size() != 48) return {};
  return {read_32(header, 0), read_32(header, 4), static_cast<std::int32_t>(read_32(header, 20)), read_32(header, 24)};
}

std::uint32_t read_32(std::span<const std::byte> bytes, std::size_t at) {
  return read_16(bytes, at) << 16 | read_16(bytes, at + 2);
}
std::uint32_t read_16(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<std::uint32_t>(bytes[at]) << 8 | std::to_integer<std::uint32_t>(bytes[at + 1]);
}

}  // namespace inkwell::virtual_usb_test
