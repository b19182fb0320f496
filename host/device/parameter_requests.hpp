// What a session was asked to make of the device's parameters and has not sent yet.
#pragma once

#include <vector>

#include <device/device.hpp>

namespace inkwell::device {

/// First the defaults of all parameters, if they are asked for, then single ones.
struct ParameterRequests {
  bool restore_defaults = false;
  std::vector<ParameterChange> changes;  ///< each parameter once, as a transaction names it

  /// A later value of the same parameter takes the place of the earlier one.
  void add(const std::vector<ParameterChange>& later);
  /// What could not be sent comes before this, which was asked for since.
  void put_before(ParameterRequests unsent);
  /// What the device will hold once it got this.
  protocol::ParameterSet applied_to(const protocol::ParameterSet& held) const;
};

}  // namespace inkwell::device
