// Connects the UARTs of the chip to terminals and sockets.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "boards/stm32f405/wiring/chip.hpp"

#include "boards/virtual/program/byte_stream.hpp"

#include "boards/virtual/program/port_option.hpp"

namespace inkwell::virtual_board {

/// Destination of a UART.
struct UartOption {
  unsigned number = 0;  ///< 1 to 6
  enum class Kind : std::uint8_t { terminal, socket, path } kind = Kind::terminal;
  PortOption socket;
  std::filesystem::path path;
  /// Parses a text such as usart1=stdio, uart4=5000, uart5=unix:PATH or usart3=PATH. Throws std::invalid_argument with
  /// an error sentence.
  static UartOption of(const std::string& text);
};

class UartLinks {
 public:
  /// Throws std::runtime_error with an error sentence if a link cannot be created. `on_arrival`: see StreamServer.
  UartLinks(const std::vector<UartOption>& options, Chip& chip, PrivateSockets& sockets,
            const std::function<void()>& on_arrival);
  /// Returns the text for the line "ready ...": " uart1=PORT" or " uart1=unix:PATH" for each listening UART.
  const std::string& announcement() const { return announcement_; }
  /// Transfers bytes in both directions. Call this between two slices of board time.
  void serve();

 private:
  struct UartLink {
    unsigned number;
    std::unique_ptr<ByteStream> stream;
    std::string to_send;
    std::string arrived;  ///< received before the receiver was enabled
  };
  Chip& chip_;
  std::vector<UartLink> links_;
  std::string announcement_;
};

}  // namespace inkwell::virtual_board
