#include "boards/stm32f405/core/engine_calls.hpp"

#include <dlfcn.h>

#include "boards/stm32f405/timing/instruction.hpp"

// Declarations of engine functions, with simplified parameter types.
extern "C" {
void tlb_set_page_with_attrs_arm(void* processor, std::uint32_t address, std::uint64_t physical,
                                 std::uint64_t attributes, int rights, int index, std::uint32_t bytes);
bool arm_cpu_tlb_fill_arm(void* processor, std::uint64_t address, int bytes, int access, int index, bool probe,
                          std::uintptr_t return_address);
void arm_cpu_do_unaligned_access_arm(void* processor, std::uint64_t address, int access, int index,
                                     std::uintptr_t return_address);
std::uint32_t cpu_lduw_code_arm(void* state, std::uint32_t address);
std::uint64_t helper_le_lduw_mmu_arm(void* state, std::uint32_t address, std::uint32_t operation,
                                     std::uintptr_t return_address);
std::uint64_t helper_le_ldul_mmu_arm(void* state, std::uint32_t address, std::uint32_t operation,
                                     std::uintptr_t return_address);
void helper_le_stw_mmu_arm(void* state, std::uint32_t address, std::uint32_t value, std::uint32_t operation,
                           std::uintptr_t return_address);
void helper_le_stl_mmu_arm(void* state, std::uint32_t address, std::uint32_t value, std::uint32_t operation,
                           std::uintptr_t return_address);
bool armv7m_nvic_neg_prio_requested_arm(void* controller, bool secure);
void* tb_gen_code_arm(void* processor, std::uint32_t address, std::uint32_t segment, std::uint32_t flags,
                      int block_flags);
void tcg_gen_qemu_ld_i32_arm(void* context, void* value, void* address, std::uintptr_t index, int operation);
void tcg_gen_qemu_st_i32_arm(void* context, void* value, void* address, std::uintptr_t index, int operation);
}

