// Clears a fault and checks that the fault does not return.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "host/client/device/device.hpp"
#include "host/client/device/error.hpp"
#include "protocol/reports.hpp"

namespace inkwell::device {

/// The fault was cleared and has returned, because its cause remains. `what()` contains the fault and its remedy.
class FaultStays : public Error {
 public:
  using Error::Error;
};

/// The fault information of a pose.
struct ShownFault {
  std::int64_t time_periods;
  protocol::State state;
  protocol::Fault fault;
};

/// Returns one line with the name, cause and remedy of the fault. For a failed self-test, the line lists the failed
/// items.
std::string fault_line(protocol::Fault fault, Device& device);

/// Returns true if the board raises this fault when its host disconnects or sends nothing. A program that starts can
/// clear such a fault, because the previous program caused it.
bool is_left_by_a_host(protocol::Fault fault);

/// Clears the fault and checks for 0.2 s of board time that it does not return. If the board runs a self-test, the
/// check lasts until the self-test finishes. Returns immediately if `now` shows no fault. Calls `next` to wait for the
/// next pose. Throws FaultStays.
void clear_fault(Device& device, const ShownFault& now, const std::function<ShownFault()>& next);

}  // namespace inkwell::device
