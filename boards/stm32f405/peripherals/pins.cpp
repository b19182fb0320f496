#include "boards/stm32f405/peripherals/pins.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

namespace inkwell::virtual_board {
void GpioPort::reset() {
  const auto configure = [this](const auto& map) {
    moder_ = map.moder.reset_value;
    pupdr_ = map.pupdr.reset_value;
    ospeedr_ = map.ospeedr.reset_value;
  };
  if (index_ == 0)
    configure(gpio_a);
  else if (index_ == 1)
    configure(gpio_b);
  else
    configure(gpio);
  otyper_ = odr_ = lckr_ = 0;
  afr_ = {};
  lock_step_ = 0;
  pins_.reconnect(index_, 0xFFFF);
}

std::uint32_t GpioPort::stored(std::uint32_t offset) const {
  switch (offset) {
    case gpio.moder: return moder_;
    case gpio.otyper: return otyper_;
    case gpio.ospeedr: return ospeedr_;
    case gpio.pupdr: return pupdr_;
    case gpio.odr: return odr_;
    case gpio.afrl: return afr_[0];
    case gpio.afrh: return afr_[1];
    default: return 0;  // BSRR: bits that are not written have no effect
  }
}

std::uint32_t GpioPort::read_word(std::uint32_t offset) {
  switch (offset) {
    case gpio.idr: machine_.advance_circuit(Machine::input_age_limit); return idr_;
    case gpio.bsrr: return 0;
    case gpio.lckr: return lckr_;
    default: break;
  }
  if (offset <= gpio.afrh) return stored(offset);
  machine_.log.note("GPIO" + std::string(1, static_cast<char>('A' + index_)), offset, false, 0);
  return 0;
}

void GpioPort::write_configuration(std::uint32_t& target, std::uint32_t value, const Field& field) {
  std::uint32_t mask = field.masks();
  if (gpio.lckr.lckk.in(lckr_))
    for (unsigned i = 0; i < field.count; ++i)
      if (gpio.lckr.lck.in(lckr_, field.first + i)) mask &= ~field.mask(i);
  target = (target & ~mask) | (value & mask);
}

void GpioPort::write_output(std::uint32_t value) {
  std::uint32_t changed = odr_ ^ value;
  odr_ = value;
  for (; changed != 0; changed &= changed - 1) pins_.update(index_, static_cast<unsigned>(std::countr_zero(changed)));
}

void GpioPort::write_lock(std::uint32_t value) {
  if (gpio.lckr.lckk.in(lckr_)) return;  // locked until the next reset
  // Lock sequence: key with pins, pins without key, key with pins, then a read (RM0090, GPIOx_LCKR).
  const bool key = gpio.lckr.lckk.in(value);
  const bool expected = lock_step_ == 1 ? !key : key;
  if (lock_step_ > 0 && (value & gpio.lckr.lck.masks()) != (lckr_ & gpio.lckr.lck.masks()))
    lock_step_ = 0;
  else
    lock_step_ = expected ? lock_step_ + 1 : 0;
  lckr_ = value & gpio.lckr.lck.masks();
  if (lock_step_ == 3) lckr_ |= gpio.lckr.lckk.mask();
}

void GpioPort::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case gpio.bsrr: return write_output((odr_ & ~(value >> gpio.bsrr.br.position())) | (value & gpio.bsrr.bs.masks()));
    case gpio.odr: return write_output(value & writable(gpio.odr));
    case gpio.lckr: return write_lock(value);
    case gpio.moder: write_configuration(moder_, value, gpio.moder.moder); break;
    case gpio.otyper: write_configuration(otyper_, value, gpio.otyper.ot); break;
    case gpio.ospeedr: return write_configuration(ospeedr_, value, gpio.ospeedr.ospeedr);
    case gpio.pupdr: write_configuration(pupdr_, value, gpio.pupdr.pupdr); break;
    case gpio.afrl: write_configuration(afr_[0], value, gpio.afrl.afr); break;
    case gpio.afrh: write_configuration(afr_[1], value, gpio.afrh.afr); break;
    default: return machine_.log.note("GPIO" + std::string(1, static_cast<char>('A' + index_)), offset, true, value);
  }
  pins_.reconnect(index_, 0xFFFF);
}

