// The registers of the memory protection unit, read and written as an operating system would.
#include "tests/boards/stm32f405/firmware/support.hpp"

void run() {
  constexpr std::uint32_t type = 0xE000ED90, control = type + 4, number = type + 8, base = type + 0xC,
                          attributes = type + 0x10, second_base = type + 0x14, second_attributes = type + 0x18;
  results[1] = word(type);
  word(number) = 3;
  word(base) = 0x20000000;
  word(attributes) = 0x03060021;
  word(second_base) = 0x08000000 | 1 << 4 | 5;  // VALID: selects region 5
  word(second_attributes) = 0x06020027;
  results[2] = word(number);
  results[3] = word(base);
  word(number) = 3;
  results[4] = word(base);
  results[5] = word(attributes);
  results[6] = word(control);
  word(control) = 5;
  results[7] = word(control);
  results[0] = finished;
}
