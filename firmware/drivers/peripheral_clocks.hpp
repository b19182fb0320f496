// Peripheral clocks (RM0090, RCC). A peripheral is inactive until its driver starts the peripheral clock.
#pragma once

#include "firmware/drivers/claims.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

namespace detail {

using registers::RCC;

/// Clock enable field of a peripheral.
template <class Peripheral>
struct ClockOf;
// clang-format off
template <> struct ClockOf<registers::TIM1> { using Enable = RCC::APB2ENR::TIM1EN; };
template <> struct ClockOf<registers::TIM8> { using Enable = RCC::APB2ENR::TIM8EN; };
template <> struct ClockOf<registers::TIM2> { using Enable = RCC::APB1ENR::TIM2EN; };
template <> struct ClockOf<registers::TIM3> { using Enable = RCC::APB1ENR::TIM3EN; };
template <> struct ClockOf<registers::TIM4> { using Enable = RCC::APB1ENR::TIM4EN; };
template <> struct ClockOf<registers::TIM5> { using Enable = RCC::APB1ENR::TIM5EN; };
template <> struct ClockOf<registers::ADC1> { using Enable = RCC::APB2ENR::ADC1EN; };
template <> struct ClockOf<registers::ADC2> { using Enable = RCC::APB2ENR::ADC2EN; };
template <> struct ClockOf<registers::ADC3> { using Enable = RCC::APB2ENR::ADC3EN; };
template <> struct ClockOf<registers::CRC> { using Enable = RCC::AHB1ENR::CRCEN; };
template <> struct ClockOf<registers::DMA2> { using Enable = RCC::AHB1ENR::DMA2EN; };
template <> struct ClockOf<registers::USART2> { using Enable = RCC::APB1ENR::USART2EN; };
template <> struct ClockOf<registers::OTG_FS_GLOBAL> { using Enable = RCC::AHB2ENR::OTGFSEN; };
// clang-format on

template <class Peripheral>
void start_clock() {
  using Enable = typename ClockOf<Peripheral>::Enable;
  Enable::Owner::modify(Enable(1));
  // Reading the register delays the first access to the peripheral (erratum "Delay after an RCC peripheral clock
  // enabling").
  static_cast<void>(Enable::Owner::read());
}

}  // namespace detail

/// Starts the clocks of peripherals that the driver claims.
template <class Driver, class... Peripherals>
void start_clocks_of() {
  (require_claim<Driver, peripheral<Peripherals>()>(), ...);
  (detail::start_clock<Peripherals>(), ...);
}

/// Starts the DMA controller clock for a stream that the driver claims.
template <class Driver, class Controller, std::uint32_t number>
void start_clock_of_stream() {
  require_claim<Driver, stream<Controller, number>()>();
  detail::start_clock<Controller>();
}

}  // namespace inkwell::drivers
