// One converter.
#include "adc.hpp"

#include <algorithm>
#include <cmath>

#include "alternate_functions.hpp"
#include "dma.hpp"

namespace inkwell::virtual_board {
namespace {

enum : std::uint32_t {
  sr = 0x00,
  cr1 = 0x04,
  cr2 = 0x08,
  smpr1 = 0x0C,
  smpr2 = 0x10,
  jofr1 = 0x14,
  jofr4 = 0x20,
  htr = 0x24,
  ltr = 0x28,
  sqr1 = 0x2C,
  sqr3 = 0x34,
  jsqr = 0x38,
  jdr1 = 0x3C,
  jdr4 = 0x48,
  dr = 0x4C
};
constexpr std::uint32_t watchdog = 1u << 0, end_of_conversion = 1u << 1, end_of_injected = 1u << 2,
                        injected_started = 1u << 3, regular_started = 1u << 4, overrun = 1u << 5;
// CR1
constexpr std::uint32_t conversion_interrupt = 1u << 5, watchdog_interrupt = 1u << 6, injected_interrupt = 1u << 7,
                        scan = 1u << 8, watchdog_single = 1u << 9, automatic_injected = 1u << 10,
                        discontinuous = 1u << 11, discontinuous_injected = 1u << 12, watchdog_injected = 1u << 22,
                        watchdog_regular = 1u << 23, overrun_interrupt = 1u << 26;
// CR2
constexpr std::uint32_t continuous = 1u << 1, dma_on = 1u << 8, end_each = 1u << 10, left_aligned = 1u << 11,
                        start_injected_bit = 1u << 22, start_regular_bit = 1u << 30;
constexpr double reference_V = 3.3;
constexpr unsigned position = 18;

}  // namespace

Adc::Adc(Machine& machine, Adcs& adcs, unsigned index)
    : machine_(machine), adcs_(adcs), index_(index), slot_(machine.timeline.add(*this)) {}

void Adc::reset() {
  sr_ = cr1_ = cr2_ = ltr_ = jsqr_ = data_ = 0;
  htr_ = 0xFFF;
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

Ticks Adc::duration(unsigned cycles) const {
  return machine_.clocks.pclk2.duration(std::uint64_t{cycles} * adcs_.prescaler());
}

unsigned Adc::regular_length() const { return (cr1_ & scan) != 0 ? (sqr_[0] >> 20 & 0xF) + 1 : 1; }
unsigned Adc::injected_length() const { return (cr1_ & scan) != 0 ? (jsqr_ >> 20 & 3) + 1 : 1; }

unsigned Adc::channel_of(Group group, unsigned rank) const {
  // A short injected sequence uses the last fields: JSQ4 alone for one conversion (RM0090, ADC_JSQR).
  if (group == Group::injected) return jsqr_ >> 5 * (3 - (jsqr_ >> 20 & 3) + rank) & 0x1F;
  return sqr_[2 - rank / 6] >> 5 * (rank % 6) & 0x1F;
}

unsigned Adc::sampling_cycles(unsigned channel) const {
  constexpr unsigned cycles[] = {3, 15, 28, 56, 84, 112, 144, 480};
  const std::uint32_t field = channel < 10 ? smpr_[1] >> 3 * channel : smpr_[0] >> 3 * (channel - 10);
  return cycles[field & 7];
}

void Adc::start_injected(Ticks now) {
  if (!is_on() || group_ == Group::injected) return;
  // An injected group interrupts a regular one, whose conversion is made again afterwards.
  resume_regular_ = group_ == Group::regular;
  group_ = Group::injected;
  sr_ |= injected_started;
  rank_ = injected_rank_;
  begin_conversion(now);
}

void Adc::start_regular(Ticks now) {
  if (!is_on() || (sr_ & overrun) != 0 || group_ == Group::regular) return;
  sr_ |= regular_started;
  if (group_ == Group::injected) {
    resume_regular_ = true;
    return;
  }
  group_ = Group::regular;
  begin_conversion(now);
}

void Adc::begin_conversion(Ticks now) {
  const unsigned channel = channel_of(group_, group_ == Group::injected ? rank_ : regular_rank_);
  phase_ = Phase::sampling;
  const Ticks sampled = now + duration(sampling_cycles(channel));
  const Ticks done = sampled + duration(resolution_bits());
  // Without an interrupt or DMA nobody needs to be stopped for the result.
  Ticks wake = never;
  if (group_ == Group::injected) {
    if ((cr1_ & injected_interrupt) != 0 && rank_ + 1 >= injected_length()) wake = done;
  } else {
    if ((cr2_ & dma_on) != 0) wake = done + machine_.transfer_lag();
    const bool ends = (cr2_ & end_each) != 0 || regular_rank_ + 1 >= regular_length();
    if ((cr1_ & conversion_interrupt) != 0 && ends) wake = done;
  }
  if ((cr1_ & watchdog_interrupt) != 0) wake = done;
  machine_.timeline.set(slot_, sampled, wake);
}

std::uint32_t Adc::convert(double voltage_V) const {
  const double counts = std::floor(voltage_V / reference_V * 4096.0);
  return static_cast<std::uint32_t>(std::clamp(counts, 0.0, 4095.0)) >> (12 - resolution_bits());
}

std::uint32_t Adc::sample(unsigned channel, Ticks now) const {
  // Typical values of the data sheet at 25 C; VBAT is divided by 2.
  if (channel == 16) return index_ == 0 && adcs_.temperature_on() ? convert(0.76) : 0;
  if (channel == 17) return index_ == 0 && adcs_.temperature_on() ? convert(1.21) : 0;
  if (channel == 18) return index_ == 0 && adcs_.battery_on() ? convert(reference_V / 2) : 0;
  if (channel > 18) return 0;
  const AnalogPin pin = index_ == 2 ? analog_pins_3[channel] : analog_pins_12[channel];
  return convert(machine_.circuit.analog_V(pin.port, pin.pin, now));
}

void Adc::step(Ticks now) {
  const unsigned channel = channel_of(group_, group_ == Group::injected ? rank_ : regular_rank_);
  if (phase_ == Phase::sampling) {
    sample_ = sample(channel, now);
    phase_ = Phase::converting;
    const Ticks done = now + duration(resolution_bits());
    machine_.timeline.set_due(slot_, done);
    return;
  }
  watch(channel);
  if (group_ == Group::injected)
    finish_injected(now);
  else
    finish_regular(now);
}

void Adc::watch(unsigned channel) {
  const std::uint32_t on = group_ == Group::injected ? watchdog_injected : watchdog_regular;
  if ((cr1_ & on) == 0 || ((cr1_ & watchdog_single) != 0 && (cr1_ & 0x1F) != channel)) return;
  if (sample_ <= htr_ && sample_ >= ltr_) return;
  sr_ |= watchdog;
  update_interrupt();
}

void Adc::finish_injected(Ticks now) {
  const std::int32_t value = static_cast<std::int32_t>(sample_) - static_cast<std::int32_t>(offset_[rank_]);
  injected_data_[rank_] = static_cast<std::uint32_t>((cr2_ & left_aligned) != 0 ? value * 8 : value) & 0xFFFF;
  ++rank_;
  const bool over = rank_ >= injected_length();
  if (!over && (cr1_ & discontinuous_injected) == 0) return begin_conversion(now);
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
    if ((cr2_ & continuous) != 0) start_regular(now);
  }
}

void Adc::finish_regular(Ticks now) {
  const bool checks_overrun = (cr2_ & (dma_on | end_each)) != 0;
  if (checks_overrun && (sr_ & end_of_conversion) != 0) {
    // The old result was not read: no more requests until firmware clears OVR.
    sr_ |= overrun;
    idle();
    return update_interrupt();
  }
  data_ = (cr2_ & left_aligned) != 0 ? sample_ << 4 : sample_;
  ++regular_rank_;
  const bool over = regular_rank_ >= regular_length();
  if (over || checks_overrun) sr_ |= end_of_conversion;
  const unsigned part = (cr1_ >> 13 & 7) + 1;
  const bool pause = (cr1_ & discontinuous) != 0 && regular_rank_ % part == 0;
  if (over) regular_rank_ = 0;
  idle();
  if ((cr2_ & dma_on) != 0 && machine_.dma->adc_request(index_)) sr_ &= ~end_of_conversion;
  update_interrupt();
  if (over && (cr1_ & automatic_injected) != 0) {
    automatic_injected_ = true;
    start_injected(now);
  } else if ((!over && !pause) || (over && (cr2_ & continuous) != 0)) {
    group_ = Group::regular;
    begin_conversion(now);
  }
}

void Adc::update_interrupt() {
  const bool asserted = ((cr1_ & conversion_interrupt) != 0 && (sr_ & end_of_conversion) != 0) ||
                        ((cr1_ & watchdog_interrupt) != 0 && (sr_ & watchdog) != 0) ||
                        ((cr1_ & injected_interrupt) != 0 && (sr_ & end_of_injected) != 0) ||
                        ((cr1_ & overrun_interrupt) != 0 && (sr_ & overrun) != 0);
  machine_.nvic.set_source(position, index_, asserted);
}

std::uint32_t Adc::stored(std::uint32_t offset) const {
  switch (offset) {
    case sr: return sr_;
    case cr1: return cr1_;
    case cr2: return cr2_;
    case htr: return htr_;
    case ltr: return ltr_;
    case jsqr: return jsqr_;
    case smpr1:
    case smpr2: return smpr_[(offset - smpr1) / 4];
    case dr: return data_;
    default: break;
  }
  if (offset >= jofr1 && offset <= jofr4) return offset_[(offset - jofr1) / 4];
  if (offset >= sqr1 && offset <= sqr3) return sqr_[(offset - sqr1) / 4];
  if (offset >= jdr1 && offset <= jdr4) return injected_data_[(offset - jdr1) / 4];
  return 0;
}

std::uint32_t Adc::read(std::uint32_t offset) {
  if (offset == dr) {
    sr_ &= ~end_of_conversion;
    update_interrupt();
  }
  if (offset > dr) machine_.log.note("ADC" + std::to_string(index_ + 1), offset, false, 0);
  return stored(offset);
}

void Adc::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case sr: sr_ &= value | ~0x3Fu; break;
    case cr1:
      cr1_ = value & 0x07C0'FFFF;
      adcs_.connect_triggers();
      break;
    case cr2: {
      cr2_ = value & ~(start_injected_bit | start_regular_bit);
      if (!is_on()) idle();
      adcs_.connect_triggers();
      const Ticks now = machine_.timeline.now();
      if ((value & start_injected_bit) != 0) adcs_.start_injected(index_, now);
      if ((value & start_regular_bit) != 0) adcs_.start_regular(index_, now);
      break;
    }
    case smpr1:
    case smpr2: smpr_[(offset - smpr1) / 4] = value; break;
    case htr: htr_ = value & 0xFFF; break;
    case ltr: ltr_ = value & 0xFFF; break;
    case jsqr: jsqr_ = value & 0x3F'FFFF; break;
    default:
      if (offset >= jofr1 && offset <= jofr4)
        offset_[(offset - jofr1) / 4] = value & 0xFFF;
      else if (offset >= sqr1 && offset <= sqr3)
        sqr_[(offset - sqr1) / 4] = value;
      else
        machine_.log.note("ADC" + std::to_string(index_ + 1), offset, true, value);
  }
  update_interrupt();
}

}  // namespace inkwell::virtual_board