Pins::Pins(Machine& machine, TimerInputs& timers, ExternalLines& external_lines)
    : machine_(machine), timers_(timers), external_lines_(external_lines) {
  ports_.reserve(ports);
  for (unsigned i = 0; i < ports; ++i) ports_.emplace_back(*this, machine, i);
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
        timers_.connect_input(route.timer, route.line, s.input);
      }
    update(port, pin);
  }
}

PinLevel Pins::output_of(unsigned port, unsigned pin) const {
  const GpioPort& pins = ports_[port];
  PinLevel level = PinLevel::floating;
  if (pins.mode(pin) == GpioPort::Mode::output) {
    level = pins.output_bit(pin) ? PinLevel::high : PinLevel::low;
  } else if (pins.mode(pin) == GpioPort::Mode::alternate) {
    const State& s = states_[port * 16 + pin];
    for (unsigned i = 0; i < s.routes && level == PinLevel::floating; ++i) {
      const TimerPin& route = timer_pins[s.route[i]];
      level = outputs_[route.timer * timer_lines + route.line].level;
    }
  }
  return level == PinLevel::high && pins.open_drain(pin) ? PinLevel::floating : level;
}

// Level of a pin while the chip does not drive the pin.
PinLevel Pins::outside(unsigned port, unsigned pin) const {
  const State& s = states_[port * 16 + pin];
  PinLevel level = s.driven;
  if (level == PinLevel::floating) {
    const unsigned pull = ports_[port].pull(pin);
    level = pull == 1 ? PinLevel::high : pull == 2 ? PinLevel::low : PinLevel::floating;
  }
  if (!s.inverted) return level;
  return level == PinLevel::high ? PinLevel::low : PinLevel::high;
}

PinLevel Pins::level(unsigned port, unsigned pin) const {
  const State& s = states_[port * 16 + pin];
  if (s.held != PinLevel::floating) return s.held;
  return s.output != PinLevel::floating ? s.output : outside(port, pin);
}

void Pins::update(unsigned port, unsigned pin, Ticks since) {
  State& s = state(port, pin);
  const PinLevel output = output_of(port, pin);
  if (output != s.output) {
    s.output = output;
    machine_.circuit.output_changed(static_cast<char>('A' + port), pin, output, machine_.timeline.now());
  }
  if (on_level)
    if (const PinLevel now = level(port, pin); now != s.level) {
      s.level = now;
      on_level(port, pin, now);
    }
  GpioPort& pins = ports_[port];
  bool input = false;
  if (pins.mode(pin) != GpioPort::Mode::analog) input = level(port, pin) == PinLevel::high;
  if (input == s.input) return;
  s.input = input;
  pins.set_input(pin, input);
  external_lines_.pin_changed(port, pin, input);
  if (output == PinLevel::floating)
    for (unsigned i = 0; i < s.routes; ++i) {
      const TimerPin& route = timer_pins[s.route[i]];
      timers_.input_changed(route.timer, route.line, input, std::min(since, machine_.timeline.now()));
    }
}

void Pins::invert(unsigned port, unsigned pin, bool inverted) {
  state(port, pin).inverted = inverted;
  update(port, pin);
}

void Pins::hold(char port, unsigned pin, PinLevel level) {
  const auto index = static_cast<unsigned>(port - 'A');
  if (index >= ports || pin > 15) return;
  state(index, pin).held = level;
  update(index, pin);
}

void Pins::drive(char port, unsigned pin, PinLevel level, Ticks since) {
  const unsigned index = static_cast<unsigned>(port - 'A');
  if (index >= ports || pin > 15) return;
  State& s = state(index, pin);
  if (s.driven == level) return;
  s.driven = level;
  update(index, pin, since);
}

}  // namespace inkwell::virtual_board
