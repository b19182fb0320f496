// DMA1 and DMA2 (RM0090, "DMA controller"). A request moves one item immediately. FIFO thresholds and bursts have no
// effect.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "boards/stm32f405/memory/bus.hpp"
#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/dma_map.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"

namespace inkwell::virtual_board {

class DmaController final : public RegisterBlock {
 public:
  DmaController(Machine& machine, Bus& bus, DmaUsers& users, unsigned number);
  void reset() override;
  /// Handles a request on a channel of a stream. Returns false if the stream does not accept the request.
  bool request(unsigned stream, unsigned channel);
  /// Returns true if the stream is enabled for the channel and an interrupt of the stream is enabled.
  bool interrupts_for(unsigned index, unsigned channel) const {
    const std::uint32_t control = streams_[index].control;
    return dma.cr.en.in(control) && dma.cr.chsel.of(control) == channel &&
           (dma.cr.tcie.in(control) || dma.cr.htie.in(control) || dma.cr.teie.in(control));
  }
  /// While `stopped` is true, the controller refuses all requests.
  void stop(bool stopped) { stopped_ = stopped; }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;
  std::span<const MapEntry> registers() const override { return shown<dma>(); }

 private:
  struct Stream {
    std::uint32_t control = 0, count = 0, peripheral = 0, memory[2] = {0, 0}, fifo = dma.fcr.reset_value;
    std::uint32_t reload = 0, moved = 0;
    std::uint32_t flags = 0;
  };
  void enable(unsigned index);
  void move_item(unsigned index);
  bool load(std::uint32_t address, unsigned size, std::uint32_t& value);
  bool store(std::uint32_t address, unsigned size, std::uint32_t value);
  void update_interrupt(unsigned index);

  Machine& machine_;
  Bus& bus_;
  DmaUsers& users_;
  unsigned number_;
  bool stopped_ = false;
  std::array<Stream, 8> streams_{};
};

/// Assignment of streams to peripherals (RM0090, tables "DMA1 request mapping" and "DMA2 request mapping").
class Dma final : public DmaRequests {
 public:
  Dma(Machine& machine, Bus& bus, DmaUsers& users);
  DmaController& controller(unsigned number) { return number == 1 ? first_ : second_; }
  bool adc_request(unsigned index) override;
  bool interrupts_for_adc(unsigned index) const override;
  bool timer_request(unsigned timer, unsigned source) override;
  bool usart_request(unsigned number, bool transmit) override;
  bool spi_request(unsigned number, bool transmit) override;

 private:
  DmaController first_, second_;
};

}  // namespace inkwell::virtual_board
