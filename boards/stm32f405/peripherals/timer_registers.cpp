// Register accesses of a timer, and the class Timers.
#include <utility>

#include "boards/stm32f405/peripherals/timer_map.hpp"
#include "boards/stm32f405/peripherals/timers.hpp"

namespace inkwell::virtual_board {

namespace {

// Timers with their internal triggers (RM0090, tables "TIMx internal trigger connection").
constexpr TimerTraits timer_traits[14] = {
    {.number = 1,
     .on_apb2 = true,
     .channels = 4,
     .complementary = 3,
     .repetition = true,
     .breaks = true,
     .up_and_down = true,
     .master = true,
     .slave = true,
     .interrupts = {.update = 25, .capture = 27, .trigger = 26, .break_input = 24},
     .internal_triggers = {5, 2, 3, 4}},
    {.number = 2,
     .bits = 32,
     .channels = 4,
     .up_and_down = true,
     .master = true,
     .slave = true,
     .interrupts = TimerInterrupts::shared(28),
     .internal_triggers = {1, 8, 3, 4}},
    {.number = 3,
     .channels = 4,
     .up_and_down = true,
     .master = true,
     .slave = true,
     .interrupts = TimerInterrupts::shared(29),
     .internal_triggers = {1, 2, 5, 4}},
    {.number = 4,
     .channels = 4,
     .up_and_down = true,
     .master = true,
     .slave = true,
     .interrupts = TimerInterrupts::shared(30),
     .internal_triggers = {1, 2, 3, 8}},
    {.number = 5,
     .bits = 32,
     .channels = 4,
     .up_and_down = true,
     .master = true,
     .slave = true,
     .interrupts = TimerInterrupts::shared(50),
     .internal_triggers = {2, 3, 4, 8}},
    {.number = 6, .master = true, .interrupts = TimerInterrupts::shared(54)},
    {.number = 7, .master = true, .interrupts = TimerInterrupts::shared(55)},
    {.number = 8,
     .on_apb2 = true,
     .channels = 4,
     .complementary = 3,
     .repetition = true,
     .breaks = true,
     .up_and_down = true,
     .master = true,
     .slave = true,
     .interrupts = {.update = 44, .capture = 46, .trigger = 45, .break_input = 43},
     .internal_triggers = {1, 2, 4, 5}},
    {.number = 9,
     .on_apb2 = true,
     .channels = 2,
     .slave = true,
     .interrupts = TimerInterrupts::shared(24),
     .internal_triggers = {2, 3, 10, 11}},
    {.number = 10, .on_apb2 = true, .channels = 1, .interrupts = TimerInterrupts::shared(25)},
    {.number = 11, .on_apb2 = true, .channels = 1, .interrupts = TimerInterrupts::shared(26)},
    {.number = 12,
     .channels = 2,
     .slave = true,
     .interrupts = TimerInterrupts::shared(43),
     .internal_triggers = {4, 5, 13, 14}},
    {.number = 13, .channels = 1, .interrupts = TimerInterrupts::shared(44)},
    {.number = 14, .channels = 1, .interrupts = TimerInterrupts::shared(45)},
};

}  // namespace

void Timer::raise(std::uint32_t flags) {
  sr_ |= flags;
  if ((dier_ & flags) != 0) update_interrupts();
}

void Timer::update_interrupts() {
  const std::uint32_t asserted = sr_ & dier_;
  auto& nvic = machine_.nvic;
  const auto& to = traits_.interrupts;
  // Each enable bit in DIER has the position of its flag in SR.
  constexpr std::uint32_t update = tim.sr.uif.mask(), captures = tim.sr.ccif.masks(), breaks = tim.sr.bif.mask(),
                          triggers = tim.sr.tif.mask() | tim.sr.comif.mask();
  if (to.update == to.capture) {
    nvic.set_source(to.update, traits_.number, (asserted & (update | captures | triggers)) != 0);
    return;
  }
  nvic.set_source(to.update, traits_.number, (asserted & update) != 0);
  nvic.set_source(to.capture, traits_.number, (asserted & captures) != 0);
  nvic.set_source(to.trigger, traits_.number, (asserted & triggers) != 0);
  nvic.set_source(to.break_input, traits_.number, (asserted & breaks) != 0);
}

std::uint32_t Timer::stored(std::uint32_t offset) const {
  switch (offset) {
    case tim.cr1: return (cr1_ & ~tim.cr1.dir.mask()) | tim.cr1.dir.with(down_);
    case tim.cr2: return cr2_;
    case tim.smcr: return smcr_;
    case tim.dier: return dier_;
    case tim.ccmr1: return ccmr_[0];
    case tim.ccmr2: return ccmr_[1];
    case tim.ccer: return ccer_;
    case tim.psc: return psc_;
    case tim.arr: return arr_;
    case tim.rcr: return rcr_;
    case tim.bdtr: return bdtr_;
    case tim.dcr: return dcr_;
    case tim.option: return or_;
    case tim.sr: return 0xFFFF'FFFF;  // writing 0 clears a flag, so unwritten bytes count as ones
    default: break;
  }
  return tim.ccr.covers(offset) ? channels_[tim.ccr.index(offset)].compare : 0;
}

std::uint32_t Timer::read_word(std::uint32_t offset) {
  switch (offset) {
    case tim.sr:
      if (runs()) account(tick_at(machine_.timeline.now()));
      return sr_;
    case tim.cnt:
      if (counts_edges()) machine_.advance_circuit(Machine::input_age_limit);
      take_input_changes(machine_.timeline.now());
      return count_now();
    case tim.egr: return 0;
    case tim.dmar:
      machine_.log.note("TIM" + std::to_string(traits_.number) + " DMA burst,", offset, false, 0);
      return 0;
    default: break;
  }
  if (tim.ccr.covers(offset)) {
    const unsigned i = tim.ccr.index(offset);
    // Reading CCRx of an input channel clears its capture flag.
    if (selection(i) != 0) {
      sr_ &= ~tim.sr.ccif.mask(i);
      update_interrupts();
    }
    return channels_[i].compare;
  }
  if (offset <= tim.option) return stored(offset);
  machine_.log.note("TIM" + std::to_string(traits_.number), offset, false, 0);
  return 0;
}

void Timer::write_control(std::uint32_t value) {
  settle();
  const bool was_running = runs(), was_enabled = enabled(), was_centred = centre_aligned();
  cr1_ = value & writable(tim.cr1);
  if (!traits_.up_and_down) cr1_ &= ~(tim.cr1.dir.mask() | tim.cr1.cms.mask());
  // DIR is read-only in center-aligned and encoder modes.
  if (!centre_aligned() && !encoder_mode())
    down_ = tim.cr1.dir.in(cr1_);
  else if (!was_centred && centre_aligned() && !was_enabled)
    down_ = tim.cr1.dir.in(value);
  configure_inputs();
  begin_ramp(was_running && runs() ? ramp_start_ : machine_.timeline.now());
  if (enabled() != was_enabled && master_mode() == master_enable) trigger_out(enabled(), false);
}

void Timer::write_events(std::uint32_t value) {
  if (tim.egr.ug.in(value)) {
    reinitialise(true);
    if (master_mode() == master_reset) trigger_out(true, true);
  }
  for (unsigned i = 0; i < traits_.channels; ++i)
    if (tim.egr.ccg.in(value, i)) {
      if (selection(i) != 0)
        capture(i);
      else
        raise(tim.sr.ccif.mask(i));
    }
  if (tim.egr.tg.in(value)) raise(tim.sr.tif.mask());
  if (traits_.breaks && tim.egr.bg.in(value)) {
    bdtr_ &= ~tim.bdtr.moe.mask();
    raise(tim.sr.bif.mask());
    configure_outputs();
  }
}

// RM0090, TIMx_BDTR: LOCK. Each LOCK level includes the protection of the lower levels. LOCK can be written once after
// reset.
std::uint32_t Timer::locked_bits(std::uint32_t offset) const {
  const unsigned level = tim.bdtr.lock.of(bdtr_);
  if (level == 0) return 0;
  constexpr std::uint32_t polarities = tim.ccer.ccp.masks() | tim.ccer.ccnp.masks(),
                          idle_levels = tim.cr2.ois.masks() | tim.cr2.oisn.masks();
  switch (offset) {
    case tim.bdtr:
      return tim.bdtr.lock.mask() | tim.bdtr.dtg.mask() | tim.bdtr.bke.mask() | tim.bdtr.bkp.mask() |
             tim.bdtr.aoe.mask() | (level >= 2 ? tim.bdtr.ossr.mask() | tim.bdtr.ossi.mask() : 0);
    case tim.cr2: return idle_levels;
    case tim.ccer: return level >= 2 ? polarities : 0;
    case tim.ccmr1:
    case tim.ccmr2: return level == 3 ? tim.ccmr1.ocm.masks() | tim.ccmr1.ocpe.masks() : 0;
    default: return 0;
  }
}

std::uint32_t Timer::unlocked(std::uint32_t offset, std::uint32_t old, std::uint32_t value) {
  const std::uint32_t locked = locked_bits(offset);
  if (((old ^ value) & locked) != 0)
    machine_.violations.violate(Rule::timer_locked, "TIM" + std::to_string(traits_.number));
  return (old & locked) | (value & ~locked);
}

void Timer::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case tim.cr1: return write_control(value);
    case tim.cr2: cr2_ = unlocked(offset, cr2_, value & writable(tim.cr2)); break;
    case tim.smcr: {
      settle();
      const bool was_running = runs();
      smcr_ = value & writable(tim.smcr);
      if (!was_running) begin_ramp(machine_.timeline.now());
      drive_external_trigger(external_.pin, machine_.timeline.now());
      break;
    }
    case tim.dier:
      dier_ = value & writable(tim.dier);
      update_interrupts();
      break;
    case tim.sr:
      if (runs()) account(tick_at(machine_.timeline.now()));
      sr_ &= value;
      update_interrupts();
      return;
    case tim.egr: return write_events(value);
    case tim.ccmr1: ccmr_[0] = unlocked(offset, ccmr_[0], value & writable(tim.ccmr1)); break;
    case tim.ccmr2: ccmr_[1] = unlocked(offset, ccmr_[1], value & writable(tim.ccmr2)); break;
    case tim.ccer:
      ccer_ = unlocked(offset, ccer_, value & writable(tim.ccer));
      for (unsigned i = 0; i < traits_.channels; ++i)
        if (!tim.ccer.cce.in(ccer_, i)) channels_[i].events = 0;
      break;
    case tim.cnt:
      settle();
      count_ = value & limit_;
      begin_ramp(machine_.timeline.now());
      configure_outputs();
      return;
    case tim.psc: psc_ = tim.psc.psc.of(value); return;
    case tim.arr:
      arr_ = value & limit_;
      if (tim.cr1.arpe.in(cr1_)) return;
      settle();
      active_reload_ = arr_;
      begin_ramp(ramp_start_);
      return;
    case tim.rcr: rcr_ = traits_.repetition ? tim.rcr.rep.of(value) : 0; return;
    case tim.bdtr:
      if (!traits_.breaks) return;
      bdtr_ = unlocked(offset, bdtr_, value & writable(tim.bdtr));
      check_break();
      break;
    case tim.dcr: dcr_ = value; return;
    case tim.option: or_ = value; return listen();
    default:
      if (tim.ccr.covers(offset)) {
        const unsigned i = tim.ccr.index(offset);
        if (i >= traits_.channels || selection(i) != 0) return;
        channels_[i].compare = value & limit_;
        if (preloads(i)) return;
        settle();
        channels_[i].active_compare = channels_[i].compare;
        begin_ramp(ramp_start_);
        configure_outputs();
        return;
      }
      return machine_.log.note("TIM" + std::to_string(traits_.number), offset, true, value);
  }
  // A channel without preload uses the new compare value immediately.
  settle();
  listen();
  configure_inputs();
  for (unsigned i = 0; i < traits_.channels; ++i)
    if (!preloads(i)) channels_[i].active_compare = channels_[i].compare;
  begin_ramp(runs() ? ramp_start_ : machine_.timeline.now());
  configure_outputs();
  plan();
}

