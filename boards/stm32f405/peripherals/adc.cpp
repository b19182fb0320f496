#include "boards/stm32f405/peripherals/adc.hpp"

#include <algorithm>
#include <cmath>

#include "boards/stm32f405/peripherals/alternate_functions.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t watchdog = adc.sr.awd.mask(), end_of_conversion = adc.sr.eoc.mask(),
                        end_of_injected = adc.sr.jeoc.mask(), overrun = adc.sr.ovr.mask();

}  // namespace

Adc::Adc(Machine& machine, Adcs& adcs, unsigned index, DmaRequests& requests, const PinFunctions& pins)
    : machine_(machine), adcs_(adcs), index_(index), dma_(requests), pins_(pins), slot_(machine.timeline.add(*this)) {}

void Adc::reset() {
  sr_ = cr1_ = cr2_ = ltr_ = jsqr_ = data_ = 0;
  htr_ = adc.htr.reset_value;
  smpr_ = {};
  sqr_ = {};
  offset_ = injected_data_ = {};
  regular_rank_ = injected_rank_ = 0;
  resume_regular_ = automatic_injected_ = false;
  idle();
  update_interrupt();
}

void Adc::idle() {
  group_ = Group::none;
  machine_.timeline.set(slot_, never, never);
}

void Adc::stop(bool stopped) {
  stopped_ = stopped;
  if (stopped) idle();
}

Ticks Adc::duration(unsigned cycles) const {
  return machine_.clocks.pclk2.duration(std::uint64_t{cycles} * adcs_.prescaler());
}

unsigned Adc::regular_length() const { return adc.cr1.scan.in(cr1_) ? adc.sqr1.l.of(sqr_[0]) + 1 : 1; }
unsigned Adc::injected_length() const { return adc.cr1.scan.in(cr1_) ? adc.jsqr.jl.of(jsqr_) + 1 : 1; }

unsigned Adc::channel_of(Group group, unsigned rank) const {
  // Short injected sequences use the last fields of ADC_JSQR (RM0090).
  if (group == Group::injected) return adc.jsqr.jsq.of(jsqr_, 3 - adc.jsqr.jl.of(jsqr_) + rank);
  return adc.sqr3.sq.of(sqr_[2 - rank / 6], rank % 6);
}

unsigned Adc::sampling_cycles(unsigned channel) const {
  constexpr unsigned cycles[] = {3, 15, 28, 56, 84, 112, 144, 480};
  return cycles[channel < 10 ? adc.smpr2.smp.of(smpr_[1], channel) : adc.smpr1.smp.of(smpr_[0], channel - 10)];
}

void Adc::start_injected(Ticks now) {
  if (!is_on() || stopped_ || group_ == Group::injected) return;
  // An injected group interrupts a regular group. The interrupted conversion is repeated after the injected group.
  resume_regular_ = group_ == Group::regular;
  group_ = Group::injected;
  sr_ |= adc.sr.jstrt.mask();
  rank_ = injected_rank_;
  begin_conversion(now);
}

void Adc::start_regular(Ticks now) {
  if (!is_on() || stopped_ || (sr_ & overrun) != 0 || group_ == Group::regular) return;
  sr_ |= adc.sr.strt.mask();
  if (group_ == Group::injected) {
    resume_regular_ = true;
    return;
  }
  group_ = Group::regular;
  begin_conversion(now);
}

void Adc::start_regular_at(Ticks when) {
  if (!is_on() || stopped_ || (sr_ & overrun) != 0 || group_ != Group::none) return;
  sr_ |= adc.sr.strt.mask();
  group_ = Group::regular;
  phase_ = Phase::waiting;
  machine_.timeline.set(slot_, when, never);
}

void Adc::check_start(Ticks now) {
  constexpr std::uint32_t limit_Hz = 36'000'000;  // at 2.4 V to 3.6 V
  const std::uint32_t clock_Hz = machine_.clocks.frequencies.pclk2_Hz / adcs_.prescaler();
  spoilt_ = clock_Hz > limit_Hz || now < stable_at_;
  if (clock_Hz > limit_Hz) machine_.violations.violate(Rule::converter_too_fast, std::to_string(clock_Hz) + " Hz");
  if (now < stable_at_) machine_.violations.violate(Rule::converter_not_stable, name());
}

