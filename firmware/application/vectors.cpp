#include "firmware/application/vectors.hpp"

#include "firmware/drivers/claims.hpp"
#include "protocol/black_box.hpp"

#include "firmware/application/handlers.hpp"
#include "firmware/application/memory.hpp"

namespace inkwell::application {
namespace {

constexpr VectorTable make_vectors() {
  VectorTable table{};
  table.initial_stack = stack_top;
  table.exceptions.fill(cpu_fault_handler);
  table.exceptions[0] = reset_handler;
  table.exceptions[protocol::hang_exception - 1] = hang_handler;
  table.interrupts.fill(cpu_fault_handler);
  table.interrupts[static_cast<std::size_t>(drivers::Interrupt::analog_converters)] = control_interrupt;
  table.interrupts[static_cast<std::size_t>(drivers::Interrupt::voltage_detector)] = logic_supply_interrupt;
  return table;
}

}  // namespace

[[gnu::section(".vectors"), gnu::used]] alignas(512) constinit const VectorTable vectors = make_vectors();

}  // namespace inkwell::application
