#include "parts.hpp"

#include <board/omni_driver.hpp>

#include "memory.hpp"

namespace inkwell::application {

static_assert(board::servo_rate_Hz == protocol::servo_rate_Hz, "board and protocol count time in the same periods");

INKWELL_CORE_COUPLED Part<drivers::Bridges> bridges;
INKWELL_CORE_COUPLED Part<drivers::Encoders> encoders;
INKWELL_CORE_COUPLED Part<drivers::Switches> switches;
INKWELL_CORE_COUPLED control::Controller controller{
    {board::supply_minimum_V, board::supply_maximum_V, board::duty_limit}};

// In main memory: one is written by the DMA controller, the other is large.
Part<drivers::AnalogInputs> analog_inputs;
link::Link host_link{board::servo_cycles};

Part<drivers::StatusLed> status_led;
Part<drivers::Console> console;
Part<drivers::IndependentWatchdog> watchdog;
Part<drivers::OtgFs> usb_port;

link::Shared<std::uint32_t> completed_periods{0};

}  // namespace inkwell::application
