// The retriggerable monostable between the chip and the bridges' enable input: 74LVC1G123, its input A on ground (data
// sheet, function table).
#pragma once

#include <algorithm>

#include <chip/interfaces.hpp>

namespace inkwell::virtual_board {

class Monostable {
 public:
  explicit Monostable(Ticks duration) : duration_(duration) {}

  /// CLR: ends the output when it is low, starts it when it rises while the trigger is high.
  void drive_clear(bool high, Ticks now) { drive(clear_high_, high, now); }
  /// B: each rise starts the output anew, unless CLR is low.
  void drive_trigger(bool high, Ticks now) { drive(trigger_high_, high, now); }

  /// The output Q is high until then, if nothing comes before.
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
