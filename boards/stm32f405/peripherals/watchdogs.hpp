// Independent and window watchdog (RM0090, "IWDG", "WWDG").
#pragma once

#include <cstdint>

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/rcc.hpp"

namespace inkwell::virtual_board {

struct IndependentWatchdogRegisters {
  struct : Register {
    Field key{"KEY", 0, 16, Access::w};
  } kr{{"KR", 0x00}};
  struct : Register {
    Field pr{"PR", 0, 3};
  } pr{{"PR", 0x04}};
  struct : Register {
    Field rl{"RL", 0, 12};
  } rlr{{"RLR", 0x08, 0xFFF}};
  struct : Register {
    Field pvu{"PVU", 0, 1, Access::r}, rvu{"RVU", 1, 1, Access::r};
  } sr{{"SR", 0x0C}};
};
inline constexpr IndependentWatchdogRegisters iwdg;

struct WindowWatchdogRegisters {
  struct : Register {
    Field t{"T", 0, 7}, wdga{"WDGA", 7, 1, Access::rs};
  } cr{{"CR", 0x00, 0x7F}};
  struct : Register {
    Field w{"W", 0, 7}, wdgtb{"WDGTB", 7, 2}, ewi{"EWI", 9};
  } cfr{{"CFR", 0x04, 0x7F}};
  struct : Register {
    Field ewif{"EWIF", 0, 1, Access::rc_w0};
  } sr{{"SR", 0x08}};
};
inline constexpr WindowWatchdogRegisters wwdg;

class IndependentWatchdog final : public RegisterBlock, public TimedPart, public Freezable {
 public:
  IndependentWatchdog(Machine& machine, Rcc& rcc) : machine_(machine), rcc_(rcc), slot_(machine.timeline.add(*this)) {
    constexpr unsigned stop_bit = 12;  // DBG_IWDG_STOP
    machine.debug_halt.add(*this, DebugHalt::apb1, stop_bit);
  }
  void reset() override {
    prescaler_ = 0;
    reload_ = iwdg.rlr.reset_value;
    unlocked_ = runs_ = false;
    prescaler_taken_at_ = reload_taken_at_ = 0;
    machine_.timeline.set(slot_, never, never);
  }
  void step(Ticks) override { machine_.request_reset(ResetCause::independent_watchdog); }
  void freeze(bool frozen) override {
    if (!runs_) return;
    const Ticks now = machine_.timeline.now();
    if (frozen)
      left_ = end_ - now;
    else
      end_ = now + left_;
    const Ticks next = frozen ? never : end_;
    machine_.timeline.set(slot_, next, next);
  }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    const Ticks now = machine_.timeline.now();
    if (offset == iwdg.sr)
      return iwdg.sr.pvu.with(now < prescaler_taken_at_) | iwdg.sr.rvu.with(now < reload_taken_at_);
    return offset == iwdg.pr ? prescaler_ : offset == iwdg.rlr ? reload_ : 0;
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == iwdg.kr) return write_key(iwdg.kr.key.of(value));
    if (!unlocked_) return;
    if (offset == iwdg.pr && takes(prescaler_taken_at_, "PR")) prescaler_ = iwdg.pr.pr.of(value);
    if (offset == iwdg.rlr && takes(reload_taken_at_, "RLR")) reload_ = iwdg.rlr.rl.of(value);
  }
  std::span<const MapEntry> registers() const override { return shown<iwdg>(); }

 private:
  /// Returns true if the register accepts a new value. After a write, the register is busy for up to five LSI cycles
  /// (RM0090, "Status register (IWDG_SR)").
  bool takes(Ticks& taken_at, const char* name) {
    const Ticks now = machine_.timeline.now();
    if (now < taken_at) {
      machine_.violations.violate(Rule::watchdog_busy, name);
      return false;
    }
    taken_at = now + machine_.clocks.low_speed_internal.duration(5);
    return true;
  }
  void write_key(std::uint32_t key) {
    unlocked_ = key == 0x5555;
    if (key == 0xCCCC) {
      runs_ = true;
      rcc_.start_low_speed_internal();
    }
    if ((key == 0xAAAA || key == 0xCCCC) && runs_) restart();
  }
  void restart() {
    const std::uint64_t divider = std::uint64_t{4} << std::min<std::uint32_t>(prescaler_, 6);
    end_ = machine_.timeline.now() + machine_.clocks.low_speed_internal.duration(divider * (reload_ + 1));
    machine_.timeline.set(slot_, end_, end_);
  }
  Machine& machine_;
  Rcc& rcc_;
  Timeline::Slot slot_;
  std::uint32_t prescaler_ = 0, reload_ = iwdg.rlr.reset_value;
  Ticks prescaler_taken_at_ = 0, reload_taken_at_ = 0;
  Ticks end_ = 0, left_ = 0;  ///< expiry time; remaining time when frozen
  bool unlocked_ = false, runs_ = false;
};

