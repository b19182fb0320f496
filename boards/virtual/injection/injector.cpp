#include "boards/virtual/injection/injector.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include "boards/stm32f405/core/memory_map.hpp"

namespace inkwell::virtual_board {
namespace {

using protocol::InjectedFault;

/// Returns the same value for faults that exclude each other at one location.
InjectedFault kind(InjectedFault fault) {
  switch (fault) {
    case InjectedFault::wire_low:
    case InjectedFault::wire_high:
    case InjectedFault::wire_frozen: return InjectedFault::wire_open;
    case InjectedFault::shunt_low:
    case InjectedFault::shunt_frozen: return InjectedFault::shunt_high;
    case InjectedFault::leg_low:
    case InjectedFault::leg_open: return InjectedFault::leg_high;
    case InjectedFault::supply_spike:
    case InjectedFault::supply_cut: return InjectedFault::supply_sag;
    case InjectedFault::analog_sag: return InjectedFault::logic_sag;
    default: return fault;
  }
}

/// Returns true if the fault is momentary.
bool is_momentary(InjectedFault fault) {
  return fault == InjectedFault::encoder_slip || fault == InjectedFault::program_astray ||
         fault == InjectedFault::ram_bit || fault == InjectedFault::flash_bit;
}

bool is_within(std::uint32_t address, std::uint32_t base, std::uint32_t bytes) {
  return address >= base && address - base < bytes;
}

/// Returns the size of the flash content without the erased words at the end.
std::uint32_t programmed_bytes(const Chip& chip) {
  std::uint32_t bytes = flash_bytes;
  while (bytes > 4 && chip.memory_word(flash_base + bytes - 4) == 0xFFFF'FFFF) bytes -= 4;
  return bytes;
}

void flip_bit(Chip& chip, const Injection& injection) {
  if (!chip.flip_bit(*injection.address, static_cast<unsigned>(injection.amount)))
    throw InvalidInjection(fmt::format("there is no memory at 0x{:08X} for a bit flip", *injection.address));
}

}  // namespace

unsigned Injector::add(Injection injection) {
  if (active_.size() + planned_.size() >= faults_maximum)
    throw InvalidInjection(
        fmt::format("the limit of {} active and planned faults is reached; heal some faults first", faults_maximum));
  if (injection.address) {
    const bool flash = is_within(*injection.address, flash_base, flash_bytes);
    // The interrupt code of the firmware runs from SRAM1 at address 0, so its symbols have these addresses.
    if (injection.fault == InjectedFault::ram_bit && victims_.chip.sram1_is_at_zero() &&
        *injection.address < sram1_bytes)
      *injection.address += sram_base;
    const bool ram =
        is_within(*injection.address, sram_base, sram_bytes) || is_within(*injection.address, ccm_base, ccm_bytes);
    if ((injection.fault == InjectedFault::ram_bit && !ram) || (injection.fault == InjectedFault::flash_bit && !flash))
      throw InvalidInjection(
          fmt::format("there is no {} at 0x{:08X}: flash starts at 0x{:08X}, RAM at 0x{:08X} and 0x{:08X}",
                      flash ? "RAM"
                      : ram ? "flash"
                            : "memory",
                      *injection.address, flash_base, sram_base, ccm_base));
  }
  const unsigned number = ++last_number_;
  if (injection.after_s > 0.0)
    planned_.push_back({number, injection, victims_.chip.now() + ticks(injection.after_s)});
  else
    put_in(number, injection);
  return number;
}

Ticks Injector::next() const {
  Ticks next = std::numeric_limits<Ticks>::max();
  for (const Planned& planned : planned_) next = std::min(next, planned.at);
  for (const Active& active : active_)
    if (active.until) next = std::min(next, *active.until);
  return next;
}

void Injector::carry_out() {
  const Ticks now = victims_.chip.now();
  for (auto& active : active_)
    if (active.until && *active.until <= now) put(active.injection, false);
  std::erase_if(active_, [&](const Active& active) { return active.until && *active.until <= now; });
  for (std::size_t i = 0; i < planned_.size();) {
    if (planned_[i].at > now) {
      ++i;
      continue;
    }
    const auto [number, due, at] = planned_[i];
    planned_.erase(planned_.begin() + static_cast<std::ptrdiff_t>(i));
    put_in(number, due);
  }
}

void Injector::put_in(unsigned number, Injection injection) {
  choose_address(injection);
  if (!is_momentary(injection.fault))
    std::erase_if(active_, [&](const Active& active) {
      if (kind(active.injection.fault) != kind(injection.fault) || active.injection.of != injection.of) return false;
      // A fault whose amount changes is not cleared first, so that no fault-free time occurs.
      if (active.injection.fault != injection.fault) put(active.injection, false);
      return true;
    });
  const Ticks now = victims_.chip.now();
  put(injection, true);
  active_.push_back({number, injection, now, {}});
  if (injection.for_s) active_.back().until = now + ticks(*injection.for_s);
}

unsigned Injector::heal(InjectedFault fault, const std::string& of) {
  const auto meant = [&](const Injection& injection) {
    return injection.fault == fault && (of.empty() || injection.of == of);
  };
  for (const Active& active : active_)
    if (meant(active.injection)) put(active.injection, false);
  const auto healed = std::erase_if(active_, [&](const Active& active) { return meant(active.injection); });
  const auto forgotten = std::erase_if(planned_, [&](const Planned& planned) { return meant(planned.injection); });
  return static_cast<unsigned>(healed + forgotten);
}

void Injector::heal_all() {
  for (const Active& active : active_) put(active.injection, false);
  active_.clear();
  planned_.clear();
}

void Injector::choose_address(Injection& injection) {
  const auto below = [&](std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); };
  if (protocol::info(injection.fault).location != protocol::InjectionLocation::address) return;
  if (!injection.address) {
    if (injection.fault == InjectedFault::ram_bit) {
      const std::uint32_t offset = below(sram_bytes + ccm_bytes);
      injection.address = offset < sram_bytes ? sram_base + offset : ccm_base + offset - sram_bytes;
    } else {
      injection.address = flash_base + below(programmed_bytes(victims_.chip));
    }
  }
  if (injection.fault == InjectedFault::program_astray) injection.address = *injection.address & ~1u;
  injection.of = fmt::format("0x{:08X}", *injection.address);
  if (injection.amount < 0.0) injection.amount = below(8);
}

// ---- applying and clearing one fault ----------------------------------------------------------------------

void Injector::put(const Injection& injection, bool in) {
  switch (protocol::info(injection.fault).location) {
    case protocol::InjectionLocation::wire:
    case protocol::InjectionLocation::wires: return put_into_wire(injection, in);
    case protocol::InjectionLocation::motor:
    case protocol::InjectionLocation::leg: return put_into_motor(injection, in);
    default: return put_into_chip(injection, in);
  }
}

void Injector::put_into_wire(const Injection& injection, bool in) {
  const PinName wire = injection.wires[0];
  const auto set = [&](WireFault fault) { victims_.wires.set(wire, in ? fault : WireFault::intact); };
  switch (injection.fault) {
    case InjectedFault::wire_open: return set(WireFault::open);
    case InjectedFault::wire_low: return set(WireFault::low);
    case InjectedFault::wire_high: return set(WireFault::high);
    case InjectedFault::wire_frozen: return set(WireFault::frozen);
    case InjectedFault::wires_shorted: return victims_.wires.set_contact(wire, injection.wires[1], in);
    default: break;
  }
  std::erase_if(spikes_, [&](const Spikes& spikes) { return spikes.wire == wire; });
  if (!in) return;
  spikes_.push_back({wire, std::make_shared<double>(injection.amount)});
  spike(spikes_.back().rate_Hz, wire);
}

void Injector::spike(const std::weak_ptr<double>& rate, PinName wire) {
  const auto rate_Hz = rate.lock();
  if (!rate_Hz) return;
  const double pause_s = std::exponential_distribution<double>(*rate_Hz)(random_);
  victims_.chip.scheduler().at(victims_.chip.now() + ticks(pause_s) + 1, [this, rate, wire] {
    if (rate.expired()) return;
    victims_.chip.glitch(wire.port, wire.pin, ticks(protocol::wire_spike_s));
    spike(rate, wire);
  });
}

void Injector::put_into_motor(const Injection& injection, bool in) {
  Plant& plant = victims_.plant;
  const unsigned i = injection.number;
  ShuntFault shunt = plant.shunt_fault(i);
  MotorFault motor = plant.motor_fault(i);
  const auto output = [&](ShuntFault::Output fault_output) {
    shunt.output = in ? fault_output : ShuntFault::Output::follows;
    plant.set_shunt_fault(i, shunt);
  };
  const auto leg = [&](LegFault fault) { plant.set_leg_fault(i, injection.leg, in ? fault : LegFault::none); };
  switch (injection.fault) {
    case InjectedFault::encoder_stuck: return plant.encoder_fault(i).set_stuck(in);
    case InjectedFault::encoder_lost_counts: return plant.encoder_fault(i).lose(in ? injection.amount : 0.0);
    case InjectedFault::encoder_slip:
      if (in) plant.encoder_fault(i).slip(injection.amount);
      return;
    case InjectedFault::shunt_offset:
      shunt.offset_A = in ? injection.amount : 0.0;
      return plant.set_shunt_fault(i, shunt);
    case InjectedFault::shunt_gain: shunt.gain = in ? injection.amount : 1.0; return plant.set_shunt_fault(i, shunt);
    case InjectedFault::shunt_high: return output(ShuntFault::Output::upper_rail);
    case InjectedFault::shunt_low: return output(ShuntFault::Output::lower_rail);
    case InjectedFault::shunt_frozen: return output(ShuntFault::Output::frozen);
    case InjectedFault::motor_open: motor.open = in; return plant.set_motor_fault(i, motor);
    case InjectedFault::motor_shorted:
      motor.turns_left = in ? injection.amount : 1.0;
      return plant.set_motor_fault(i, motor);
    case InjectedFault::motor_hot: motor.warmer_K = in ? injection.amount : 0.0; return plant.set_motor_fault(i, motor);
    case InjectedFault::leg_high: return leg(LegFault::high);
    case InjectedFault::leg_low: return leg(LegFault::low);
    case InjectedFault::leg_open: return leg(LegFault::open);
    case InjectedFault::leg_slow: return plant.set_leg_delay(i, injection.leg, in ? injection.amount : 0.0);
    default: return;
  }
}

void Injector::put_into_chip(const Injection& injection, bool in) {
  Chip& chip = victims_.chip;
  Plant& plant = victims_.plant;
  const double amount = injection.amount;
  const auto supply_V = [&](double volts) { plant.fail_supply_at_V(in ? std::optional(volts) : std::nullopt); };
  switch (injection.fault) {
    case InjectedFault::bridge_fault: return plant.set_bridge_fault(in);
    case InjectedFault::supply_sag:
    case InjectedFault::supply_spike: return supply_V(amount);
    case InjectedFault::supply_cut: return supply_V(0.0);
    case InjectedFault::supply_ripple: return plant.swing_supply_by_V(in ? amount : 0.0);
    case InjectedFault::logic_sag:
      plant.set_analog_supply_V(in ? amount : logic_supply_V);
      return chip.set_supply_V(in ? amount : logic_supply_V);
    case InjectedFault::analog_sag:
      plant.set_analog_supply_V(in ? amount : logic_supply_V);
      return chip.set_analog_supply_V(in ? amount : logic_supply_V);
    case InjectedFault::crystal_stop: return chip.let_crystal_swing(!in);
    case InjectedFault::crystal_drift:
      return chip.drift_crystal(in ? static_cast<std::int32_t>(amount) : victims_.crystal_ppm);
    case InjectedFault::usb_cut: return victims_.plug(!in);
    case InjectedFault::host_silent: return victims_.set_host_polling(!in);
    case InjectedFault::core_stalled: return chip.stall(in ? ticks(amount) : 0);
    case InjectedFault::main_loop_stalled: return chip.stall_thread(in ? ticks(amount) : 0);
    case InjectedFault::core_halted: return chip.halt(in ? ticks(amount) : 0);
    case InjectedFault::program_astray:
      if (in) chip.jump(*injection.address);
      return;
    case InjectedFault::exception_lost: return chip.lose_exception(injection.number, in);
    case InjectedFault::exception_late:
      return chip.delay_exception(injection.number, in ? static_cast<std::uint32_t>(amount) : 0);
    case InjectedFault::adc_stopped: return chip.stop_converter(injection.number, in);
    case InjectedFault::dma_stopped: return chip.stop_dma(in);
    case InjectedFault::ram_bit:
      if (in) flip_bit(chip, injection);
      return;
    case InjectedFault::flash_bit: return flip_bit(chip, injection);
    default: return;
  }
}

}  // namespace inkwell::virtual_board
