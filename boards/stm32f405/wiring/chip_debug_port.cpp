#include "boards/stm32f405/wiring/chip_debug_port.hpp"

#include <algorithm>
#include <cstring>

#include "boards/stm32f405/core/processor.hpp"
#include "boards/stm32f405/core/system_control.hpp"
#include "boards/stm32f405/memory/bus.hpp"
#include "boards/stm32f405/wiring/execution.hpp"

namespace inkwell::virtual_board {
namespace {

/// Returns true for peripheral registers and core registers (RM0090, memory map).
bool are_registers(std::uint32_t address, std::size_t bytes) {
  struct Window {
    std::uint32_t base, bytes;
  };
  for (const auto& window :
       {Window{0x4000'0000, 0x8'0000}, {0x5000'0000, 0x6'1000}, {private_bus_base, private_bus_bytes}})
    if (address - window.base < window.bytes && bytes <= window.bytes - (address - window.base)) return true;
  return false;
}

/// Size of the widest aligned register access at `address`, at most `bytes` bytes.
unsigned access_size(std::uint32_t address, std::size_t bytes) {
  if (address % 4 == 0 && bytes >= 4) return 4;
  return address % 2 == 0 && bytes >= 2 ? 2 : 1;
}

}  // namespace

void ChipDebugPort::attach() { machine_.debugging.attached = true; }

void ChipDebugPort::detach() {
  while (!watch_points_.empty()) remove_watch_point(watch_points_.front().watch_point);
  machine_.debugging = {};
}

CoreRegisters ChipDebugPort::core_registers() const { return processor_.core_registers(); }

void ChipDebugPort::set_core_registers(const CoreRegisters& registers) {
  const CoreRegisters before = processor_.core_registers();
  processor_.set_core_registers(registers);
  const std::uint32_t pc = registers.general[CoreRegisters::pc];
  if (pc != before.general[CoreRegisters::pc]) execution_.jump(pc);
}

FloatRegisters ChipDebugPort::float_registers() const { return processor_.read_float_registers(); }
void ChipDebugPort::set_float_registers(const FloatRegisters& registers) {
  processor_.write_float_registers(registers);
}

bool ChipDebugPort::read(std::uint32_t address, std::span<std::uint8_t> bytes) {
  if (const auto* memory = machine_.memory.at(address, static_cast<std::uint32_t>(bytes.size()))) {
    std::memcpy(bytes.data(), memory, bytes.size());
    return true;
  }
  if (!are_registers(address, bytes.size())) return false;
  while (!bytes.empty()) {
    const unsigned size = access_size(address, bytes.size());
    const std::uint32_t value =
        address >= private_bus_base ? system_control_.read(address, size) : bus_.read_register(address, size);
    std::memcpy(bytes.data(), &value, size);
    bytes = bytes.subspan(size);
    address += size;
  }
  return true;
}

bool ChipDebugPort::write(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return true;  // gdb tests with an empty write whether binary writes are supported
  const auto size = static_cast<std::uint32_t>(bytes.size());
  if (auto* memory = machine_.memory.ram_at(address, size)) {
    std::memcpy(memory, bytes.data(), bytes.size());
    processor_.forget_code(address, size);
    return true;
  }
  if (!are_registers(address, bytes.size())) return false;
  while (!bytes.empty()) {
    const unsigned width = access_size(address, bytes.size());
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data(), width);
    if (address >= private_bus_base)
      system_control_.write(address, value, width);
    else
      bus_.write_register(address, value, width);
    bytes = bytes.subspan(width);
    address += width;
  }
  return true;
}

void ChipDebugPort::add_breakpoint(std::uint32_t address) { machine_.debugging.breakpoints.insert(address & ~1u); }
void ChipDebugPort::remove_breakpoint(std::uint32_t address) { machine_.debugging.breakpoints.erase(address & ~1u); }

void ChipDebugPort::add_watch_point(const WatchPoint& watch_point) {
  if (watch_point.bytes != 0) watch_points_.push_back({watch_point, processor_.watch(watch_point)});
}

void ChipDebugPort::remove_watch_point(const WatchPoint& watch_point) {
  const auto found = std::find_if(watch_points_.begin(), watch_points_.end(),
                                  [&](const Watched& watched) { return watched.watch_point == watch_point; });
  if (found == watch_points_.end()) return;
  processor_.unwatch(found->hook);
  watch_points_.erase(found);
}

void ChipDebugPort::resume() {
  auto& debugging = machine_.debugging;
  debugging.steps = false;
  debugging.touched.reset();
  debugging.resumed_at = processor_.program_counter() & ~1u;
}

void ChipDebugPort::step() {
  resume();
  machine_.debugging.steps = true;
}

DebugStop ChipDebugPort::last_stop() const { return machine_.debugging.last_stop; }

}  // namespace inkwell::virtual_board
