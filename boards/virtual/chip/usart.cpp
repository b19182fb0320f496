#include "usart.hpp"

#include <algorithm>

#include "dma.hpp"

namespace inkwell::virtual_board {
namespace {
constexpr auto& map = usart_registers;
constexpr std::uint32_t overrun = map.sr.ore.mask(), idle_line = map.sr.idle.mask(), receive_full = map.sr.rxne.mask(),
                        complete = map.sr.tc.mask(), transmit_empty = map.sr.txe.mask();
// The enables of the interrupts stand at the bits of their flags.
static_assert(idle_line == map.cr1.idleie.mask() && receive_full == map.cr1.rxneie.mask() &&
              complete == map.cr1.tcie.mask() && transmit_empty == map.cr1.txeie.mask());
}  // namespace

Usart::Usart(Machine& machine, unsigned number, unsigned position, bool on_apb2)
    : machine_(machine), number_(number), position_(position), on_apb2_(on_apb2), slot_(machine.timeline.add(*this)) {}

void Usart::reset() {
  status_ = map.sr.reset_value;
  baud_ = control1_ = control2_ = control3_ = guard_ = 0;
  holding_full_ = false;
  sent_at_ = received_at_ = never;
  line_.clear();
  update();
}

Ticks Usart::frame_duration() const {
  const Clock& clock = on_apb2_ ? machine_.clocks.pclk2 : machine_.clocks.pclk1;
  const std::uint64_t cycles =
      map.cr1.over8.in(control1_) ? map.brr.div_mantissa.of(baud_) * 8 + (map.brr.div_fraction.of(baud_) & 7) : baud_;
  const unsigned stop_bits = map.cr2.stop.of(control2_) >= 2 ? 2 : 1;
  const unsigned bits = 1 + (map.cr1.m.in(control1_) ? 9 : 8) + stop_bits;
  return clock.duration(std::max<std::uint64_t>(cycles, 1) * bits);
}

void Usart::update() {
  const std::uint32_t asserted = (status_ & control1_ & (idle_line | receive_full | complete | transmit_empty)) |
                                 ((control1_ & receive_full) != 0 ? status_ & overrun : 0);
  machine_.nvic.set_source(position_, 0, asserted != 0);
  const Ticks due = std::min(sent_at_, received_at_);
  const bool awaited = (control1_ & (receive_full | complete | transmit_empty | idle_line)) != 0 ||
                       map.cr3.dmar.in(control3_) || map.cr3.dmat.in(control3_);
  machine_.timeline.set(slot_, due, awaited ? due : never);
}

void Usart::serve_dma() {
  if (map.cr3.dmar.in(control3_) && (status_ & receive_full) != 0) machine_.dma->usart_request(number_, false);
  if (map.cr3.dmat.in(control3_))
    while ((status_ & transmit_empty) != 0 && machine_.dma->usart_request(number_, true)) {
    }
}

void Usart::load_shift_register() {
  if (!holding_full_ || sent_at_ != never) return;
  if (!map.cr1.ue.in(control1_) || !map.cr1.te.in(control1_)) return;
  shift_ = holding_;
  holding_full_ = false;
  status_ |= transmit_empty;
  sent_at_ = machine_.timeline.now() + frame_duration();
  update();
}

void Usart::step(Ticks now) {
  if (sent_at_ <= now) {
    sent_at_ = never;
    if (on_sent) on_sent(number_, shift_);
    load_shift_register();
    if (sent_at_ == never) status_ |= complete;
    serve_dma();
  }
  if (received_at_ <= now) take_received();
  update();
}

void Usart::receive(std::uint8_t byte) {
  line_.push_back(byte);
  if (received_at_ == never) received_at_ = machine_.timeline.now() + frame_duration();
  update();
}

bool Usart::listens() const { return map.cr1.ue.in(control1_) && map.cr1.re.in(control1_); }

void Usart::take_received() {
  received_at_ = never;
  if (line_.empty()) {
    status_ |= idle_line;
    return;
  }
  if (listens()) {
    if ((status_ & receive_full) != 0) {
      status_ |= overrun;
    } else {
      received_ = line_.front();
      status_ |= receive_full;
      serve_dma();
    }
  }
  line_.pop_front();
  received_at_ = machine_.timeline.now() + frame_duration();
}

std::uint32_t Usart::stored(std::uint32_t offset) const {
  switch (offset) {
    case map.sr: return status_;
    case map.brr: return baud_;
    case map.cr1: return control1_;
    case map.cr2: return control2_;
    case map.cr3: return control3_;
    case map.gtpr: return guard_;
    default: return 0;
  }
}

std::uint32_t Usart::read_word(std::uint32_t offset) {
  if (offset == map.dr) {
    // Reading SR, then DR clears the receiver's flags.
    status_ &= ~(receive_full | overrun | idle_line);
    update();
    return received_;
  }
  if (offset > map.gtpr) machine_.log.note("USART" + std::to_string(number_), offset, false, 0);
  return stored(offset);
}

void Usart::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case map.sr: status_ &= value | ~bits_of(map.sr, Access::rc_w0); break;
    case map.dr:
      holding_ = static_cast<std::uint8_t>(value);
      holding_full_ = true;
      status_ &= ~(transmit_empty | complete);
      load_shift_register();
      break;
    case map.brr: baud_ = value & writable(map.brr); break;
    case map.cr1:
      control1_ = value & writable(map.cr1);
      load_shift_register();
      break;
    case map.cr2: control2_ = value & writable(map.cr2); break;
    case map.cr3:
      control3_ = value & writable(map.cr3);
      serve_dma();
      break;
    case map.gtpr: guard_ = value & writable(map.gtpr); break;
    default: return machine_.log.note("USART" + std::to_string(number_), offset, true, value);
  }
  update();
}

}  // namespace inkwell::virtual_board
