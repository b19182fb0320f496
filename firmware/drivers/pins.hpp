// Configures the chip's pins from the facts of the board (RM0090, chapter GPIO). A pin is a template argument, so that
// its setup compiles to a few stores. Only the driver that claims a pin can set it up.
#pragma once

#include <type_traits>

#include <board/board.hpp>
#include "firmware/drivers/claims.hpp"
#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

enum class Pull : std::uint8_t { none = 0, up = 1, down = 2 };
enum class Speed : std::uint8_t { low = 0, medium = 1, fast = 2, high = 3 };

namespace detail {

enum class Mode : std::uint8_t { input = 0, output = 1, alternate = 2, analog = 3 };

template <char letter>
struct Port;
template <>
struct Port<'A'> {
  using Registers = registers::GPIOA;
};
template <>
struct Port<'B'> {
  using Registers = registers::GPIOB;
};
template <>
struct Port<'C'> {
  using Registers = registers::GPIOC;
};

template <board::Pin pin>
using Registers = typename Port<pin.port>::Registers;

/// Field of one pin in a register with `width` bits per pin.
template <class Register, board::Pin pin, unsigned width>
using PinField = registers::Field<Register, pin.number % (32 / width) * width, width>;

template <class Driver, board::Pin number>
void configure(Mode mode, Pull pull, Speed speed) {
  require_claim<Driver, pin(number)>();
  using Io = Registers<number>;
  Io::PUPDR::modify(PinField<typename Io::PUPDR, number, 2>(static_cast<std::uint32_t>(pull)));
  Io::OSPEEDR::modify(PinField<typename Io::OSPEEDR, number, 2>(static_cast<std::uint32_t>(speed)));
  Io::MODER::modify(PinField<typename Io::MODER, number, 2>(static_cast<std::uint32_t>(mode)));
}

}  // namespace detail

/// Enables the port clocks. Call this function before all other functions in this file.
inline void start_pins() {
  using Enable = registers::RCC::AHB1ENR;
  Enable::modify(Enable::GPIOAEN(1), Enable::GPIOBEN(1), Enable::GPIOCEN(1));
  // Reading the register delays the first access to the port (erratum "Delay after an RCC peripheral clock enabling").
  static_cast<void>(Enable::read());
}

template <class Driver, board::PeripheralPin wiring>
void connect(Pull pull, Speed speed) {
  using Io = detail::Registers<wiring.pin>;
  using Function = std::conditional_t<(wiring.pin.number < 8), typename Io::AFRL, typename Io::AFRH>;
  Function::modify(detail::PinField<Function, wiring.pin, 4>(wiring.alternate_function));
  detail::configure<Driver, wiring.pin>(detail::Mode::alternate, pull, speed);
}

/// Disconnects an ADC input pin from the digital circuits of the port.
template <class Driver, board::AnalogInput input>
void connect_analog() {
  detail::configure<Driver, input.pin>(detail::Mode::analog, Pull::none, Speed::low);
}

/// Returns true if no circuit drives the pin, so that the internal pull resistors can change the level. A pull resistor
/// of about 40 kOhm charges the capacitance at the pin within `settle_cycles`.
template <class Driver, board::Pin number>
bool follows_pulls(std::uint32_t settle_cycles) {
  require_claim<Driver, pin(number)>();
  using Io = detail::Registers<number>;
  const auto level_with = [&](Pull pull) {
    Io::PUPDR::modify(detail::PinField<typename Io::PUPDR, number, 2>(static_cast<std::uint32_t>(pull)));
    wait(settle_cycles);
    return (Io::IDR::read() >> number.number & 1u) != 0;
  };
  const bool low_with_pull_down = !level_with(Pull::down);
  const bool high_with_pull_up = level_with(Pull::up);
  return low_with_pull_down && high_with_pull_up;
}

template <class Driver, board::Pin pin>
struct DigitalInput {
  static void start(Pull pull) { detail::configure<Driver, pin>(detail::Mode::input, pull, Speed::low); }
  /// Returns the levels of all pins of the port.
  static std::uint32_t read_port() { return detail::Registers<pin>::IDR::read(); }
  static bool is_high() { return (read_port() >> pin.number & 1u) != 0; }
};

template <class Driver, board::Pin pin>
struct DigitalOutput {
  /// The level is set first, so that the new output is low from the start.
  static void start() {
    set_low();
    detail::configure<Driver, pin>(detail::Mode::output, Pull::none, Speed::low);
  }
  static void set_high() { detail::Registers<pin>::BSRR::write(1u << pin.number); }
  static void set_low() { detail::Registers<pin>::BSRR::write(1u << (pin.number + 16)); }
  static void set(bool high) { high ? set_high() : set_low(); }
};

}  // namespace inkwell::drivers
