#include "boards/stm32f405/memory/bus.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "boards/stm32f405/core/chip_error.hpp"
#include "boards/stm32f405/core/processor.hpp"
#include "boards/stm32f405/core/system_control.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t apb_base = 0x4000'0000, apb_bytes = 0x8'0000;
constexpr std::uint32_t apb_end = 0x4002'0000;  ///< start of AHB1
constexpr std::uint32_t ahb2_base = 0x5000'0000, ahb2_bytes = 0x6'1000;
constexpr std::uint32_t private_base = 0xE000'0000, private_bytes = 0x10'0000;
constexpr std::uint32_t external_base = 0xA000'0000, external_bytes = 0x1000;
constexpr std::uint32_t peripheral_alias_base = 0x4200'0000, peripheral_alias_bytes = 0x0200'0000;
constexpr std::uint32_t sram_alias_base = 0x2200'0000, sram_alias_bytes = 32 * sram_bytes;

template <std::uint32_t base>
std::uint64_t read_window(uc_engine*, std::uint64_t offset, unsigned size, void* bus) {
  return static_cast<Bus*>(bus)->read(base + static_cast<std::uint32_t>(offset), size);
}

template <std::uint32_t base>
void write_window(uc_engine*, std::uint64_t offset, unsigned size, std::uint64_t value, void* bus) {
  static_cast<Bus*>(bus)->write(base + static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(value), size);
}

template <std::uint32_t base, std::uint32_t bytes>
constexpr BusWindow window() {
  return {base, bytes, read_window<base>, write_window<base>};
}

/// Returns the width of the narrowest allowed write, in bytes (RM0090). Each row applies to all peripherals whose name
/// starts with `begin`. Peripherals that accept byte writes, such as serial ports, have no row.
unsigned narrowest_write(std::string_view name) {
  struct Row {
    std::string_view begin;
    unsigned bytes;
  };
  constexpr Row rows[] = {{"TIM", 2}, {"IWDG", 2}, {"WWDG", 2}, {"PWR", 2}, {"I2C", 2}, {"ADC", 4},
                          {"DAC", 4}, {"CAN", 4},  {"EXTI", 4}, {"RTC", 4}, {"DMA", 4}, {"RNG", 4}};
  for (const Row& row : rows)
    if (name.substr(0, row.begin.size()) == row.begin) return row.bytes;
  return 1;
}

}  // namespace

const BusWindow Bus::all_windows[6] = {
    window<apb_base, apb_bytes>(),
    window<private_base, private_bytes>(),
    window<ahb2_base, ahb2_bytes>(),
    window<peripheral_alias_base, peripheral_alias_bytes>(),
    window<sram_alias_base, sram_alias_bytes>(),
    window<external_base, external_bytes>(),
};

Bus::Bus(Machine& machine, Processor& processor, SystemControl& system_control, const StartingClock& starting_clock)
    : machine_(machine),
      processor_(processor),
      system_control_(system_control),
      starting_clock_(starting_clock),
      apb_and_ahb1_(apb_bytes / 1024),
      ahb2_(ahb2_bytes / 1024) {}

void Bus::add(std::uint32_t base, std::uint32_t bytes, const std::string& name, Peripheral& peripheral,
              const std::uint32_t* enable_register, std::uint32_t enable_mask) {
  for (std::uint32_t address = base; address < base + bytes; address += 1024) {
    Slot* slot = slot_at(address);
    if (slot == nullptr || base % 1024 != 0)
      throw ChipError("The peripheral " + name +
                      " is not on the bus: its base must be a multiple of 1024 in the "
                      "regions 0x40000000 or 0x50000000.");
    *slot = {&peripheral, base, enable_register, enable_mask, name, narrowest_write(name)};
  }
  if (std::find(peripherals_.begin(), peripherals_.end(), &peripheral) == peripherals_.end())
    peripherals_.push_back(&peripheral);
}

void Bus::reset_peripherals() {
  for (auto* peripheral : peripherals_) peripheral->reset();
}

std::vector<RegisterMap> Bus::register_maps() const {
  std::vector<RegisterMap> maps;
  for (const auto* slots : {&apb_and_ahb1_, &ahb2_})
    for (std::size_t i = 0; i < slots->size(); ++i) {
      const Slot& slot = (*slots)[i];
      const bool first = i == 0 || (*slots)[i - 1].peripheral != slot.peripheral;
      if (slot.peripheral == nullptr || !first) continue;
      for (auto& map : slot.peripheral->register_maps(slot.name, slot.base)) maps.push_back(std::move(map));
    }
  for (auto& map : SystemControl::register_maps()) maps.push_back(std::move(map));
  return maps;
}