namespace inkwell::virtual_board {
namespace {

thread_local EngineCalls* in_use = nullptr;

/// Functions of the engine. A pointer is null if the installed Unicorn version lacks the function.
struct Engine {
  using PageFunction = void(void* processor, std::uint32_t address);
  using Function = void(void* processor);
  template <class Type>
  static Type* find(const char* name) {
    return reinterpret_cast<Type*>(dlsym(RTLD_NEXT, name));
  }
  decltype(&tlb_set_page_with_attrs_arm) set_page =
      find<decltype(tlb_set_page_with_attrs_arm)>("tlb_set_page_with_attrs_arm");
  decltype(&arm_cpu_tlb_fill_arm) fill = find<decltype(arm_cpu_tlb_fill_arm)>("arm_cpu_tlb_fill_arm");
  decltype(&arm_cpu_do_unaligned_access_arm) fault =
      find<decltype(arm_cpu_do_unaligned_access_arm)>("arm_cpu_do_unaligned_access_arm");
  decltype(&tb_gen_code_arm) translate = find<decltype(tb_gen_code_arm)>("tb_gen_code_arm");
  decltype(&cpu_lduw_code_arm) fetch = find<decltype(cpu_lduw_code_arm)>("cpu_lduw_code_arm");
  decltype(&tcg_gen_qemu_ld_i32_arm) load = find<decltype(tcg_gen_qemu_ld_i32_arm)>("tcg_gen_qemu_ld_i32_arm");
  decltype(&tcg_gen_qemu_st_i32_arm) store = find<decltype(tcg_gen_qemu_st_i32_arm)>("tcg_gen_qemu_st_i32_arm");
  decltype(&helper_le_lduw_mmu_arm) load_half = find<decltype(helper_le_lduw_mmu_arm)>("helper_le_lduw_mmu_arm");
  decltype(&helper_le_ldul_mmu_arm) load_word = find<decltype(helper_le_ldul_mmu_arm)>("helper_le_ldul_mmu_arm");
  decltype(&helper_le_stw_mmu_arm) store_half = find<decltype(helper_le_stw_mmu_arm)>("helper_le_stw_mmu_arm");
  decltype(&helper_le_stl_mmu_arm) store_word = find<decltype(helper_le_stl_mmu_arm)>("helper_le_stl_mmu_arm");
  PageFunction* mark_plain = find<PageFunction>("tlb_set_dirty_arm");
  PageFunction* forget_page = find<PageFunction>("tlb_flush_page_arm");
  Function* forget_pages = find<Function>("tlb_flush_arm");
};

const Engine& engine() {
  static const Engine functions;
  return functions;
}

/// The engine is translating this instruction.
struct Translated {
  std::uint32_t block = 0, address = 0;
  std::uint16_t first = 0, second = 0;
  bool whole = true;
  void fetched(std::uint32_t at, std::uint16_t half_word) {
    if (!whole && at == address + 2) {
      second = half_word;
      whole = true;
    } else {
      *this = {block, at, half_word, 0, !is_wide(half_word)};
    }
  }
  bool begins_at(std::uint32_t at) const { return whole || at != address + 2; }
};
thread_local Translated translated;

/// Converts an MMU index of the engine to a role.
EngineCalls::Role role_of(unsigned index) {
  constexpr unsigned privileged = 1, negative_priority = 2;
  return {(index & privileged) != 0, (index & negative_priority) != 0};
}
EngineCalls::Role role_of(int index) { return role_of(static_cast<unsigned>(index)); }

int aligned_if_needed(int operation) {
  constexpr int aligned = 0x70;  // MO_ALIGN
  return in_use != nullptr && in_use->must_be_aligned(translated.first, translated.second) ? operation | aligned
                                                                                           : operation;
}

/// Without this check the engine would silently split a misaligned device access into two accesses.
void check_alignment(std::uint32_t address, unsigned bytes, EngineCalls::Access access, std::uint32_t operation,
                     std::uintptr_t return_address) {
  constexpr std::uint32_t index_mask = 0xF;
  if (address % bytes == 0 || in_use == nullptr || !in_use->is_device(address, role_of(operation & index_mask))) return;
  arm_cpu_do_unaligned_access_arm(in_use->remembered_processor(), address, static_cast<int>(access),
                                  static_cast<int>(operation & index_mask), return_address);  // does not return
}

}  // namespace

EngineCalls::Use::Use(EngineCalls& calls) : before_(in_use) { in_use = &calls; }
EngineCalls::Use::~Use() { in_use = before_; }

void EngineCalls::forget_page(std::uint32_t address) {
  if (processor_ != nullptr && engine().forget_page != nullptr) engine().forget_page(processor_, address);
}

void EngineCalls::forget_pages() {
  if (processor_ != nullptr && engine().forget_pages != nullptr) engine().forget_pages(processor_);
}

}  // namespace inkwell::virtual_board

using inkwell::virtual_board::EngineCalls;

// `attributes` is an engine structure with the size of one register.
void tlb_set_page_with_attrs_arm(void* processor, std::uint32_t address, std::uint64_t physical,
                                 std::uint64_t attributes, int rights, int index, std::uint32_t bytes) {
  using namespace inkwell::virtual_board;
  constexpr std::uint32_t page_bytes = 4096, not_the_whole_page = 32;
  if (in_use == nullptr) return engine().set_page(processor, address, physical, attributes, rights, index, bytes);
  in_use->remember_processor(processor);
  const std::uint32_t page = address & ~(page_bytes - 1);
  const int allowed = in_use->rights_in_page(page, page_bytes, role_of(index));
  // The engine does not cache entries smaller than a page, so it checks each access to this page.
  if (allowed < 0)
    return engine().set_page(processor, address, physical, attributes, rights, index, not_the_whole_page);
  engine().set_page(processor, address, physical, attributes, rights & allowed, index, bytes);
  if (engine().mark_plain != nullptr && in_use->takes_plain_stores(page)) engine().mark_plain(processor, address);
}

