// Detection of faulting accesses (ARMv7-M, A3.2.1, B3.1, B3.5). An access faults if its address is unmapped or
// misaligned, or if the memory protection unit refuses the access.
#include "boards/stm32f405/core/processor.hpp"

namespace inkwell::virtual_board {
namespace {

/// In the device and system regions, the default memory map forbids execution and requires aligned accesses.
bool is_of_devices(std::uint32_t address) {
  return (address >= 0x4000'0000 && address < 0x6000'0000) || address >= 0xA000'0000;
}

}  // namespace

// Unicorn's model of the MPU is not used, because this model cannot distinguish mapped and unmapped addresses. The
// engine caches the access rights of each page. In pages that contain an MPU region boundary, the engine checks each
// access.
std::optional<Outcome> Processor::refusal_of(std::uint32_t address, Access access, Role role) const {
  const bool fetch = access == Access::fetch;
  if (fetch && is_of_devices(address)) return Outcome::execute_never;
  const bool on_private_bus = address - private_bus_base < private_bus_bytes;
  if (on_private_bus) return role.privileged ? std::nullopt : std::optional(Outcome::data_fault);
  const auto& protection = machine_.memory_protection;
  if (protection.is_on(role.above_faults) &&
      !protection.allows(address, access == Access::store, fetch, role.privileged))
    return fetch ? Outcome::execute_never : Outcome::protected_data;
  const bool is_core_coupled = address - ccm_base < ccm_bytes;
  const bool is_system = address - system_base < system_bytes ||
                         (machine_.memory.at_zero() == MemoryAtZero::system && address < system_bytes);
  const bool answers = (fetch ? machine_.memory.at(address, 1) != nullptr && !is_core_coupled
                              : machine_.memory.at(address, 1) != nullptr || windows_.answer(address)) &&
                       (core_coupled_on_ || !is_core_coupled) && (access != Access::store || !is_system);
  if (answers) return {};
  return fetch ? Outcome::instruction_fault : Outcome::data_fault;
}

bool Processor::refuses(std::uint32_t address, unsigned bytes, Access access, Role role) {
  for (const std::uint32_t byte : {address, address + bytes - 1}) {
    refusal_ = refusal_of(byte, access, role);
    if (!refusal_) continue;
    fault_address_ = byte;
    if (!core_coupled_on_ && byte - ccm_base < ccm_bytes) machine_.violations.violate(Rule::ccm_clock_off);
    return true;
  }
  // An interrupt cannot abort a read that has started.
  if (access == Access::load && flash_is_busy_ && machine_.memory.is_in_flash(address)) flash_port_.hold_up();
  // The engine notices changes of translated code only at the address where the code runs.
  if (access == Access::store && plain_stores_.holds_code_at_other_address(address)) {
    forget_code_later(*machine_.memory.other_address(address), bytes);
    end_slice();
  }
  return false;
}

int Processor::rights_in_page(std::uint32_t page, std::uint32_t bytes, Role role) {
  const auto& protection = machine_.memory_protection;
  if (protection.is_on(role.above_faults) && protection.divides(page, bytes)) return -1;
  if (machine_.memory.at_zero() == MemoryAtZero::sram1 && plain_stores_.holds_code_at_other_address(page)) return -1;
  // After a negative result, the engine checks rights and alignment at each access.
  const bool is_memory = machine_.memory.at(page, 1) != nullptr;
  if (is_memory && is_device(page, role)) return -1;
  int rights = 0;
  // While the flash is busy, its pages have no read right. The first read of a busy flash therefore calls refuses(),
  // and refuses() makes the core wait.
  const bool waits = flash_is_busy_ && machine_.memory.is_in_flash(page);
  if (!waits && !refusal_of(page, Access::load, role)) rights |= may_read;
  if (!refusal_of(page, Access::store, role)) rights |= may_write;
  if (!refusal_of(page, Access::fetch, role)) rights |= may_execute;
  return rights;
}

// Returns true for Device and Strongly-ordered memory (ARMv7-M, A3.2.1 and A3.5).
bool Processor::is_device(std::uint32_t address, Role role) const {
  const auto& protection = machine_.memory_protection;
  const bool on_private_bus = address - private_bus_base < private_bus_bytes;
  if (protection.is_on(role.above_faults) && !on_private_bus)
    if (const auto device = protection.makes_device(address)) return *device;
  return is_of_devices(address);
}

bool Processor::runs_above_faults() const {
  if (!machine_.memory_protection.is_on(false)) return false;  // the result is not used while the MPU is off
  return current_exception_ == exception_nmi || current_exception_ == exception_hard_fault ||
         (read(UC_ARM_REG_FAULTMASK) & 1) != 0;
}

EngineCalls::Role Processor::role() const {
  constexpr std::uint32_t control_unprivileged = 1;
  return {current_exception_ != exception_none || (read(UC_ARM_REG_CONTROL) & control_unprivileged) == 0,
          runs_above_faults()};
}

void Processor::misaligned(std::uint32_t address) {
  refusal_ = Outcome::misaligned;
  fault_address_ = address;
}

bool Processor::must_be_aligned(std::uint16_t first, std::uint16_t second) const {
  if (translates_aligned_) return true;
  if ((first & 0xF000) == 0xC000) return true;  // 16-bit LDM, STM
  if ((first & 0xFE00) == 0xEC00) return true;  // VLDR, VSTR, VLDM, VSTM
  const bool table_branch = (first & 0xFFF0) == 0xE8D0 && (second & 0xFFE0) == 0xF000;
  return (first & 0xFE00) == 0xE800 && !table_branch;  // LDM, STM, LDRD, STRD, LDREX, STREX
}

void Processor::take_new_rights() {
  if (traps_misaligned_ != translates_aligned_) {
    translates_aligned_ = traps_misaligned_;
    forget_code(flash_base, flash_bytes);
    forget_code(sram_base, sram_bytes);
  }
  if (!std::exchange(rights_changed_, false)) return;
  forget_pages();
  write(UC_ARM_REG_APSR_NZCV, read(UC_ARM_REG_APSR_NZCV));  // makes the engine call runs_above_faults()
}

}  // namespace inkwell::virtual_board
