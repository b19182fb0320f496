// A minimal USB/IP client, and a board in a separate thread.
#pragma once

#include <cstdint>
#include <future>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "boards/virtual/usb/virtual_usb.hpp"
#include "protocol/usbip/messages.hpp"

#include "tests/boards/virtual/usb/fake_board.hpp"
#include "tests/boards/virtual/usb/fake_firmware.hpp"

namespace inkwell::virtual_usb_test {

/// The board's thread advances board time as fast as possible, unless the board is paused.
class LiveBoard {
 public:
  explicit LiveBoard(const local::SocketAddress& where = {});  ///< any free port
  ~LiveBoard();

  /// Runs `action` between two milliseconds of board time, in the board's thread.
  void call(std::function<void()> action);
  void pause(bool paused) {
    call([&] { paused_ = paused; });
  }
  /// Returns false if the device is not enumerated in time.
  bool wait_until_enumerated();

  std::atomic<bool> is_ending = false;  ///< the result of `is_ending()` of the board
  FakeScheduler scheduler;
  FakeInterrupts interrupts;
  FakeLog log;
  FakeChipState state;
  FakeTriggers triggers;
  virtual_board::VirtualUsb usb;
  FakeFirmware firmware;

 private:
  void run();

  bool paused_ = false;
  bool stop_ = false;
  std::mutex mutex_;
  std::vector<std::pair<std::function<void()>*, std::promise<void>*>> calls_;
  std::thread thread_;
};

/// Identifier of the exported device in the server.
inline constexpr std::uint32_t exported_device = usbip::device_of(1, 2);

class UsbIpClient {
 public:
  explicit UsbIpClient(std::uint16_t port);
  ~UsbIpClient();

  void send(std::span<const std::byte> bytes);
  /// Returns fewer bytes if the server closes the connection or sends nothing for one minute.
  Bytes receive(std::size_t length);
  template <class Message>
  Message receive() {
    const Bytes bytes = receive(sizeof(Message));
    return bytes.size() == sizeof(Message) ? usbip::read<Message>(bytes) : Message{};
  }
  /// Returns true if the server closed the connection without sending a byte.
  bool closed() { return receive(1).empty() && closed_; }

  void ask_for_list();
  usbip::OperationStatus import(const std::string& bus_id = "1-1");

  void submit(std::uint32_t sequence, unsigned endpoint, bool in, std::uint32_t length, Bytes out_data = {},
              std::array<std::uint8_t, 8> setup = {});
  void unlink(std::uint32_t sequence, std::uint32_t victim);
  /// Returns the header of an answer to `submit`, or zeros if no answer arrived.
  usbip::ReturnSubmit read_reply() { return receive<usbip::ReturnSubmit>(); }

 private:
  int socket_;
  bool closed_ = false;
};

}  // namespace inkwell::virtual_usb_test
