#include "host/client/device/control_client.hpp"

#include <array>
#include <span>
#include <string>

#include <fmt/format.h>

#include "host/client/device/control_answers.hpp"
#include "host/client/device/socket.hpp"

namespace inkwell::device {

using nlohmann::json;

namespace {
/// A trace is the longest answer. It has 100,000 rows of 30 numbers, and each number has up to 25 characters.
constexpr std::size_t line_maximum = 128u << 20;
}  // namespace

struct ControlClient::Implementation {
  Socket socket;
  std::string received;  ///< bytes after the last line

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
      if (received.size() > line_maximum)
        throw Error(
            "The program at the control socket sent a line without an end. Give the address that virtual-board "
            "printed.");
      searched = received.size();
      const std::size_t length = socket.receive_some(chunk);
      received.append(reinterpret_cast<const char*>(chunk.data()), length);
    }
  }
};

ControlClient::ControlClient(const SocketAddress& server) : implementation_(new Implementation{Socket(server), {}}) {}
ControlClient::~ControlClient() = default;
ControlClient::ControlClient(ControlClient&&) noexcept = default;
ControlClient& ControlClient::operator=(ControlClient&&) noexcept = default;

json ControlClient::call(const json& request) {
  const std::string line = request.dump() + "\n";
  implementation_->socket.send(std::as_bytes(std::span(line)));
  return parse_answer(implementation_->read_line(), request.at("command").get<std::string>());
}

void ControlClient::wait_at_most(std::chrono::milliseconds limit) { implementation_->socket.wait_at_most(limit); }

BoardStatus ControlClient::status() { return status_of(call({{"command", "status"}})); }

void BoardStatus::insist_on_running() const {
  if (locked_up.empty()) return;
  throw Error(fmt::format(
      "The firmware does not run on this virtual board. {} Check that the firmware was built for this board.",
      locked_up));
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

PinLevels ControlClient::call_pin(const json& request) { return pin_levels_of(call(request)); }
PinLevels ControlClient::pin(const std::string& pin) { return call_pin({{"command", "pin"}, {"pin", pin}}); }
PinLevels ControlClient::drive_pin(const std::string& pin, const std::string& level) {
  return call_pin({{"command", "pin"}, {"pin", pin}, {"drive", level}});
}
void ControlClient::glitch(const std::string& pin, double duration_s) {
  call({{"command", "glitch"}, {"pin", pin}, {"for_s", duration_s}});
}

void ControlClient::gimbal(const Vector3& angles_rad) { call({{"command", "gimbal"}, {"angles_rad", angles_rad}}); }
void ControlClient::dock(bool docked) { call({{"command", "dock"}, {"docked", docked}}); }

Injection ControlClient::inject(const protocol::InjectionRequest& injection) {
  json request{{"command", "inject"}, {"fault", injection.fault}, {"after_s", injection.after_s}};
  if (!injection.of.empty()) request["of"] = injection.of;
  if (injection.amount) request["amount"] = *injection.amount;
  if (injection.for_s) request["for_s"] = *injection.for_s;
  return injection_of(call(request), injection);
}

void ControlClient::heal(const std::string& fault, const std::string& of) {
  json request{{"command", "heal"}, {"fault", fault}};
  if (!of.empty()) request["of"] = of;
  call(request);
}
void ControlClient::heal_all() { call({{"command", "heal"}}); }

Injections ControlClient::injections() { return injections_of(call({{"command", "status"}})); }

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

MeterReading ControlClient::meter_read() { return meter_reading_of(call({{"command", "meter"}, {"action", "read"}})); }

void ControlClient::trace_start() { call({{"command", "trace"}, {"action", "start"}}); }
void ControlClient::trace_stop() { call({{"command", "trace"}, {"action", "stop"}}); }

Trace ControlClient::trace_read(std::size_t rows_maximum) {
  return trace_of(call({{"command", "trace"}, {"action", "read"}, {"maximum", rows_maximum}}));
}

}  // namespace inkwell::device
