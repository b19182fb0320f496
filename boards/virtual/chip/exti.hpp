// External interrupts and the choice of their ports in SYSCFG (RM0090, "External interrupt/event controller").
#pragma once

#include <array>
#include <cstdint>

#include "bus.hpp"

namespace inkwell::virtual_board {

class Exti final : public RegisterBlock {
 public:
  explicit Exti(Machine& machine) : machine_(machine), syscfg_(*this) { machine.exti = this; }
  void reset() override;
  void pin_changed(unsigned port, unsigned pin, bool high);
  Peripheral& syscfg() { return syscfg_; }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;

 private:
  class Syscfg final : public RegisterBlock {
   public:
    explicit Syscfg(Exti& exti) : exti_(exti) {}
    void reset() override { words_ = {}; }
    unsigned port_of(unsigned pin) const { return words_[2 + pin / 4] >> 4 * (pin % 4) & 0xF; }

   protected:
    std::uint32_t read_word(std::uint32_t offset) override;
    void write_word(std::uint32_t offset, std::uint32_t value) override;
    std::uint32_t stored(std::uint32_t offset) const override { return offset < 0x24 ? words_[offset / 4] : 0; }

   private:
    Exti& exti_;
    std::array<std::uint32_t, 9> words_{};
  };
  void edge(unsigned line);
  void update_interrupts();

  Machine& machine_;
  Syscfg syscfg_;
  std::uint32_t interrupt_mask_ = 0, event_mask_ = 0, rising_ = 0, falling_ = 0, software_ = 0, pending_ = 0;
};

}  // namespace inkwell::virtual_board
