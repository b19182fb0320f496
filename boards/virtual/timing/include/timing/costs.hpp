// What the Cortex-M4F and the STM32F405 charge in cycles of HCLK, each figure with its source: the one home of
// every number of the cycle model.
//
// No board has confirmed them. Where sources leave a choice there are two figures: the likely one, and the
// conservative one by which deadlines are judged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace inkwell::virtual_board {

/// Which of its two figures every cost takes.
enum class Pricing : std::uint8_t { likely, conservative };

/// Where a figure comes from.
enum class Source : std::uint8_t {
  reference_manual,  ///< ARM's technical reference manuals of the Cortex-M4 (DDI 0439) and M3 (DDI 0337)
  compiler,          ///< the scheduling description of the Cortex-M4 in GCC
  chip_manual,       ///< RM0090
  measured,          ///< published measurements on an STM32F407
  guess,             ///< none: a board has to tell
};

enum class Cost : std::uint8_t {
  refill_immediate,
  refill_register,
  refill_load,
  table_branch,
  address_from_previous,
  load_stall,
  store_before_load,
  same_base_written_back,
  store_register_offset,
  multiple_base,
  divide_shortest,
  divide_longest,
  system_register,
  barrier,
  exclusive,
  float_result_used_next,
  float_multiply_accumulate,
  float_divide,
  float_transfer,
  float_multiple_base,
  exception_entry,
  exception_return,
  exception_tail_chain,
  lazy_stacking,
  float_unstacking,
  vector_from_flash,
  sram_refill,
  prefetch_follows_hit,
  prefetched_line_is_cached,
  miss_waits_for_prefetch,
  ahb_read,
  ahb_write,
  apb_cross,
  apb_peripheral_clocks,
  private_bus,
  count_,
};

struct CostInfo {
  Cost cost;
  std::string_view name;
  std::uint8_t likely, conservative;
  Source source;
  std::string_view meaning;
};