void Adc::begin_conversion(Ticks now) {
  check_start(now);
  const unsigned channel = channel_of(group_, group_ == Group::injected ? rank_ : regular_rank_);
  phase_ = Phase::sampling;
  began_ = now;
  const Ticks sampled = now + duration(sampling_cycles(channel));
  const Ticks done = sampled + duration(resolution_bits());
  // The processor stops for a result only if an interrupt or DMA uses the result.
  Ticks wake = never;
  if (group_ == Group::injected) {
    if (adc.cr1.jeocie.in(cr1_) && rank_ + 1 >= injected_length()) wake = done;
  } else {
    const bool is_awaited = adc.cr1.ovrie.in(cr1_) || dma_.interrupts_for_adc(adcs_.shares_dma() ? 0 : index_);
    if (adc.cr2.dma.in(cr2_) || adcs_.shares_dma()) wake = done + (is_awaited ? 0 : machine_.transfer_lag());
    const bool ends = adc.cr2.eocs.in(cr2_) || regular_rank_ + 1 >= regular_length();
    if (adc.cr1.eocie.in(cr1_) && ends) wake = done;
  }
  if (adc.cr1.awdie.in(cr1_)) wake = done;
  wake_lag_ = wake == never ? never : wake - done;
  machine_.timeline.set(slot_, sampled, wake);
}

std::uint32_t Adc::convert(double voltage_V) const {
  constexpr double least_V = 1e-3;  // without a reference the converter reads full scale
  const double counts = std::floor(voltage_V / std::max(machine_.analog_supply_V, least_V) * 4096.0);
  return static_cast<std::uint32_t>(std::clamp(counts, 0.0, 4095.0)) >> (12 - resolution_bits());
}

/// Charges the sampling capacitor, starting from the voltage of the previous channel. The pin capacitor and the
/// sampling capacitor share their charge, and the source recharges both capacitors. The model uses the maximum
/// resistance of the sampling switch (data sheet, figure "Typical connection diagram using the ADC").
double Adc::charge(double pin_V, const AnalogSource& source, double time_s) {
  constexpr double switch_ohm = 6000.0, sampling_F = 4e-12;
  const double both_F = source.capacitance_F + sampling_F;
  const double shared_V = (source.capacitance_F * pin_V + sampling_F * sampled_V_) / both_F;
  const double sharing_s = switch_ohm * sampling_F * source.capacitance_F / both_F;
  const double supplying_s = source.resistance_ohm * both_F + switch_ohm * sampling_F;
  const double unshared_V = sharing_s > 0.0 ? (sampled_V_ - shared_V) * std::exp(-time_s / sharing_s) : 0.0;
  sampled_V_ = pin_V + (shared_V - pin_V) * std::exp(-time_s / supplying_s) + unshared_V;
  return sampled_V_;
}

