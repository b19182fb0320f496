// Flash interface: wait states, lock, sector erase and programming (RM0090, "Embedded Flash memory interface").
//
// During an erase or program operation the processor waits at each access to the flash (RM0090, "Read-while-write").
// Code in RAM continues. A reset during an erase or program operation leaves partially changed contents.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "boards/stm32f405/core/flash_port.hpp"
#include "boards/stm32f405/memory/register_block.hpp"

namespace inkwell::virtual_board {

struct FlashRegisters {
  struct : Register {
    Field latency{"LATENCY", 0, 3}, prften{"PRFTEN", 8}, icen{"ICEN", 9}, dcen{"DCEN", 10},
        icrst{"ICRST", 11, 1, Access::w}, dcrst{"DCRST", 12, 1, Access::w};
  } acr{{"ACR", 0x00}};
  struct : Register {
    Field key{"KEY", 0, 32, Access::w};
  } keyr{{"KEYR", 0x04}};
  struct : Register {
    Field optkey{"OPTKEY", 0, 32, Access::w};
  } optkeyr{{"OPTKEYR", 0x08}};
  struct : Register {
    Field eop{"EOP", 0, 1, Access::rc_w1}, operr{"OPERR", 1, 1, Access::rc_w1}, wrperr{"WRPERR", 4, 1, Access::rc_w1},
        pgaerr{"PGAERR", 5, 1, Access::rc_w1}, pgperr{"PGPERR", 6, 1, Access::rc_w1},
        pgserr{"PGSERR", 7, 1, Access::rc_w1}, bsy{"BSY", 16, 1, Access::r};
  } sr{{"SR", 0x0C}};
  struct : Register {
    Field pg{"PG", 0}, ser{"SER", 1}, mer{"MER", 2}, snb{"SNB", 3, 4}, psize{"PSIZE", 8, 2},
        strt{"STRT", 16, 1, Access::rs}, eopie{"EOPIE", 24}, errie{"ERRIE", 25}, lock{"LOCK", 31, 1, Access::rs};
  } cr{{"CR", 0x10, 0x8000'0000}};
  struct : Register {
    Field optlock{"OPTLOCK", 0, 1, Access::rs}, optstrt{"OPTSTRT", 1, 1, Access::rs}, bor_lev{"BOR_LEV", 2, 2},
        wdg_sw{"WDG_SW", 5}, nrst_stop{"nRST_STOP", 6}, nrst_stdby{"nRST_STDBY", 7}, rdp{"RDP", 8, 8},
        nwrp{"nWRP", 16, 12};
  } optcr{{"OPTCR", 0x14, 0x0FFF'AAED}};
};
inline constexpr FlashRegisters flash_map;

class Processor;

class FlashController final : public RegisterBlock, public TimedPart, public ClockUser, public FlashPort {
 public:
  FlashController(Machine& machine, Processor& processor);
  void reset() override;
  void step(Ticks now) override;
  void before_clock_change() override {}
  void after_clock_change() override { check_wait_states(); }
  std::optional<std::uint32_t> program(std::uint32_t address, std::uint32_t value, unsigned size) override;
  /// Typical falling and rising thresholds of the brown-out reset (data sheet).
  struct Threshold {
    double falling_V, rising_V;
  };
  Threshold brown_out() const;
  bool busy() const { return flash_map.sr.bsy.in(status_); }
  void hold_up() override;
  /// Number of erase and program operations since construction.
  std::uint64_t operations() const { return operations_; }
  /// Cuts the power during flash operation number `operation`, counted from 1. With 0, the power is not cut. Power
  /// returns immediately.
  void cut_power_at(std::uint64_t operation) { cut_at_ = operation; }
  /// Call this function when the supply voltage or the clock has changed.
  void check_wait_states();

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;
  std::span<const MapEntry> registers() const override { return shown<flash_map>(); }

 private:
  void erase();
  void write_option_key(std::uint32_t key);
  void write_options(std::uint32_t value);
  void set_accelerator(std::uint32_t access);
  /// Flash operation in progress, with the flash contents before the operation.
  struct Operation {
    bool erases;
    std::uint32_t offset;
    std::vector<std::uint8_t> before;
  };
  void begin(Ticks typical, bool erases, std::uint32_t offset, std::uint32_t bytes);
  /// Writes the partial result of the flash operation that a reset interrupted.
  void tear();
  void set_busy(bool busy);
  void update_interrupt();

  Machine& machine_;
  Processor& processor_;
  Timeline::Slot slot_;
  std::uint32_t access_ = 0, status_ = 0, control_ = 0;
  unsigned unlock_step_ = 0;
  bool unlock_failed_ = false;
  std::uint32_t option_bytes_;  ///< programmed values, which persist across resets
  std::uint32_t options_ = 0;   ///< OPTCR without OPTLOCK and OPTSTRT
  bool options_locked_ = true, options_start_ = false, options_unlock_failed_ = false;
  unsigned options_unlock_step_ = 0;
  std::optional<Operation> operation_;
  Ticks done_ = 0;
  std::uint64_t operations_ = 0, cut_at_ = 0;
  std::minstd_rand random_;
};

}  // namespace inkwell::virtual_board
