// Queued parameter changes of a session.
#pragma once

#include <vector>

#include "host/client/device/device.hpp"

namespace inkwell::device {

/// The defaults are restored before the changes are sent.
struct ParameterRequests {
  bool restore_defaults = false;
  std::vector<ParameterChange> changes;  ///< contains each parameter at most once

  /// A later value replaces the earlier value of the same parameter.
  void add(const std::vector<ParameterChange>& later);
  void put_before(ParameterRequests unsent);
  /// Returns the parameter values of the device after these requests.
  protocol::ParameterSet applied_to(const protocol::ParameterSet& held) const;
};

}  // namespace inkwell::device
