#include "pins.hpp"

#include <bit>
#include <iterator>

#include "exti.hpp"
#include "timers.hpp"

namespace inkwell::virtual_board {
namespace {
constexpr std::uint32_t moder = 0x00, otyper = 0x04, ospeedr = 0x08, pupdr = 0x0C, idr = 0x10, odr = 0x14, bsrr = 0x18,
                        lckr = 0x1C, afrl = 0x20, afrh = 0x24;
constexpr std::uint32_t lock_key = 1u << 16;
}  // namespace

void GpioPort::reset() {
  // The debug pins of ports A and B start in their alternate function (RM0090, reset values).
  moder_ = index_ == 0 ? 0xA800'0000 : index_ == 1 ? 0x0000'0280 : 0;
  pupdr_ = index_ == 0 ? 0x6400'0000 : index_ == 1 ? 0x0000'0100 : 0;
  ospeedr_ = index_ == 0 ? 0x0C00'0000 : index_ == 1 ? 0x0000'00C0 : 0;
  otyper_ = odr_ = lckr_ = 0;
  afr_ = {};
  lock_step_ = 0;
  pins_.reconnect(index_, 0xFFFF);
}

std::uint32_t GpioPort::stored(std::uint32_t offset) const {
  switch (offset) {
    case moder: return moder_;
    case otyper: return otyper_;
    case ospeedr: return ospeedr_;
    case pupdr: return pupdr_;
    case odr: return odr_;
    case afrl: return afr_[0];
    case afrh: return afr_[1];
    default: return 0;  // BSRR: what is not written changes nothing
  }
}

std::uint32_t GpioPort::read_word(std::uint32_t offset) {
  switch (offset) {
    case idr: machine_.advance_circuit(Machine::input_age_limit); return idr_;
    case bsrr: return 0;
    case lckr: return lckr_;
    default: break;
  }
  if (offset <= afrh) return stored(offset);
  machine_.log.note("GPIO" + std::string(1, static_cast<char>('A' + index_)), offset, false, 0);
  return 0;
}

void GpioPort::write_configuration(std::uint32_t& target, std::uint32_t value, unsigned bits_per_pin) {
  std::uint32_t mask = 0xFFFF'FFFF;
  if ((lckr_ & lock_key) != 0)
    for (unsigned pin = 0; pin < 16; ++pin)
      if ((lckr_ >> pin & 1) != 0) {
        const unsigned shift = bits_per_pin * pin % 32;
        const bool in_this_word = bits_per_pin < 4 || &target == &afr_[pin >> 3];
        if (in_this_word) mask &= ~(((1u << bits_per_pin) - 1) << shift);
      }
  target = (target & ~mask) | (value & mask);
}

void GpioPort::write_output(std::uint32_t value) {
  std::uint32_t changed = odr_ ^ value;
  odr_ = value;
  for (; changed != 0; changed &= changed - 1) pins_.update(index_, static_cast<unsigned>(std::countr_zero(changed)));
}

void GpioPort::write_lock(std::uint32_t value) {
  if ((lckr_ & lock_key) != 0) return;  // until the next reset
  // Sequence: key with pins, pins without key, key with pins (RM0090, GPIOx_LCKR); then a read.
  const bool key = (value & lock_key) != 0;
  const bool expected = lock_step_ == 1 ? !key : key;
  if (lock_step_ > 0 && (value & 0xFFFF) != (lckr_ & 0xFFFF))
    lock_step_ = 0;
  else
    lock_step_ = expected ? lock_step_ + 1 : 0;
  lckr_ = value & 0xFFFF;
  if (lock_step_ == 3) lckr_ |= lock_key;
}

void GpioPort::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case bsrr: return write_output((odr_ & ~(value >> 16)) | (value & 0xFFFF));
    case odr: return write_output(value & 0xFFFF);
    case lckr: return write_lock(value);
    case moder: write_configuration(moder_, value, 2); break;
    case otyper: write_configuration(otyper_, value & 0xFFFF, 1); break;
    case ospeedr: return write_configuration(ospeedr_, value, 2);
    case pupdr: write_configuration(pupdr_, value, 2); break;
    case afrl: write_configuration(afr_[0], value, 4); break;
    case afrh: write_configuration(afr_[1], value, 4); break;
    default: return machine_.log.note("GPIO" + std::string(1, static_cast<char>('A' + index_)), offset, true, value);
  }
  pins_.reconnect(index_, 0xFFFF);
}

