// Which accesses fault, and how: where nothing answers, where the memory protection unit says no, where an address is
// not aligned (ARMv7-M, A3.2.1, B3.1, B3.5).
#include "bus.hpp"
#include "processor.hpp"

namespace inkwell::virtual_board {
namespace {

/// Devices and the system's own region: the default memory map executes nothing there, and wants every access aligned.
bool is_of_devices(std::uint32_t address) {
  return (address >= 0x4000'0000 && address < 0x6000'0000) || address >= 0xA000'0000;
}

}  // namespace

std::optional<Outcome> Processor::refusal_of(std::uint32_t address, Access access, bool privileged) const {
  const bool fetch = access == Access::fetch;
  if (fetch && is_of_devices(address)) return Outcome::execute_never;
  const bool on_private_bus = address - private_bus_base < private_bus_bytes;
  if (on_private_bus) return privileged ? std::nullopt : std::optional(Outcome::data_fault);
  if (protects_ && !machine_.memory_protection.allows(address, access == Access::store, fetch, privileged))
    return fetch ? Outcome::execute_never : Outcome::protected_data;
  const bool is_core_coupled = address - ccm_base < ccm_bytes;
  const bool answers = (fetch ? machine_.memory.at(address, 1) != nullptr && !is_core_coupled
                              : machine_.memory.at(address, 1) != nullptr || Bus::answers(address)) &&
                       (core_coupled_on_ || !is_core_coupled) &&
                       (access != Access::store || address - system_base >= system_bytes);
  if (answers) return {};
  return fetch ? Outcome::instruction_fault : Outcome::data_fault;
}

bool Processor::refuses(std::uint32_t address, unsigned bytes, Access access, bool privileged) {
  for (const std::uint32_t byte : {address, address + bytes - 1}) {
    refusal_ = refusal_of(byte, access, privileged);
    if (!refusal_) continue;
    fault_address_ = byte;
    if (!core_coupled_on_ && byte - ccm_base < ccm_bytes) machine_.violations.violate(Rule::ccm_clock_off);
    return true;
  }
  return false;
}

int Processor::rights_in_page(std::uint32_t page, std::uint32_t bytes, bool privileged) {
  if (protects_ && machine_.memory_protection.divides(page, bytes)) return -1;
  int rights = 0;
  if (!refusal_of(page, Access::load, privileged)) rights |= may_read;
  if (!refusal_of(page, Access::store, privileged)) rights |= may_write;
  if (!refusal_of(page, Access::fetch, privileged)) rights |= may_execute;
  return rights;
}

// ARMv7-M, A3.2.1 and A3.5: of Device and Strongly-ordered memory. What the memory protection unit could make of these
// regions is left out.
bool Processor::is_device(std::uint32_t address) const { return is_of_devices(address); }

void Processor::misaligned(std::uint32_t address) {
  refusal_ = Outcome::misaligned;
  fault_address_ = address;
}

bool Processor::must_be_aligned(std::uint16_t first, std::uint16_t second) const {
  if (translates_aligned_) return true;
  if ((first & 0xF000) == 0xC000) return true;  // LDM, STM of 16 bits
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
  const bool at_fault = current_exception_ == exception_nmi || current_exception_ == exception_hard_fault;
  const bool protects = machine_.memory_protection.is_on(at_fault);
  if (!rights_changed_ && protects == protects_) return;
  rights_changed_ = false;
  protects_ = protects;
  forget_pages();
}

}  // namespace inkwell::virtual_board
