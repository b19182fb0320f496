// What each driver has to itself: peripherals, pins, DMA streams and interrupt lines.
//
//   class Encoders {
//    public:
//     static constexpr std::array claims{peripheral<registers::TIM3>(), pin(board::encoders[1].a), ...};
//
// A driver starts a peripheral's clock, sets a pin up and enables an interrupt only if it claims them, and the
// application's PartsList does not compile with two drivers that claim the same.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include <board/board.hpp>

namespace inkwell::drivers {

/// Position in the vector table (RM0090, "Vector table for STM32F405xx").
enum class Interrupt : std::uint8_t { analog_converters = 18, usb = 67 };

struct Claim {
  enum class Kind : std::uint8_t { peripheral, pin, stream, interrupt };
  Kind kind;
  std::uint32_t which;  ///< address of a peripheral's registers; a stream's number is added to its controller's
  bool operator==(const Claim&) const = default;
};

namespace detail {

template <class Peripheral>
struct BaseOf;
template <template <std::uint32_t> class Registers, std::uint32_t base>
struct BaseOf<Registers<base>> : std::integral_constant<std::uint32_t, base> {};

template <class Claims>
constexpr bool holds(const Claims& claims, const Claim& wanted) {
  for (const Claim& claim : claims)
    if (claim == wanted) return true;
  return false;
}

template <class One, class Other>
struct Apart {
  static constexpr bool share = [] {
    for (const Claim& claim : One::claims)
      if (holds(Other::claims, claim)) return true;
    return false;
  }();
  static_assert(!share, "two drivers claim the same peripheral, pin, DMA stream or interrupt line");
  static constexpr bool value = !share;
};

template <class... Drivers>
struct AllApart : std::true_type {};
template <class First, class... Rest>
struct AllApart<First, Rest...> : std::bool_constant<(Apart<First, Rest>::value && ...) && AllApart<Rest...>::value> {};

}  // namespace detail

template <class Peripheral>
constexpr Claim peripheral() {
  return {Claim::Kind::peripheral, detail::BaseOf<Peripheral>::value};
}
template <class Controller, std::uint32_t number>
constexpr Claim stream() {
  return {Claim::Kind::stream, detail::BaseOf<Controller>::value + number};
}
constexpr Claim pin(const board::Pin& pin) {
  return {Claim::Kind::pin, static_cast<std::uint32_t>(pin.port) << 8 | pin.number};
}
constexpr Claim pin(const board::PeripheralPin& wiring) { return pin(wiring.pin); }
constexpr Claim pin(const board::AnalogInput& input) { return pin(input.pin); }
constexpr Claim interrupt(Interrupt line) { return {Claim::Kind::interrupt, static_cast<std::uint32_t>(line)}; }

template <class Driver, Claim claim>
constexpr void require_claim() {
  static_assert(detail::holds(Driver::claims, claim), "a driver uses what it does not claim");
}

/// All drivers of an application.
template <class... Drivers>
struct PartsList {
  static_assert(detail::AllApart<Drivers...>::value);
  template <class Driver>
  static constexpr bool has = (std::is_same_v<Driver, Drivers> || ...);
};

}  // namespace inkwell::drivers