Bus::Slot* Bus::slot_at(std::uint32_t address) {
  if (address - apb_base < apb_bytes) return &apb_and_ahb1_[(address - apb_base) / 1024];
  if (address - ahb2_base < ahb2_bytes) return &ahb2_[(address - ahb2_base) / 1024];
  return nullptr;
}

bool Bus::is_clocked(const Slot& slot, std::uint32_t) {
  if (slot.enable_register == nullptr) return true;
  if ((*slot.enable_register & slot.enable_mask) != 0) {
    if (!starting_clock_.includes(slot.enable_register, slot.enable_mask, access_began_)) return true;
    machine_.violations.violate(Rule::clock_fresh, slot.name);
    return false;
  }
  machine_.violations.violate(Rule::clock_off, slot.name);
  return false;
}

std::uint32_t Bus::read_register(std::uint32_t address, unsigned size) {
  Slot* slot = slot_at(address);
  if (slot == nullptr || slot->peripheral == nullptr) {
    char name[24];
    std::snprintf(name, sizeof name, "0x%08X", static_cast<unsigned>(address & ~0x3FFu));
    machine_.log.note(name, address & 0x3FF, false, 0);
    return 0;
  }
  return is_clocked(*slot, address) ? slot->peripheral->read(address - slot->base, size) : 0;
}

void Bus::check_width(std::uint32_t address, unsigned size) {
  const Slot* slot = slot_at(address);
  if (slot != nullptr && size < slot->narrowest_write)
    machine_.violations.violate(Rule::narrow_register_write, slot->name);
}

void Bus::write_register(std::uint32_t address, std::uint32_t value, unsigned size) {
  Slot* slot = slot_at(address);
  if (slot == nullptr || slot->peripheral == nullptr) {
    char name[24];
    std::snprintf(name, sizeof name, "0x%08X", static_cast<unsigned>(address & ~0x3FFu));
    machine_.log.note(name, address & 0x3FF, true, value);
    return;
  }
  if (!is_clocked(*slot, address)) return;
  // An APB bridge converts every narrow write to a word with repeated bytes (RM0090, "AHB/APB bridges").
  if (size < slot->narrowest_write && address < apb_end) {
    const std::uint32_t repeated = size == 1 ? 0x0101'0101u * (value & 0xFF) : 0x0001'0001u * (value & 0xFFFF);
    slot->peripheral->write((address & ~3u) - slot->base, repeated, 4);
    return;
  }
  slot->peripheral->write(address - slot->base, value, size);
}

void Bus::synchronise() { machine_.timeline.catch_up(processor_.now()); }

void Bus::settle_processor() {
  if (machine_.nvic.changed() || machine_.timeline.wake_moved_forward() || machine_.reset_requested)
    processor_.end_slice();
}

std::uint32_t Bus::read(std::uint32_t address, unsigned size) {
  access_began_ = processor_.cycles();
  processor_.wait_for_register(address, false);
  synchronise();
  const Log::Access access(machine_.log);
  std::uint32_t value = 0;
  if (address >= private_base) {
    value = system_control_.read(address, size);
  } else if (address - sram_alias_base < sram_alias_bytes) {
    const std::uint32_t bit = (address - sram_alias_base) / 4;
    value = machine_.memory.sram()[bit / 8] >> (bit % 8) & 1;
  } else if (address - peripheral_alias_base < peripheral_alias_bytes) {
    const std::uint32_t bit = (address - peripheral_alias_base) / 4;
    value = read_register(apb_base + bit / 32 * 4, 4) >> (bit % 32) & 1;
  } else {
    value = read_register(address, size);
  }
  settle_processor();
  return value;
}

void Bus::write(std::uint32_t address, std::uint32_t value, unsigned size) {
  access_began_ = processor_.cycles();
  processor_.wait_for_register(address, true);
  synchronise();
  const Log::Access access(machine_.log);
  if (address >= private_base) {
    system_control_.write(address, value, size);
  } else if (address - sram_alias_base < sram_alias_bytes) {
    const std::uint32_t bit = (address - sram_alias_base) / 4;
    std::uint8_t& byte = machine_.memory.sram()[bit / 8];
    const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
    byte = static_cast<std::uint8_t>((value & 1) != 0 ? byte | mask : byte & ~mask);
    machine_.on_ram_write(sram_base + bit / 8, 1);
  } else if (address - peripheral_alias_base < peripheral_alias_bytes) {
    const std::uint32_t bit = (address - peripheral_alias_base) / 4;
    const std::uint32_t target = apb_base + bit / 32 * 4, mask = 1u << (bit % 32);
    const std::uint32_t old = read_register(target, 4);
    write_register(target, (value & 1) != 0 ? old | mask : old & ~mask, 4);
  } else {
    check_width(address, size);
    write_register(address, value, size);
  }
  settle_processor();
}

}  // namespace inkwell::virtual_board
