// The parts that the main loop and the control interrupt share. What they hand to each other is in
// `host_link`.
#pragma once

#include <array>
#include <cstdint>

#include <control/controller.hpp>
#include <drivers/analog_inputs.hpp>
#include <drivers/bridges.hpp>
#include <drivers/encoders.hpp>
#include <drivers/switches.hpp>
#include <link/link.hpp>

namespace inkwell::application {

/// Set up by main(), then the control interrupt's own.
extern drivers::Bridges bridges;
extern drivers::Encoders encoders;
extern drivers::AnalogInputs analog_inputs;
extern drivers::Switches switches;
extern control::Controller controller;

extern link::Link host_link;

/// Control periods completed, for the main loop.
extern link::Shared<std::uint32_t> completed_periods;

}  // namespace inkwell::application
