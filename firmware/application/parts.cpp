#include "parts.hpp"

#include <board/omni_driver.hpp>

#include "memory.hpp"

namespace inkwell::application {

static_assert(board::servo_rate_Hz == protocol::servo_rate_Hz, "board and protocol count time in the same periods");

INKWELL_CORE_COUPLED drivers::Bridges bridges;
INKWELL_CORE_COUPLED drivers::Encoders encoders;
INKWELL_CORE_COUPLED drivers::Switches switches;
INKWELL_CORE_COUPLED control::Controller controller{
    {board::supply_minimum_V, board::supply_maximum_V, board::duty_limit}};

// In main memory: one is written by the DMA controller, the other is large.
drivers::AnalogInputs analog_inputs;
link::Link host_link{board::servo_cycles};

link::Shared<std::uint32_t> completed_periods{0};

}  // namespace inkwell::application
