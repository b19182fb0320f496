// Flash interface: wait states, lock, sector erase and programming (RM0090, "Embedded Flash memory interface").
#pragma once

#include <cstdint>
#include <optional>

#include "bus.hpp"

namespace inkwell::virtual_board {

class FlashController final : public RegisterBlock, public TimedPart, public ClockUser {
 public:
  explicit FlashController(Machine& machine);
  void reset() override;
  void step(Ticks now) override;
  void before_clock_change() override {}
  void after_clock_change() override { check_wait_states(); }
  /// A store of the processor into the flash: what is there afterwards. Nothing: not the flash, a bus fault.
  std::optional<std::uint32_t> program(std::uint32_t address, std::uint32_t value, unsigned size);

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;

 private:
  void erase();
  void check_wait_states();
  void begin(Ticks duration);
  void update_interrupt();

  Machine& machine_;
  Timeline::Slot slot_;
  std::uint32_t access_ = 0, status_ = 0, control_ = 0;
  unsigned unlock_step_ = 0;
  bool unlock_failed_ = false;
};

}  // namespace inkwell::virtual_board
