// Sends bytes received on USART1 back, with letters in upper case, at 115200 baud.
#include "tests/boards/stm32f405/firmware/support.hpp"

void run() {
  constexpr std::uint32_t usart1 = 0x40011000, status = usart1, data = usart1 + 4;
  word(rcc::apb2enr) |= 1 << 4;
  [[maybe_unused]] const std::uint32_t arrived = word(rcc::apb2enr);
  word(rcc::ahb1enr) |= 1;
  [[maybe_unused]] const std::uint32_t port_arrived = word(rcc::ahb1enr);
  gpio::alternate(gpio::a, 9, 7);
  word(usart1 + 0x08) = 139;
  word(usart1 + 0x0C) = 1 << 13 | 1 << 3 | 1 << 2;
  for (;;) {
    while ((word(status) & 1 << 5) == 0) {
    }
    const std::uint32_t byte = word(data);
    while ((word(status) & 1 << 7) == 0) {
    }
    word(data) = byte >= 'a' && byte <= 'z' ? byte - 32 : byte;
  }
}
