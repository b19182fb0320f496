// Names that the tests of the controller share.
#pragma once

#include "firmware/control/controller.hpp"
#include "tests/firmware/control/near_wall.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace inkwell::tests::controller_names {

using control::Controller;
using control::Drive;
using control::Samples;
using control::Settings;
using protocol::Command;
using protocol::Fault;
using protocol::Signal;
using protocol::State;
using tests::run_with_host;
using tests::settings_near_wall;

}  // namespace inkwell::tests::controller_names
