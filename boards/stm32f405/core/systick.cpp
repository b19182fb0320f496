#include "boards/stm32f405/core/system_control.hpp"

namespace inkwell::virtual_board {
SysTick::SysTick(Machine& machine) : machine_(machine), slot_(machine.timeline.add(*this)) {
  machine.clock_users.push_back(this);
  machine.debug_halt.add(*this, DebugHalt::core, 0);
}

void SysTick::reset() {
  control_ = reload_ = held_ = 0;
  zero_at_ = never;
  frozen_ = false;
  announce();
}

Ticks SysTick::duration(std::uint64_t counts) const {
  // The external reference clock is HCLK / 8 (RM0090, "Clocks").
  return machine_.clocks.hclk.duration(counts * (stk.ctrl.clksource.in(control_) ? 1 : 8));
}

std::uint32_t SysTick::current() const {
  if (zero_at_ == never) return held_;
  const Ticks left = zero_at_ - machine_.timeline.now();
  const std::uint64_t counts =
      machine_.clocks.hclk.cycles_in(left + duration(1) - 1) / (stk.ctrl.clksource.in(control_) ? 1 : 8);
  return counts > reload_ ? 0 : static_cast<std::uint32_t>(counts);
}

void SysTick::start(std::uint32_t counts_until_zero) {
  zero_at_ = !frozen_ && stk.ctrl.enable.in(control_) && (reload_ != 0 || counts_until_zero != 0)
                 ? machine_.timeline.now() + duration(counts_until_zero)
                 : never;
  announce();
}

void SysTick::announce() { machine_.timeline.set(slot_, zero_at_, stk.ctrl.tickint.in(control_) ? zero_at_ : never); }

void SysTick::step(Ticks now) {
  control_ |= stk.ctrl.countflag.mask();
  if (stk.ctrl.tickint.in(control_)) machine_.nvic.pend(exception_systick);
  held_ = 0;
  zero_at_ = reload_ != 0 ? now + duration(std::uint64_t{reload_} + 1) : never;
  announce();
}

std::uint32_t SysTick::read(std::uint32_t offset) {
  switch (offset) {
    case stk.ctrl: {
      const std::uint32_t value = control_;
      control_ &= ~stk.ctrl.countflag.mask();
      return value;
    }
    case stk.load: return reload_;
    case stk.val: return current();
    default: return stk.calib.reset_value;  // CALIB: no reference clock and no calibration value
  }
}

void SysTick::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case stk.ctrl: {
      held_ = current();
      control_ = (control_ & stk.ctrl.countflag.mask()) | (value & writable(stk.ctrl));
      // A counter at 0 needs one count to load the reload value.
      start(held_ != 0 ? held_ : reload_ + 1);
      break;
    }
    case stk.load: reload_ = stk.load.reload.of(value); break;
    case stk.val:
      held_ = 0;
      control_ &= ~stk.ctrl.countflag.mask();
      start(reload_ + 1);
      break;
    default: break;
  }
}

void SysTick::freeze(bool frozen) {
  if (frozen == frozen_) return;
  held_ = current();
  frozen_ = frozen;
  start(held_ != 0 ? held_ : reload_ + 1);
}

void SysTick::before_clock_change() { held_ = current(); }
void SysTick::after_clock_change() {
  if (stk.ctrl.enable.in(control_)) start(held_ != 0 ? held_ : reload_ + 1);
}

}  // namespace inkwell::virtual_board
