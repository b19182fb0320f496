// External interrupts, and their port selection in SYSCFG (RM0090, "External interrupt/event controller").
#pragma once

#include <array>
#include <cstdint>

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"

namespace inkwell::virtual_board {

struct ExtiRegisters {
  struct : Register {
    Field mr{"MR#", 0, 1, Access::rw, {23, 1}};
  } imr{{"IMR", 0x00}}, emr{{"EMR", 0x04}};
  struct : Register {
    Field tr{"TR#", 0, 1, Access::rw, {23, 1}};
  } rtsr{{"RTSR", 0x08}}, ftsr{{"FTSR", 0x0C}};
  struct : Register {
    Field swier{"SWIER#", 0, 1, Access::rw, {23, 1}};
  } swier{{"SWIER", 0x10}};
  struct : Register {
    Field pr{"PR#", 0, 1, Access::rc_w1, {23, 1}};
  } pr{{"PR", 0x14}};
};
inline constexpr ExtiRegisters exti_map;

template <unsigned lowest>
struct ExtiPorts : Register {
  Field exti{"EXTI#", 0, 4, Access::rw, {4, 4, lowest}};
};
struct SyscfgRegisters {
  struct : Register {
    Field mem_mode{"MEM_MODE", 0, 2};
  } memrmp{{"MEMRMP", 0x00}};
  struct : Register {
    Field mii_rmii_sel{"MII_RMII_SEL", 23};
  } pmc{{"PMC", 0x04}};
  ExtiPorts<0> exticr1{{"EXTICR1", 0x08}};
  ExtiPorts<4> exticr2{{"EXTICR2", 0x0C}};
  ExtiPorts<8> exticr3{{"EXTICR3", 0x10}};
  ExtiPorts<12> exticr4{{"EXTICR4", 0x14}};
  struct : Register {
    Field cmp_pd{"CMP_PD", 0}, ready{"READY", 8, 1, Access::r};
  } cmpcr{{"CMPCR", 0x20}};
};
inline constexpr SyscfgRegisters syscfg_registers;

class Processor;

class Exti final : public RegisterBlock, public ExternalLines {
 public:
  Exti(Machine& machine, Processor& processor, ConverterTriggers& triggers)
      : machine_(machine), processor_(processor), triggers_(triggers), syscfg_(*this) {}
  void reset() override;
  void pin_changed(unsigned port, unsigned pin, bool high) override;
  void internal_line(unsigned line, bool high) override;
  Peripheral& syscfg() { return syscfg_; }
  /// Until the next reset, SYSCFG_MEMRMP reports that the boot pins selected the boot loader (RM0090).
  void show_boot_loader_chosen() { syscfg_.show_boot_loader_chosen(); }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;
  std::span<const MapEntry> registers() const override { return shown<exti_map>(); }

 private:
  class Syscfg final : public RegisterBlock {
   public:
    explicit Syscfg(Exti& exti) : exti_(exti) {}
    void reset() override;
    void show_boot_loader_chosen();
    unsigned port_of(unsigned pin) const {
      constexpr unsigned first_word = syscfg_registers.exticr1 / 4;
      return syscfg_registers.exticr1.exti.of(words_[first_word + pin / 4], pin % 4);
    }

   protected:
    std::uint32_t read_word(std::uint32_t offset) override;
    void write_word(std::uint32_t offset, std::uint32_t value) override;
    std::uint32_t stored(std::uint32_t offset) const override { return offset < bytes ? words_[offset / 4] : 0; }
    std::span<const MapEntry> registers() const override { return shown<syscfg_registers>(); }

   private:
    void map_at_zero(std::uint32_t mode);
    static constexpr std::uint32_t bytes = syscfg_registers.cmpcr + 4;
    Exti& exti_;
    std::array<std::uint32_t, bytes / 4> words_{};
  };
  void edge(unsigned line);
  void update_interrupts();

  Machine& machine_;
  Processor& processor_;
  ConverterTriggers& triggers_;
  Syscfg syscfg_;
  std::uint32_t interrupt_mask_ = 0, event_mask_ = 0, rising_ = 0, falling_ = 0, software_ = 0, pending_ = 0;
  std::uint32_t internal_ = 0;  ///< levels of the internal lines
};

}  // namespace inkwell::virtual_board
