// The wires between chip and circuit, with wire faults. Each call between chip and circuit passes through the class
// Wires.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "boards/stm32f405/core/interfaces.hpp"
#include "boards/stm32f405/peripherals/pin_name.hpp"

namespace inkwell::virtual_board {

enum class WireFault : std::uint8_t {
  intact,
  open,    ///< its receiver floats; an analog input falls to 0 V through its resistor or through leakage
  low,     ///< shorted to ground
  high,    ///< shorted to the chip's 3.3 V supply
  frozen,  ///< retains its level
};

/// Connects a chip and a circuit. The chip uses Wires as its Circuit, and the circuit uses Wires as its InputPins.
class Wires final : public Circuit, public InputPins {
 public:
  static constexpr double open_input_s = 0.01;  ///< time constant of an analog input without a resistor to ground

  explicit Wires(Circuit& circuit) : circuit_(circuit) {}
  /// Connects the chip.
  void connect(InputPins& chip) { chip_ = &chip; }

  void set(PinName wire, WireFault fault);
  void set_contact(PinName a, PinName b, bool in_contact);

  void output_changed(char port, unsigned pin, PinLevel level, Ticks now) override;
  double analog_V(char port, unsigned pin, Ticks now) override;
  AnalogSource analog_source(char port, unsigned pin) const override;
  void advance(Ticks now) override;
  void drive(char port, unsigned pin, PinLevel level, Ticks since) override;

 private:
  struct State {
    WireFault fault = WireFault::intact;
    PinLevel by_chip = PinLevel::floating, by_circuit = PinLevel::floating;  ///< driven level at either end
    PinLevel frozen_by_chip = PinLevel::floating, frozen_by_circuit = PinLevel::floating;
    double newest_V = 0.0, frozen_V = 0.0;
    Ticks since = 0;  ///< time at which the fault began
  };
  struct Pair {
    PinName a, b;
  };
  static std::size_t index(PinName wire) { return static_cast<std::size_t>(wire.port - 'A') * 16 + wire.pin; }
  State& state(PinName wire) { return states_[index(wire)]; }
  const PinName* neighbour(PinName wire) const;
  PinLevel arriving(PinName wire, PinLevel State::*driven, PinLevel State::*frozen);
  void update_chip(PinName wire, Ticks since);
  void update_circuit(PinName wire);
  void update_both(PinName wire);
  double volts(PinName wire, Ticks now);

  Circuit& circuit_;
  InputPins* chip_ = nullptr;
  std::array<State, 16 * 9> states_{};  ///< ports A to I
  std::vector<Pair> contacts_;
  Ticks now_ = 0;
};

}  // namespace inkwell::virtual_board
