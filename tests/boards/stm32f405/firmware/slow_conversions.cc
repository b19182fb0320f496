// Runs the firmware's drivers of bridges and converters, and disturbs slow conversions in selected periods. One fault
// stops the stream during a sequence; the other sets a destination that the DMA controller cannot write.
#include "firmware/drivers/analog_inputs.cpp"
#include "firmware/drivers/bridges.cpp"

#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

using namespace inkwell::drivers;

AnalogInputs analog_inputs;
Bridges bridges;

void period() {
  static_cast<void>(bridges.begin_period());
  static_cast<void>(analog_inputs.take_currents());
  const std::uint32_t age = analog_inputs.slow_age_periods();
  if (age > results[2]) results[2] = age;
  results[3] = age;
  results[4] = static_cast<std::uint32_t>(analog_inputs.supply_V() * 1000.0f);
  results[5] = static_cast<std::uint32_t>(analog_inputs.gimbal_ratio()[0] * 1000.0f);
  results[6] = analog_inputs.reference_counts();
  results[7] = AnalogInputs::calibrated_reference_counts();
  results[8] = analog_inputs.supply_counts();
  analog_inputs.start_slow_conversions();
  results[1] = results[1] + 1;
}

void stop_stream_in_the_middle() {
  while (DMA2::S0NDTR::read() == slow_channels) {
  }
  DMA2::S0CR::write(0);
}

void move_destination_out_of_reach() {
  constexpr std::uint32_t core_coupled_memory = 0x1000'0000;
  const std::uint32_t control = DMA2::S0CR::read();
  DMA2::S0CR::write(control & ~DMA2::S0CR::EN::mask);
  DMA2::S0M0AR::write(core_coupled_memory);
  DMA2::LIFCR::write(flags_of_stream);
  DMA2::S0CR::write(control | DMA2::S0CR::EN::mask);
}

}  // namespace

void run() {
  run_at_168_MHz();
  word(rcc::ahb1enr) |= 7;
  CycleCounter::start();
  analog_inputs.start_clocks();
  bridges.start();
  analog_inputs.start();
  set_handler(interrupt(18), period);
  if (!bridges.wait_for_update()) return;
  analog_inputs.arm();
  results[0] = finished;
  while (results[1] < 100) wait_for_interrupt();
  stop_stream_in_the_middle();
  while (results[1] < 200) wait_for_interrupt();
  move_destination_out_of_reach();
  for (;;) wait_for_interrupt();
}
