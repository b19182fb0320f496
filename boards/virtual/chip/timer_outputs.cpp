// Compare references and outputs of a timer, its break input, captures, encoder and slave modes.
#include "adc.hpp"
#include "dma.hpp"
#include "pins.hpp"
#include "timer_bits.hpp"
#include "timers.hpp"

namespace inkwell::virtual_board {

using namespace timer_bits;

bool Timer::compare_level(unsigned i, std::uint32_t count) const {
  const std::uint32_t compare = channels_[i].active_compare;
  // PWM mode 1 upward: active while CNT < CCR; downward: inactive while CNT > CCR.
  const bool active = down_ ? count <= compare : count < compare;
  return output_mode(i) == pwm_2 ? !active : active;
}

void Timer::set_reference(unsigned i, bool level) {
  auto& channel = channels_[i];
  if (channel.reference == level) return;
  channel.reference = level;
  drive_outputs(i);
  if ((cr2_ >> 4 & 7) == 4 + i) trigger_out(level, false);
}

void Timer::drive_outputs(unsigned i) {
  const auto& channel = channels_[i];
  machine_.pins->timer_output(model_.number, i, channel.reference ? channel.when_active : channel.when_inactive);
  if (model_.advanced && i < 3)
    machine_.pins->timer_output(model_.number, complementary_1 + i,
                                channel.reference ? channel.complement_when_active : channel.complement_when_inactive);
}

void Timer::configure_channel(unsigned i) {
  auto& channel = channels_[i];
  const auto level = [](bool high) { return high ? PinLevel::high : PinLevel::low; };
  const std::uint32_t bits = ccer_ >> 4 * i;
  const bool output = (bits & 1) != 0, inverted = (bits & 2) != 0;
  const bool complement = model_.advanced && i < 3 && (bits & 4) != 0, complement_inverted = (bits & 8) != 0;
  channel.when_active = channel.when_inactive = PinLevel::floating;
  channel.complement_when_active = channel.complement_when_inactive = PinLevel::floating;
  channel.needed = false;
  if (selection(i) != 0) return;  // an input

  // RM0090, table "Output control bits for complementary OCx and OCxN channels with break feature".
  if (!model_.advanced || (bdtr_ & main_output) != 0) {
    if (output) {
      channel.when_active = level(!inverted);
      channel.when_inactive = level(inverted);
    } else if (complement && (bdtr_ & off_state_run) != 0) {
      channel.when_active = channel.when_inactive = level(inverted);
    }
    if (complement) {
      // Beside OCx its complement; alone it follows the reference itself.
      channel.complement_when_active = level(output == complement_inverted);
      channel.complement_when_inactive = level(output != complement_inverted);
      if (output && (bdtr_ & 0xFF) != 0) machine_.log.say_once("TIMx_BDTR.DTG: dead time is not modelled, taken as 0");
    } else if (model_.advanced && i < 3 && output && (bdtr_ & off_state_run) != 0) {
      channel.complement_when_active = channel.complement_when_inactive = level(complement_inverted);
    }
    channel.needed = output || complement;
  } else if ((bdtr_ & off_state_idle) != 0 && (output || complement)) {
    channel.when_active = channel.when_inactive = level((cr2_ >> (8 + 2 * i) & 1) != 0);
    if (i < 3)
      channel.complement_when_active = channel.complement_when_inactive = level((cr2_ >> (9 + 2 * i) & 1) != 0);
  }
  if ((cr2_ >> 4 & 7) >= master_compare_pulse) channel.needed = true;
}

void Timer::configure_outputs() {
  const std::uint32_t count = count_now();
  for (unsigned i = 0; i < model_.channels; ++i) {
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
  if (!model_.advanced || (bdtr_ & break_enable) == 0) return;
  const bool active = break_input_ == ((bdtr_ & break_polarity) != 0);
  if (!active) return;
  bdtr_ &= ~main_output;
  raise(break_flag);
}

void Timer::capture(unsigned i) {
  auto& channel = channels_[i];
  if ((sr_ & capture_compare_1 << i) != 0) sr_ |= overcapture_1 << i;
  channel.compare = channel.active_compare = count_now();
  raise(capture_compare_1 << i);
  if ((dier_ >> (9 + i) & 1) != 0) machine_.dma->timer_request(model_.number, i + 1);
  if (i == 0 && (cr2_ >> 4 & 7) == master_compare_pulse) trigger_out(true, true);
}

void Timer::count_encoder_edge(unsigned changed) {
  // RM0090, table "Counting direction versus encoder signals"; CCxP inverts an input.
  const unsigned mode = slave_mode();
  if ((cr1_ & enable) == 0) return;
  if ((mode == 1 && changed == 0) || (mode == 2 && changed == 1)) return;
  const bool first = channels_[0].input != ((ccer_ & 1u << 1) != 0);
  const bool second = channels_[1].input != ((ccer_ & 1u << 5) != 0);
  const bool down = changed == 0 ? first == second : first != second;
  count_one(down);
}

void Timer::channel_edge(unsigned i) {
  const bool high = channels_[i].input;
  // Captures: channel i from its own input, its neighbour through the cross connection.
  for (const unsigned target : {i, i ^ 1}) {
    if (target >= model_.channels || selection(target) != (target == i ? 1u : 2u)) continue;
    const std::uint32_t bits = ccer_ >> 4 * target;
    if ((bits & 1) == 0) continue;
    const bool both = (bits & 0xA) == 0xA, falling = (bits & 2) != 0;
    if (both || high != falling) capture(target);
  }
  const unsigned source = smcr_ >> 4 & 7;
  if (encoder_mode() || slave_mode() == 0) return;
  const bool inverted = (ccer_ >> (4 * i + 1) & 1) != 0;
  if (source == 4 && i == 0) trigger_in(true, true);
  if ((source == 5 && i == 0) || (source == 6 && i == 1)) trigger_in(high != inverted, false);
}

void Timer::input_changed(unsigned line, bool high) {
  if (line == break_input) {
    break_input_ = high;
    check_break();
    configure_outputs();
    return;
  }
  if (line == external_trigger) {
    const bool inverted = (smcr_ & 1u << 15) != 0;
    if ((smcr_ >> 4 & 7) == 7) trigger_in(high != inverted, false);
    return;
  }
  if (line >= model_.channels) return;
  channels_[line].input = high;
  if (encoder_mode() && line < 2) {
    if ((ccmr_[0] & 0xF0F0) != 0) machine_.log.say_once("TIMx_CCMR1.ICxF: input filters are not modelled");
    count_encoder_edge(line);
  }
  channel_edge(line);
}

void Timer::connect_input(unsigned line, bool high) {
  if (line == break_input)
    break_input_ = high;
  else if (line < model_.channels)
    channels_[line].input = high;
}

void Timer::internal_trigger(unsigned master, bool level, bool is_pulse) {
  const unsigned source = smcr_ >> 4 & 7;
  if (!model_.is_slave || source > 3 || model_.internal_triggers[source] != master) return;
  trigger_in(level, is_pulse);
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
      if (level && (cr1_ & enable) == 0) {
        cr1_ |= enable;
        begin_ramp(now);
      }
      break;
    case external_clock:
      if (level && (cr1_ & enable) != 0) count_one(down_);
      break;
    default: return;
  }
  if (level) raise(trigger_flag);
}

}  // namespace inkwell::virtual_board