class WindowWatchdog final : public RegisterBlock, public TimedPart, public ClockUser, public Freezable {
 public:
  explicit WindowWatchdog(Machine& machine) : machine_(machine), slot_(machine.timeline.add(*this)) {
    machine.clock_users.push_back(this);
    constexpr unsigned stop_bit = 11;  // DBG_WWDG_STOP
    machine.debug_halt.add(*this, DebugHalt::apb1, stop_bit);
  }
  void freeze(bool frozen) override {
    frozen_ = frozen;
    after_clock_change();
  }
  void reset() override {
    counter_ = wwdg.cr.reset_value;
    configuration_ = wwdg.cfr.reset_value;
    active_ = early_ = false;
    plan();
    update_interrupt();
  }
  void step(Ticks now) override {
    start_ = now;
    --counter_;
    if (counter_ == last_count) early_ = true;
    update_interrupt();
    if (counter_ < last_count)
      machine_.request_reset(ResetCause::window_watchdog);
    else
      plan();
  }
  void before_clock_change() override {}
  void after_clock_change() override {
    start_ = machine_.timeline.now();
    plan();
  }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    if (offset == wwdg.cr) return counter_ | wwdg.cr.wdga.with(active_);
    if (offset == wwdg.cfr) return configuration_;
    return wwdg.sr.ewif.with(early_);
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == wwdg.cr) {
      const bool outside = active_ && counter_ > wwdg.cfr.w.of(configuration_);
      active_ |= wwdg.cr.wdga.in(value);
      counter_ = wwdg.cr.t.of(value);
      start_ = machine_.timeline.now();
      // The watchdog resets the chip after a refresh outside of the window, or if the new count is too low.
      if (outside || (active_ && counter_ < last_count)) machine_.request_reset(ResetCause::window_watchdog);
      plan();
    } else if (offset == wwdg.cfr) {
      configuration_ = value & writable(wwdg.cfr);
      plan();
    } else {
      early_ = early_ && wwdg.sr.ewif.in(value);
    }
    update_interrupt();
  }
  std::span<const MapEntry> registers() const override { return shown<wwdg>(); }

 private:
  static constexpr std::uint32_t last_count = 0x40;  ///< the next lower value resets the chip
  void plan() {
    if (!active_ || frozen_) return machine_.timeline.set(slot_, never, never);
    const Ticks next =
        start_ + machine_.clocks.pclk1.duration(std::uint64_t{4096} << wwdg.cfr.wdgtb.of(configuration_));
    machine_.timeline.set(slot_, next, counter_ <= last_count + 1 ? next : never);
  }
  void update_interrupt() { machine_.nvic.set_source(0, 0, early_ && wwdg.cfr.ewi.in(configuration_)); }
  Machine& machine_;
  Timeline::Slot slot_;
  std::uint32_t counter_ = wwdg.cr.reset_value, configuration_ = wwdg.cfr.reset_value;
  Ticks start_ = 0;
  bool active_ = false, early_ = false, frozen_ = false;
};

}  // namespace inkwell::virtual_board
