#include "boards/virtual/usb/host_pace.hpp"

#include <algorithm>

namespace inkwell::virtual_board {

void HostPace::submitted(const Urb& urb) {
  if (urb.endpoint == 0) ++control_transfers_;
  if (urb.endpoint == 0 || !urb.in) return;
  Endpoint& endpoint = in_endpoints_[urb.endpoint];
  ++endpoint.requests;
  endpoint.newest_sequence = urb.sequence;
  endpoint.requested = std::min(endpoint.requested + 1, 2u);
  endpoint.most = std::max(endpoint.most, endpoint.requests);
}

void HostPace::completed(const Urb& urb, std::int32_t status) { end(urb, status != transfer_status::success); }

void HostPace::unlinked(const Urb& urb) { end(urb, true); }

void HostPace::unlinked_too_late(std::uint32_t sequence) {
  for (Endpoint& one : in_endpoints_)
    if (one.newest_sequence == sequence) one.requested = one.most = 0;
}

void HostPace::end(const Urb& urb, bool is_dropped) {
  if (urb.endpoint == 0 && control_transfers_ > 0) --control_transfers_;
  if (urb.endpoint == 0 || !urb.in) return;
  Endpoint& endpoint = in_endpoints_[urb.endpoint];
  if (endpoint.requests > 0) --endpoint.requests;
  if (is_dropped) endpoint.requested = endpoint.most = 0;
}

void HostPace::restart() { *this = {}; }

bool HostPace::is_starved() const {
  return std::ranges::any_of(in_endpoints_, [](const Endpoint& one) { return one.is_kept() && one.requests == 0; });
}

bool HostPace::is_owed() const {
  return std::ranges::any_of(in_endpoints_,
                             [](const Endpoint& one) { return one.is_kept() && one.requests < one.most; });
}

bool HostPace::is_waited_for_without_limit() const {
  return !has_control_transfer() && std::ranges::none_of(in_endpoints_, [](const Endpoint& one) {
    return one.is_kept() && one.requests < one.most && one.most == 1;
  });
}

bool HostPace::waits_for_board() const {
  const auto has_requested = [](const Endpoint& one) { return one.most > 0; };
  if (std::ranges::none_of(in_endpoints_, has_requested)) return has_control_transfer();
  // A streaming host renews its requests in time. If the host submits single requests, board time passes only while a
  // request is pending.
  return std::ranges::none_of(in_endpoints_, [](const Endpoint& one) { return one.most == 1 && one.requests == 0; });
}

bool HostPace::is_stream_starved() const {
  return std::ranges::any_of(in_endpoints_, [](const Endpoint& one) { return one.streams() && one.requests == 0; });
}

bool HostPace::is_stream_owed() const {
  return std::ranges::any_of(in_endpoints_,
                             [](const Endpoint& one) { return one.streams() && one.requests < one.most; });
}

void HostPace::lose_patience() {
  for (Endpoint& one : in_endpoints_)
    if (one.requests < one.most) one.requested = one.most = 0;
}

}  // namespace inkwell::virtual_board
