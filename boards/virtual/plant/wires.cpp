#include "boards/virtual/plant/wires.hpp"

#include <algorithm>
#include <cmath>

namespace inkwell::virtual_board {

const PinName* Wires::neighbour(PinName wire) const {
  for (const Pair& pair : contacts_) {
    if (pair.a == wire) return &pair.b;
    if (pair.b == wire) return &pair.a;
  }
  return nullptr;
}

// Returns the level at the receiving end of a wire. Two touching wires are low if one of the wires is driven low. An
// undriven wire has the level of the wire that it touches.
PinLevel Wires::arriving(PinName wire, PinLevel State::*driven, PinLevel State::*frozen) {
  const State& s = state(wire);
  switch (s.fault) {
    case WireFault::open: return PinLevel::floating;
    case WireFault::low: return PinLevel::low;
    case WireFault::high: return PinLevel::high;
    case WireFault::frozen: return s.*frozen;
    case WireFault::intact: break;
  }
  const PinName* other = neighbour(wire);
  if (other == nullptr || state(*other).*driven == PinLevel::floating) return s.*driven;
  return s.*driven == PinLevel::floating || state(*other).*driven == PinLevel::low ? state(*other).*driven : s.*driven;
}

void Wires::update_chip(PinName wire, Ticks since) {
  if (chip_ != nullptr)
    chip_->drive(wire.port, wire.pin, arriving(wire, &State::by_circuit, &State::frozen_by_circuit), since);
}

void Wires::update_circuit(PinName wire) {
  circuit_.output_changed(wire.port, wire.pin, arriving(wire, &State::by_chip, &State::frozen_by_chip), now_);
}

void Wires::update_both(PinName wire) {
  update_chip(wire, just_now);
  update_circuit(wire);
}

void Wires::set(PinName wire, WireFault fault) {
  State& s = state(wire);
  s.frozen_by_chip = arriving(wire, &State::by_chip, &State::frozen_by_chip);
  s.frozen_by_circuit = arriving(wire, &State::by_circuit, &State::frozen_by_circuit);
  s.frozen_V = s.newest_V;
  s.since = now_;
  s.fault = fault;
  // A short circuit overrides the output of the chip.
  const bool is_shorted = fault == WireFault::low || fault == WireFault::high;
  if (chip_ != nullptr)
    chip_->hold(wire.port, wire.pin,
                is_shorted ? arriving(wire, &State::by_chip, &State::frozen_by_chip) : PinLevel::floating);
  update_both(wire);
}

void Wires::set_contact(PinName a, PinName b, bool in_contact) {
  std::erase_if(contacts_,
                [&](const Pair& pair) { return (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a); });
  if (in_contact) contacts_.push_back({a, b});
  update_both(a);
  update_both(b);
}

void Wires::output_changed(char port, unsigned pin, PinLevel level, Ticks now) {
  now_ = std::max(now_, now);
  const PinName wire{port, pin};
  state(wire).by_chip = level;
  if (state(wire).fault == WireFault::intact) update_circuit(wire);
  if (const PinName* other = neighbour(wire)) update_circuit(*other);
}

void Wires::drive(char port, unsigned pin, PinLevel level, Ticks since) {
  const PinName wire{port, pin};
  state(wire).by_circuit = level;
  if (state(wire).fault == WireFault::intact) update_chip(wire, since);
  if (const PinName* other = neighbour(wire)) update_chip(*other, since);
}

double Wires::volts(PinName wire, Ticks now) {
  const State& s = state(wire);
  switch (s.fault) {
    case WireFault::open: {
      const AnalogSource source = circuit_.analog_source(wire.port, wire.pin);
      const double falls_s = source.pull_down_ohm > 0.0 ? source.pull_down_ohm * source.capacitance_F : open_input_s;
      return s.frozen_V * std::exp(-seconds(now - s.since) / falls_s);
    }
    case WireFault::low: return 0.0;
    case WireFault::high: return logic_supply_V;
    case WireFault::frozen: return s.frozen_V;
    case WireFault::intact: break;
  }
  return circuit_.analog_V(wire.port, wire.pin, now);
}

double Wires::analog_V(char port, unsigned pin, Ticks now) {
  now_ = std::max(now_, now);
  const PinName wire{port, pin};
  double read_V = volts(wire, now);
  if (const PinName* other = neighbour(wire)) read_V = 0.5 * (read_V + volts(*other, now));
  state(wire).newest_V = read_V;
  return read_V;
}

// A broken wire is a source without impedance, because its voltage already includes the time constant.
AnalogSource Wires::analog_source(char port, unsigned pin) const {
  return states_[index({port, pin})].fault == WireFault::intact ? circuit_.analog_source(port, pin) : AnalogSource{};
}

void Wires::advance(Ticks now) {
  now_ = std::max(now_, now);
  circuit_.advance(now);
}

}  // namespace inkwell::virtual_board
