#include "boards/stm32f405/peripherals/spi.hpp"

namespace inkwell::virtual_board {
namespace {
constexpr std::uint32_t spi_receive_full = spi.sr.rxne.mask(), spi_transmit_empty = spi.sr.txe.mask(),
                        spi_overrun = spi.sr.ovr.mask();
}  // namespace

void Spi::reset() {
  if (frame_ != 0) events_.cancel(std::exchange(frame_, 0));
  control1_ = control2_ = i2s_ = received_ = 0;
  status_ = spi.sr.reset_value;
  polynomial_ = spi.crcpr.reset_value;
  update();
}

Ticks Spi::frame_duration() const {
  const Clock& clock = on_apb2_ ? machine_.clocks.pclk2 : machine_.clocks.pclk1;
  const unsigned bits = spi.cr1.dff.in(control1_) ? 16 : 8;
  return clock.duration(std::uint64_t{bits} * (2u << spi.cr1.br.of(control1_)));
}

void Spi::start_frame() {
  const bool clocks = spi.cr1.spe.in(control1_) && spi.cr1.mstr.in(control1_);
  const bool has_frame = (status_ & spi_transmit_empty) == 0 || spi.cr1.rxonly.in(control1_);
  if (frame_ != 0 || !clocks || !has_frame) return;
  status_ |= spi_transmit_empty;  // the frame has moved to the shift register
  frame_ = events_.at(machine_.timeline.now() + frame_duration(), [this] { end_frame(); });
}

void Spi::end_frame() {
  frame_ = 0;
  if ((status_ & spi_receive_full) != 0)
    status_ |= spi_overrun;
  else
    received_ = spi.cr1.dff.in(control1_) ? 0xFFFF : 0xFF;
  status_ |= spi_receive_full;
  start_frame();
  serve_dma();
  update();
}

void Spi::serve_dma() {
  if (spi.cr2.rxdmaen.in(control2_) && (status_ & spi_receive_full) != 0) dma_.spi_request(number_, false);
  if (spi.cr2.txdmaen.in(control2_))
    while ((status_ & spi_transmit_empty) != 0 && dma_.spi_request(number_, true)) {
    }
}

void Spi::update() {
  machine_.nvic.set_source(position_, 0,
                           (spi.cr2.rxneie.in(control2_) && (status_ & spi_receive_full) != 0) ||
                               (spi.cr2.txeie.in(control2_) && (status_ & spi_transmit_empty) != 0) ||
                               (spi.cr2.errie.in(control2_) && (status_ & spi_overrun) != 0));
}

std::uint32_t Spi::stored(std::uint32_t offset) const {
  switch (offset) {
    case spi.cr1: return control1_;
    case spi.cr2: return control2_;
    case spi.sr: return status_ | spi.sr.bsy.with(frame_ != 0);
    case spi.crcpr: return polynomial_;
    case spi.i2scfgr: return i2s_;
    default: return 0;
  }
}

std::uint32_t Spi::read_word(std::uint32_t offset) {
  if (offset == spi.dr) {
    status_ &= ~(spi_receive_full | spi_overrun);  // real hardware clears OVR only at the subsequent read of SR
    update();
    return received_;
  }
  if (offset > spi.crcpr && offset != spi.i2scfgr) machine_.log.note(name(), offset, false, 0);
  return stored(offset);
}

void Spi::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case spi.cr1:
      control1_ = value & writable(spi.cr1);
      if (spi.cr1.crcen.in(value)) machine_.log.say_once(name() + ": CRC is not modeled and is never sent");
      start_frame();
      break;
    case spi.cr2: control2_ = value & writable(spi.cr2); break;
    case spi.sr: status_ &= value | ~bits_of(spi.sr, Access::rc_w0); break;
    case spi.dr:
      status_ &= ~spi_transmit_empty;
      start_frame();
      break;
    case spi.crcpr: polynomial_ = value & writable(spi.crcpr); break;
    case spi.i2scfgr:
      i2s_ = value & writable(spi.i2scfgr);
      if (spi.i2scfgr.i2smod.in(value)) machine_.log.say_once(name() + ": I2S is not modeled, and no samples are sent");
      break;
    default: return machine_.log.note(name(), offset, true, value);
  }
  serve_dma();
  update();
}

}  // namespace inkwell::virtual_board
