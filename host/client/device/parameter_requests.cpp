#include "host/client/device/parameter_requests.hpp"

#include <algorithm>
#include <utility>

namespace inkwell::device {

void ParameterRequests::add(const std::vector<ParameterChange>& later) {
  for (const auto& change : later) {
    const auto same =
        std::find_if(changes.begin(), changes.end(), [&](const auto& old) { return old.first == change.first; });
    if (same != changes.end())
      same->second = change.second;
    else
      changes.push_back(change);
  }
}

void ParameterRequests::put_before(ParameterRequests unsent) {
  if (restore_defaults) return;  // the restored defaults overwrite the unsent changes
  unsent.add(changes);
  *this = std::move(unsent);
}

protocol::ParameterSet ParameterRequests::applied_to(const protocol::ParameterSet& held) const {
  protocol::ParameterSet set = restore_defaults ? protocol::default_parameters() : held;
  for (const auto& [parameter, value] : changes) set[parameter] = value;
  return set;
}

}  // namespace inkwell::device
