#include "firmware/drivers/bridges.hpp"

#include <board/board.hpp>
#include "firmware/drivers/bridges_off.hpp"
#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/drivers/interrupts.hpp"
#include "firmware/drivers/leg_compares.hpp"
#include "firmware/drivers/peripheral_clocks.hpp"
#include "firmware/drivers/pins.hpp"
#include "firmware/placement/interrupt.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {
namespace {

using TIM1 = RegistersOf<Bridges, registers::TIM1>;
using TIM8 = RegistersOf<Bridges, registers::TIM8>;
using Enable = DigitalOutput<Bridges, board::facts.bridge_enable>;
using Heartbeat = DigitalOutput<Bridges, board::facts.bridge_heartbeat>;
using Hold = DigitalInput<Bridges, board::facts.bridge_hold>;

/// Sources of TIM1's trigger output (RM0090, TIMx_CR2, MMS).
constexpr std::uint32_t trigger_on_enable = 0b001;
constexpr std::uint32_t trigger_on_update = 0b010;

/// Sets up a timer with disabled outputs and a stopped counter. Compare values are written before the outputs are
/// switched on.
template <class Timer>
void set_up() {
  constexpr std::uint32_t centre_aligned = 0b01;
  constexpr std::uint32_t high_below_compare = 0b110;
  Timer::CR1::write(typename Timer::CR1::CMS(centre_aligned));
  Timer::ARR::write(board::pwm_top);
  Timer::RCR::write(typename Timer::RCR::REP(board::pwm_repetition));
  Timer::CCMR1::write(typename Timer::CCMR1::OC1M(high_below_compare), typename Timer::CCMR1::OC1PE(1),
                      typename Timer::CCMR1::OC2M(high_below_compare), typename Timer::CCMR1::OC2PE(1));
  Timer::CCMR2::write(typename Timer::CCMR2::OC3M(high_below_compare), typename Timer::CCMR2::OC3PE(1));
  Timer::BDTR::write(outputs_off);
  Timer::CCER::write(typename Timer::CCER::CC1E(1), typename Timer::CCER::CC2E(1), typename Timer::CCER::CC3E(1));
  // UG loads the repetition counter. The repetition value is odd and the counter starts upward from 0. The update
  // occurs at every sixth counter reversal, when the counter is 0 (RM0090, "Repetition counter").
  Timer::EGR::write(typename Timer::EGR::UG(1));
}

/// The bridge number is a template argument, so that the compiler resolves the channel.
template <std::size_t bridge>
void write_legs(const LegCompares& legs) {
  constexpr unsigned channel_index = board::facts.bridges[bridge].channel - 1u;
  TIM1::CCR::write(channel_index, legs.leg_a);
  TIM8::CCR::write(channel_index, legs.leg_b);
}

/// The three pins belong to one port, so one access reads all three levels.
template <board::Pin first, board::Pin second, board::Pin third>
bool any_is_high() {
  static_assert(first.port == second.port && first.port == third.port);
  constexpr std::uint32_t pins = 1u << first.number | 1u << second.number | 1u << third.number;
  return (DigitalInput<Bridges, first>::read_port() & pins) != 0;
}

/// Starts both counters together. TIM8 waits for internal trigger 0, the trigger output of TIM1 (RM0090, "TIMx internal
/// trigger connection"). The trigger arrives about two cycles late, so leg B of a bridge switches 12 ns later than leg
/// A. The dead times of the bridges are several times longer than 12 ns.
void start_together() {
  constexpr std::uint32_t start_on_trigger = 0b110, internal_trigger_0 = 0b000;
  TIM1::CR2::write(TIM1::CR2::MMS(trigger_on_enable));
  TIM8::SMCR::write(TIM8::SMCR::TS(internal_trigger_0), TIM8::SMCR::SMS(start_on_trigger));
  TIM1::CR1::modify(TIM1::CR1::CEN(1));
  // Two reads of TIM1 delay the change of the trigger source until TIM8 has received the trigger. Later triggers have
  // no effect on the running timer.
  static_cast<void>(TIM1::CR1::read());
  static_cast<void>(TIM1::CR1::read());
  TIM1::CR2::write(TIM1::CR2::MMS(trigger_on_update));
}

/// Writing 0 clears a flag, and writing 1 does not change the flag.
void clear_update() { TIM1::SR::write(~TIM1::SR::UIF::mask); }

/// Settling time of 4 us. In 4 us an internal pull resistor charges 100 pF.
constexpr std::uint32_t fault_pull_cycles = board::processor_Hz / 250'000;

void connect_pins() {
  // Slow edges disturb the shunt amplifiers less than fast edges. The pull-downs keep the legs low if the timer does
  // not drive them.
  connect<Bridges, board::facts.bridges[0].leg_a>(Pull::down, Speed::medium);
  connect<Bridges, board::facts.bridges[1].leg_a>(Pull::down, Speed::medium);
  connect<Bridges, board::facts.bridges[2].leg_a>(Pull::down, Speed::medium);
  connect<Bridges, board::facts.bridges[0].leg_b>(Pull::down, Speed::medium);
  connect<Bridges, board::facts.bridges[1].leg_b>(Pull::down, Speed::medium);
  connect<Bridges, board::facts.bridges[2].leg_b>(Pull::down, Speed::medium);
  // The open-drain fault wire has a strong pull-up on the board. The chip's pull-up prevents a floating wire if no
  // bridges are connected.
  connect<Bridges, board::facts.bridge_fault_tim1>(Pull::up, Speed::low);
  connect<Bridges, board::facts.bridge_fault_tim8>(Pull::up, Speed::low);
}

}  // namespace

