// The parameter changes that a session has queued and not sent yet.
#pragma once

#include <vector>

#include "host/client/device/device.hpp"

namespace inkwell::device {

/// Requests for the defaults of all parameters, then for individual values.
struct ParameterRequests {
  bool restore_defaults = false;
  std::vector<ParameterChange> changes;  ///< each parameter once, as a transaction requires

  /// A later value of a parameter replaces the earlier value.
  void add(const std::vector<ParameterChange>& later);
  /// Inserts unsent requests before the requests of this object.
  void put_before(ParameterRequests unsent);
  /// The parameter values of the device after these requests.
  protocol::ParameterSet applied_to(const protocol::ParameterSet& held) const;
};

}  // namespace inkwell::device
