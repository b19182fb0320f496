// USART1 to 3 and 6, UART4 and 5 (RM0090, "Universal synchronous asynchronous receiver transmitter"):
// asynchronous frames at their real speed, characters instead of edges on the pins.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "bus.hpp"

namespace inkwell::virtual_board {

class Usart final : public RegisterBlock, public TimedPart {
 public:
  Usart(Machine& machine, unsigned number, unsigned position, bool on_apb2);
  void reset() override;
  void step(Ticks now) override;
  void receive(std::uint8_t byte);
  /// A DMA stream has been enabled: requests that wait can be served.
  void serve_dma();
  std::function<void(unsigned number, std::uint8_t byte)> on_sent;

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;

 private:
  Ticks frame_duration() const;
  void load_shift_register();
  void take_received();
  void update();

  Machine& machine_;
  unsigned number_, position_;
  bool on_apb2_;
  Timeline::Slot slot_;
  std::uint32_t status_ = 0xC0, baud_ = 0, control1_ = 0, control2_ = 0, control3_ = 0, guard_ = 0;
  std::uint8_t shift_ = 0, holding_ = 0, received_ = 0;
  bool holding_full_ = false;
  Ticks sent_at_ = never, received_at_ = never;
  std::deque<std::uint8_t> line_;
};

}  // namespace inkwell::virtual_board
