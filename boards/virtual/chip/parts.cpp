#include "parts.hpp"

#include <cstring>

namespace inkwell::virtual_board {
namespace {

/// Reset register that belongs to an enable register: 0x20 before it (RM0090, "RCC register map").
constexpr std::uint32_t reset_register_of(std::uint32_t enable_register) { return enable_register - 0x20; }

struct Place {
  std::uint32_t base;
  std::uint32_t enable_register;
  unsigned enable_bit;
};
constexpr Place timer_places[14] = {
    {0x4001'0000, Rcc::apb2enr, 0},  {0x4000'0000, Rcc::apb1enr, 0},  {0x4000'0400, Rcc::apb1enr, 1},
    {0x4000'0800, Rcc::apb1enr, 2},  {0x4000'0C00, Rcc::apb1enr, 3},  {0x4000'1000, Rcc::apb1enr, 4},
    {0x4000'1400, Rcc::apb1enr, 5},  {0x4001'0400, Rcc::apb2enr, 1},  {0x4001'4000, Rcc::apb2enr, 16},
    {0x4001'4400, Rcc::apb2enr, 17}, {0x4001'4800, Rcc::apb2enr, 18}, {0x4000'1800, Rcc::apb1enr, 6},
    {0x4000'1C00, Rcc::apb1enr, 7},  {0x4000'2000, Rcc::apb1enr, 8},
};
struct UsartPlace {
  Place place;
  unsigned position;
};
constexpr UsartPlace usart_places[6] = {
    {{0x4001'1000, Rcc::apb2enr, 4}, 37},  {{0x4000'4400, Rcc::apb1enr, 17}, 38}, {{0x4000'4800, Rcc::apb1enr, 18}, 39},
    {{0x4000'4C00, Rcc::apb1enr, 19}, 52}, {{0x4000'5000, Rcc::apb1enr, 20}, 53}, {{0x4001'1400, Rcc::apb2enr, 5}, 71},
};
/// Enable bits of blocks that come from outside of this library.
constexpr Place outside_places[] = {
    {0x5000'0000, Rcc::ahb2enr, 7},  {0x5005'0000, Rcc::ahb2enr, 0},  {0x4000'3800, Rcc::apb1enr, 14},
    {0x4000'3C00, Rcc::apb1enr, 15}, {0x4001'3000, Rcc::apb2enr, 12}, {0x4000'5400, Rcc::apb1enr, 21},
    {0x4000'5800, Rcc::apb1enr, 22}, {0x4000'5C00, Rcc::apb1enr, 23}, {0x4000'6400, Rcc::apb1enr, 25},
    {0x4000'6800, Rcc::apb1enr, 26}, {0x4000'7400, Rcc::apb1enr, 29}};

}  // namespace

void ChipParts::put(std::uint32_t base, const std::string& name, Peripheral& peripheral, std::uint32_t enable_register,
                    unsigned enable_bit) {
  const std::uint32_t mask = 1u << enable_bit;
  bus.add(base, 1024, name, peripheral, rcc.enable_register(enable_register), mask);
  rcc.add_reset(reset_register_of(enable_register), mask, peripheral);
}

ChipParts::ChipParts(Circuit& circuit, const ChipOptions& options) : machine(circuit, options) {
  machine.processor = &processor;
  for (unsigned i = 0; i < 6; ++i)
    usarts.emplace_back(machine, i + 1, usart_places[i].position,
                        usart_places[i].place.enable_register == Rcc::apb2enr);
  for (unsigned number : {1u, 2u})
    dma.controller(number).on_enabled = [this] {
      for (auto& usart : usarts) usart.serve_dma();
    };

  // The tree of clocks first: the others count its cycles.
  bus.add(0x4002'3800, 1024, "RCC", rcc);
  bus.add(0x4002'3C00, 1024, "FLASH", flash);
  bus.add(0x4001'3C00, 1024, "EXTI", exti);
  put(0x4001'3800, "SYSCFG", exti.syscfg(), Rcc::apb2enr, 14);
  put(0x4000'7000, "PWR", power, Rcc::apb1enr, 28);
  put(0x4002'3000, "CRC", crc, Rcc::ahb1enr, 12);
  put(0x5006'0800, "RNG", random_numbers, Rcc::ahb2enr, 6);
  bus.add(0x4000'3000, 1024, "IWDG", independent_watchdog);
  put(0x4000'2C00, "WWDG", window_watchdog, Rcc::apb1enr, 11);
  for (unsigned i = 0; i < 14; ++i)
    put(timer_places[i].base, "TIM" + std::to_string(i + 1), timers.timer(i + 1), timer_places[i].enable_register,
        timer_places[i].enable_bit);
  // The three converters share a block; each has an enable bit, one bit resets them all.
  bus.add(0x4001'2000, 1024, "ADC", adcs, rcc.enable_register(Rcc::apb2enr), 7u << 8);
  rcc.add_reset(Rcc::apb2rstr, 1u << 8, adcs);
  put(0x4002'6000, "DMA1", dma.controller(1), Rcc::ahb1enr, 21);
  put(0x4002'6400, "DMA2", dma.controller(2), Rcc::ahb1enr, 22);
  for (unsigned i = 0; i < 6; ++i)
    put(usart_places[i].place.base, "USART" + std::to_string(i + 1), usarts[i], usart_places[i].place.enable_register,
        usart_places[i].place.enable_bit);
  for (unsigned i = 0; i < Pins::ports; ++i)
    put(0x4002'0000 + 0x400 * i, "GPIO" + std::string(1, static_cast<char>('A' + i)), pins.port(i), Rcc::ahb1enr, i);

  // Electronic signature (RM0090, "Device electronic signature"), option bytes at their factory values.
  std::uint8_t* system = machine.memory.system();
  std::memcpy(system + 0x7A10, options.unique_id.data(), 12);
  const std::uint16_t flash_kilobytes = flash_bytes / 1024;
  std::memcpy(system + 0x7A22, &flash_kilobytes, 2);
}

void ChipParts::add_outside_peripheral(std::uint32_t base, std::uint32_t size, const std::string& name,
                                       Peripheral& peripheral) {
  for (const auto& place : outside_places)
    if (place.base == base) {
      bus.add(base, size, name, peripheral, rcc.enable_register(place.enable_register), 1u << place.enable_bit);
      rcc.add_reset(reset_register_of(place.enable_register), 1u << place.enable_bit, peripheral);
      return;
    }
  bus.add(base, size, name, peripheral);
}

}  // namespace inkwell::virtual_board
