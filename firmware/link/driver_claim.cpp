#include "firmware/link/driver_claim.hpp"

#include <algorithm>
#include <cstring>

namespace inkwell::link {

namespace {

using protocol::ClaimOperation;

constexpr auto expiry_periods = static_cast<std::uint32_t>(protocol::claim_expiry_s * protocol::servo_rate_Hz);

}  // namespace

bool DriverClaim::accept(std::span<const std::byte> report, std::uint32_t now_periods) {
  protocol::ClaimReport request;
  if (report.size() < sizeof request) return false;
  std::memcpy(&request, report.data(), sizeof request);
  if (request.version != protocol::protocol_version || request.claim == 0) return false;
  const bool is_held = claim_ != 0;
  const bool is_same = request.claim == claim_;
  switch (request.operation) {
    case ClaimOperation::claim:
      if (is_same) {
        renew(now_periods);
      } else if (is_held) {
        ++refused_;
      } else {
        begin(request, now_periods);
      }
      return false;
    case ClaimOperation::take_over:
      if (is_same)
        renew(now_periods);
      else
        begin(request, now_periods);
      return is_held && !is_same;
    case ClaimOperation::release:
      if (is_same) end();
      return is_same;
  }
  return false;
}

void DriverClaim::pass_time(std::uint32_t now_periods) {
  if (claim_ == 0 || now_periods - second_began_periods_ < protocol::servo_rate_Hz) return;
  second_began_periods_ += protocol::servo_rate_Hz;
  ++driver_.driven_s;
}

bool DriverClaim::has_expired(std::uint32_t now_periods) const {
  return claim_ != 0 && now_periods - heard_at_periods_ > expiry_periods;
}

void DriverClaim::end() {
  if (claim_ == 0) return;
  claim_ = 0;
  driver_ = {};
  ++changes_;
}

void DriverClaim::begin(const protocol::ClaimReport& request, std::uint32_t now_periods) {
  claim_ = request.claim;
  driver_ = {};
  driver_.is_driven = 1;
  driver_.claim_digest = protocol::digest_of(request.claim);
  driver_.process_id = request.process_id;
  std::ranges::copy(request.program, driver_.program);
  driver_.program[protocol::program_name_maximum] = '\0';
  second_began_periods_ = now_periods;
  ++changes_;
  renew(now_periods);
}

protocol::DriverReport DriverClaim::report(std::uint32_t now_periods) const {
  protocol::DriverReport report = driver_;
  report.time_periods = now_periods;
  report.changes = changes_;
  report.refused = refused_;
  return report;
}

}  // namespace inkwell::link