bool arm_cpu_tlb_fill_arm(void* processor, std::uint64_t address, int bytes, int access, int index, bool probe,
                          std::uintptr_t return_address) {
  using namespace inkwell::virtual_board;
  if (in_use != nullptr) {
    in_use->remember_processor(processor);
    if (in_use->refuses(static_cast<std::uint32_t>(address), static_cast<unsigned>(bytes > 0 ? bytes : 1),
                        static_cast<EngineCalls::Access>(access), role_of(index))) {
      if (probe) return false;
      engine().fault(processor, address, access, index, return_address);  // does not return
    }
  }
  return engine().fill(processor, address, bytes, access, index, probe, return_address);
}

void arm_cpu_do_unaligned_access_arm(void* processor, std::uint64_t address, int access, int index,
                                     std::uintptr_t return_address) {
  using namespace inkwell::virtual_board;
  if (in_use != nullptr) in_use->misaligned(static_cast<std::uint32_t>(address));
  engine().fault(processor, address, access, index, return_address);
}

std::uint32_t cpu_lduw_code_arm(void* state, std::uint32_t address) {
  using namespace inkwell::virtual_board;
  // For a fetch fault inside a block, the engine reports the address of the first instruction of the block. For an
  // instruction that would fault inside a block, this function returns the code of `b .`. This branch ends the block.
  // The next block then starts with the faulting instruction.
  constexpr std::uint32_t branch_to_itself = 0xE7FE;
  const bool may_end = in_use != nullptr && address != translated.block && translated.begins_at(address);
  if (may_end && !in_use->may_fetch(address)) return branch_to_itself;
  const std::uint32_t half_word = engine().fetch(state, address);
  if (may_end && is_wide(static_cast<std::uint16_t>(half_word)) && !in_use->may_fetch(address + 2))
    return branch_to_itself;
  translated.fetched(address, static_cast<std::uint16_t>(half_word));
  if (in_use != nullptr) in_use->translates(address);
  return half_word;
}

void* tb_gen_code_arm(void* processor, std::uint32_t address, std::uint32_t segment, std::uint32_t flags,
                      int block_flags) {
  using namespace inkwell::virtual_board;
  translated = {};
  translated.block = address;
  return engine().translate(processor, address, segment, flags, block_flags);
}

// The engine has no interrupt controller, so its original function always returns false.
bool armv7m_nvic_neg_prio_requested_arm(void*, bool) {
  using namespace inkwell::virtual_board;
  return in_use != nullptr && in_use->runs_above_faults();
}

void tcg_gen_qemu_ld_i32_arm(void* context, void* value, void* address, std::uintptr_t index, int operation) {
  using namespace inkwell::virtual_board;
  engine().load(context, value, address, index, aligned_if_needed(operation));
}

void tcg_gen_qemu_st_i32_arm(void* context, void* value, void* address, std::uintptr_t index, int operation) {
  using namespace inkwell::virtual_board;
  engine().store(context, value, address, index, aligned_if_needed(operation));
}

std::uint64_t helper_le_lduw_mmu_arm(void* state, std::uint32_t address, std::uint32_t operation,
                                     std::uintptr_t return_address) {
  using namespace inkwell::virtual_board;
  check_alignment(address, 2, EngineCalls::Access::load, operation, return_address);
  return engine().load_half(state, address, operation, return_address);
}

std::uint64_t helper_le_ldul_mmu_arm(void* state, std::uint32_t address, std::uint32_t operation,
                                     std::uintptr_t return_address) {
  using namespace inkwell::virtual_board;
  check_alignment(address, 4, EngineCalls::Access::load, operation, return_address);
  return engine().load_word(state, address, operation, return_address);
}

void helper_le_stw_mmu_arm(void* state, std::uint32_t address, std::uint32_t value, std::uint32_t operation,
                           std::uintptr_t return_address) {
  using namespace inkwell::virtual_board;
  check_alignment(address, 2, EngineCalls::Access::store, operation, return_address);
  engine().store_half(state, address, value, operation, return_address);
}

void helper_le_stl_mmu_arm(void* state, std::uint32_t address, std::uint32_t value, std::uint32_t operation,
                           std::uintptr_t return_address) {
  using namespace inkwell::virtual_board;
  check_alignment(address, 4, EngineCalls::Access::store, operation, return_address);
  engine().store_word(state, address, value, operation, return_address);
}
