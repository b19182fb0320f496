// Tests the thread that injects faults into a virtual board. A fake control socket answers instead of a board. The test
// sets the answers of the socket.
#include "host/companion/window/panes/fault_injector.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/host/client/device/fake_control_server.hpp"
#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace inkwell::window;
using nlohmann::json;

namespace {

constexpr auto nothing_in =
    R"({"ok": true, "board_time_s": 1.5, "control_period": {"number": 7, "board_time_s": 1.4}, "injected": [], )"
    R"("still_to_come": []})";

/// Reads messages of the thread until a message of this kind arrives.
template <class Kind>
Kind wait_for(FaultInjector& faults) {
  std::optional<Kind> come;
  REQUIRE(eventually([&] {
    for (const auto& news : faults.take_news())
      if (const auto* found = std::get_if<Kind>(&news); found != nullptr && !come) come = *found;
    return come.has_value();
  }));
  return *come;
}

bool was_asked(FakeControlServer& server, const json& request) {
  const auto requests = server.requests();
  return std::ranges::find(requests, request) != requests.end();
}

}  // namespace

TEST_CASE("the fault injector polls the board and sends injections and repairs") {
  FakeControlServer server([](const json& request) {
    return request.at("command") == "inject" ? R"({"ok": true, "number": 3, "at_s": 1.6})" + std::string("\n")
                                             : nothing_in + std::string("\n");
  });
  FaultInjector faults({"127.0.0.1", server.port()});
  CHECK(wait_for<device::Injections>(faults).period == 7);
  CHECK(wait_for<device::Injections>(faults).board_time_s == 1.5);
  faults.inject({.fault = "motor_open", .of = "2", .for_s = 0.25});
  const auto injection = wait_for<device::Injection>(faults);
  CHECK(injection.number == 3);
  CHECK(injection.fault == "motor_open");
  CHECK(injection.at_s == 1.6);
  CHECK(injection.until_s == 1.85);
  faults.heal("motor_open", "2");
  faults.heal_all();
  REQUIRE(eventually([&] { return was_asked(server, {{"command", "heal"}}); }));
  CHECK(was_asked(server, {{"command", "heal"}, {"fault", "motor_open"}, {"of", "2"}}));
}

TEST_CASE("the fault injector reports a refusal and continues to poll the board") {
  FakeControlServer server([](const json& request) {
    return request.at("command") == "inject" ? R"({"ok": false, "error": "there is no such motor"})" + std::string("\n")
                                             : nothing_in + std::string("\n");
  });
  FaultInjector faults({"127.0.0.1", server.port()});
  faults.inject({.fault = "motor_open", .of = "9"});
  CHECK(wait_for<FaultInjector::Refusal>(faults).sentence.find("no such motor") != std::string::npos);
  CHECK(wait_for<device::Injections>(faults).period == 7);
}

TEST_CASE("the fault injector reports a lost board once, continues to poll it, and discards earlier requests") {
  std::atomic<bool> answers = true;
  FakeControlServer server([&](const json&) { return answers ? nothing_in + std::string("\n") : std::string("no\n"); });
  FaultInjector faults({"127.0.0.1", server.port()});
  wait_for<device::Injections>(faults);
  answers = false;
  CHECK_FALSE(wait_for<FaultInjector::Gone>(faults).sentence.empty());
  faults.inject({.fault = "supply_cut"});
  const json inject{{"command", "inject"}, {"fault", "supply_cut"}, {"after_s", 0.0}};
  REQUIRE(eventually([&] { return was_asked(server, inject); }));
  const auto asked = server.requests().size();
  REQUIRE(eventually([&] { return server.requests().size() >= asked + 2; }));
  CHECK(faults.take_news().empty());
  server.hang_up();
  answers = true;
  wait_for<device::Injections>(faults);
  const auto requests = server.requests();
  CHECK(std::ranges::count_if(requests, [](const json& each) { return each.at("command") == "inject"; }) == 1);
}

TEST_CASE("an answer like the last one is no change") {
  std::atomic<bool> has_fault = false;
  FakeControlServer server([&](const json&) {
    json answer = json::parse(nothing_in);
    if (has_fault) answer["injected"].push_back({{"number", 1}, {"fault", "supply_cut"}, {"since_s", 1.0}});
    return answer.dump() + "\n";
  });
  FaultInjector faults({"127.0.0.1", server.port()});
  wait_for<device::Injections>(faults);
  const auto asked = server.requests().size();
  REQUIRE(eventually([&] { return server.requests().size() >= asked + 2; }));
  CHECK_FALSE(faults.has_changed());
  has_fault = true;
  REQUIRE(eventually([&] { return faults.has_changed(); }));
  CHECK(wait_for<device::Injections>(faults).faults.size() == 1);
  CHECK_FALSE(faults.has_changed());
}
