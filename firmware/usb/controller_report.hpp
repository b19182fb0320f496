// The pose as a multi-axis controller reports it: in the middle of its axes while nobody knows where the arm is.
#pragma once

#include <protocol/reports.hpp>

namespace inkwell::usb {

protocol::ControllerReport controller_report(const protocol::PoseReport& pose);

}  // namespace inkwell::usb
