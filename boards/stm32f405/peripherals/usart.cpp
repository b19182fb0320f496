#include "boards/stm32f405/peripherals/usart.hpp"

#include <algorithm>

#include "boards/stm32f405/peripherals/alternate_functions.hpp"

namespace inkwell::virtual_board {
namespace {
constexpr std::uint32_t usart_overrun = usart_map.sr.ore.mask(), idle_line = usart_map.sr.idle.mask(),
                        usart_receive_full = usart_map.sr.rxne.mask(), complete = usart_map.sr.tc.mask(),
                        usart_transmit_empty = usart_map.sr.txe.mask();
// Each interrupt enable bit has the position of its flag.
static_assert(idle_line == usart_map.cr1.idleie.mask() && usart_receive_full == usart_map.cr1.rxneie.mask() &&
              complete == usart_map.cr1.tcie.mask() && usart_transmit_empty == usart_map.cr1.txeie.mask());
}  // namespace

Usart::Usart(Machine& machine, DmaRequests& requests, const PinFunctions& pins, unsigned number, unsigned position,
             bool on_apb2)
    : machine_(machine),
      dma_(requests),
      pins_(pins),
      number_(number),
      position_(position),
      on_apb2_(on_apb2),
      slot_(machine.timeline.add(*this)) {}

void Usart::reset() {
  status_ = usart_map.sr.reset_value;
  baud_ = control1_ = control2_ = control3_ = guard_ = 0;
  holding_full_ = false;
  sent_at_ = received_at_ = never;
  line_.clear();
  update();
}

unsigned Usart::cycles_of_bit() const {
  if (!usart_map.cr1.over8.in(control1_)) return baud_;
  return usart_map.brr.div_mantissa.of(baud_) * 8 + (usart_map.brr.div_fraction.of(baud_) & 7);
}

Ticks Usart::frame_duration() const {
  const Clock& clock = on_apb2_ ? machine_.clocks.pclk2 : machine_.clocks.pclk1;
  const unsigned stop_bits = usart_map.cr2.stop.of(control2_) >= 2 ? 2 : 1;
  const unsigned bits = 1 + (usart_map.cr1.m.in(control1_) ? 9 : 8) + stop_bits;
  return clock.duration(std::uint64_t{std::max(cycles_of_bit(), 1u)} * bits);
}

void Usart::update() {
  const std::uint32_t asserted =
      (status_ & control1_ & (idle_line | usart_receive_full | complete | usart_transmit_empty)) |
      ((control1_ & usart_receive_full) != 0 ? status_ & usart_overrun : 0);
  machine_.nvic.set_source(position_, 0, asserted != 0);
  const Ticks due = std::min(sent_at_, received_at_);
  const bool awaited = (control1_ & (usart_receive_full | complete | usart_transmit_empty | idle_line)) != 0 ||
                       usart_map.cr3.dmar.in(control3_) || usart_map.cr3.dmat.in(control3_);
  machine_.timeline.set(slot_, due, awaited ? due : never);
}

void Usart::serve_dma() {
  if (usart_map.cr3.dmar.in(control3_) && (status_ & usart_receive_full) != 0) dma_.usart_request(number_, false);
  if (usart_map.cr3.dmat.in(control3_))
    while ((status_ & usart_transmit_empty) != 0 && dma_.usart_request(number_, true)) {
    }
}

void Usart::load_shift_register() {
  if (!holding_full_ || sent_at_ != never) return;
  if (!usart_map.cr1.ue.in(control1_) || !usart_map.cr1.te.in(control1_)) return;
  shift_ = holding_;
  holding_full_ = false;
  status_ |= usart_transmit_empty;
  sent_at_ = machine_.timeline.now() + frame_duration();
  update();
}

std::string Usart::name() const { return (number_ == 4 || number_ == 5 ? "UART" : "USART") + std::to_string(number_); }

bool Usart::is_heard() const {
  const unsigned shortest = usart_map.cr1.over8.in(control1_) ? 8 : 16;
  if (cycles_of_bit() < shortest) {
    machine_.violations.violate(Rule::usart_divider, name());
    return false;
  }
  for (const auto& [usart, port, pin, function] : transmit_pins)
    if (usart == number_ && pins_.has_function(static_cast<unsigned>(port - 'A'), pin, function)) return true;
  machine_.violations.violate(Rule::usart_pin, name());
  return false;
}

void Usart::step(Ticks now) {
  if (sent_at_ <= now) {
    sent_at_ = never;
    if (is_heard() && on_sent) on_sent(number_, shift_);
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

bool Usart::listens() const { return usart_map.cr1.ue.in(control1_) && usart_map.cr1.re.in(control1_); }

void Usart::take_received() {
  received_at_ = never;
  if (line_.empty()) {
    status_ |= idle_line;
    return;
  }
  if (listens()) {
    if ((status_ & usart_receive_full) != 0) {
      status_ |= usart_overrun;
    } else {
      received_ = line_.front();
      status_ |= usart_receive_full;
      serve_dma();
    }
  }
  line_.pop_front();
  received_at_ = machine_.timeline.now() + frame_duration();
}

std::uint32_t Usart::stored(std::uint32_t offset) const {
  switch (offset) {
    case usart_map.sr: return status_;
    case usart_map.brr: return baud_;
    case usart_map.cr1: return control1_;
    case usart_map.cr2: return control2_;
    case usart_map.cr3: return control3_;
    case usart_map.gtpr: return guard_;
    default: return 0;
  }
}

std::uint32_t Usart::read_word(std::uint32_t offset) {
  if (offset == usart_map.dr) {
    // Reading SR and then DR clears the receiver flags.
    status_ &= ~(usart_receive_full | usart_overrun | idle_line);
    update();
    return received_;
  }
  if (offset > usart_map.gtpr) machine_.log.note("USART" + std::to_string(number_), offset, false, 0);
  return stored(offset);
}

void Usart::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case usart_map.sr: status_ &= value | ~bits_of(usart_map.sr, Access::rc_w0); break;
    case usart_map.dr:
      holding_ = static_cast<std::uint8_t>(value);
      holding_full_ = true;
      status_ &= ~(usart_transmit_empty | complete);
      load_shift_register();
      break;
    case usart_map.brr: baud_ = value & writable(usart_map.brr); break;
    case usart_map.cr1:
      control1_ = value & writable(usart_map.cr1);
      load_shift_register();
      break;
    case usart_map.cr2: control2_ = value & writable(usart_map.cr2); break;
    case usart_map.cr3:
      control3_ = value & writable(usart_map.cr3);
      serve_dma();
      break;
    case usart_map.gtpr: guard_ = value & writable(usart_map.gtpr); break;
    default: return machine_.log.note(name(), offset, true, value);
  }
  update();
}

}  // namespace inkwell::virtual_board