void Timer::listen() {
  bool captures = false;
  for (unsigned i = 0; i < traits_.channels; ++i)
    captures |= selection(i) == trigger_input && tim.ccer.cce.in(ccer_, i);
  const unsigned source = trigger_source();
  const bool listens = traits_.slave && (slave_mode() >= reset_mode || captures) && source < input_1_edge;
  const bool is_remapped = traits_.number == 2 && source == 1 && itr1_remap.in(or_);
  const unsigned master = listens && !is_remapped ? traits_.internal_triggers[source] : 0;
  if (std::exchange(master_, master) != master) timers_.set_slave(traits_.number, master);
}

Timers::Timers(Machine& machine, const TimerLines& lines) {
  for (const auto& traits : timer_traits) timers_.emplace_back(machine, *this, lines, traits);
  // DBGMCU_APB1_FZ and APB2_FZ: DBG_TIMx_STOP.
  constexpr unsigned stop_bits[14] = {0, 0, 1, 2, 3, 4, 5, 1, 16, 17, 18, 6, 7, 8};
  for (auto& timer : timers_)
    machine.debug_halt.add(timer, timer.traits().on_apb2 ? DebugHalt::apb2 : DebugHalt::apb1,
                           stop_bits[timer.traits().number - 1]);
}

void Timers::trigger_from(unsigned master, bool level, bool is_pulse) {
  std::uint32_t slaves = slaves_[master];
  for (unsigned number = 1; slaves >> number != 0; ++number)
    if ((slaves >> number & 1) != 0) timer(number).internal_trigger(master, level, is_pulse);
}

void Timers::set_slave(unsigned slave, unsigned master) {
  for (auto& slaves : slaves_) slaves &= ~(1u << slave);
  if (master != 0) slaves_[master] |= 1u << slave;
  for (auto& t : timers_)
    if (t.traits().number != slave) t.plan_again();
}

void Timers::plan_again() {
  for (auto& t : timers_) t.plan_again();
}

}  // namespace inkwell::virtual_board