void Bridges::start() {
  Enable::start();
  Heartbeat::start();
  Hold::start(Pull::down);  // defines the level if the wire is broken
  start_clocks_of<Bridges, registers::TIM1, registers::TIM8>();
  // The timers stop while a debugger halts the processor, because the last duty cycle must not remain on the motors. A
  // measurement must show that the outputs become idle (README.md of the board, "First power-up").
  using Freeze = registers::DBG::DBGMCU_APB2_FZ;
  Freeze::modify(Freeze::DBG_TIM1_STOP(1), Freeze::DBG_TIM8_STOP(1));

  set_up<TIM1>();
  set_up<TIM8>();
  connect_pins();
  start_together();
}

INKWELL_INTERRUPT void Bridges::write_neutral() {
  write_legs<0>(neutral_legs);
  write_legs<1>(neutral_legs);
  write_legs<2>(neutral_legs);
}

INKWELL_INTERRUPT void Bridges::write(const std::array<float, 3>& duty) {
  std::array<LegCompares, 3> legs;
#pragma GCC unroll 1  // unrolled code would not be faster
  for (std::size_t i = 0; i < legs.size(); ++i) legs[i] = leg_compares(duty[i]);
  write_legs<0>(legs[0]);
  write_legs<1>(legs[1]);
  write_legs<2>(legs[2]);
}

INKWELL_INTERRUPT void Bridges::write_brake() {
  write_legs<0>(low_legs);
  write_legs<1>(low_legs);
  write_legs<2>(low_legs);
}

INKWELL_INTERRUPT void Bridges::enable() {
  if (enabled_) return;
  enabled_ = true;
  TIM1::SR::write(~TIM1::SR::BIF::mask);
  TIM8::SR::write(~TIM8::SR::BIF::mask);
  TIM1::BDTR::write(outputs_off | TIM1::BDTR::MOE::mask);
  TIM8::BDTR::write(outputs_off | TIM8::BDTR::MOE::mask);
  Heartbeat::set_high();
  Enable::set_high();
}

INKWELL_INTERRUPT void Bridges::disable() {
  enabled_ = false;
  Enable::set_low();
  TIM1::BDTR::write(outputs_off);
  TIM8::BDTR::write(outputs_off);
}

INKWELL_INTERRUPT bool Bridges::fault() const {
  const bool low_now = !DigitalInput<Bridges, board::facts.bridge_fault_tim1.pin>::is_high();
  return low_now || (enabled_ && (TIM1::SR::BIF::is_set() || TIM8::SR::BIF::is_set()));
}

bool Bridges::fault_wire_of_tim1_floats() const {
  const InterruptsHeld held;
  return follows_pulls<Bridges, board::facts.bridge_fault_tim1.pin>(fault_pull_cycles);
}

bool Bridges::fault_wire_of_tim8_floats() const {
  const InterruptsHeld held;
  return follows_pulls<Bridges, board::facts.bridge_fault_tim8.pin>(fault_pull_cycles);
}

bool Bridges::enable_is_high() const { return DigitalInput<Bridges, board::facts.bridge_enable>::is_high(); }

bool Bridges::heartbeat_is_high() const { return DigitalInput<Bridges, board::facts.bridge_heartbeat>::is_high(); }

bool Bridges::hold_is_high() const { return Hold::is_high(); }

bool Bridges::a_leg_is_high() const {
  constexpr auto& bridges = board::facts.bridges;
  return any_is_high<bridges[0].leg_a.pin, bridges[1].leg_a.pin, bridges[2].leg_a.pin>() ||
         any_is_high<bridges[0].leg_b.pin, bridges[1].leg_b.pin, bridges[2].leg_b.pin>();
}

INKWELL_INTERRUPT bool Bridges::begin_period() {
  clear_update();
  if (!enabled_) return false;
  const bool were_released = !Hold::is_high();
  Heartbeat::set_high();
  return were_released;
}

INKWELL_INTERRUPT void Bridges::end_period() { Heartbeat::set_low(); }

bool Bridges::wait_for_update() {
  clear_update();
  return wait_for(2 * board::servo_cycles, [this] { return period_is_over(); }) && TIM8::CR1::CEN::is_set();
}

}  // namespace inkwell::drivers
