// Converts a pose to a multi-axis controller report. The axes are centered while the position of the arm is unknown.
#pragma once

#include "protocol/reports.hpp"

namespace inkwell::usb {

protocol::ControllerReport controller_report(const protocol::PoseReport& pose);

}  // namespace inkwell::usb
