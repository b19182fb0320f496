// Buttons and the inkwell switch: closing to ground, with pull-ups in the chip.
#pragma once

#include <drivers/pins.hpp>

namespace inkwell::drivers {

/// True is closed. The contacts bounce; who reads them more than once debounces them.
struct SwitchContacts {
  bool button_1;
  bool button_2;
  bool inkwell;
};

class Switches {
 public:
  static constexpr std::array claims{pin(board::button_1), pin(board::button_2), pin(board::inkwell_switch)};

  void start() {
    DigitalInput<Switches, board::button_1>::start(Pull::up);
    DigitalInput<Switches, board::button_2>::start(Pull::up);
    DigitalInput<Switches, board::inkwell_switch>::start(Pull::up);
  }

  SwitchContacts read() const {
    return {!DigitalInput<Switches, board::button_1>::is_high(), !DigitalInput<Switches, board::button_2>::is_high(),
            !DigitalInput<Switches, board::inkwell_switch>::is_high()};
  }
};

}  // namespace inkwell::drivers
