#include "boards/virtual/program/uart_links.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "boards/virtual/program/stream_server.hpp"

#include "boards/virtual/program/terminal_stream.hpp"

namespace inkwell::virtual_board {
namespace {

/// Largest queue length in bytes before the firmware enables the receiver.
constexpr std::size_t kept_maximum = 4096;
/// Largest queue length in the UART model in bytes. The fastest UART receives fewer bytes between two calls of serve().
constexpr std::size_t line_maximum = 4096;

bool may_be_anything(std::string_view) { return true; }

}  // namespace

UartOption UartOption::of(const std::string& text) {
  const auto wrong = [&] {
    return std::invalid_argument(
        fmt::format("\"{}\" is not a UART with an address. Write usart1=stdio, usart1=PORT, usart1=unix:PATH or "
                    "usart1=PATH, with usart1 to usart3, uart4, uart5 or usart6.",
                    text));
  };
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size()) throw wrong();
  const std::string name = text.substr(0, equals), target = text.substr(equals + 1);
  constexpr std::string_view names[] = {"usart1", "usart2", "usart3", "uart4", "uart5", "usart6"};
  const auto* found = std::find(std::begin(names), std::end(names), name);
  if (found == std::end(names)) throw wrong();
  UartOption option;
  option.number = static_cast<unsigned>(found - std::begin(names)) + 1;
  if (target == "stdio") return option;
  const bool is_number = target.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number && !target.starts_with(local::unix_scheme)) {
    option.kind = Kind::path;
    option.path = target;
    return option;
  }
  option.kind = Kind::socket;
  try {
    option.socket = PortOption::of(target);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", text, error.what()));
  }
  return option;
}

UartLinks::UartLinks(const std::vector<UartOption>& options, Chip& chip, PrivateSockets& sockets,
                     const std::function<void()>& on_arrival)
    : chip_(chip) {
  for (const UartOption& option : options) {
    UartLink link{option.number, nullptr, {}, {}};
    if (option.kind == UartOption::Kind::terminal) {
      link.stream = std::make_unique<TerminalStream>(on_arrival);
    } else if (option.kind == UartOption::Kind::path) {
      link.stream = std::make_unique<TerminalStream>(option.path, on_arrival);
    } else {
      const std::string name = fmt::format("uart{}", option.number);
      const local::SocketAddress where = sockets.address_of(option.socket, name);
      // Only TCP clients are checked, because a browser cannot connect to a Unix socket.
      const FirstBytes welcome = where.is_unix() ? &may_be_anything : &may_be_terminal;
      auto server = std::make_unique<StreamServer>(where, "--uart", welcome, on_arrival);
      announcement_ += fmt::format(" {}={}", name, announced(server->address()));
      link.stream = std::move(server);
    }
    links_.push_back(std::move(link));
  }
  if (links_.empty()) return;
  chip_.on_usart = [this](unsigned number, std::uint8_t byte) {
    for (UartLink& link : links_)
      if (link.number == number) link.to_send += static_cast<char>(byte);
  };
}

void UartLinks::serve() {
  for (UartLink& link : links_) {
    if (link.arrived.size() < kept_maximum) link.arrived += link.stream->take().bytes;
    // Bytes are queued until the firmware enables the receiver.
    if (chip_.usart_listens(link.number)) {
      const std::size_t room = line_maximum - std::min(chip_.usart_waiting(link.number), line_maximum);
      const std::size_t count = std::min(link.arrived.size(), room);
      for (const char byte : link.arrived.substr(0, count))
        chip_.usart_receive(link.number, static_cast<std::uint8_t>(byte));
      link.arrived.erase(0, count);
    }
    if (!link.to_send.empty()) link.stream->send(std::exchange(link.to_send, {}));
  }
}

}  // namespace inkwell::virtual_board
