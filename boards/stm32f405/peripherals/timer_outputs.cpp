// Compare references and outputs of a timer, break input, captures, encoder and slave modes.
#include "boards/stm32f405/peripherals/timer_map.hpp"
#include "boards/stm32f405/peripherals/timers.hpp"

namespace inkwell::virtual_board {

bool Timer::compare_level(unsigned i, std::uint32_t count) const {
  const std::uint32_t compare = channels_[i].active_compare;
  // In PWM mode 1, the reference of an up-counting timer is active if CNT < CCR. The reference of a down-counting timer
  // is inactive if CNT > CCR. In center-aligned mode the count 0 belongs to the upward ramp, so the reference is never
  // active if CCR = 0 (RM0090, "PWM mode").
  const bool active = down_ ? count <= compare && !(centre_aligned() && compare == 0) : count < compare;
  return output_mode(i) == pwm_2 ? !active : active;
}

void Timer::set_reference(unsigned i, bool level) {
  auto& channel = channels_[i];
  if (channel.reference == level) return;
  channel.reference = level;
  drive_outputs(i);
  if (master_mode() == compare_reference_1 + i) trigger_out(level, false);
}

void Timer::drive_outputs(unsigned i) {
  const auto& channel = channels_[i];
  lines_.outputs.timer_output(traits_.number, i, channel.reference ? channel.when_active : channel.when_inactive);
  if (i < traits_.complementary)
    lines_.outputs.timer_output(traits_.number, complementary_1 + i,
                                channel.reference ? channel.complement_when_active : channel.complement_when_inactive);
}

void Timer::configure_channel(unsigned i) {
  auto& channel = channels_[i];
  const auto level = [](bool high) { return high ? PinLevel::high : PinLevel::low; };
  const bool output = tim.ccer.cce.in(ccer_, i), inverted = tim.ccer.ccp.in(ccer_, i);
  const bool has_complement = i < traits_.complementary;
  const bool complement = has_complement && tim.ccer.ccne.in(ccer_, i);
  const bool complement_inverted = tim.ccer.ccnp.in(ccer_, i);
  channel.when_active = channel.when_inactive = PinLevel::floating;
  channel.complement_when_active = channel.complement_when_inactive = PinLevel::floating;
  channel.needed = false;
  if (selection(i) != 0) return;  // input channel

  // RM0090, table "Output control bits for complementary OCx and OCxN channels with break feature".
  if (outputs_on()) {
    if (output) {
      channel.when_active = level(!inverted);
      channel.when_inactive = level(inverted);
    } else if (complement && tim.bdtr.ossr.in(bdtr_)) {
      channel.when_active = channel.when_inactive = level(inverted);
    }
    if (complement) {
      // If OCx is enabled, OCxN is the complement of OCx. If OCx is disabled, OCxN follows the reference.
      channel.complement_when_active = level(output == complement_inverted);
      channel.complement_when_inactive = level(output != complement_inverted);
      if (output && tim.bdtr.dtg.in(bdtr_)) machine_.log.say_once("TIMx_BDTR.DTG: dead time is not modeled; it is 0");
    } else if (has_complement && output && tim.bdtr.ossr.in(bdtr_)) {
      channel.complement_when_active = channel.complement_when_inactive = level(complement_inverted);
    }
    channel.needed = output || complement;
  } else if (tim.bdtr.ossi.in(bdtr_) && (output || complement)) {
    channel.when_active = channel.when_inactive = level(tim.cr2.ois.in(cr2_, i));
    if (has_complement)
      channel.complement_when_active = channel.complement_when_inactive = level(tim.cr2.oisn.in(cr2_, i));
  }
  if (master_mode() >= master_compare_pulse) channel.needed = true;
}

void Timer::configure_outputs() {
  const std::uint32_t count = count_now();
  for (unsigned i = 0; i < traits_.channels; ++i) {
    configure_channel(i);
    switch (output_mode(i)) {
      case force_inactive: channels_[i].reference = false; break;
      case force_active: channels_[i].reference = true; break;
      case pwm_1:
      case pwm_2: channels_[i].reference = compare_level(i, count); break;
      default: break;
    }
    drive_outputs(i);
  }
}

void Timer::check_break() {
  if (!traits_.breaks || !tim.bdtr.bke.in(bdtr_)) return;
  const bool active = break_input_ == tim.bdtr.bkp.in(bdtr_);
  if (active) break_now();
}

void Timer::break_now() {
  bdtr_ &= ~tim.bdtr.moe.mask();
  raise(tim.sr.bif.mask());
}

void Timer::clock_failed() {
  if (!traits_.breaks || !tim.bdtr.bke.in(bdtr_)) return;
  break_now();
  configure_outputs();
}

void Timer::capture(unsigned i) {
  auto& channel = channels_[i];
  if (tim.sr.ccif.in(sr_, i)) sr_ |= tim.sr.ccof.mask(i);
  channel.compare = channel.active_compare = count_now();
  raise(tim.sr.ccif.mask(i));
  if (tim.dier.ccde.in(dier_, i)) lines_.dma.timer_request(traits_.number, i + 1);
  if (i == 0 && master_mode() == master_compare_pulse) trigger_out(true, true);
}

// RM0090, TIMx_CCMR1: ICxPSC. The timer captures at every 1st, 2nd, 4th or 8th event.
void Timer::capture_event(unsigned i) {
  auto& channel = channels_[i];
  if (++channel.events < 1u << tim.ccmr1.icpsc.of(ccmr_[i / 2], i % 2)) return;
  channel.events = 0;
  capture(i);
}

void Timer::capture_by_trigger() {
  for (unsigned i = 0; i < traits_.channels; ++i)
    if (selection(i) == trigger_input && tim.ccer.cce.in(ccer_, i)) capture_event(i);
}

void Timer::count_encoder_edge(unsigned changed) {
  // RM0090, table "Counting direction versus encoder signals". CCxP inverts an input.
  const unsigned mode = slave_mode();
  if (!enabled()) return;
  if ((mode == 1 && changed == 0) || (mode == 2 && changed == 1)) return;
  const bool first = input(0) != tim.ccer.ccp.in(ccer_, 0);
  const bool second = input(1) != tim.ccer.ccp.in(ccer_, 1);
  const bool down = changed == 0 ? first == second : first != second;
  count_one(down);
}

void Timer::channel_edge(unsigned i) {
  const bool high = input(i);
  // Input i triggers captures in channel i, and in the adjacent channel if that channel selects input i.
  for (const unsigned target : {i, i ^ 1}) {
    if (target >= traits_.channels || selection(target) != (target == i ? 1u : 2u)) continue;
    if (!tim.ccer.cce.in(ccer_, target)) continue;
    const bool falling = tim.ccer.ccp.in(ccer_, target), both = falling && tim.ccer.ccnp.in(ccer_, target);
    if (both || high != falling) capture_event(target);
  }
  const unsigned source = trigger_source();
  if (source == input_1_edge && i == 0) capture_by_trigger();
  if (encoder_mode() || slave_mode() == 0) return;
  const bool inverted = tim.ccer.ccp.in(ccer_, i);
  if (source == input_1_edge && i == 0) trigger_in(true, true);
  if ((source == filtered_input_1 && i == 0) || (source == filtered_input_2 && i == 1))
    trigger_in(high != inverted, false);
}

// If a channel is an output, the bits at the position of ICxF are output fields.
void Timer::configure_inputs() {
  for (unsigned i = 0; i < traits_.channels; ++i) {
    const unsigned filter = selection(i) == 0 ? 0 : tim.ccmr1.icf.of(ccmr_[i / 2], i % 2);
    channels_[i].input.configure(InputFilterSetting::of(filter, tim.cr1.ckd.of(cr1_)), clock(),
                                 machine_.timeline.now());
  }
  external_.filter.configure(InputFilterSetting::of(tim.smcr.etf.of(smcr_), tim.cr1.ckd.of(cr1_)), clock(),
                             machine_.timeline.now());
}

unsigned Timer::next_input() const {
  unsigned next = external_trigger_input;
  for (unsigned i = 0; i < traits_.channels; ++i)
    if (channels_[i].input.next_change() < filter_of(next).next_change()) next = i;
  return next;
}

void Timer::take_input_changes(Ticks until) {
  for (;;) {
    const unsigned i = next_input();
    if (filter_of(i).next_change() > until) return;
    if (i == external_trigger_input) {
      external_.filter.pass();
      external_edge();
      continue;
    }
    channels_[i].input.pass();
    if (encoder_mode() && i < 2) count_encoder_edge(i);
    channel_edge(i);
  }
}

bool Timer::inputs_wake() const { return dier_ != 0 || slave_mode() >= reset_mode || master_mode() != master_reset; }

void Timer::input_changed(unsigned line, bool high, Ticks when) {
  if (line == break_input) {
    break_input_ = high;
    check_break();
    configure_outputs();
    return;
  }
  if (line == external_trigger) return drive_external_trigger(high, when);
  if (line >= traits_.channels) return;
  // The filter sample at the time of a level change reads the new level.
  if (when != 0) take_input_changes(when - 1);
  channels_[line].input.drive(high, when);
  plan();
}

void Timer::connect_input(unsigned line, bool high) {
  if (line == break_input) {
    break_input_ = high;
  } else if (line == external_trigger) {
    external_.pin = high;
    external_.level = external_.divided = high != tim.smcr.etp.in(smcr_);
    external_.filter.connect(external_.level);
  } else if (line < traits_.channels) {
    channels_[line].input.connect(high);
  }
}

// The trigger passes ETP, then ETPS, then ETF (RM0090, TIMx_SMCR). The initial phase of the ETPS prescaler is not
// documented; in this model the first edge passes.
void Timer::drive_external_trigger(bool high, Ticks when) {
  external_.pin = high;
  const bool level = high != tim.smcr.etp.in(smcr_);
  const bool rises = level && !external_.level;
  external_.level = level;
  const unsigned prescaler = tim.smcr.etps.of(smcr_);
  bool divided = external_.divided;
  if (prescaler == 0)
    divided = level;
  else if (rises && external_.rises++ % (1u << (prescaler - 1)) == 0)
    divided = !divided;
  if (divided == external_.divided) return;
  external_.divided = divided;
  if (when != 0) take_input_changes(when - 1);
  external_.filter.drive(external_.divided, when);
  plan();
}

// If ECE is set, the external trigger clocks the counter. In a slave mode, the trigger may reset, gate or start the
// counter.
void Timer::external_edge() {
  const bool high = external_.filter.output();
  if (high && tim.smcr.ece.in(smcr_) && enabled() && (slave_mode() != gated || gate_open_)) count_one(down_);
  if (trigger_source() == external_input) trigger_in(high, false);
}

void Timer::internal_trigger(unsigned master, bool level, bool is_pulse) {
  if (master != master_) return;
  if (level) capture_by_trigger();
  trigger_in(level, is_pulse);
}

void Timer::usb_start_of_frame() {
  if (itr1_remap.of(or_) != itr1_is_otg_fs_sof || trigger_source() != 1) return;
  capture_by_trigger();
  trigger_in(true, true);
}

void Timer::trigger_in(bool level, bool is_pulse) {
  const Ticks now = machine_.timeline.now();
  switch (slave_mode()) {
    case reset_mode:
      if (level) reinitialise(true);
      break;
    case gated:
      if (is_pulse) return;
      settle();
      gate_open_ = level;
      begin_ramp(runs() ? now : ramp_start_);
      break;
    case trigger_mode:
      if (level && !enabled()) {
        cr1_ |= tim.cr1.cen.mask();
        begin_ramp(now);
      }
      break;
    case external_clock:
      if (level && enabled() && !tim.smcr.ece.in(smcr_)) count_one(down_);
      break;
    default: return;
  }
  if (level) raise(tim.sr.tif.mask());
}

}  // namespace inkwell::virtual_board
