#include "commands.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "injection_commands.hpp"
#include "requests.hpp"
#include "simulation.hpp"
#include "truth_commands.hpp"

namespace inkwell::virtual_board {
namespace {

using nlohmann::json;

Vector3 vector(const json& request, const char* key, double largest) {
  const json& value = at(request, key, "a list of three numbers");
  if (!value.is_array() || value.size() != 3) throw Refused(fmt::format("\"{}\" must be a list of three numbers", key));
  Vector3 result;
  for (int i = 0; i < 3; ++i) result[i] = checked_number(value[static_cast<std::size_t>(i)], key, -largest, largest);
  return result;
}

constexpr double reach_m = 2.0;  // farther away than any arm of the descriptions' ranges

// ---- commands -------------------------------------------------------------------------------------------------

json violations_of(Board& board) {
  json list = json::array();
  for (const Violation& violation : board.chip().violations())
    list.push_back({{"rule", info(violation.rule).name},
                    {"register", info(violation.rule).of_register},
                    {"section", info(violation.rule).section},
                    {"where", violation.where},
                    {"sentence", sentence(violation)},
                    {"code_address", violation.code_address},
                    {"code", board.name_of_code(violation.code_address)},
                    {"board_time_s", seconds(violation.first)},
                    {"count", violation.count}});
  return list;
}

json status(const json&, Simulation& simulation) {
  Board& board = simulation.board();
  const Chip& chip = board.chip();
  const Counters& counters = chip.counters();
  unsigned longest = exception_interrupt_0;
  for (unsigned exception = exception_interrupt_0; exception < exception_numbers; ++exception)
    if (counters.exceptions[exception].longest_cycles > counters.exceptions[longest].longest_cycles)
      longest = exception;
  const auto of = [&](ResetCause cause) { return counters.resets[static_cast<std::size_t>(cause)]; };
  json reply{
      {"board_time_s", seconds(chip.now())},
      {"mode", chip.mode() == Mode::exact ? "exact" : "fast"},
      {"paused", simulation.paused()},
      {"stands_by", simulation.stands_by()},
      {"real_time", simulation.options().real_time},
      {"time_dropped_s", simulation.time_dropped_s()},
      {"seed", simulation.options().seed},
      {"instructions", counters.instructions},
      {"cycles", counters.cycles},
      {"flash_operations", chip.flash_operations()},
      {"sleep_share", counters.sleep_share()},
      {"exception", chip.current_exception()},
      {"processor_clock_Hz", chip.clocks().hclk_Hz},
      {"resets", counters.all_resets()},
      {"watchdog_resets", of(ResetCause::independent_watchdog) + of(ResetCause::window_watchdog)},
      {"unmodelled", chip.unmodelled_accesses()},
      {"violations", violations_of(board)},
      {"injected", injected(board)},
      {"still_to_come", still_to_come(board)},
      {"control_period",
       {{"number", board.control_period().number}, {"board_time_s", seconds(board.control_period().began)}}},
      {"longest_interrupt", {{"exception", longest}, {"cycles", counters.exceptions[longest].longest_cycles}}},
      {"usb",
       {{"connected", board.usb().connected()},
        {"enumerated", board.usb().enumerated()},
        {"imported", board.usb().imported()},
        {"waits_for", board.usb().late_hosts()}}},
      {"trace",
       {{"running", board.trace().is_running()},
        {"rows", board.trace().waiting()},
        {"dropped", board.trace().dropped()}}},
  };
  if (board.locked_up()) reply["locked_up"] = chip.lockup_reason();
  return reply;
}

json pause(const json&, Simulation& simulation) {
  simulation.pause();
  return {{"board_time_s", seconds(simulation.board().chip().now())}};
}

json run(const json& request, Simulation& simulation) {
  if (simulation.is_running_for()) throw Refused("another run is under way; wait for its reply or pause it");
  if (simulation.board().locked_up() && !simulation.options().seconds)
    throw Refused("the processor is locked up; reset it first");
  simulation.run_for(number(request, "for_s", 0.0, 1e6));
  return {};
}

json stand_by(const json&, Simulation& simulation) {
  simulation.stand_by();
  return {{"board_time_s", seconds(simulation.board().chip().now())}};
}

json resume(const json&, Simulation& simulation) {
  if (simulation.is_running_for()) throw Refused("a run is under way; wait for its reply or pause it");
  if (simulation.board().locked_up()) throw Refused("the processor is locked up; reset it first");
  simulation.resume();
  return {};
}

json reset(const json&, Simulation& simulation) {
  simulation.board().reset();
  return {};
}

json cut_power(const json& request, Simulation& simulation) {
  Chip& chip = simulation.board().chip();
  if (request.contains("at_flash_operation"))
    chip.cut_power_at_flash_operation(static_cast<std::uint64_t>(number(request, "at_flash_operation", 1.0, 1e9)));
  else
    chip.reset(ResetCause::power_on);
  return {};
}

json quit(const json&, Simulation& simulation) {
  simulation.quit();
  return {};
}

json usb(const json& request, Simulation& simulation) {
  simulation.board().plug(truth_value(request, "connected"));
  return {};
}

json buttons(const json& request, Simulation& simulation) {
  const json& pressed = at(request, "pressed", "a list of two, true or false");
  if (!pressed.is_array() || pressed.size() != 2 || !pressed[0].is_boolean() || !pressed[1].is_boolean())
    throw Refused("\"pressed\" must be a list of two, true or false");
  simulation.board().plant().press_buttons(pressed[0].get<bool>(), pressed[1].get<bool>());
  return {};
}

json supply(const json& request, Simulation& simulation) {
  simulation.board().plant().set_supply_V(number(request, "voltage_V", 0.0, 36.0));
  return {};
}

json hand(const json& request, Simulation& simulation) {
  Plant& plant = simulation.board().plant();
  if (!truth_value(request, "holds")) {
    plant.let_go();
    return {};
  }
  const Hand& now = plant.hand();
  const Vector3 target_m = vector(request, "target_m", reach_m);
  const double stiffness =
      number_or(request, "stiffness_N_per_m", now.stiffness_N_per_m(), 0.0, Hand::stiffness_maximum_N_per_m);
  const double damping =
      number_or(request, "damping_Ns_per_m", now.damping_Ns_per_m(), 0.0, Hand::damping_maximum_Ns_per_m);
  plant.hold(target_m, stiffness, damping);
  return {};
}

json hand_path(const json& request, Simulation& simulation) {
  const json& points = at(request, "points", "a list of {\"after_s\":time,\"target_m\":[x,y,z]}");
  if (!points.is_array() || points.empty()) throw Refused("\"points\" must be a list of at least one point");
  std::vector<Waypoint> path;
  for (const json& point : points) {
    if (!point.is_object()) throw Refused("each of \"points\" must be {\"after_s\":time,\"target_m\":[x,y,z]}");
    const double earliest_s = path.empty() ? 0.0 : path.back().after_s;
    path.push_back({number(point, "after_s", earliest_s, 1e6), vector(point, "target_m", reach_m)});
  }
  simulation.board().plant().follow(path);
  return {};
}

PinName pin_of(const json& request) {
  const json& name = at(request, "pin", "a pin, such as \"PA5\"");
  if (!name.is_string()) throw Refused("\"pin\" must be a pin, such as \"PA5\"");
  try {
    return PinName::of(name.get<std::string>());
  } catch (const std::invalid_argument& error) {
    throw Refused(error.what());
  }
}

json pin(const json& request, Simulation& simulation) {
  const PinName place = pin_of(request);
  Chip& chip = simulation.board().chip();
  if (const auto level = request.find("drive"); level != request.end()) {
    if (*level != "high" && *level != "low" && *level != "floating")
      throw Refused("\"drive\" must be \"high\", \"low\" or \"floating\"");
    chip.input_pins().drive(place.port, place.pin,
                            *level == "high"  ? PinLevel::high
                            : *level == "low" ? PinLevel::low
                                              : PinLevel::floating);
  }
  return {{"level", name_of(chip.pin_level(place.port, place.pin))},
          {"chip_drives", name_of(chip.pin_output(place.port, place.pin))}};
}

json glitch(const json& request, Simulation& simulation) {
  const PinName place = pin_of(request);
  simulation.board().chip().glitch(place.port, place.pin, ticks(number(request, "for_s", 0.0, 1e3)));
  return {};
}

json gimbal(const json& request, Simulation& simulation) {
  simulation.board().plant().turn_gimbal(vector(request, "angles_rad", 20.0));
  return {};
}

json dock(const json& request, Simulation& simulation) {
  simulation.board().plant().dock(truth_value(request, "docked"));
  return {};
}

/// All that is said about a command: it is known, checked and explained by this alone.
struct Command {
  std::string_view name;
  std::vector<std::string_view> keys;  ///< that it knows besides "command"
  std::string_view help;
  json (*carry_out)(const json& request, Simulation& simulation);
  bool is_for_any_time = false;  ///< also in the middle of a frame
};

const std::vector<Command>& commands() {
  static const std::vector<Command> table = {
      {"status",
       {},
       "time, mode, resets, USB, whom board time waits for, faults in and to come, unmodelled registers",
       status,
       true},
      {"truth", {}, "every true quantity, the levels on the bridges' inputs included", truth},
      {"pause", {}, "board time stands still", pause},
      {"stand_by", {}, "it stands still, but passes while a USB control transfer is under way", stand_by},
      {"run", {"for_s"}, "it passes for a while; answered when that is over", run},
      {"resume", {}, "it passes freely", resume},
      {"reset", {}, "the reset pin", reset},
      {"cut_power",
       {"at_flash_operation"},
       "the power fails and is back at once: now, or in the middle of the so many-th word or sector that the flash is "
       "told to program or erase",
       cut_power},
      {"quit", {}, "the end of this program", quit, true},
      {"usb", {"connected"}, "plug or pull the cable, and with it VBUS", usb},
      {"buttons", {"pressed"}, "of the stylus: [true,false]", buttons},
      {"supply", {"voltage_V"}, "of the bridges", supply},
      {"pin", {"pin", "drive"}, "level at a pin, such as PA5; drives it high, low or floating from outside first", pin},
      {"glitch", {"pin", "for_s"}, "a pin is the opposite of what drives it, as by a spike on its wire", glitch},
      {"inject",
       {"fault", "of", "amount", "after_s", "for_s"},
       "put a fault of the list above in, at once or later, for ever or a while",
       inject},
      {"heal",
       {"fault", "of"},
       "take it out again, all of its name without \"of\", all that are in without both",
       heal},
      {"hand", {"holds", "target_m", "stiffness_N_per_m", "damping_Ns_per_m"}, "it pulls the probe, or lets go", hand},
      {"hand_path", {"points"}, "minimum jerk between [{\"after_s\":0.5,\"target_m\":[x,y,z]},...]", hand_path},
      {"gimbal", {"angles_rad"}, "turn the stylus: yaw, pitch, roll", gimbal},
      {"dock", {"docked"}, "lay the stylus into the inkwell, or take it out", dock},
      {"meter", {"action"}, "start or read: peak force on the hand, energy given to it, how far it was taken", meter},
      {"trace", {"action", "maximum"}, "start, stop or read the true quantities at every control period", trace},
  };
  return table;
}

json carry_out_checked(const std::string& line, Simulation& simulation, bool is_within_frame) {
  const json request = json::parse(line, nullptr, false);
  if (request.is_discarded() || !request.is_object())
    throw Refused("a command is one JSON object in one line, such as {\"command\":\"status\"}");
  const json& name = at(request, "command", "the name of a command, such as \"status\"");
  const auto command = std::ranges::find_if(commands(), [&](const Command& c) { return name == c.name; });
  if (command == commands().end()) {
    std::vector<std::string_view> names;
    for (const Command& c : commands()) names.push_back(c.name);
    throw Refused(fmt::format("there is no command {}; known are {}", name.dump(), fmt::join(names, ", ")));
  }
  for (const auto& [key, value] : request.items())
    if (key != "command" && std::ranges::find(command->keys, key) == command->keys.end())
      throw Refused(fmt::format("\"{}\" does not know the key \"{}\"; it knows {}", command->name, key,
                                command->keys.empty() ? "none" : fmt::format("{}", fmt::join(command->keys, ", "))));
  if (is_within_frame && !command->is_for_any_time)
    throw Refused(fmt::format("board time waits for {}, which has stopped; let it go on or end it, then ask again",
                              fmt::join(simulation.board().usb().late_hosts(), ", ")));
  return command->carry_out(request, simulation);
}

json answer(const std::string& line, Simulation& simulation, bool is_within_frame) {
  try {
    json reply = carry_out_checked(line, simulation, is_within_frame);
    reply["ok"] = true;
    return reply;
  } catch (const Refused& refused) {
    return {{"ok", false}, {"error", refused.what()}};
  }
}

}  // namespace

std::string explain_commands() {
  std::string text;
  for (const Command& command : commands()) {
    const std::string usage = fmt::format("{} {}", command.name, fmt::join(command.keys, " "));
    constexpr std::size_t column = 26;  // of the explanations
    text += usage.size() < column ? fmt::format("  {:<{}}{}\n", usage, column, command.help)
                                  : fmt::format("  {}\n  {:{}}{}\n", usage, "", column, command.help);
  }
  return text;
}

json carry_out(const std::string& line, Simulation& simulation) { return answer(line, simulation, false); }
json carry_out_within_frame(const std::string& line, Simulation& simulation) { return answer(line, simulation, true); }

}  // namespace inkwell::virtual_board
