// Global objects of the firmware: drivers, controller, and shared data.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/control/controller.hpp"
#include "firmware/drivers/analog_inputs.hpp"
#include "firmware/drivers/bridges.hpp"
#include "firmware/drivers/checksum.hpp"
#include "firmware/drivers/claims.hpp"
#include "firmware/drivers/console.hpp"
#include "firmware/drivers/encoders.hpp"
#include "firmware/drivers/independent_watchdog.hpp"
#include "firmware/drivers/logic_supply.hpp"
#include "firmware/drivers/otg_fs/otg_fs.hpp"
#include "firmware/drivers/parameter_flash.hpp"
#include "firmware/drivers/status_led.hpp"
#include "firmware/drivers/switches.hpp"
#include "firmware/link/link.hpp"

namespace inkwell::application {

/// List of all drivers. The list does not compile if two drivers claim the same resource (claims.hpp).
using Parts = drivers::PartsList<drivers::Bridges, drivers::Encoders, drivers::AnalogInputs, drivers::Switches,
                                 drivers::StatusLed, drivers::Console, drivers::IndependentWatchdog,
                                 drivers::LogicSupply, drivers::Checksum, drivers::OtgFs, drivers::ParameterFlash>;

template <class Driver>
requires(Parts::has<Driver>) using Part = Driver;

/// The function main() sets up these drivers for the control interrupt.
extern Part<drivers::Bridges> bridges;
extern Part<drivers::Encoders> encoders;
extern Part<drivers::AnalogInputs> analog_inputs;
extern Part<drivers::Switches> switches;
extern Part<drivers::LogicSupply> logic_supply;
extern control::Controller controller;

/// The main loop owns these drivers.
extern Part<drivers::StatusLed> status_led;
extern Part<drivers::Console> console;
extern Part<drivers::IndependentWatchdog> watchdog;
extern Part<drivers::Checksum> checksum;
extern Part<drivers::OtgFs> usb_port;
extern Part<drivers::ParameterFlash> parameter_flash;

extern link::Link host_link;

/// True if the boot pins selected the boot loader of the chip, and the boot loader started the firmware. Start-up sets
/// this variable.
extern bool started_by_boot_loader;

/// Initial counts of control periods and bus frames. A test image starts just before the counters wrap
/// (tests/target/near_wrap).
#ifndef INKWELL_FIRST_PERIOD
#define INKWELL_FIRST_PERIOD 0
#define INKWELL_FIRST_FRAME 0
#endif
inline constexpr std::uint32_t first_period = INKWELL_FIRST_PERIOD;

/// Number of completed control periods. The main loop reads this counter.
extern link::Shared<std::uint32_t> completed_periods;
/// Value of `completed_periods` in the last round of the main loop. The control interrupt reads this value.
extern link::Shared<std::uint32_t> main_loop_periods;

}  // namespace inkwell::application
