// Registers of a timer, and the set of all timers.
#include "adc.hpp"
#include "dma.hpp"
#include "pins.hpp"
#include "timer_bits.hpp"
#include "timers.hpp"

namespace inkwell::virtual_board {

using namespace timer_bits;

namespace {

enum : std::uint32_t {
  cr1 = 0x00,
  cr2 = 0x04,
  smcr = 0x08,
  dier = 0x0C,
  sr = 0x10,
  egr = 0x14,
  ccmr1 = 0x18,
  ccmr2 = 0x1C,
  ccer = 0x20,
  cnt = 0x24,
  psc = 0x28,
  arr = 0x2C,
  rcr = 0x30,
  ccr1 = 0x34,
  ccr4 = 0x40,
  bdtr = 0x44,
  dcr = 0x48,
  dmar = 0x4C,
  option = 0x50,
};

// Positions: RM0090, table "Vector table". Internal triggers: tables "TIMx internal trigger connection".
constexpr TimerModel models[14] = {
    {1, 16, 4, true, true, true, true, true, 25, 27, 26, 24, {5, 2, 3, 4}},
    {2, 32, 4, false, false, true, true, true, 28, 28, 28, 0, {1, 8, 3, 4}},
    {3, 16, 4, false, false, true, true, true, 29, 29, 29, 0, {1, 2, 5, 4}},
    {4, 16, 4, false, false, true, true, true, 30, 30, 30, 0, {1, 2, 3, 8}},
    {5, 32, 4, false, false, true, true, true, 50, 50, 50, 0, {2, 3, 4, 8}},
    {6, 16, 0, false, false, false, true, false, 54, 54, 54, 0, {}},
    {7, 16, 0, false, false, false, true, false, 55, 55, 55, 0, {}},
    {8, 16, 4, true, true, true, true, true, 44, 46, 45, 43, {1, 2, 4, 5}},
    {9, 16, 2, true, false, false, false, true, 24, 24, 24, 0, {2, 3, 10, 11}},
    {10, 16, 1, true, false, false, false, false, 25, 25, 25, 0, {}},
    {11, 16, 1, true, false, false, false, false, 26, 26, 26, 0, {}},
    {12, 16, 2, false, false, false, false, true, 43, 43, 43, 0, {4, 5, 13, 14}},
    {13, 16, 1, false, false, false, false, false, 44, 44, 44, 0, {}},
    {14, 16, 1, false, false, false, false, false, 45, 45, 45, 0, {}},
};

}  // namespace

void Timer::raise(std::uint32_t flags) {
  sr_ |= flags;
  if ((dier_ & flags) != 0) update_interrupts();
}

void Timer::update_interrupts() {
  const std::uint32_t asserted = sr_ & dier_;
  auto& nvic = machine_.nvic;
  if (!model_.advanced) {
    nvic.set_source(model_.update_position, model_.number, (asserted & 0x5F) != 0);
    return;
  }
  nvic.set_source(model_.update_position, model_.number, (asserted & update_flag) != 0);
  nvic.set_source(model_.capture_position, model_.number, (asserted & 0x1E) != 0);
  nvic.set_source(model_.trigger_position, model_.number, (asserted & 0x60) != 0);
  nvic.set_source(model_.break_position, model_.number, (asserted & break_flag) != 0);
}

std::uint32_t Timer::stored(std::uint32_t offset) const {
  switch (offset) {
    case cr1: return (cr1_ & ~direction) | (down_ ? direction : 0u);
    case cr2: return cr2_;
    case smcr: return smcr_;
    case dier: return dier_;
    case ccmr1: return ccmr_[0];
    case ccmr2: return ccmr_[1];
    case ccer: return ccer_;
    case psc: return psc_;
    case arr: return arr_;
    case rcr: return rcr_;
    case bdtr: return bdtr_;
    case dcr: return dcr_;
    case option: return or_;
    case sr: return 0xFFFF'FFFF;  // zeros clear: what is not written stays
    default: break;
  }
  return offset >= ccr1 && offset <= ccr4 ? channels_[(offset - ccr1) / 4].compare : 0;
}

std::uint32_t Timer::read_word(std::uint32_t offset) {
  switch (offset) {
    case sr:
      if (runs()) account(tick_at(machine_.timeline.now()));
      return sr_;
    case cnt:
      if (encoder_mode() || slave_mode() == external_clock) machine_.advance_circuit(Machine::input_age_limit);
      return count_now();
    case egr: return 0;
    case dmar: machine_.log.note("TIM" + std::to_string(model_.number) + " DMA burst,", offset, false, 0); return 0;
    default: break;
  }
  if (offset >= ccr1 && offset <= ccr4) {
    const unsigned i = (offset - ccr1) / 4;
    // Reading a captured value acknowledges it.
    if (selection(i) != 0) {
      sr_ &= ~(capture_compare_1 << i);
      update_interrupts();
    }
    return channels_[i].compare;
  }
  if (offset <= option) return stored(offset);
  machine_.log.note("TIM" + std::to_string(model_.number), offset, false, 0);
  return 0;
}

void Timer::write_control(std::uint32_t value) {
  settle();
  const bool was_running = runs(), was_enabled = (cr1_ & enable) != 0, was_centred = centre_aligned();
  cr1_ = value & 0x3FF;
  if (!model_.counts_down) cr1_ &= ~0x70u;
  // DIR is read-only in centre-aligned and encoder modes.
  if (!centre_aligned() && !encoder_mode())
    down_ = (cr1_ & direction) != 0;
  else if (!was_centred && centre_aligned() && !was_enabled)
    down_ = (value & direction) != 0;
  begin_ramp(was_running && runs() ? ramp_start_ : machine_.timeline.now());
  if (((cr1_ & enable) != 0) != was_enabled && (cr2_ >> 4 & 7) == master_enable)
    trigger_out((cr1_ & enable) != 0, false);
}

void Timer::write_events(std::uint32_t value) {
  if ((value & 1) != 0) {
    reinitialise(true);
    if ((cr2_ >> 4 & 7) == master_reset) trigger_out(true, true);
  }
  for (unsigned i = 0; i < model_.channels; ++i)
    if ((value >> (1 + i) & 1) != 0) {
      if (selection(i) != 0)
        capture(i);
      else
        raise(capture_compare_1 << i);
    }
  if ((value & trigger_flag) != 0) raise(trigger_flag);
  if (model_.advanced && (value & break_flag) != 0) {
    bdtr_ &= ~main_output;
    raise(break_flag);
    configure_outputs();
  }
}

void Timer::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case cr1: return write_control(value);
    case cr2: cr2_ = value & 0x7FFF; break;
    case smcr: {
      settle();
      smcr_ = value & 0xFFF7;
      const unsigned source = smcr_ >> 4 & 7;
      const bool listens = model_.is_slave && slave_mode() >= reset_mode && source < 4;
      machine_.timers->set_slave(model_.number, source < 4 ? model_.internal_triggers[source] : 0, listens);
      if ((smcr_ & 1u << 14) != 0) machine_.log.say_once("TIMx_SMCR.ECE: external clock mode 2 is not modelled");
      break;
    }
    case dier:
      dier_ = value & 0x7FFF;
      update_interrupts();
      break;
    case sr:
      if (runs()) account(tick_at(machine_.timeline.now()));
      sr_ &= value;
      update_interrupts();
      return;
    case egr: return write_events(value);
    case ccmr1: ccmr_[0] = value & 0xFFFF; break;
    case ccmr2: ccmr_[1] = value & 0xFFFF; break;
    case ccer: ccer_ = value & 0x3FFF; break;
    case cnt:
      settle();
      count_ = value & limit_;
      begin_ramp(machine_.timeline.now());
      configure_outputs();
      return;
    case psc: psc_ = value & 0xFFFF; return;
    case arr:
      arr_ = value & limit_;
      if ((cr1_ & reload_preload) != 0) return;
      settle();
      active_reload_ = arr_;
      begin_ramp(ramp_start_);
      return;
    case rcr: rcr_ = model_.advanced ? value & 0xFF : 0; return;
    case bdtr:
      if (!model_.advanced) return;
      bdtr_ = value & 0xFFFF;
      check_break();
      break;
    case dcr: dcr_ = value; return;
    case option: or_ = value; return;
    default:
      if (offset >= ccr1 && offset <= ccr4) {
        const unsigned i = (offset - ccr1) / 4;
        if (i >= model_.channels || selection(i) != 0) return;
        channels_[i].compare = value & limit_;
        if (preloads(i)) return;
        settle();
        channels_[i].active_compare = channels_[i].compare;
        begin_ramp(ramp_start_);
        configure_outputs();
        return;
      }
      return machine_.log.note("TIM" + std::to_string(model_.number), offset, true, value);
  }
  // A new configuration of channels, triggers or interrupts; a channel without preload takes its value at once.
  settle();
  for (unsigned i = 0; i < model_.channels; ++i)
    if (!preloads(i)) channels_[i].active_compare = channels_[i].compare;
  begin_ramp(runs() ? ramp_start_ : machine_.timeline.now());
  configure_outputs();
  plan();
}

Timers::Timers(Machine& machine) {
  for (const auto& model : models) timers_.emplace_back(machine, model);
  machine.timers = this;
}

void Timers::trigger_from(unsigned master, bool level, bool is_pulse) {
  std::uint32_t slaves = slaves_[master];
  for (unsigned number = 1; slaves >> number != 0; ++number)
    if ((slaves >> number & 1) != 0) timer(number).internal_trigger(master, level, is_pulse);
}

void Timers::set_slave(unsigned slave, unsigned master, bool listens) {
  for (auto& slaves : slaves_) slaves &= ~(1u << slave);
  if (listens) slaves_[master] |= 1u << slave;
  for (auto& t : timers_)
    if (t.model().number != slave) t.plan_again();
}

void Timers::plan_again() {
  for (auto& t : timers_) t.plan_again();
}

}  // namespace inkwell::virtual_board
