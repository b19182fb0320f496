#pragma once

#include <vector>
#include "boards/stm32f405/core/debug_port.hpp"

#include "boards/stm32f405/core/machine.hpp"
#include "boards/stm32f405/core/processor.hpp"

namespace inkwell::virtual_board {

class Bus;
class Execution;
class SystemControl;

class ChipDebugPort final : public DebugPort {
 public:
  ChipDebugPort(Machine& machine, Processor& processor, Execution& execution, Bus& bus, SystemControl& system_control)
      : machine_(machine), processor_(processor), execution_(execution), bus_(bus), system_control_(system_control) {}
  void attach() override;
  void detach() override;
  CoreRegisters core_registers() const override;
  void set_core_registers(const CoreRegisters& registers) override;
  FloatRegisters float_registers() const override;
  void set_float_registers(const FloatRegisters& registers) override;
  bool read(std::uint32_t address, std::span<std::uint8_t> bytes) override;
  bool write(std::uint32_t address, std::span<const std::uint8_t> bytes) override;
  void add_breakpoint(std::uint32_t address) override;
  void remove_breakpoint(std::uint32_t address) override;
  void add_watch_point(const WatchPoint& watch_point) override;
  void remove_watch_point(const WatchPoint& watch_point) override;
  void resume() override;
  void step() override;
  DebugStop last_stop() const override;

 private:
  struct Watched {
    WatchPoint watch_point;
    uc_hook hook;
  };
  Machine& machine_;
  Processor& processor_;
  Execution& execution_;
  Bus& bus_;
  SystemControl& system_control_;
  std::vector<Watched> watch_points_;
};

}  // namespace inkwell::virtual_board
