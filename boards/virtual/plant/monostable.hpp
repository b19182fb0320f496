// The retriggerable monostable 74LVC1G123 with input A grounded (data sheet, function table).
#pragma once

#include <algorithm>

#include "boards/stm32f405/core/interfaces.hpp"

namespace inkwell::virtual_board {

class Monostable {
 public:
  explicit Monostable(Ticks duration) : duration_(duration) {}

  /// CLR input. A low level of CLR ends the output pulse. A rising edge of CLR starts a pulse if the trigger is high.
  void drive_clear(bool high, Ticks now) { drive(clear_high_, high, now); }
  /// B input. Each rising edge of B restarts the output pulse if CLR is high.
  void drive_trigger(bool high, Ticks now) { drive(trigger_high_, high, now); }

  /// Returns the end of the output pulse (Q high).
  Ticks ends_at() const { return ends_at_; }

 private:
  void drive(bool& input_high, bool high, Ticks now) {
    const bool rises = high && !input_high;
    input_high = high;
    if (rises && trigger_high_) ends_at_ = now + duration_;
    if (!clear_high_) ends_at_ = std::min(ends_at_, now);
  }

  Ticks duration_, ends_at_ = 0;
  bool clear_high_ = false, trigger_high_ = false;
};

}  // namespace inkwell::virtual_board
