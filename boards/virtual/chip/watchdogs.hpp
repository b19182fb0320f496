// Independent and window watchdog (RM0090, "IWDG", "WWDG").
#pragma once

#include <cstdint>

#include "bus.hpp"
#include "rcc.hpp"

namespace inkwell::virtual_board {

class IndependentWatchdog final : public RegisterBlock, public TimedPart {
 public:
  explicit IndependentWatchdog(Machine& machine) : machine_(machine), slot_(machine.timeline.add(*this)) {}
  void reset() override {
    prescaler_ = 0;
    reload_ = 0xFFF;
    unlocked_ = runs_ = false;
    machine_.timeline.set(slot_, never, never);
  }
  void step(Ticks) override { machine_.request_reset(ResetCause::independent_watchdog); }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    return offset == prescaler_register ? prescaler_ : offset == reload_register ? reload_ : 0;  // SR: never busy
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == key_register) return write_key(value & 0xFFFF);
    if (!unlocked_) return;
    if (offset == prescaler_register) prescaler_ = value & 7;
    if (offset == reload_register) reload_ = value & 0xFFF;
  }

 private:
  static constexpr std::uint32_t key_register = 0x0, prescaler_register = 0x4, reload_register = 0x8;
  void write_key(std::uint32_t key) {
    unlocked_ = key == 0x5555;
    if (key == 0xCCCC) {
      runs_ = true;
      machine_.rcc->start_low_speed_internal();
    }
    if ((key == 0xAAAA || key == 0xCCCC) && runs_) restart();
  }
  void restart() {
    const std::uint64_t divider = std::uint64_t{4} << std::min<std::uint32_t>(prescaler_, 6);
    const Ticks end = machine_.timeline.now() + machine_.clocks.low_speed_internal.duration(divider * (reload_ + 1));
    machine_.timeline.set(slot_, end, end);
  }
  Machine& machine_;
  Timeline::Slot slot_;
  std::uint32_t prescaler_ = 0, reload_ = 0xFFF;
  bool unlocked_ = false, runs_ = false;
};

class WindowWatchdog final : public RegisterBlock, public TimedPart, public ClockUser {
 public:
  explicit WindowWatchdog(Machine& machine) : machine_(machine), slot_(machine.timeline.add(*this)) {
    machine.clock_users.push_back(this);
  }
  void reset() override {
    counter_ = 0x7F;
    configuration_ = 0x7F;
    active_ = early_ = false;
    plan();
    update_interrupt();
  }
  void step(Ticks now) override {
    start_ = now;
    --counter_;
    if (counter_ == 0x40) early_ = true;
    update_interrupt();
    if (counter_ < 0x40)
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
    return offset == 0 ? counter_ | (active_ ? activation : 0u) : offset == 4 ? configuration_ : early_ ? 1u : 0u;
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == 0) {
      const bool outside = active_ && counter_ > (configuration_ & 0x7F);
      active_ |= (value & activation) != 0;
      counter_ = value & 0x7F;
      start_ = machine_.timeline.now();
      // Too early, or at once below the limit.
      if (outside || (active_ && counter_ < 0x40)) machine_.request_reset(ResetCause::window_watchdog);
      plan();
    } else if (offset == 4) {
      configuration_ = value & 0x3FF;
      plan();
    } else {
      early_ = early_ && (value & 1) != 0;
    }
    update_interrupt();
  }

 private:
  static constexpr std::uint32_t activation = 1u << 7, early_interrupt = 1u << 9;
  void plan() {
    if (!active_) return machine_.timeline.set(slot_, never, never);
    const Ticks next = start_ + machine_.clocks.pclk1.duration(std::uint64_t{4096} << (configuration_ >> 7 & 3));
    machine_.timeline.set(slot_, next, counter_ <= 0x41 ? next : never);
  }
  void update_interrupt() { machine_.nvic.set_source(0, 0, early_ && (configuration_ & early_interrupt) != 0); }
  Machine& machine_;
  Timeline::Slot slot_;
  std::uint32_t counter_ = 0x7F, configuration_ = 0x7F;
  Ticks start_ = 0;
  bool active_ = false, early_ = false;
};

}  // namespace inkwell::virtual_board
