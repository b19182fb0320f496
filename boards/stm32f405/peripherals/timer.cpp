#include <algorithm>

#include "boards/stm32f405/peripherals/timer_map.hpp"
#include "boards/stm32f405/peripherals/timers.hpp"

namespace inkwell::virtual_board {

Timer::Timer(Machine& machine, Timers& timers, const TimerLines& lines, const TimerTraits& traits)
    : machine_(machine),
      timers_(timers),
      lines_(lines),
      traits_(traits),
      slot_(machine.timeline.add(*this)),
      limit_(traits.bits == 32 ? 0xFFFF'FFFF : 0xFFFF) {
  machine.clock_users.push_back(this);
}

void Timer::reset() {
  cr1_ = cr2_ = smcr_ = dier_ = sr_ = ccer_ = psc_ = rcr_ = bdtr_ = dcr_ = or_ = 0;
  arr_ = active_reload_ = limit_;
  ccmr_ = {};
  active_prescaler_ = repetitions_ = count_ = 0;
  down_ = gate_open_ = false;
  for (auto& channel : channels_) channel = Channel{.input = channel.input};
  connect_input(external_trigger, external_.pin);
  external_.rises = edges_ = 0;
  listen();
  configure_inputs();
  configure_outputs();
  begin_ramp(machine_.timeline.now());
  update_interrupts();
}

const Clock& Timer::clock() const { return traits_.on_apb2 ? machine_.clocks.timer2 : machine_.clocks.timer1; }

bool Timer::runs() const {
  if (!enabled() || frozen_ || counts_edges()) return false;
  return slave_mode() != gated || gate_open_;
}

std::uint32_t Timer::count_at(std::uint64_t tick) const {
  const auto moved = static_cast<std::uint32_t>(tick);
  return (down_ ? count_ - moved : count_ + moved) & limit_;
}

std::uint32_t Timer::count_now() const { return runs() ? count_at(tick_at(machine_.timeline.now())) : count_; }

void Timer::settle() {
  if (!runs()) return;
  const std::uint64_t tick = tick_at(machine_.timeline.now());
  if (tick >= ramp_length_) {  // the end of the ramp is due now, but another part was stepped first
    account(ramp_length_);
    return end_ramp(time_of(ramp_length_));
  }
  account(tick);
  count_ = count_at(tick);
  ramp_start_ = time_of(tick);  // keeps the phase of the prescaler
  accounted_ = 0;
  find_matches();
}

void Timer::before_clock_change() { settle(); }
void Timer::after_clock_change() {
  configure_inputs();
  begin_ramp(machine_.timeline.now());
}

void Timer::freeze(bool frozen) {
  settle();
  frozen_ = frozen;
  begin_ramp(machine_.timeline.now());
  configure_outputs();
}

void Timer::begin_ramp(Ticks now) {
  ramp_start_ = now;
  accounted_ = 0;
  const std::uint64_t wrap = std::uint64_t{limit_} + 1;
  if (centre_aligned()) {
    if (!down_)
      ramp_length_ = count_ < active_reload_ ? active_reload_ - count_ : wrap - count_ + active_reload_;
    else
      ramp_length_ = count_ != 0 ? count_ : 1;
  } else if (!down_) {
    // A counter above its reload value counts up to the maximum count before it overflows.
    ramp_length_ = (count_ <= active_reload_ ? active_reload_ : limit_) + std::uint64_t{1} - count_;
  } else {
    ramp_length_ = std::uint64_t{count_} + 1;
  }
  find_matches();
  plan();
}

void Timer::find_matches() {
  for (unsigned i = 0; i < traits_.channels; ++i) {
    auto& channel = channels_[i];
    channel.match = no_match;
    if (selection(i) != 0) continue;
    const std::uint32_t compare = channel.active_compare;
    if (!down_ && compare > count_) channel.match = compare - count_;
    if (down_ && compare < count_) channel.match = count_ - compare;
    // In edge-aligned mode, the last tick of a ramp sets the counter to the first value of the next ramp.
    const std::uint64_t last = centre_aligned() ? ramp_length_ : ramp_length_ - 1;
    if (channel.match != no_match && channel.match > last) channel.match = no_match;
  }
}

void Timer::account(std::uint64_t tick) {
  const std::uint64_t from = accounted_;
  accounted_ = tick;
  for (unsigned i = 0; i < traits_.channels; ++i)
    if (channels_[i].match > from && channels_[i].match <= tick) matched(i);
}

void Timer::matched(unsigned i) {
  auto& channel = channels_[i];
  switch (output_mode(i)) {
    case active_on_match: set_reference(i, true); break;
    case inactive_on_match: set_reference(i, false); break;
    case toggle_on_match: set_reference(i, !channel.reference); break;
    case pwm_1:
    case pwm_2: set_reference(i, compare_level(i, channel.active_compare)); break;
    default: break;
  }
  const unsigned centre_mode = tim.cr1.cms.of(cr1_);
  if (centre_mode == 1 && !down_) return;
  if (centre_mode == 2 && down_) return;
  raise(tim.sr.ccif.mask(i));
  if (tim.dier.ccde.in(dier_, i)) lines_.dma.timer_request(traits_.number, i + 1);
  if (i == 0 && master_mode() == master_compare_pulse) trigger_out(true, true);
  lines_.converters.timer_trigger(traits_.number, i + 1);
}

bool Timer::repetitions_over() {
  if (!traits_.repetition) return true;
  if (repetitions_ != 0) {
    --repetitions_;
    return false;
  }
  return true;
}

void Timer::end_ramp(Ticks now) {
  const bool past_reload = !centre_aligned() && !down_ && count_at(ramp_length_ - 1) != active_reload_;
  if (centre_aligned()) {
    count_ = down_ ? 0 : active_reload_;
    down_ = !down_;
  } else if (!down_) {
    count_ = 0;
  }
  if (!past_reload && repetitions_over()) update_event(false);
  if (!centre_aligned() && down_) count_ = active_reload_;
  begin_ramp(now);
  for (unsigned i = 0; i < traits_.channels; ++i) {
    if (selection(i) != 0) continue;
    if (!centre_aligned() && channels_[i].active_compare == count_) matched(i);
    const unsigned mode = output_mode(i);
    if (mode == pwm_1 || mode == pwm_2) set_reference(i, compare_level(i, count_));
  }
}

void Timer::update_event(bool by_software) {
  if (tim.cr1.udis.in(cr1_)) return;
  active_prescaler_ = psc_;
  active_reload_ = arr_;
  repetitions_ = rcr_;
  for (auto& channel : channels_) channel.active_compare = channel.compare;
  if (!by_software || !tim.cr1.urs.in(cr1_)) {
    raise(tim.sr.uif.mask());
    if (tim.dier.ude.in(dier_)) lines_.dma.timer_request(traits_.number, 0);
  }
  if (tim.bdtr.aoe.in(bdtr_) && !tim.bdtr.moe.in(bdtr_)) {
    bdtr_ |= tim.bdtr.moe.mask();
    check_break();
    configure_outputs();
  }
  if (!by_software && tim.cr1.opm.in(cr1_)) cr1_ &= ~tim.cr1.cen.mask();
  if (master_mode() == master_update) trigger_out(true, true);
}

void Timer::reinitialise(bool by_software) {
  settle();
  if (centre_aligned()) down_ = false;
  edges_ = 0;
  update_event(by_software);
  count_ = down_ ? active_reload_ : 0;
  begin_ramp(machine_.timeline.now());
  configure_outputs();
}

void Timer::count_one(bool down) {
  if (frozen_) return;
  down_ = down;
  // The prescaler divides external clocks.
  if (edges_++ < active_prescaler_) return;
  edges_ = 0;
  bool wrapped = false;
  if (down) {
    wrapped = count_ == 0;
    count_ = wrapped ? active_reload_ : count_ - 1;
  } else {
    wrapped = count_ == active_reload_;
    count_ = wrapped ? 0 : (count_ + 1) & limit_;
  }
  if (wrapped && repetitions_over()) update_event(false);
  for (unsigned i = 0; i < traits_.channels; ++i)
    if (selection(i) == 0 && channels_[i].active_compare == count_) matched(i);
}

void Timer::step(Ticks now) {
  take_input_changes(now);
  if (now < step_due_) return plan();
  account(next_tick_);
  if (next_tick_ >= ramp_length_)
    end_ramp(now);
  else
    plan();
}

bool Timer::update_needed() const {
  return tim.dier.uie.in(dier_) || tim.dier.ude.in(dier_) || tim.cr1.opm.in(cr1_) ||
         (master_mode() == master_update &&
          (lines_.converters.listens_to_timer(traits_.number, trigger_output) || timers_.has_slave(traits_.number)));
}

Ticks Timer::update_time() const {
  const std::uint64_t later_ramps = centre_aligned() ? active_reload_ : std::uint64_t{active_reload_} + 1;
  return time_of(ramp_length_ + (traits_.repetition ? repetitions_ * later_ramps : 0));
}

void Timer::plan() {
  const Ticks input_due = filter_of(next_input()).next_change();
  const Ticks input_wake = inputs_wake() ? input_due : never;
  step_due_ = never;
  if (!runs() || !clock().runs()) return machine_.timeline.set(slot_, input_due, input_wake);
  next_tick_ = ramp_length_;
  std::uint64_t next_needed = no_match;
  bool any_needed = false;
  for (unsigned i = 0; i < traits_.channels; ++i) {
    const auto& channel = channels_[i];
    const bool to_processor = tim.dier.ccie.in(dier_, i) || tim.dier.ccde.in(dier_, i) ||
                              lines_.converters.listens_to_timer(traits_.number, i + 1) ||
                              (master_mode() >= master_compare_pulse && timers_.has_slave(traits_.number));
    any_needed |= to_processor;
    if (channel.match == no_match || channel.match <= accounted_) continue;
    if (channel.needed || to_processor) next_tick_ = std::min(next_tick_, channel.match);
    if (to_processor) next_needed = std::min(next_needed, channel.match);
  }
  // The time of a match in a later ramp is computed at the end of the present ramp.
  if (any_needed && next_needed == no_match) next_needed = ramp_length_;
  Ticks wake = next_needed == no_match ? never : time_of(next_needed);
  if (update_needed()) wake = std::min(wake, update_time());
  step_due_ = time_of(next_tick_);
  machine_.timeline.set(slot_, std::min(step_due_, input_due), std::min(wake, input_wake));
}

void Timer::plan_again() {
  settle();
  begin_ramp(runs() ? ramp_start_ : machine_.timeline.now());
}

void Timer::trigger_out(bool level, bool is_pulse) {
  timers_.trigger_from(traits_.number, level, is_pulse);
  if (level) lines_.converters.timer_trigger(traits_.number, trigger_output);
}

}  // namespace inkwell::virtual_board
