// Buttons and inkwell switch are contacts to ground with pull-ups in the chip.
#pragma once

#include "firmware/drivers/pins.hpp"

namespace inkwell::drivers {

/// A member is true while its contact is closed. The contacts bounce, so the caller must debounce them.
struct SwitchContacts {
  bool button_1;
  bool button_2;
  bool inkwell;
};

class Switches {
 public:
  static constexpr std::array claims{pin(board::facts.button_1), pin(board::facts.button_2),
                                     pin(board::facts.inkwell_switch)};

  void start() {
    DigitalInput<Switches, board::facts.button_1>::start(Pull::up);
    DigitalInput<Switches, board::facts.button_2>::start(Pull::up);
    DigitalInput<Switches, board::facts.inkwell_switch>::start(Pull::up);
  }

  /// Reads all contacts at one instant, with one port access.
  SwitchContacts read() const {
    static_assert(board::facts.button_1.port == board::facts.button_2.port &&
                  board::facts.button_1.port == board::facts.inkwell_switch.port);
    const std::uint32_t port = DigitalInput<Switches, board::facts.button_1>::read_port();
    const auto closed = [port](board::Pin pin) { return (port >> pin.number & 1u) == 0; };
    return {closed(board::facts.button_1), closed(board::facts.button_2), closed(board::facts.inkwell_switch)};
  }
};

}  // namespace inkwell::drivers
