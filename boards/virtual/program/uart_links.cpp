#include "uart_links.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "stream_server.hpp"
#include "terminal_stream.hpp"

namespace inkwell::virtual_board {

UartOption UartOption::of(const std::string& text) {
  const auto wrong = [&] {
    return std::invalid_argument(
        fmt::format("\"{}\" is no UART and its place; write usart1=stdio, usart1=PORT or usart1=PATH, with usart1 to "
                    "usart3, uart4, uart5 or usart6.",
                    text));
  };
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size()) throw wrong();
  const std::string name = text.substr(0, equals), place = text.substr(equals + 1);
  constexpr std::string_view names[] = {"usart1", "usart2", "usart3", "uart4", "uart5", "usart6"};
  const auto* found = std::find(std::begin(names), std::end(names), name);
  if (found == std::end(names)) throw wrong();
  UartOption option;
  option.number = static_cast<unsigned>(found - std::begin(names)) + 1;
  if (place == "stdio") return option;
  const auto* end = place.data() + place.size();
  const auto number = std::from_chars(place.data(), end, option.port);
  option.kind = number.ptr == end ? Kind::port : Kind::path;
  if (option.kind == Kind::port && number.ec != std::errc{}) throw wrong();
  option.path = place;
  return option;
}

UartLinks::UartLinks(const std::vector<UartOption>& options, Chip& chip, const std::function<void()>& on_arrival)
    : chip_(chip) {
  for (const UartOption& option : options) {
    UartLink link{option.number, nullptr, {}, {}};
    if (option.kind == UartOption::Kind::terminal) {
      link.stream = std::make_unique<TerminalStream>(on_arrival);
    } else if (option.kind == UartOption::Kind::path) {
      link.stream = std::make_unique<TerminalStream>(option.path, on_arrival);
    } else {
      auto server = std::make_unique<StreamServer>(option.port, "--uart", on_arrival);
      announcement_ += fmt::format(" uart{}={}", option.number, server->port());
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
    link.arrived += link.stream->take().bytes;
    // A program on the other end cannot know when the firmware has switched its receiver on, so it need not.
    if (chip_.usart_listens(link.number))
      for (const char byte : std::exchange(link.arrived, {}))
        chip_.usart_receive(link.number, static_cast<std::uint8_t>(byte));
    if (!link.to_send.empty()) link.stream->send(std::exchange(link.to_send, {}));
  }
}

}  // namespace inkwell::virtual_board