/// An invalid conversion returns a random value, so that firmware errors become visible.
std::uint32_t Adc::nonsense(Ticks now) const {
  return static_cast<std::uint32_t>(now * 2'654'435'761u >> 16 & 0xFFF) >> (12 - resolution_bits());
}

/// The temperature sensor and the reference need 10 us to start and 10 us per sample (data sheet).
std::uint32_t Adc::sample_internal(double volts, Ticks now) {
  if (index_ != 0) return 0;
  if (!adcs_.temperature_on()) {
    machine_.violations.violate(Rule::reference_off, name());
    return 0;
  }
  const bool hurried = now - began_ < internal_source_time || began_ < adcs_.internal_ready_at();
  if (hurried) machine_.violations.violate(Rule::reference_hurried, name());
  sampled_V_ = volts;
  return hurried || spoilt_ ? nonsense(now) : convert(volts);
}

std::uint32_t Adc::sample(unsigned channel, Ticks now) {
  constexpr double temperature_sensor_V = 0.76;  // typical at 25 C
  if (channel == 16) return sample_internal(temperature_sensor_V, now);
  if (channel == 17) return sample_internal(internal_reference_V, now);
  // VBAT, divided by 2.
  if (channel == 18) return index_ == 0 && adcs_.battery_on() ? convert(logic_supply_V / 2) : 0;
  if (channel > 18) return 0;
  const AnalogPin pin = index_ == 2 ? analog_pins_3[channel] : analog_pins_12[channel];
  const bool analog = pins_.is_analog(static_cast<unsigned>(pin.port - 'A'), pin.pin);
  if (!analog) machine_.violations.violate(Rule::analog_pin_mode, std::string{'P', pin.port} + std::to_string(pin.pin));
  if (!analog || spoilt_) return nonsense(now);
  return convert(charge(machine_.circuit.analog_V(pin.port, pin.pin, now),
                        machine_.circuit.analog_source(pin.port, pin.pin),
                        seconds(duration(sampling_cycles(channel)))));
}

void Adc::step(Ticks now) {
  if (phase_ == Phase::waiting) return begin_conversion(now);
  const unsigned channel = channel_of(group_, group_ == Group::injected ? rank_ : regular_rank_);
  if (phase_ == Phase::sampling) {
    sample_ = sample(channel, now);
    phase_ = Phase::converting;
    // The clock may have changed since the start of the conversion.
    const Ticks done = now + duration(resolution_bits());
    machine_.timeline.set(slot_, done, wake_lag_ == never ? never : done + wake_lag_);
    return;
  }
  watch(channel);
  if (group_ == Group::injected)
    finish_injected(now);
  else
    finish_regular(now);
}

void Adc::watch(unsigned channel) {
  const Field& on = group_ == Group::injected ? adc.cr1.jawden : adc.cr1.awden;
  if (!on.in(cr1_) || (adc.cr1.awdsgl.in(cr1_) && adc.cr1.awdch.of(cr1_) != channel)) return;
  if (sample_ <= htr_ && sample_ >= ltr_) return;
  sr_ |= watchdog;
  update_interrupt();
}

void Adc::finish_injected(Ticks now) {
  const std::int32_t value = static_cast<std::int32_t>(sample_) - static_cast<std::int32_t>(offset_[rank_]);
  injected_data_[rank_] = static_cast<std::uint32_t>(adc.cr2.align.in(cr2_) ? value * 8 : value) & 0xFFFF;
  ++rank_;
  const bool over = rank_ >= injected_length();
  if (!over && !adc.cr1.jdiscen.in(cr1_)) return begin_conversion(now);
  injected_rank_ = over ? 0 : rank_;
  idle();
  if (over) sr_ |= end_of_injected;
  update_interrupt();
  if (resume_regular_) {
    resume_regular_ = false;
    group_ = Group::regular;
    begin_conversion(now);
  } else if (automatic_injected_) {
    automatic_injected_ = false;
    if (adc.cr2.cont.in(cr2_)) start_regular(now);
  }
}

void Adc::finish_regular(Ticks now) {
  const bool checks_overrun = adc.cr2.dma.in(cr2_) || adc.cr2.eocs.in(cr2_) || adcs_.shares_dma();
  if (checks_overrun && (sr_ & end_of_conversion) != 0) {
    // Firmware has not read the previous result. The converter sends no DMA requests until firmware clears OVR.
    sr_ |= overrun;
    regular_rank_ = 0;
    idle();
    return update_interrupt();
  }
  data_ = adc.cr2.align.in(cr2_) ? sample_ << 4 : sample_;
  ++regular_rank_;
  const bool over = regular_rank_ >= regular_length();
  if (over || checks_overrun) sr_ |= end_of_conversion;
  const unsigned part = adc.cr1.discnum.of(cr1_) + 1;
  const bool pause = adc.cr1.discen.in(cr1_) && regular_rank_ % part == 0;
  if (over) regular_rank_ = 0;
  idle();
  if (adcs_.shares_dma())
    adcs_.share(data_);
  else if (adc.cr2.dma.in(cr2_) && dma_.adc_request(index_))
    sr_ &= ~end_of_conversion;
  update_interrupt();
  if (over && adc.cr1.jauto.in(cr1_)) {
    automatic_injected_ = true;
    start_injected(now);
  } else if ((!over && !pause) || (over && adc.cr2.cont.in(cr2_))) {
    if (adcs_.interleaved()) return start_regular_at(std::max(now, began_ + adcs_.interleaving_turn()));
    group_ = Group::regular;
    begin_conversion(now);
  }
}

void Adc::update_interrupt() {
  const bool asserted =
      (adc.cr1.eocie.in(cr1_) && adc.sr.eoc.in(sr_)) || (adc.cr1.awdie.in(cr1_) && adc.sr.awd.in(sr_)) ||
      (adc.cr1.jeocie.in(cr1_) && adc.sr.jeoc.in(sr_)) || (adc.cr1.ovrie.in(cr1_) && adc.sr.ovr.in(sr_));
  machine_.nvic.set_source(converters_position, index_, asserted);
}

std::uint32_t Adc::stored(std::uint32_t offset) const {
  switch (offset) {
    case adc.sr: return sr_;
    case adc.cr1: return cr1_;
    case adc.cr2: return cr2_;
    case adc.htr: return htr_;
    case adc.ltr: return ltr_;
    case adc.jsqr: return jsqr_;
    case adc.smpr1: return smpr_[0];
    case adc.smpr2: return smpr_[1];
    case adc.sqr1: return sqr_[0];
    case adc.sqr2: return sqr_[1];
    case adc.sqr3: return sqr_[2];
    case adc.dr: return data_;
    default: break;
  }
  if (adc.jofr.covers(offset)) return offset_[adc.jofr.index(offset)];
  if (adc.jdr.covers(offset)) return injected_data_[adc.jdr.index(offset)];
  return 0;
}

void Adc::result_taken() {
  sr_ &= ~end_of_conversion;
  update_interrupt();
}

std::uint32_t Adc::read(std::uint32_t offset) {
  if (offset == adc.dr) result_taken();
  if (offset > adc.dr) machine_.log.note("ADC" + std::to_string(index_ + 1), offset, false, 0);
  return stored(offset);
}

void Adc::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case adc.sr: sr_ &= value | ~bits_of(adc.sr, Access::rc_w0); break;
    case adc.cr1:
      cr1_ = value & writable(adc.cr1);
      adcs_.connect_triggers();
      break;
    case adc.cr2: {
      constexpr Ticks stabilisation = 3 * (ticks_per_s / 1'000'000);  // t_STAB
      if (!is_on() && adc.cr2.adon.in(value)) stable_at_ = machine_.timeline.now() + stabilisation;
      cr2_ = value & writable(adc.cr2);
      if (!is_on()) idle();
      adcs_.connect_triggers();
      const Ticks now = machine_.timeline.now();
      if (adc.cr2.jswstart.in(value)) adcs_.start_injected(index_, now);
      if (adc.cr2.swstart.in(value)) adcs_.start_regular(index_, now);
      break;
    }
    case adc.smpr1: smpr_[0] = value & writable(adc.smpr1); break;
    case adc.smpr2: smpr_[1] = value & writable(adc.smpr2); break;
    case adc.sqr1: sqr_[0] = value & writable(adc.sqr1); break;
    case adc.sqr2: sqr_[1] = value & writable(adc.sqr2); break;
    case adc.sqr3: sqr_[2] = value & writable(adc.sqr3); break;
    case adc.htr: htr_ = adc.htr.ht.of(value); break;
    case adc.ltr: ltr_ = adc.ltr.lt.of(value); break;
    case adc.jsqr: jsqr_ = value & writable(adc.jsqr); break;
    default:
      if (adc.jofr.covers(offset))
        offset_[adc.jofr.index(offset)] = adc.jofr.joffset.of(value);
      else
        machine_.log.note("ADC" + std::to_string(index_ + 1), offset, true, value);
  }
  update_interrupt();
}

}  // namespace inkwell::virtual_board
