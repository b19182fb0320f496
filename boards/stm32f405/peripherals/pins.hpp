// GPIO A to I: registers and pin levels (RM0090, "General-purpose I/Os").
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/alternate_functions.hpp"
#include "boards/stm32f405/peripherals/gpio_map.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"

namespace inkwell::virtual_board {

class Pins;

class GpioPort final : public RegisterBlock {
 public:
  GpioPort(Pins& pins, Machine& machine, unsigned index) : pins_(pins), machine_(machine), index_(index) {}
  void reset() override;

  enum class Mode : std::uint8_t { input, output, alternate, analog };
  Mode mode(unsigned pin) const { return static_cast<Mode>(gpio.moder.moder.of(moder_, pin)); }
  bool open_drain(unsigned pin) const { return gpio.otyper.ot.in(otyper_, pin); }
  unsigned pull(unsigned pin) const { return gpio.pupdr.pupdr.of(pupdr_, pin); }
  bool output_bit(unsigned pin) const { return gpio.odr.odr.in(odr_, pin); }
  unsigned alternate_function(unsigned pin) const { return gpio.afrl.afr.of(afr_[pin / 8], pin % 8); }
  void set_input(unsigned pin, bool high) { idr_ = (idr_ & ~gpio.idr.idr.mask(pin)) | gpio.idr.idr.with(high, pin); }
  bool input(unsigned pin) const { return gpio.idr.idr.in(idr_, pin); }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;
  std::span<const MapEntry> registers() const override {
    return index_ == 0 ? shown<gpio_a>() : index_ == 1 ? shown<gpio_b>() : shown<gpio>();
  }

 private:
  void write_configuration(std::uint32_t& target, std::uint32_t value, const Field& field);
  void write_output(std::uint32_t value);
  void write_lock(std::uint32_t value);
  Pins& pins_;
  Machine& machine_;
  unsigned index_;
  std::uint32_t moder_ = 0, otyper_ = 0, ospeedr_ = 0, pupdr_ = 0, idr_ = 0, odr_ = 0, lckr_ = 0;
  std::array<std::uint32_t, 2> afr_{};
  unsigned lock_step_ = 0;
};

class Pins final : public InputPins, public TimerOutputs, public PinFunctions {
 public:
  static constexpr unsigned ports = 9;
  Pins(Machine& machine, TimerInputs& timers, ExternalLines& external_lines);
  GpioPort& port(unsigned index) { return ports_[index]; }
  bool has_function(unsigned port, unsigned pin, unsigned function) const override {
    return ports_[port].mode(pin) == GpioPort::Mode::alternate && ports_[port].alternate_function(pin) == function;
  }
  bool is_analog(unsigned port, unsigned pin) const override {
    return ports_[port].mode(pin) == GpioPort::Mode::analog;
  }
  void drive(char port, unsigned pin, PinLevel level, Ticks since = just_now) override;
  void hold(char port, unsigned pin, PinLevel level) override;
  /// While `inverted` is true, the level from the circuit is inverted.
  void invert(unsigned port, unsigned pin, bool inverted);
  /// Electrical level at the pin.
  PinLevel level(unsigned port, unsigned pin) const;
  PinLevel output(unsigned port, unsigned pin) const { return states_[port * 16 + pin].output; }
  /// Callback at each level change of a pin.
  std::function<void(unsigned port, unsigned pin, PinLevel level)> on_level;

  void timer_output(unsigned timer, unsigned line, PinLevel level) override {
    auto& output = outputs_[timer * timer_lines + line];
    if (output.level == level) return;
    output.level = level;
    for (unsigned i = 0; i < output.count; ++i) update(output.pins[i] >> 4, output.pins[i] & 15);
  }

  /// Call this function when the mode or the alternate function of `pins` has changed.
  void reconnect(unsigned port, std::uint32_t pins);
  /// Updates the level of a pin and reports the level to the circuit, timers, EXTI and on_level.
  void update(unsigned port, unsigned pin, Ticks since = just_now);

 private:
  struct TimerOutput {
    PinLevel level = PinLevel::floating;
    std::uint8_t count = 0;
    std::array<std::uint8_t, 3> pins{};  ///< port << 4 | pin
  };
  struct State {
    PinLevel driven = PinLevel::floating;  ///< by the circuit
    PinLevel held = PinLevel::floating;    ///< by hold(), stronger than the chip's output
    PinLevel output = PinLevel::floating;  ///< by the chip, last reported to the circuit
    PinLevel level = PinLevel::floating;   ///< last reported to on_level
    bool input = false;
    bool inverted = false;
    std::uint8_t routes = 0;
    std::array<std::uint8_t, 2> route{};  ///< indices into timer_pins
  };
  State& state(unsigned port, unsigned pin) { return states_[port * 16 + pin]; }
  PinLevel output_of(unsigned port, unsigned pin) const;
  PinLevel outside(unsigned port, unsigned pin) const;

  Machine& machine_;
  TimerInputs& timers_;
  ExternalLines& external_lines_;
  std::vector<GpioPort> ports_;
  std::array<State, ports * 16> states_{};
  std::array<TimerOutput, 15 * timer_lines> outputs_{};
};

}  // namespace inkwell::virtual_board
