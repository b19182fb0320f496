// Lines between the peripherals. Wiring connects them (wiring/parts.hpp).
#pragma once

#include <cstdint>

#include "boards/stm32f405/core/interfaces.hpp"

namespace inkwell::virtual_board {

/// Request lines of the DMA controllers. A request returns false if no stream accepts it.
class DmaRequests {
 public:
  virtual ~DmaRequests() = default;
  virtual bool adc_request(unsigned index) = 0;
  /// Returns true if an interrupt is enabled in a DMA stream of the converter.
  virtual bool interrupts_for_adc(unsigned index) const = 0;
  /// `source` is 0 for the update event and 1 to 4 for the channels.
  virtual bool timer_request(unsigned timer, unsigned source) = 0;
  virtual bool usart_request(unsigned number, bool transmit) = 0;
  virtual bool spi_request(unsigned number, bool transmit) = 0;
};

/// Peripherals that use DMA.
class DmaUsers {
 public:
  virtual ~DmaUsers() = default;
  /// Handles waiting requests after a stream has been enabled.
  virtual void serve_dma() = 0;
};

/// Trigger inputs of the converters.
class ConverterTriggers {
 public:
  virtual ~ConverterTriggers() = default;
  /// Handles a timer event: a compare match of channel 1 to 4, or trigger_output (timers.hpp).
  virtual void timer_trigger(unsigned timer, unsigned channel) = 0;
  /// Returns true if the processor waits for conversions that the timer event starts.
  virtual bool listens_to_timer(unsigned timer, unsigned channel) const = 0;
  virtual void external_line(unsigned line) = 0;
};

/// Users of timer events.
class TimerEventUsers {
 public:
  virtual ~TimerEventUsers() = default;
  /// Reports that a part of the chip starts or stops using timer events.
  virtual void timer_events_changed() = 0;
};

/// Input pins of the timers.
class TimerInputs {
 public:
  virtual ~TimerInputs() = default;
  virtual void input_changed(unsigned timer, unsigned line, bool high, Ticks when) = 0;
  /// Connects a pin. The initial level is not counted as an edge.
  virtual void connect_input(unsigned timer, unsigned line, bool high) = 0;
};

/// Output lines of the timers.
class TimerOutputs {
 public:
  virtual ~TimerOutputs() = default;
  /// Sets a timer output. Calls must be in the order of board time.
  virtual void timer_output(unsigned timer, unsigned line, PinLevel level) = 0;
};

/// Pin functions that firmware has selected. `port` is 0 for port A.
class PinFunctions {
 public:
  virtual ~PinFunctions() = default;
  virtual bool has_function(unsigned port, unsigned pin, unsigned alternate_function) const = 0;
  virtual bool is_analog(unsigned port, unsigned pin) const = 0;
};

/// Inputs of the EXTI lines.
class ExternalLines {
 public:
  virtual ~ExternalLines() = default;
  virtual void pin_changed(unsigned port, unsigned pin, bool high) = 0;
  /// Sets the level of an internal EXTI line, 16 to 22.
  virtual void internal_line(unsigned line, bool high) = 0;
};

/// Output of the clock security system.
class CrystalFailure {
 public:
  virtual ~CrystalFailure() = default;
  virtual void crystal_failed() = 0;
};

}  // namespace inkwell::virtual_board