Pins::Pins(Machine& machine) : machine_(machine) {
  ports_.reserve(ports);
  for (unsigned i = 0; i < ports; ++i) ports_.emplace_back(*this, machine, i);
  machine.pins = this;
}

void Pins::reconnect(unsigned port, std::uint32_t pins) {
  for (; pins != 0; pins &= pins - 1) {
    const unsigned pin = static_cast<unsigned>(std::countr_zero(pins));
    State& s = state(port, pin);
    const auto code = static_cast<std::uint8_t>(port << 4 | pin);
    for (unsigned i = 0; i < s.routes; ++i) {
      const TimerPin& route = timer_pins[s.route[i]];
      auto& output = outputs_[route.timer * timer_lines + route.line];
      for (unsigned k = 0; k < output.count; ++k)
        if (output.pins[k] == code) output.pins[k--] = output.pins[--output.count];
    }
    s.routes = 0;
    if (ports_[port].mode(pin) == GpioPort::Mode::alternate)
      for (unsigned i = 0; i < std::size(timer_pins); ++i) {
        const TimerPin& route = timer_pins[i];
        if (route.port != static_cast<char>('A' + port) || route.pin != pin ||
            route.alternate_function != ports_[port].alternate_function(pin))
          continue;
        s.route[s.routes++] = static_cast<std::uint8_t>(i);
        auto& output = outputs_[route.timer * timer_lines + route.line];
        if (output.count < output.pins.size()) output.pins[output.count++] = code;
        machine_.timers->timer(route.timer).connect_input(route.line, s.input);
      }
    update(port, pin);
  }
}

PinLevel Pins::output_of(unsigned port, unsigned pin) const {
  const GpioPort& gpio = ports_[port];
  PinLevel level = PinLevel::floating;
  if (gpio.mode(pin) == GpioPort::Mode::output) {
    level = gpio.output_bit(pin) ? PinLevel::high : PinLevel::low;
  } else if (gpio.mode(pin) == GpioPort::Mode::alternate) {
    const State& s = states_[port * 16 + pin];
    for (unsigned i = 0; i < s.routes && level == PinLevel::floating; ++i) {
      const TimerPin& route = timer_pins[s.route[i]];
      level = outputs_[route.timer * timer_lines + route.line].level;
    }
  }
  return level == PinLevel::high && gpio.open_drain(pin) ? PinLevel::floating : level;
}

void Pins::update(unsigned port, unsigned pin) {
  State& s = state(port, pin);
  const PinLevel output = output_of(port, pin);
  if (output != s.output) {
    s.output = output;
    machine_.circuit.output_changed(static_cast<char>('A' + port), pin, output, machine_.timeline.now());
  }
  GpioPort& gpio = ports_[port];
  bool input = false;
  if (gpio.mode(pin) != GpioPort::Mode::analog) {
    const PinLevel level = output != PinLevel::floating ? output : s.driven;
    input = level == PinLevel::floating ? gpio.pull(pin) == 1 : level == PinLevel::high;
  }
  if (input == s.input) return;
  s.input = input;
  gpio.set_input(pin, input);
  machine_.exti->pin_changed(port, pin, input);
  if (output == PinLevel::floating)
    for (unsigned i = 0; i < s.routes; ++i) {
      const TimerPin& route = timer_pins[s.route[i]];
      machine_.timers->input_changed(route.timer, route.line, input);
    }
}

void Pins::drive(char port, unsigned pin, PinLevel level) {
  const unsigned index = static_cast<unsigned>(port - 'A');
  if (index >= ports || pin > 15) return;
  State& s = state(index, pin);
  if (s.driven == level) return;
  s.driven = level;
  update(index, pin);
}

}  // namespace inkwell::virtual_board
