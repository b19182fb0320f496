#include <device/control_client.hpp>

#include <array>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "socket.hpp"

namespace inkwell::device {

using nlohmann::json;

struct ControlClient::Implementation {
  Socket socket;
  std::string received;  ///< what came after the last line

  std::string read_line() {
    std::array<std::byte, 65536> chunk;
    std::size_t searched = 0;
    for (;;) {
      const auto end = received.find('\n', searched);
      if (end != std::string::npos) {
        std::string line = received.substr(0, end);
        received.erase(0, end + 1);
        return line;
      }
      searched = received.size();
      const std::size_t length = socket.receive_some(chunk);
      received.append(reinterpret_cast<const char*>(chunk.data()), length);
    }
  }
};

namespace {

PutInFault put_in_fault(const json& told, const char* time_key) {
  PutInFault fault{.number = told.at("number").get<unsigned>(),
                   .fault = told.at("fault").get<std::string>(),
                   .of = told.value("of", std::string()),
                   .at_s = told.at(time_key).get<double>(),
                   .has_come = std::string_view(time_key) == "since_s"};
  if (told.contains("amount")) fault.amount = told["amount"].get<double>();
  if (told.contains("until_s")) fault.until_s = told["until_s"].get<double>();
  return fault;
}

}  // namespace

ControlClient::ControlClient(const std::string& host, std::uint16_t port)
    : implementation_(new Implementation{Socket(host, port), {}}) {}
ControlClient::~ControlClient() = default;
ControlClient::ControlClient(ControlClient&&) noexcept = default;
ControlClient& ControlClient::operator=(ControlClient&&) noexcept = default;

json ControlClient::call(const json& request) {
  const std::string line = request.dump() + "\n";
  implementation_->socket.send(std::as_bytes(std::span(line)));
  json reply;
  try {
    reply = json::parse(implementation_->read_line());
    if (reply.at("ok").get<bool>()) return reply;
  } catch (const json::exception&) {
    throw Error("What answers at the control port is not a virtual board. Give the control port that it printed.");
  }
  throw CommandRefused(fmt::format("The virtual board refused {}: {}", request.at("command").dump(),
                                   reply.value("error", std::string("it gave no reason."))));
}

void ControlClient::wait_at_most(std::chrono::milliseconds limit) { implementation_->socket.wait_at_most(limit); }

BoardStatus ControlClient::status() {
  BoardStatus status;
  status.all = call({{"command", "status"}});
  status.board_time_s = status.all.value("board_time_s", 0.0);
  status.mode = status.all.value("mode", std::string());
  status.paused = status.all.value("paused", false);
  status.locked_up = status.all.value("locked_up", std::string());
  status.unmodelled = status.all.value("unmodelled", std::vector<std::string>());
  return status;
}

void BoardStatus::insist_on_running() const {
  if (locked_up.empty()) return;
  throw Error(
      fmt::format("The firmware does not run on this virtual board. {} Check that it is for this board.", locked_up));
}

json ControlClient::truth() { return call({{"command", "truth"}}); }
void ControlClient::pause() { call({{"command", "pause"}}); }
void ControlClient::stand_by() { call({{"command", "stand_by"}}); }
void ControlClient::run(double for_s) { call({{"command", "run"}, {"for_s", for_s}}); }
void ControlClient::resume() { call({{"command", "resume"}}); }
void ControlClient::reset() { call({{"command", "reset"}}); }
void ControlClient::cut_power() { call({{"command", "cut_power"}}); }
void ControlClient::quit() { call({{"command", "quit"}}); }
void ControlClient::usb(bool connected) { call({{"command", "usb"}, {"connected", connected}}); }
void ControlClient::buttons(bool first, bool second) { call({{"command", "buttons"}, {"pressed", {first, second}}}); }
void ControlClient::supply(double voltage_V) { call({{"command", "supply"}, {"voltage_V", voltage_V}}); }

PinLevels ControlClient::call_pin(const json& request) {
  const json reply = call(request);
  return {reply.value("level", std::string()), reply.value("chip_drives", std::string())};
}
PinLevels ControlClient::pin(const std::string& pin) { return call_pin({{"command", "pin"}, {"pin", pin}}); }
PinLevels ControlClient::drive_pin(const std::string& pin, const std::string& level) {
  return call_pin({{"command", "pin"}, {"pin", pin}, {"drive", level}});
}
void ControlClient::glitch(const std::string& pin, double duration_s) {
  call({{"command", "glitch"}, {"pin", pin}, {"for_s", duration_s}});
}

void ControlClient::gimbal(const Vector3& angles_rad) { call({{"command", "gimbal"}, {"angles_rad", angles_rad}}); }
void ControlClient::dock(bool docked) { call({{"command", "dock"}, {"docked", docked}}); }

PutInFault ControlClient::inject(const protocol::InjectionRequest& fault) {
  json request{{"command", "inject"}, {"fault", fault.fault}, {"after_s", fault.after_s}};
  if (!fault.of.empty()) request["of"] = fault.of;
  if (fault.amount) request["amount"] = *fault.amount;
  if (fault.for_s) request["for_s"] = *fault.for_s;
  const json reply = call(request);
  PutInFault put_in{.number = reply.value("number", 0u),
                    .fault = fault.fault,
                    .of = fault.of,
                    .amount = fault.amount,
                    .at_s = reply.value("at_s", 0.0),
                    .has_come = fault.after_s == 0.0};
  if (fault.for_s) put_in.until_s = put_in.at_s + *fault.for_s;
  return put_in;
}

void ControlClient::heal(const std::string& fault, const std::string& of) {
  json request{{"command", "heal"}, {"fault", fault}};
  if (!of.empty()) request["of"] = of;
  call(request);
}
void ControlClient::heal_all() { call({{"command", "heal"}}); }

Injections ControlClient::injections() {
  const json reply = call({{"command", "status"}});
  Injections now;
  try {
    const json& period = reply.at("control_period");
    now.board_time_s = reply.at("board_time_s").get<double>();
    now.period = period.at("number").get<std::uint64_t>();
    now.period_at_s = period.at("board_time_s").get<double>();
    for (const json& each : reply.at("injected")) now.faults.push_back(put_in_fault(each, "since_s"));
    for (const json& each : reply.at("still_to_come")) now.faults.push_back(put_in_fault(each, "at_s"));
  } catch (const json::exception&) {
    throw Error("The virtual board does not say which faults are in. Build it again.");
  }
  return now;
}

void ControlClient::hand(const Hand& hand) {
  json request{{"command", "hand"}, {"holds", hand.holds}};
  if (hand.holds) {
    request["target_m"] = hand.target_m;
    request["stiffness_N_per_m"] = hand.stiffness_N_per_m;
    request["damping_Ns_per_m"] = hand.damping_Ns_per_m;
  }
  call(request);
}

void ControlClient::hand_path(const std::vector<HandWaypoint>& path) {
  json points = json::array();
  for (const auto& waypoint : path) points.push_back({{"after_s", waypoint.after_s}, {"target_m", waypoint.target_m}});
  call({{"command", "hand_path"}, {"points", points}});
}

void ControlClient::meter_start() { call({{"command", "meter"}, {"action", "start"}}); }

HandReading ControlClient::meter_read() {
  const json reply = call({{"command", "meter"}, {"action", "read"}});
  return {reply.value("peak_force_N", 0.0), reply.value("energy_J", 0.0), reply.value("travel_m", 0.0),
          reply.value("lag_m", 0.0)};
}

void ControlClient::trace_start() { call({{"command", "trace"}, {"action", "start"}}); }
void ControlClient::trace_stop() { call({{"command", "trace"}, {"action", "stop"}}); }

Trace ControlClient::trace_read(std::size_t rows_maximum) {
  const json reply = call({{"command", "trace"}, {"action", "read"}, {"maximum", rows_maximum}});
  Trace trace;
  try {
    trace.columns = reply.at("columns").get<std::vector<std::string>>();
    for (const auto& row : reply.at("rows")) {
      if (row.size() != trace.columns.size()) throw Error("The virtual board sent a damaged trace. Build it again.");
      for (const auto& value : row) trace.values.push_back(value.get<double>());
    }
  } catch (const json::exception&) {
    throw Error("The virtual board sent a damaged trace. Build it again.");
  }
  return trace;
}

}  // namespace inkwell::device
