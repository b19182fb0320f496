#include "usart.hpp"

#include <algorithm>

#include "dma.hpp"

namespace inkwell::virtual_board {
namespace {
constexpr std::uint32_t sr = 0x00, dr = 0x04, brr = 0x08, cr1 = 0x0C, cr2 = 0x10, cr3 = 0x14, gtpr = 0x18;
constexpr std::uint32_t overrun = 1u << 3, idle_line = 1u << 4, receive_full = 1u << 5, complete = 1u << 6,
                        transmit_empty = 1u << 7;
constexpr std::uint32_t receiver = 1u << 2, transmitter = 1u << 3, nine_bits = 1u << 12, usart_enable = 1u << 13,
                        over_8 = 1u << 15;
constexpr std::uint32_t dma_receive = 1u << 6, dma_transmit = 1u << 7;
}  // namespace

Usart::Usart(Machine& machine, unsigned number, unsigned position, bool on_apb2)
    : machine_(machine), number_(number), position_(position), on_apb2_(on_apb2), slot_(machine.timeline.add(*this)) {}

void Usart::reset() {
  status_ = transmit_empty | complete;
  baud_ = control1_ = control2_ = control3_ = guard_ = 0;
  holding_full_ = false;
  sent_at_ = received_at_ = never;
  line_.clear();
  update();
}

Ticks Usart::frame_duration() const {
  const Clock& clock = on_apb2_ ? machine_.clocks.pclk2 : machine_.clocks.pclk1;
  const std::uint64_t cycles = (control1_ & over_8) != 0 ? (baud_ >> 4 << 3) + (baud_ & 7) : baud_;
  const unsigned stop_bits = (control2_ >> 13 & 1) != 0 ? 2 : 1;
  const unsigned bits = 1 + ((control1_ & nine_bits) != 0 ? 9 : 8) + stop_bits;
  return clock.duration(std::max<std::uint64_t>(cycles, 1) * bits);
}

void Usart::update() {
  const std::uint32_t asserted = (status_ & control1_ & (idle_line | receive_full | complete | transmit_empty)) |
                                 ((control1_ & receive_full) != 0 ? status_ & overrun : 0);
  machine_.nvic.set_source(position_, 0, asserted != 0);
  const Ticks due = std::min(sent_at_, received_at_);
  // TXEIE, TCIE and RXNEIE stand at the bits of their flags.
  const bool awaited = (control1_ & (receive_full | complete | transmit_empty | idle_line)) != 0 ||
                       (control3_ & (dma_receive | dma_transmit)) != 0;
  machine_.timeline.set(slot_, due, awaited ? due : never);
}

void Usart::serve_dma() {
  if ((control3_ & dma_receive) != 0 && (status_ & receive_full) != 0) machine_.dma->usart_request(number_, false);
  if ((control3_ & dma_transmit) != 0)
    while ((status_ & transmit_empty) != 0 && machine_.dma->usart_request(number_, true)) {
    }
}

void Usart::load_shift_register() {
  if (!holding_full_ || sent_at_ != never) return;
  if ((control1_ & (usart_enable | transmitter)) != (usart_enable | transmitter)) return;
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

void Usart::take_received() {
  received_at_ = never;
  if (line_.empty()) {
    status_ |= idle_line;
    return;
  }
  if ((control1_ & (usart_enable | receiver)) == (usart_enable | receiver)) {
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
    case sr: return status_;
    case brr: return baud_;
    case cr1: return control1_;
    case cr2: return control2_;
    case cr3: return control3_;
    case gtpr: return guard_;
    default: return 0;
  }
}

std::uint32_t Usart::read_word(std::uint32_t offset) {
  if (offset == dr) {
    // Reading SR, then DR clears the receiver's flags.
    status_ &= ~(receive_full | overrun | idle_line);
    update();
    return received_;
  }
  if (offset > gtpr) machine_.log.note("USART" + std::to_string(number_), offset, false, 0);
  return stored(offset);
}

void Usart::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case sr: status_ &= value | ~(receive_full | complete); break;
    case dr:
      holding_ = static_cast<std::uint8_t>(value);
      holding_full_ = true;
      status_ &= ~(transmit_empty | complete);
      load_shift_register();
      break;
    case brr: baud_ = value & 0xFFFF; break;
    case cr1:
      control1_ = value & 0xFFFF;
      load_shift_register();
      break;
    case cr2: control2_ = value & 0x7FFF; break;
    case cr3:
      control3_ = value & 0xFFF;
      serve_dma();
      break;
    case gtpr: guard_ = value; break;
    default: return machine_.log.note("USART" + std::to_string(number_), offset, true, value);
  }
  update();
}

}  // namespace inkwell::virtual_board
