#include "boards/stm32f405/wiring/parts.hpp"

#include <cstdio>
#include <cstring>

#include "boards/stm32f405/peripherals/can.hpp"
#include "boards/stm32f405/peripherals/crc.hpp"
#include "boards/stm32f405/peripherals/dac.hpp"
#include "boards/stm32f405/peripherals/i2c.hpp"
#include "boards/stm32f405/peripherals/random_numbers.hpp"
#include "boards/stm32f405/peripherals/rtc.hpp"
#include "boards/stm32f405/peripherals/watchdogs.hpp"
#include "boards/stm32f405/wiring/boot_loader.hpp"

namespace inkwell::virtual_board {
namespace {

template <class EnableRegister>
constexpr ClockGate gate(const EnableRegister& enable, const Field& field, unsigned index = 0) {
  return {enable, field.mask(index)};
}

/// Returns the reset register that belongs to an enable register (RM0090, "RCC register map").
constexpr std::uint32_t reset_register_of(std::uint32_t enable_register) {
  return enable_register - (rcc_map.ahb1enr - rcc_map.ahb1rstr);
}

struct BusSlot {
  std::uint32_t base;
  ClockGate clock;
};
constexpr BusSlot timer_slots[14] = {
    {0x4001'0000, gate(rcc_map.apb2enr, rcc_map.apb2enr.tim1en)},
    {0x4000'0000, gate(rcc_map.apb1enr, rcc_map.apb1enr.tim2en)},
    {0x4000'0400, gate(rcc_map.apb1enr, rcc_map.apb1enr.tim3en)},
    {0x4000'0800, gate(rcc_map.apb1enr, rcc_map.apb1enr.tim4en)},
    {0x4000'0C00, gate(rcc_map.apb1enr, rcc_map.apb1enr.tim5en)},
    {0x4000'1000, gate(rcc_map.apb1enr, rcc_map.apb1enr.tim6en)},
    {0x4000'1400, gate(rcc_map.apb1enr, rcc_map.apb1enr.tim7en)},
    {0x4001'0400, gate(rcc_map.apb2enr, rcc_map.apb2enr.tim8en)},
    {0x4001'4000, gate(rcc_map.apb2enr, rcc_map.apb2enr.tim9en)},
    {0x4001'4400, gate(rcc_map.apb2enr, rcc_map.apb2enr.tim10en)},
    {0x4001'4800, gate(rcc_map.apb2enr, rcc_map.apb2enr.tim11en)},
    {0x4000'1800, gate(rcc_map.apb1enr, rcc_map.apb1enr.tim12en)},
    {0x4000'1C00, gate(rcc_map.apb1enr, rcc_map.apb1enr.tim13en)},
    {0x4000'2000, gate(rcc_map.apb1enr, rcc_map.apb1enr.tim14en)},
};
struct UsartInstance {
  const char* name;
  BusSlot slot;
  unsigned position;  ///< in the vector table
};
constexpr UsartInstance usart_instances[6] = {
    {"USART1", {0x4001'1000, gate(rcc_map.apb2enr, rcc_map.apb2enr.usart1en)}, 37},
    {"USART2", {0x4000'4400, gate(rcc_map.apb1enr, rcc_map.apb1enr.usart2en)}, 38},
    {"USART3", {0x4000'4800, gate(rcc_map.apb1enr, rcc_map.apb1enr.usart3en)}, 39},
    {"UART4", {0x4000'4C00, gate(rcc_map.apb1enr, rcc_map.apb1enr.uart4en)}, 52},
    {"UART5", {0x4000'5000, gate(rcc_map.apb1enr, rcc_map.apb1enr.uart5en)}, 53},
    {"USART6", {0x4001'1400, gate(rcc_map.apb2enr, rcc_map.apb2enr.usart6en)}, 71},
};
struct InstanceWithInterrupt {
  BusSlot slot;
  unsigned position;  ///< vector table position of the first interrupt
};
constexpr InstanceWithInterrupt spi_instances[3] = {{{0x4001'3000, gate(rcc_map.apb2enr, rcc_map.apb2enr.spi1en)}, 35},
                                                    {{0x4000'3800, gate(rcc_map.apb1enr, rcc_map.apb1enr.spi2en)}, 36},
                                                    {{0x4000'3C00, gate(rcc_map.apb1enr, rcc_map.apb1enr.spi3en)}, 51}};
constexpr InstanceWithInterrupt i2c_instances[3] = {
    {{0x4000'5400, gate(rcc_map.apb1enr, rcc_map.apb1enr.i2cen, 0)}, 31},
    {{0x4000'5800, gate(rcc_map.apb1enr, rcc_map.apb1enr.i2cen, 1)}, 33},
    {{0x4000'5C00, gate(rcc_map.apb1enr, rcc_map.apb1enr.i2cen, 2)}, 72}};
constexpr InstanceWithInterrupt can_instances[2] = {
    {{0x4000'6400, gate(rcc_map.apb1enr, rcc_map.apb1enr.canen, 0)}, 19},
    {{0x4000'6800, gate(rcc_map.apb1enr, rcc_map.apb1enr.canen, 1)}, 63}};
/// Clocks of peripherals that are defined outside of this library.
constexpr BusSlot outside_slots[] = {
    {0x5000'0000, gate(rcc_map.ahb2enr, rcc_map.ahb2enr.otgfsen)},
    {0x5005'0000, gate(rcc_map.ahb2enr, rcc_map.ahb2enr.dcmien)},
};

}  // namespace

void ChipParts::put(std::uint32_t base, const std::string& name, Peripheral& peripheral) {
  bus.add(base, 1024, name, peripheral);
}

void ChipParts::put(std::uint32_t base, const std::string& name, Peripheral& peripheral, ClockGate clock) {
  bus.add(base, 1024, name, peripheral, rcc.enable_register(clock.enable_register), clock.mask);
  rcc.add_reset(reset_register_of(clock.enable_register), clock.mask, peripheral);
}

ChipParts::ChipParts(Circuit& circuit, const ChipOptions& options) : machine(circuit, options, memory, *this) {
  machine.log.code = [this] {
    const std::uint32_t address = processor.code_address();
    char text[64];
    std::snprintf(text, sizeof text, "by the code %s 0x%08X",
                  machine.options.mode == Mode::exact ? "at" : "that begins at", static_cast<unsigned>(address));
    const auto& name = machine.options.name_of_code;
    const std::string function = name ? name(address) : std::string();
    return function.empty() ? text : text + (" " + function);
  };
  for (unsigned i = 0; i < std::size(usart_instances); ++i)
    usarts.emplace_back(machine, dma, pins, i + 1, usart_instances[i].position,
                        usart_instances[i].slot.clock.enable_register == rcc_map.apb2enr);
  for (unsigned i = 0; i < std::size(spi_instances); ++i)
    spis.emplace_back(machine, events, dma, i + 1, spi_instances[i].position,
                      spi_instances[i].slot.clock.enable_register == rcc_map.apb2enr);
  put_peripherals();

  // Electronic signature (RM0090, "Device electronic signature"), and option bytes with their factory values.
  std::uint8_t* system = machine.memory.system();
  std::memcpy(system + 0x7A10, options.unique_id.data(), 12);
  // Factory calibration in ADC counts at 3.3 V: VREFINT, then the temperature sensor at 30 C and at 110 C.
  const std::uint16_t calibration[] = {internal_reference_calibration, 958, 1207};
  std::memcpy(system + 0x7A2A, calibration, sizeof calibration);
  const std::uint16_t flash_kilobytes = flash_bytes / 1024;
  std::memcpy(system + 0x7A22, &flash_kilobytes, 2);
  put_boot_loader(system, machine.options.crystal_Hz);
}

void ChipParts::put_peripherals() {
  // The clock tree is added first, because the other peripherals count its cycles.
  put(0x4002'3800, "RCC", rcc);
  put(0x4002'3C00, "FLASH", flash);
  put(0x4001'3C00, "EXTI", exti);
  put(0x4001'3800, "SYSCFG", exti.syscfg(), gate(rcc_map.apb2enr, rcc_map.apb2enr.syscfgen));
  put(0x4000'7000, "PWR", power, gate(rcc_map.apb1enr, rcc_map.apb1enr.pwren));
  put(0x4002'3000, "CRC", make<CrcUnit>(), gate(rcc_map.ahb1enr, rcc_map.ahb1enr.crcen));
  put(0x5006'0800, "RNG", make<RandomNumbers>(machine.options.random_seed),
      gate(rcc_map.ahb2enr, rcc_map.ahb2enr.rngen));
  put(0x4000'3000, "IWDG", make<IndependentWatchdog>(machine, rcc));
  put(0x4000'2C00, "WWDG", make<WindowWatchdog>(machine), gate(rcc_map.apb1enr, rcc_map.apb1enr.wwdgen));
  for (unsigned i = 0; i < std::size(timer_slots); ++i)
    put(timer_slots[i].base, "TIM" + std::to_string(i + 1), timers.timer(i + 1), timer_slots[i].clock);
  // The three converters share a register block. Each converter has a separate enable bit, and one bit resets all
  // converters.
  bus.add(0x4001'2000, 1024, "ADC", adcs, rcc.enable_register(rcc_map.apb2enr), rcc_map.apb2enr.adcen.masks());
  adcs.clock_by(rcc.enable_register(rcc_map.apb2enr));
  rcc.add_reset(rcc_map.apb2rstr, rcc_map.apb2enr.adcen.mask(), adcs);
  put(0x4002'6000, "DMA1", dma.controller(1), gate(rcc_map.ahb1enr, rcc_map.ahb1enr.dmaen, 0));
  put(0x4002'6400, "DMA2", dma.controller(2), gate(rcc_map.ahb1enr, rcc_map.ahb1enr.dmaen, 1));
  for (unsigned i = 0; i < std::size(usart_instances); ++i)
    put(usart_instances[i].slot.base, usart_instances[i].name, usarts[i], usart_instances[i].slot.clock);
  for (unsigned i = 0; i < std::size(spi_instances); ++i)
    put(spi_instances[i].slot.base, "SPI" + std::to_string(i + 1), spis[i], spi_instances[i].slot.clock);
  for (unsigned i = 0; i < std::size(i2c_instances); ++i)
    put(i2c_instances[i].slot.base, "I2C" + std::to_string(i + 1),
        make<I2c>(machine, events, i + 1, i2c_instances[i].position), i2c_instances[i].slot.clock);
  const Can* first_can = nullptr;
  for (unsigned i = 0; i < std::size(can_instances); ++i) {
    Can& one = make<Can>(machine, events, i + 1, can_instances[i].position, first_can);
    put(can_instances[i].slot.base, "CAN" + std::to_string(i + 1), one, can_instances[i].slot.clock);
    if (first_can == nullptr) first_can = &one;
  }
  put(0x4000'7400, "DAC", make<Dac>(machine), gate(rcc_map.apb1enr, rcc_map.apb1enr.dacen));
  put(0x4000'2800, "RTC", make<RealTimeClock>(machine, events, rcc, exti));
  for (unsigned i = 0; i < Pins::ports; ++i)
    put(0x4002'0000 + 0x400 * i, "GPIO" + std::string(1, static_cast<char>('A' + i)), pins.port(i),
        gate(rcc_map.ahb1enr, rcc_map.ahb1enr.gpioen, i));
}

void ChipParts::add_outside_peripheral(std::uint32_t base, std::uint32_t size, const std::string& name,
                                       Peripheral& peripheral) {
  for (const auto& slot : outside_slots)
    if (slot.base == base) {
      bus.add(base, size, name, peripheral, rcc.enable_register(slot.clock.enable_register), slot.clock.mask);
      rcc.add_reset(reset_register_of(slot.clock.enable_register), slot.clock.mask, peripheral);
      return;
    }
  bus.add(base, size, name, peripheral);
}

}  // namespace inkwell::virtual_board
