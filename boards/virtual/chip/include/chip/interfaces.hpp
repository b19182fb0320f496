// What the parts of the virtual board share: time, events, interrupt lines, peripherals, pins.
//
// One thread runs everything in here. Other threads (sockets) hand over work through their own queues,
// which are emptied by events.
#pragma once

#include <chip/register_map.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace inkwell::virtual_board {

/// Board time. 8.4 GHz is a multiple of every clock in use (168 MHz is 50 ticks, 48 MHz 175, 16 MHz 525).
using Ticks = std::uint64_t;
inline constexpr Ticks ticks_per_s = 8'400'000'000;
constexpr double seconds(Ticks ticks) { return static_cast<double>(ticks) / static_cast<double>(ticks_per_s); }
constexpr Ticks ticks(double time_s) { return static_cast<Ticks>(time_s * static_cast<double>(ticks_per_s) + 0.5); }

/// Of the chip, and of its converters' reference VDDA, unless something is wrong with them.
inline constexpr double logic_supply_V = 3.3;

/// Events in the order of board time; equal times run in the order in which they were asked for.
class Scheduler {
 public:
  using Id = std::uint64_t;
  virtual ~Scheduler() = default;
  virtual Ticks now() const = 0;
  /// Runs `action` once when board time reaches `when` (at once, but not re-entrantly, if that has passed).
  virtual Id at(Ticks when, std::function<void()> action) = 0;
  virtual void cancel(Id id) = 0;
};

/// Level-sensitive inputs of the interrupt controller, by position in RM0090's vector table.
class InterruptController {
 public:
  virtual ~InterruptController() = default;
  virtual void set_level(unsigned position, bool asserted) = 0;
};

/// A block of registers on a bus. Offsets are within the block; sizes are 1, 2 or 4 bytes.
class Peripheral {
 public:
  virtual ~Peripheral() = default;
  virtual std::uint32_t read(std::uint32_t offset, unsigned size) = 0;
  virtual void write(std::uint32_t offset, std::uint32_t value, unsigned size) = 0;
  virtual void reset() = 0;
  /// Its registers under the names of the reference manual, if it is called `name` and lies at `base`.
  virtual std::vector<RegisterMap> register_maps(const std::string&, std::uint32_t) const { return {}; }
};

/// Says once per place that firmware touched a register that is not modelled.
class UnmodelledLog {
 public:
  virtual ~UnmodelledLog() = default;
  virtual void note(const std::string& peripheral, std::uint32_t offset, bool write, std::uint32_t value) = 0;
};

/// Clocks and pins as they are now, for a peripheral that depends on them.
class ChipState {
 public:
  virtual ~ChipState() = default;
  virtual std::uint32_t hclk_Hz() const = 0;
  virtual std::uint32_t usb_Hz() const = 0;  ///< PLL48CLK; 0 if it stands still
  virtual bool has_function(char port, unsigned pin, unsigned alternate_function) const = 0;
};

/// Signals that lead from a peripheral to the trigger inputs of the timers.
class TriggerLines {
 public:
  virtual ~TriggerLines() = default;
  /// The USB core OTG_FS has received a start of frame.
  virtual void usb_start_of_frame() = 0;
};

enum class PinLevel : std::uint8_t { low, high, floating };

/// What stands behind a voltage at an analogue pin. None of either is an ideal source.
struct AnalogSource {
  double resistance_ohm = 0.0;
  double capacitance_F = 0.0;  ///< from the pin to ground
  double pull_down_ohm = 0.0;  ///< at the pin, the chip's side of what may break; 0 where there is none
};

/// What is soldered to the chip. Times of calls never run backward.
class Circuit {
 public:
  virtual ~Circuit() = default;
  /// The chip drives a pin (GPIO output or a timer's output), or lets go of it. `port` is 'A'..'I'.
  virtual void output_changed(char port, unsigned pin, PinLevel level, Ticks now) = 0;
  /// Voltage that an ADC samples at a pin, in volts. Called at the sampling instant.
  virtual double analog_V(char port, unsigned pin, Ticks now) = 0;
  /// How fast that voltage reaches the ADC's sampling capacitor.
  virtual AnalogSource analog_source(char /*port*/, unsigned /*pin*/) const { return {}; }
  /// Lets the circuit's own time pass; called at least once every 50 us of board time.
  virtual void advance(Ticks now) = 0;
};

/// How a circuit drives the chip's digital inputs; edges reach GPIO, EXTI and timer inputs.
class InputPins {
 public:
  virtual ~InputPins() = default;
  static constexpr Ticks just_now = ~Ticks{0};
  /// A circuit that looks back, as one that moves in steps does, tells since when the level has been so. Calls for one
  /// pin come in the order of these times.
  virtual void drive(char port, unsigned pin, PinLevel level, Ticks since = just_now) = 0;
  /// The pin touches something that wins against the chip's own output; `floating` is nothing any more.
  virtual void hold(char /*port*/, unsigned /*pin*/, PinLevel /*level*/) {}
};

}  // namespace inkwell::virtual_board
