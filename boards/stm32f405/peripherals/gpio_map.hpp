// Registers of a port (RM0090, GPIOx_MODER to GPIOx_AFRH).
#pragma once

#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

/// The arguments are the reset values of MODER, OSPEEDR and PUPDR.
template <std::uint32_t mode, std::uint32_t speed, std::uint32_t pull>
struct GpioRegisters {
  struct : Register {
    Field moder{"MODER#", 0, 2, Access::rw, {16, 2}};
  } moder{{"MODER", 0x00, mode}};
  struct : Register {
    Field ot{"OT#", 0, 1, Access::rw, {16, 1}};
  } otyper{{"OTYPER", 0x04}};
  struct : Register {
    Field ospeedr{"OSPEEDR#", 0, 2, Access::rw, {16, 2}};
  } ospeedr{{"OSPEEDR", 0x08, speed}};
  struct : Register {
    Field pupdr{"PUPDR#", 0, 2, Access::rw, {16, 2}};
  } pupdr{{"PUPDR", 0x0C, pull}};
  struct : Register {
    Field idr{"IDR#", 0, 1, Access::r, {16, 1}};
  } idr{{"IDR", 0x10}};
  struct : Register {
    Field odr{"ODR#", 0, 1, Access::rw, {16, 1}};
  } odr{{"ODR", 0x14}};
  struct : Register {
    Field bs{"BS#", 0, 1, Access::w, {16, 1}}, br{"BR#", 16, 1, Access::w, {16, 1}};
  } bsrr{{"BSRR", 0x18}};
  struct : Register {
    Field lck{"LCK#", 0, 1, Access::rw, {16, 1}}, lckk{"LCKK", 16};
  } lckr{{"LCKR", 0x1C}};
  struct : Register {
    Field afr{"AFRL#", 0, 4, Access::rw, {8, 4}};
  } afrl{{"AFRL", 0x20}};
  struct : Register {
    Field afr{"AFRH#", 0, 4, Access::rw, {8, 4, 8}};
  } afrh{{"AFRH", 0x24}};
};
inline constexpr GpioRegisters<0, 0, 0> gpio;
// After a reset, the debug pins of ports A and B have their alternate function (RM0090, GPIOx_MODER).
inline constexpr GpioRegisters<0xA800'0000, 0x0C00'0000, 0x6400'0000> gpio_a;
inline constexpr GpioRegisters<0x0000'0280, 0x0000'00C0, 0x0000'0100> gpio_b;

}  // namespace inkwell::virtual_board
