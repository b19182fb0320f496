// Interfaces between the parts of the virtual board: time, events, interrupt lines, peripherals, pins.
//
// The board thread runs all parts of the virtual board. The socket threads pass their work to the board thread through
// queues.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>
#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

/// Board time in ticks of 1 / 8.4 GHz. One cycle lasts 50 ticks at 168 MHz, 175 ticks at 48 MHz, and 525 ticks at 16
/// MHz.
using Ticks = std::uint64_t;
inline constexpr Ticks ticks_per_s = 8'400'000'000;
constexpr double seconds(Ticks ticks) { return static_cast<double>(ticks) / static_cast<double>(ticks_per_s); }
constexpr Ticks ticks(double time_s) { return static_cast<Ticks>(time_s * static_cast<double>(ticks_per_s) + 0.5); }

/// Nominal voltage of VDD and VDDA.
inline constexpr double logic_supply_V = 3.3;

/// Runs events in the order of board time. Events with equal times run in the order of their requests.
class Scheduler {
 public:
  using Id = std::uint64_t;
  virtual ~Scheduler() = default;
  virtual Ticks now() const = 0;
  /// Runs `action` once when board time reaches `when`. If `when` is in the past, `action` runs at the current board
  /// time, after at() has returned.
  virtual Id at(Ticks when, std::function<void()> action) = 0;
  virtual void cancel(Id id) = 0;
};

/// Level-sensitive inputs of the interrupt controller. Their numbers are the positions in the vector table of RM0090.
class InterruptController {
 public:
  virtual ~InterruptController() = default;
  virtual void set_level(unsigned position, bool asserted) = 0;
};

/// A register block on a bus. Offsets are relative to the start of the block. An access has 1, 2 or 4 bytes.
class Peripheral {
 public:
  virtual ~Peripheral() = default;
  virtual std::uint32_t read(std::uint32_t offset, unsigned size) = 0;
  virtual void write(std::uint32_t offset, std::uint32_t value, unsigned size) = 0;
  virtual void reset() = 0;
  /// Returns register maps with names from the reference manual. The arguments are the name and base address of the
  /// peripheral.
  virtual std::vector<RegisterMap> register_maps(const std::string&, std::uint32_t) const { return {}; }
};

/// Logs the first access to each unmodeled register.
class UnmodelledLog {
 public:
  virtual ~UnmodelledLog() = default;
  virtual void note(const std::string& peripheral, std::uint32_t offset, bool write, std::uint32_t value) = 0;
};

/// Present clocks and pin functions of the chip.
class ChipState {
 public:
  virtual ~ChipState() = default;
  virtual std::uint32_t hclk_Hz() const = 0;
  virtual std::uint32_t usb_Hz() const = 0;  ///< PLL48CLK; 0 if it is stopped
  virtual bool has_function(char port, unsigned pin, unsigned alternate_function) const = 0;
};

/// Trigger signals from a peripheral to the timers.
class TriggerLines {
 public:
  virtual ~TriggerLines() = default;
  /// Call this function when OTG_FS receives a start of frame.
  virtual void usb_start_of_frame() = 0;
};

enum class PinLevel : std::uint8_t { low, high, floating };

/// Voltage source at an analog pin. A source with zero resistance and capacitance is ideal.
struct AnalogSource {
  double resistance_ohm = 0.0;
  double capacitance_F = 0.0;  ///< from the pin to ground
  double pull_down_ohm = 0.0;  ///< on the chip's side of a wire break; 0 if there is none
};

/// Circuit around the chip. `now` never decreases from call to call.
class Circuit {
 public:
  virtual ~Circuit() = default;
  /// Called when the chip drives or releases a pin (GPIO output or timer output). `port` is 'A'..'I'.
  virtual void output_changed(char port, unsigned pin, PinLevel level, Ticks now) = 0;
  /// Returns the voltage at a pin, in volts. An ADC calls this function at its sampling instant.
  virtual double analog_V(char port, unsigned pin, Ticks now) = 0;
  /// Returns the voltage source at a pin. The source impedance determines the charging time of the sampling capacitor.
  virtual AnalogSource analog_source(char /*port*/, unsigned /*pin*/) const { return {}; }
  /// Advances the circuit to `now`. The chip calls this function at least once every 50 us of board time.
  virtual void advance(Ticks now) = 0;
};

/// The circuit drives the pins of the chip through this interface. Edges reach GPIO, EXTI and timer inputs.
class InputPins {
 public:
  virtual ~InputPins() = default;
  static constexpr Ticks just_now = ~Ticks{0};
  /// Drives a pin. If the circuit computes in steps, `since` is the time of the edge within the step. `since` must not
  /// decrease between the calls for one pin.
  virtual void drive(char port, unsigned pin, PinLevel level, Ticks since = just_now) = 0;
  /// Overrides the chip's output at a pin. `floating` removes the override.
  virtual void hold(char /*port*/, unsigned /*pin*/, PinLevel /*level*/) {}
};

}  // namespace inkwell::virtual_board
