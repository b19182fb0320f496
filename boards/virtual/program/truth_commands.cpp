#include "boards/virtual/program/truth_commands.hpp"

#include <string>
#include <utility>

#include "boards/virtual/program/requests.hpp"
#include "protocol/simulation.hpp"

#include "boards/virtual/program/injection_commands.hpp"

namespace inkwell::virtual_board {

using nlohmann::json;

std::string_view name_of(PinLevel level) {
  switch (level) {
    case PinLevel::low: return "low";
    case PinLevel::high: return "high";
    default: return "floating";
  }
}

json truth(const json&, Simulation& simulation) {
  const Truth t = simulation.board().truth();
  json reply{{"board_time_s", seconds(t.at)},
             {"encoder_counts", t.encoder_counts},
             {"hand_holds", t.hand_holds},
             {"docked", t.docked},
             {"inkwell_switch", t.inkwell_switch},
             {"bridge_fault", t.bridge_fault},
             {"buttons", t.buttons},
             {"bridges_enabled", t.bridges_enabled},
             {"resets", simulation.board().chip().counters().all_resets()},
             {"bridges_driven_until_s", seconds(t.driven_until)},
             {"injected", injected(simulation.board())}};
  for (const auto& legs : t.leg_levels) reply["bridge_legs"].push_back({name_of(legs[0]), name_of(legs[1])});
  const auto values = traced_values(t);
  for (std::size_t i = 0; i < values.size(); ++i)
    reply[std::string(protocol::simulated_quantity_table[i].name)] = values[i];
  return reply;
}

json meter(const json& request, Simulation& simulation) {
  Plant& plant = simulation.board().plant();
  if (meter_action(request) == MeterAction::start) plant.start_meters();
  if (!plant.hand_meter().runs()) throw Refused("the meter has not been started; send {\"action\":\"start\"} first");
  const HandMeter::Reading& reading = plant.hand_meter().reading();
  return {{"since_s", seconds(reading.since)},
          {"peak_force_N", reading.peak_force_N},
          {"energy_J", reading.energy_J},
          {"travel_m", reading.travel_m},
          {"lag_m", reading.lag_m},
          {"peak_motor_force_N", plant.motor_force_meter().peak_N()},
          {"peak_motor_force_over_ms_N", plant.motor_force_meter().peak_over_ms_N()}};
}

json trace(const json& request, Simulation& simulation) {
  Trace& trace = simulation.board().trace();
  switch (trace_action(request)) {
    case TraceAction::start: trace.start(); return {};
    case TraceAction::stop: trace.stop(); return {};
    case TraceAction::read: break;
  }
  json columns{"period", "board_time_s"};
  for (const auto& quantity : protocol::simulated_quantity_table) columns.push_back(quantity.name);
  json rows = json::array();
  for (const Trace::Row& row : trace.read(trace_rows(request))) {
    json cells{row.period, seconds(row.at)};
    for (const double value : row.values) cells.push_back(value);
    rows.push_back(std::move(cells));
  }
  return {{"columns", std::move(columns)}, {"rows", std::move(rows)}, {"dropped", trace.dropped()}};
}

}  // namespace inkwell::virtual_board
