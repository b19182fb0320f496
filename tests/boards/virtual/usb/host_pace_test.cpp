// Tests the conditions for which board time waits for the host.
#include <doctest/doctest.h>

#include "boards/virtual/usb/host_pace.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using virtual_board::HostPace;
using virtual_board::Urb;
namespace transfer_status = virtual_board::transfer_status;

Urb in(std::uint8_t endpoint, std::uint32_t sequence = 1) {
  Urb urb;
  urb.sequence = sequence;
  urb.endpoint = endpoint;
  urb.in = true;
  return urb;
}

void submit(HostPace& pace, std::uint8_t endpoint, int times) {
  for (int i = 0; i < times; ++i) pace.submitted(in(endpoint));
}

void answer(HostPace& pace, std::uint8_t endpoint, int times) {
  for (int i = 0; i < times; ++i) pace.completed(in(endpoint), transfer_status::success);
}

TEST_CASE("the board waits for a host that had several pending requests, if no request is left") {
  HostPace pace;
  submit(pace, 1, 3);
  CHECK_FALSE(pace.is_owed());
  answer(pace, 1, 2);
  CHECK(pace.is_owed());
  CHECK_FALSE(pace.is_starved());
  answer(pace, 1, 1);
  CHECK(pace.is_starved());
  submit(pace, 1, 1);
  CHECK_FALSE(pace.is_starved());
  CHECK(pace.is_owed());
  submit(pace, 1, 2);
  CHECK_FALSE(pace.is_owed());
}

TEST_CASE(
    "the board expects no second request after a single request, but expects one after repeated single requests") {
  HostPace pace;
  submit(pace, 1, 1);
  answer(pace, 1, 1);
  CHECK_FALSE(pace.is_starved());
  CHECK_FALSE(pace.is_owed());
  submit(pace, 1, 1);
  answer(pace, 1, 1);
  CHECK(pace.is_starved());
}

TEST_CASE("the board does not wait for an endpoint without requests, or for OUT and control transfers") {
  HostPace pace;
  submit(pace, 2, 2);
  CHECK_FALSE(pace.is_starved());
  Urb out;
  out.endpoint = 1;
  for (int i = 0; i < 2; ++i) {
    pace.submitted(out);
    pace.submitted(in(0));
    CHECK(pace.has_control_transfer());
    pace.completed(out, transfer_status::success);
    pace.completed(in(0), transfer_status::success);
    CHECK_FALSE(pace.has_control_transfer());
  }
  CHECK_FALSE(pace.is_starved());
  CHECK_FALSE(pace.is_owed());
}

TEST_CASE("a host that takes a request back, gets an error, is too late or is another one is not waited for") {
  HostPace pace;
  submit(pace, 1, 2);
  submit(pace, 2, 2);
  answer(pace, 1, 1);
  SUBCASE("takes back") { pace.unlinked(in(1)); }
  SUBCASE("takes the last one back, too late") {
    pace.submitted(in(1, 2));
    answer(pace, 1, 2);
    CHECK(pace.is_starved());
    pace.unlinked_too_late(2);
  }
  SUBCASE("error") { pace.completed(in(1), transfer_status::stalled); }
  SUBCASE("too late") {
    answer(pace, 1, 1);
    pace.lose_patience();
  }
  SUBCASE("another host") {
    pace.restart();
    submit(pace, 2, 2);
  }
  CHECK_FALSE(pace.is_starved());
  CHECK_FALSE(pace.is_owed());
  answer(pace, 2, 1);  // the host is still expected to repeat this request
  CHECK(pace.is_owed());
  submit(pace, 2, 1);
  submit(pace, 1, 1);
  answer(pace, 1, 1);
  CHECK_FALSE(pace.is_starved());
  submit(pace, 1, 1);  // the second request after the restart
  answer(pace, 1, 1);
  CHECK(pace.is_starved());
}

TEST_CASE(
    "the board waits indefinitely for a host that streams, but not while the host waits or sends single requests") {
  HostPace pace;
  submit(pace, 1, 2);
  answer(pace, 1, 2);
  REQUIRE(pace.is_starved());
  CHECK(pace.is_waited_for_without_limit());
  pace.submitted(in(0));
  CHECK_FALSE(pace.is_waited_for_without_limit());
  pace.completed(in(0), transfer_status::success);
  CHECK(pace.is_waited_for_without_limit());
  for (int i = 0; i < 2; ++i) {
    submit(pace, 2, 1);
    answer(pace, 2, 1);
  }
  CHECK_FALSE(pace.is_waited_for_without_limit());
  submit(pace, 2, 1);  // no request is expected on this endpoint
  CHECK(pace.is_waited_for_without_limit());
}

TEST_CASE("a transfer without an answer is one that the host waits for, until it takes it back") {
  HostPace pace;
  pace.submitted(in(0));
  pace.submitted(in(0));
  pace.unlinked(in(0));
  CHECK(pace.has_control_transfer());
  pace.completed(in(0), transfer_status::stalled);
  CHECK_FALSE(pace.has_control_transfer());
}

TEST_CASE(
    "in lock step, board time passes after each report request until the host has the report, regardless of its "
    "stream") {
  HostPace pace;
  CHECK_FALSE(pace.waits_for_board());
  pace.submitted(in(0));
  CHECK(pace.waits_for_board());  // the host has not requested a report yet
  pace.completed(in(0), transfer_status::success);
  CHECK_FALSE(pace.waits_for_board());
  submit(pace, 2, 3);
  for (int i = 0; i < 3; ++i) {
    submit(pace, 1, 1);
    CHECK(pace.waits_for_board());
    answer(pace, 1, 1);
    CHECK_FALSE(pace.waits_for_board());
    pace.submitted(in(0));
    CHECK_FALSE(pace.waits_for_board());
    pace.completed(in(0), transfer_status::success);
  }
  CHECK_FALSE(pace.is_stream_starved());
  CHECK_FALSE(pace.is_stream_owed());
  answer(pace, 2, 1);
  CHECK(pace.is_stream_owed());
  answer(pace, 2, 2);
  CHECK(pace.is_stream_starved());
}

TEST_CASE("in lock step a host that streams its reports does not decide when time passes") {
  HostPace pace;
  submit(pace, 1, 2);
  answer(pace, 1, 2);
  CHECK(pace.waits_for_board());
  CHECK(pace.is_stream_starved());
}

}  // namespace
}  // namespace inkwell::virtual_usb_test