// clang-format off
inline constexpr CostInfo cost_table[] = {
    {Cost::refill_immediate, "refill_immediate", 1, 2, Source::reference_manual, "a taken branch whose target is in the instruction (B, Bcc, BL, CBZ): refill of the pipeline, 1 to 3"},
    {Cost::refill_register, "refill_register", 2, 3, Source::reference_manual, "a branch to a register (BX, BLX, MOV to the program counter)"},
    {Cost::refill_load, "refill_load", 3, 3, Source::reference_manual, "a branch by a load (POP, LDM or LDR to the program counter), after the load's own cycles"},
    {Cost::table_branch, "table_branch", 6, 6, Source::reference_manual, "TBB and TBH, refill included"},
    {Cost::address_from_previous, "address_from_previous", 1, 1, Source::reference_manual, "a load or store whose base or index the instruction just before has written"},
    {Cost::load_stall, "load_stall", 1, 1, Source::reference_manual, "a load of one register beyond its first cycle, unless another access follows in the pipeline"},
    {Cost::store_before_load, "store_before_load", 1, 1, Source::measured, "a store directly before a load"},
    {Cost::same_base_written_back, "same_base_written_back", 1, 1, Source::measured, "two accesses in a row that write back one base"},
    {Cost::store_register_offset, "store_register_offset", 2, 2, Source::compiler, "a store with a register offset; one less before a narrow NOP"},
    {Cost::multiple_base, "multiple_base", 1, 1, Source::reference_manual, "LDM, STM, PUSH, POP, LDRD, STRD beside a cycle a word"},
    {Cost::divide_shortest, "divide_shortest", 2, 2, Source::reference_manual, "SDIV and UDIV with a quotient of 0"},
    {Cost::divide_longest, "divide_longest", 12, 12, Source::reference_manual, "SDIV and UDIV with a quotient of 32 bits"},
    {Cost::system_register, "system_register", 1, 2, Source::reference_manual, "MRS, MSR, CPS"},
    {Cost::barrier, "barrier", 1, 4, Source::reference_manual, "DMB, DSB, ISB, beside ISB's refill"},
    {Cost::exclusive, "exclusive", 2, 2, Source::reference_manual, "LDREX, STREX"},
    {Cost::float_result_used_next, "float_result_used_next", 1, 1, Source::compiler, "a result of the FPU's arithmetic that the next instruction of the FPU uses, the addend of a multiply-accumulate excepted"},
    {Cost::float_multiply_accumulate, "float_multiply_accumulate", 3, 3, Source::compiler, "VMLA, VMLS, VFMA, VFMS and their negative forms"},
    {Cost::float_divide, "float_divide", 14, 14, Source::compiler, "VDIV, VSQRT; the core goes on until the next instruction of the FPU"},
    {Cost::float_transfer, "float_transfer", 2, 2, Source::compiler, "VLDR, VSTR of one word; VMOV of two registers"},
    {Cost::float_multiple_base, "float_multiple_base", 1, 1, Source::reference_manual, "VLDM, VSTM, VPUSH, VPOP, VLDR and VSTR of a double beside a cycle a word"},
    {Cost::exception_entry, "exception_entry", 12, 12, Source::reference_manual, "from the request to the first instruction of the handler"},
    {Cost::exception_return, "exception_return", 10, 12, Source::reference_manual, "from EXC_RETURN to the next instruction"},
    {Cost::exception_tail_chain, "exception_tail_chain", 6, 6, Source::reference_manual, "from handler to handler"},
    {Cost::lazy_stacking, "lazy_stacking", 18, 18, Source::reference_manual, "the first instruction of the FPU in a handler that interrupted users of the FPU"},
    {Cost::float_unstacking, "float_unstacking", 17, 17, Source::reference_manual, "return from such a handler"},
    {Cost::vector_from_flash, "vector_from_flash", 0, 1, Source::guess, "times the wait states: the vector's fetch when it outlasts the stacking"},
    {Cost::sram_refill, "sram_refill", 1, 1, Source::reference_manual, "a taken branch in SRAM, whose fetches cross the system bus through a register"},
    {Cost::prefetch_follows_hit, "prefetch_follows_hit", 0, 1, Source::guess, "1: a hit in the instruction cache starts a prefetch of the next line"},
    {Cost::prefetched_line_is_cached, "prefetched_line_is_cached", 1, 0, Source::guess, "1: a prefetched line that is used enters the instruction cache"},
    {Cost::miss_waits_for_prefetch, "miss_waits_for_prefetch", 1, 1, Source::guess, "1: a miss waits for the flash to finish a prefetch that nobody needs"},
    {Cost::ahb_read, "ahb_read", 1, 2, Source::guess, "a read of an AHB peripheral beyond a load from RAM"},
    {Cost::ahb_write, "ahb_write", 0, 1, Source::guess, "a write of an AHB peripheral beyond a store to RAM"},
    {Cost::apb_cross, "apb_cross", 1, 2, Source::guess, "crossing from AHB to APB, in cycles of HCLK"},
    {Cost::apb_peripheral_clocks, "apb_peripheral_clocks", 2, 2, Source::chip_manual, "an access on APB, in cycles of its own clock, up to one more to align with it"},
    {Cost::private_bus, "private_bus", 1, 2, Source::guess, "NVIC, SysTick, DWT and the system control block beyond an access to RAM"},
};
// clang-format on

static_assert(std::size(cost_table) == static_cast<std::size_t>(Cost::count_));
static_assert([] {
  for (std::size_t i = 0; i < std::size(cost_table); ++i)
    if (cost_table[i].cost != static_cast<Cost>(i) || cost_table[i].likely > cost_table[i].conservative) {
      // The cache is worth less, not more, when less enters it.
      if (cost_table[i].cost == static_cast<Cost>(i) && cost_table[i].cost == Cost::prefetched_line_is_cached) continue;
      return false;
    }
  return true;
}());

/// The figures of one pricing.
class Costs {
 public:
  constexpr explicit Costs(Pricing pricing) : pricing_(pricing) {}
  constexpr unsigned operator[](Cost cost) const {
    const auto& row = cost_table[static_cast<std::size_t>(cost)];
    return pricing_ == Pricing::likely ? row.likely : row.conservative;
  }
  constexpr Pricing pricing() const { return pricing_; }

 private:
  Pricing pricing_;
};

}  // namespace inkwell::virtual_board
