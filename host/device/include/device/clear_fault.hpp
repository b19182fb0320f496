// Clearing a fault, and whether it is there again because its cause stays.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <device/device.hpp>
#include <device/error.hpp>
#include <protocol/reports.hpp>

namespace inkwell::device {

/// The fault was cleared, and its cause has put it there again. `what()` names it with its remedy.
class FaultStays : public Error {
 public:
  using Error::Error;
};

/// What a pose tells of faults.
struct ShownFault {
  std::int64_t time_periods;
  protocol::State state;
  protocol::Fault fault;
};

/// One line with the fault's name, its cause and its remedy; of a self-test that failed with its items, for which the
/// device is asked.
std::string fault_line(protocol::Fault fault, Device& device);

/// Whether the board raises this fault when its host disconnects or falls silent with the force on. A program that
/// finds this fault when it starts can clear it: the previous program caused it, and the arm is healthy.
bool is_left_by_a_host(protocol::Fault fault);

/// Clears the fault and looks for a fifth of a second of the board whether it stays away, or until the self-test is
/// over that follows. Without a fault `now` that ends at once. `next` waits for the next pose. Throws FaultStays.
void clear_fault(Device& device, const ShownFault& now, const std::function<ShownFault()>& next);

}  // namespace inkwell::device
