// Tests the client of a virtual board's control socket: requests, and handling of each kind of answer.
#include <doctest/doctest.h>

#include <chrono>
#include <string>

#include "host/client/device/control_client.hpp"
#include "tests/failure.hpp"

#include "tests/host/client/device/fake_control_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using device::ControlClient;
using nlohmann::json;

namespace {

ControlClient client_of(const FakeControlServer& server) { return ControlClient({"127.0.0.1", server.port()}); }

/// Returns the error message for this answer line.
std::string failure_at(const std::string& line) {
  FakeControlServer server([&](const json&) { return line + "\n"; });
  auto client = client_of(server);
  return message_of<device::Error>([&] { client.trace_read(10); });
}

}  // namespace

TEST_CASE("the status of a board is read from its answer, and a missing field is empty") {
  std::string line =
      R"({"ok": true, "board_time_s": 1.5, "mode": "exact", "paused": true, "unmodelled": ["x\u001b[1m"]})";
  FakeControlServer server([&](const json&) { return line + "\n"; });
  auto client = client_of(server);
  const auto status = client.status();
  CHECK(status.board_time_s == 1.5);
  CHECK(status.mode == "exact");
  CHECK(status.paused);
  CHECK(status.unmodelled == std::vector<std::string>{"x?[1m"});
  CHECK_NOTHROW(status.insist_on_running());
  line = R"({"ok": true})";
  CHECK(client.status().board_time_s == 0.0);
}

TEST_CASE("a refusal contains the command and the reason of the board") {
  const auto message = failure_at(R"({"ok": false, "error": "No trace runs."})");
  CHECK(contains(message, "refused \"trace\""));
  CHECK(contains(message, "No trace runs."));
  CHECK(contains(failure_at(R"({"ok": false})"), "no reason was given"));
  CHECK(contains(failure_at(R"({"ok": false, "error": "\u001b[2Jred"})"), ": ?[2Jred"));
}

TEST_CASE("a refusal leaves the connection as it was; no answer in time is another error") {
  FakeControlServer server([](const json& request) {
    if (request.at("command") == "reset") return std::string();
    return request.at("command") == "run" ? std::string("{\"ok\": false, \"error\": \"no\"}\n") : "{\"ok\": true}\n";
  });
  auto client = client_of(server);
  CHECK_THROWS_AS(client.run(1), device::CommandRefused);
  client.pause();
  client.wait_at_most(std::chrono::milliseconds(1));
  CHECK(contains(message_of<device::Error>([&] { client.reset(); }), "does not answer"));
}

TEST_CASE("the active and the planned faults are read from the status of the board") {
  const std::string line =
      R"({"ok": true, "board_time_s": 2.5, "control_period": {"number": 40000, "board_time_s": 2.25}, "injected": [)"
      R"({"number": 1, "fault": "motor_open", "of": "2", "since_s": 1.5, "until_s": 3.5}], "still_to_come": [)"
      R"({"number": 2, "fault": "supply_sag", "amount": 9.5, "at_s": 4.5}]})";
  FakeControlServer server([&](const json&) { return line + "\n"; });
  const auto now = client_of(server).injections();
  CHECK(now.board_time_s == 2.5);
  CHECK(now.period == 40'000);
  CHECK(now.period_at_s == 2.25);
  REQUIRE(now.faults.size() == 2);
  CHECK(
      now.faults[0] ==
      device::Injection{.number = 1, .fault = "motor_open", .of = "2", .at_s = 1.5, .until_s = 3.5, .has_come = true});
  CHECK(now.faults[1] ==
        device::Injection{.number = 2, .fault = "supply_sag", .amount = 9.5, .at_s = 4.5, .has_come = false});
  FakeControlServer older([](const json&) { return "{\"ok\": true, \"injected\": []}\n"; });
  CHECK(contains(message_of<device::Error>([&] { client_of(older).injections(); }), "its injected faults"));
}

TEST_CASE("an answer from a server that is not a virtual board raises an error") {
  for (const auto line : {"HTTP/1.1 400 Bad Request", "{}", "[]", R"({"ok": 1})"})
    CHECK(contains(failure_at(line), "is not a virtual board"));
}

TEST_CASE("an answer whose values are of another kind, or fit no number, is an error like others") {
  std::string line;
  FakeControlServer server([&](const json&) { return line + "\n"; });
  auto client = client_of(server);
  const auto failure = [&](auto call) { return message_of<device::Error>([&] { call(); }); };
  for (const auto damaged : {R"({"ok": true, "board_time_s": "soon"})", R"({"ok": true, "mode": 1})",
                             R"({"ok": true, "paused": 0})", R"({"ok": true, "unmodelled": [1]})"}) {
    line = damaged;
    CHECK(contains(failure([&] { client.status(); }), "damaged answer"));
  }
  line = R"({"ok": true, "level": 1})";
  CHECK(contains(failure([&] { client.pin("PA0"); }), "damaged answer"));
  line = R"({"ok": true, "peak_force_N": []})";
  CHECK(contains(failure([&] { client.meter_read(); }), "damaged answer"));
  for (const auto number : {"-1", "1e300", "4294967296", "\"1\""}) {
    line = std::string(R"({"ok": true, "number": )") + number + "}";
    CHECK(contains(failure([&] { client.inject({.fault = "motor_open"}); }), "damaged answer"));
    line = R"({"ok": true, "board_time_s": 1, "control_period": {"number": 1, "board_time_s": 1}, "injected": [)"
           R"({"fault": "motor_open", "since_s": 1, "number": )" +
           std::string(number) + R"(}], "still_to_come": []})";
    CHECK(contains(failure([&] { client.injections(); }), "its injected faults"));
  }
  CHECK(contains(failure_at(R"({"ok": false, "error": 7})"), "is not a virtual board"));
}

TEST_CASE("a trace is read row by row, however long; a damaged one is refused") {
  json rows = json::array();
  for (int i = 0; i < 20'000; ++i) rows.push_back({i, 0.5});
  const json reply{{"ok", true}, {"columns", {"time_s", "force_N"}}, {"rows", rows}};
  FakeControlServer server([&](const json&) { return reply.dump() + "\n"; });
  auto client = client_of(server);
  const auto trace = client.trace_read(20'000);
  REQUIRE(trace.row_count() == 20'000);
  CHECK(trace.values[2 * 19'999] == 19'999.0);
  CHECK(server.requests().back() == json{{"command", "trace"}, {"action", "read"}, {"maximum", 20'000}});
  for (const auto damaged : {R"({"ok": true, "columns": ["a", "b"], "rows": [[1]]})",
                             R"({"ok": true, "columns": ["a"], "rows": [["x"]]})", R"({"ok": true, "rows": []})"})
    CHECK(contains(failure_at(damaged), "damaged trace"));
}

TEST_CASE("an answer that arrives together with the previous answer is used for its own call") {
  bool is_first = true;
  FakeControlServer server([&](const json&) {
    return std::exchange(is_first, false)
               ? std::string("{\"ok\": true, \"mode\": \"fast\"}\n{\"ok\": true, ") + "\"mode\": \"exact\"}\n"
               : std::string();
  });
  auto client = client_of(server);
  CHECK(client.status().mode == "fast");
  CHECK(client.status().mode == "exact");
}

TEST_CASE("a line without an end does not fill the memory") {
  FakeControlServer server([](const json&) { return std::string(129u << 20, 'x'); });
  auto client = client_of(server);
  client.wait_at_most(std::chrono::seconds(60));
  CHECK(contains(message_of<device::Error>([&] { client.status(); }), "a line without an end"));
}

TEST_CASE("a request for a hand that holds contains its parameters, and a request to release contains no parameters") {
  FakeControlServer server([](const json&) { return "{\"ok\": true}\n"; });
  auto client = client_of(server);
  client.hand({.holds = true, .target_m = {0.01, 0.02, 0.03}, .stiffness_N_per_m = 200, .damping_Ns_per_m = 4});
  client.hand({});
  const auto requests = server.requests();
  REQUIRE(requests.size() == 2);
  CHECK(requests[0] == json{{"command", "hand"},
                            {"holds", true},
                            {"target_m", {0.01, 0.02, 0.03}},
                            {"stiffness_N_per_m", 200.0},
                            {"damping_Ns_per_m", 4.0}});
  CHECK(requests[1] == json{{"command", "hand"}, {"holds", false}});
}

TEST_CASE("a lost board raises Disconnected") {
  FakeControlServer server([](const json&) { return "{\"ok\": true}\n"; });
  auto client = client_of(server);
  client.pause();
  server.hang_up();
  for (int i = 0; i < 10; ++i) CHECK_THROWS_AS(client.resume(), device::Disconnected);
}
