// A driver claims resources: peripherals, pins, DMA streams and interrupt lines.
//
// A driver lists its resources in the array `claims`. A driver can access a peripheral and start its clock only if the
// driver claims this peripheral. A driver must claim the pins that it sets up and the interrupts that it enables. The
// application's PartsList does not compile if two drivers claim the same resource.
#pragma once

// The following steps add a driver.
// (1) Write a class in firmware/drivers and list its peripherals, pins, DMA streams and interrupts in `claims`. Add
//     the source to firmware/drivers/CMakeLists.txt.
// (2) Access registers with RegistersOf<Driver, registers::TIM3>.
// (3) Add the driver to Parts in firmware/application/parts.hpp.
// (4) For a new peripheral, follow the steps in registers/peripherals.hpp.

#include <array>
#include <cstdint>
#include <type_traits>

#include <board/board.hpp>
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

/// Position in the vector table (RM0090, "Vector table for STM32F405xx").
enum class Interrupt : std::uint8_t { voltage_detector = 1, analog_converters = 18 };

struct Claim {
  enum class Kind : std::uint8_t { peripheral, pin, stream, interrupt };
  Kind kind;
  std::uint32_t which;  ///< base address of a peripheral; for a stream, base address of its controller plus its number
  bool operator==(const Claim&) const = default;
};

namespace detail {

/// Base address and register map of a peripheral.
template <class Peripheral>
struct Underlying;
template <template <std::uint32_t> class Map, std::uint32_t base_>
struct Underlying<registers::Claimable<Map, base_>> {
  static constexpr std::uint32_t base = base_;
  using Registers = Map<base_>;
};

template <class Claims>
constexpr bool holds(const Claims& claims, const Claim& wanted) {
  for (const Claim& claim : claims)
    if (claim == wanted) return true;
  return false;
}

template <class One, class Other>
struct Disjoint {
  static constexpr bool share = []() {
    for (const Claim& claim : One::claims)
      if (holds(Other::claims, claim)) return true;
    return false;
  }();
  static_assert(!share, "two drivers claim the same peripheral, pin, DMA stream or interrupt line");
  static constexpr bool value = !share;
};

template <class... Drivers>
struct AllDisjoint : std::true_type {};
template <class First, class... Rest>
struct AllDisjoint<First, Rest...>
    : std::bool_constant<(Disjoint<First, Rest>::value && ...) && AllDisjoint<Rest...>::value> {};

}  // namespace detail

template <class Peripheral>
constexpr Claim peripheral() {
  return {Claim::Kind::peripheral, detail::Underlying<Peripheral>::base};
}
template <class Controller, std::uint32_t number>
constexpr Claim stream() {
  return {Claim::Kind::stream, detail::Underlying<Controller>::base + number};
}
constexpr Claim pin(const board::Pin& pin) {
  return {Claim::Kind::pin, static_cast<std::uint32_t>(pin.port) << 8 | pin.number};
}
constexpr Claim pin(const board::PeripheralPin& wiring) { return pin(wiring.pin); }
constexpr Claim pin(const board::AnalogInput& input) { return pin(input.pin); }
constexpr Claim interrupt(Interrupt line) { return {Claim::Kind::interrupt, static_cast<std::uint32_t>(line)}; }

template <class Driver, Claim claim>
constexpr bool require_claim() {
  static_assert(detail::holds(Driver::claims, claim), "a driver uses what it does not claim");
  return true;
}

namespace detail {

template <class Driver, class Peripheral, Claim claim>
struct Claimed : Underlying<Peripheral> {
  static_assert(require_claim<Driver, claim>());
};

}  // namespace detail

/// Registers of a claimed peripheral.
template <class Driver, class Peripheral>
using RegistersOf = typename detail::Claimed<Driver, Peripheral, peripheral<Peripheral>()>::Registers;
/// DMA controller registers of a claimed stream.
template <class Driver, class Controller, std::uint32_t number>
using RegistersOfStream = typename detail::Claimed<Driver, Controller, stream<Controller, number>()>::Registers;

/// List of all drivers of an application.
template <class... Drivers>
struct PartsList {
  static_assert(detail::AllDisjoint<Drivers...>::value);
  template <class Driver>
  static constexpr bool has = (std::is_same_v<Driver, Drivers> || ...);
};

}  // namespace inkwell::drivers
