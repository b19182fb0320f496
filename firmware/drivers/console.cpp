#include "firmware/drivers/console.hpp"

#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/drivers/peripheral_clocks.hpp"
#include "firmware/drivers/pins.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {
namespace {

using USART2 = RegistersOf<Console, registers::USART2>;

constexpr std::uint32_t baud_Hz = 115'200;
/// Time limit per character, equal to the duration of two characters. The limit prevents a failed serial port from
/// blocking the board.
constexpr std::uint32_t character_cycles = 2 * 10 * (board::processor_Hz / baud_Hz);

void write_character(char character) {
  if (!wait_for(character_cycles, [] { return USART2::SR::TXE::is_set(); })) return;
  USART2::DR::write(static_cast<std::uint8_t>(character));
}

}  // namespace

void Console::start(std::uint32_t bus_Hz) {
  start_clocks_of<Console, registers::USART2>();
  connect<Console, board::facts.console_transmit>(Pull::up, Speed::low);
  USART2::BRR::write((bus_Hz + baud_Hz / 2) / baud_Hz);
  USART2::CR1::write(USART2::CR1::UE(1), USART2::CR1::TE(1));
}

void Console::write(std::string_view text) {
  for (const char character : text) write_character(character);
}

void Console::write_hexadecimal(std::uint32_t word) {
  for (int shift = 28; shift >= 0; shift -= 4) write_character("0123456789abcdef"[word >> shift & 0xF]);
}

}  // namespace inkwell::drivers
