#include "firmware/application/parts.hpp"

#include <board/board.hpp>

#include "firmware/application/memory.hpp"

namespace inkwell::application {

using BlackBoxMemory = link::BlackBoxMemory<protocol::black_box_rows_before, protocol::black_box_rows_from_fault>;

extern link::ScopeFrames scope_frames;
extern link::ProgramRequests program_requests;
extern BlackBoxMemory black_box_memory;

/// Returns true if a current at this limit is measurable. The current loops overshoot the limit by at most 5 %, and
/// amplifier offsets add to the overshoot.
constexpr bool can_be_supervised(protocol::Parameter current_limit) {
  return info(current_limit).maximum * 1.05f + control::CurrentOffsets::plausible_A <
         board::facts.current_measurable_A();
}
static_assert(can_be_supervised(protocol::Parameter::current_limit_1_A) &&
                  can_be_supervised(protocol::Parameter::current_limit_2_A) &&
                  can_be_supervised(protocol::Parameter::current_limit_3_A),
              "a current at its limit would be taken for one that cannot be measured");
static_assert(board::current_ripple_A(arm_defaults::motor::inductance_H) <= board::current_ripple_maximum_A,
              "the arm's motors need more inductance, or the board a faster PWM");
static_assert(info(protocol::Parameter::voltage_limit_V).maximum == board::supply_maximum_V,
              "the largest voltage that may be asked for is the highest that the board's supply may have");
static_assert(board::servo_rate_Hz == protocol::servo_rate_Hz, "board and protocol count time in the same periods");

INKWELL_CORE_COUPLED Part<drivers::Bridges> bridges;
INKWELL_CORE_COUPLED Part<drivers::Encoders> encoders;
INKWELL_CORE_COUPLED Part<drivers::Switches> switches;
INKWELL_CORE_COUPLED control::Controller controller{
    {board::supply_minimum_V, board::supply_maximum_V, board::duty_limit, board::facts.current_measurable_A(),
     board::facts.bridge_dead_time_part()},
    first_period};
INKWELL_SRAM2 link::Link host_link{board::servo_cycles, program_requests, scope_frames, black_box_memory, first_period};

INKWELL_SRAM2 Part<drivers::AnalogInputs> analog_inputs;  // DMA cannot access the core-coupled memory
link::ScopeFrames scope_frames;
link::ProgramRequests program_requests;
INKWELL_KEPT_OVER_RESET BlackBoxMemory black_box_memory;

bool started_by_boot_loader;

Part<drivers::LogicSupply> logic_supply;
Part<drivers::StatusLed> status_led;
Part<drivers::Console> console;
Part<drivers::IndependentWatchdog> watchdog;
Part<drivers::Checksum> checksum;
Part<drivers::OtgFs> usb_port{INKWELL_FIRST_FRAME};
Part<drivers::ParameterFlash> parameter_flash;

link::Shared<std::uint32_t> completed_periods{first_period};
link::Shared<std::uint32_t> main_loop_periods{first_period};

}  // namespace inkwell::application
