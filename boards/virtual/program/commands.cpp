#include "boards/virtual/program/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include "boards/virtual/program/requests.hpp"

#include "boards/virtual/program/injection_commands.hpp"
#include "boards/virtual/program/simulation.hpp"
#include "boards/virtual/program/truth_commands.hpp"

namespace inkwell::virtual_board {
namespace {

using nlohmann::json;

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
  if (simulation.is_running_for()) throw Refused("another run is in progress; wait for its reply, or send pause");
  if (simulation.board().locked_up() && !simulation.options().seconds)
    throw Refused("the processor is locked up; reset the board first");
  simulation.run_for(run_time_s(request));
  return {};
}

json stand_by(const json&, Simulation& simulation) {
  simulation.stand_by();
  return {{"board_time_s", seconds(simulation.board().chip().now())}};
}

json resume(const json&, Simulation& simulation) {
  if (simulation.is_running_for()) throw Refused("a run is in progress; wait for its reply, or send pause");
  if (simulation.board().locked_up()) throw Refused("the processor is locked up; reset the board first");
  simulation.resume();
  return {};
}

json reset(const json&, Simulation& simulation) {
  simulation.board().reset();
  return {};
}

json cut_power(const json& request, Simulation& simulation) {
  Chip& chip = simulation.board().chip();
  if (const auto operation = flash_operation(request))
    chip.cut_power_at_flash_operation(*operation);
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
  const auto [first, second] = pressed_buttons(request);
  simulation.board().plant().press_buttons(first, second);
  return {};
}

json supply(const json& request, Simulation& simulation) {
  simulation.board().plant().set_supply_V(supply_voltage_V(request));
  return {};
}

json hand(const json& request, Simulation& simulation) {
  Plant& plant = simulation.board().plant();
  const HandRequest requested_hand = hand_request(request);
  if (!requested_hand.holds) {
    plant.let_go();
    return {};
  }
  const Hand& now = plant.hand();
  plant.hold(requested_hand.target_m, requested_hand.stiffness_N_per_m.value_or(now.stiffness_N_per_m()),
             requested_hand.damping_Ns_per_m.value_or(now.damping_Ns_per_m()));
  return {};
}

json hand_path(const json& request, Simulation& simulation) {
  simulation.board().plant().follow(hand_path_request(request));
  return {};
}

json pin(const json& request, Simulation& simulation) {
  const PinName pin_name = pin_of(request);
  Chip& chip = simulation.board().chip();
  if (const auto level = pin_drive(request)) chip.input_pins().drive(pin_name.port, pin_name.pin, *level);
  return {{"level", name_of(chip.pin_level(pin_name.port, pin_name.pin))},
          {"chip_drives", name_of(chip.pin_output(pin_name.port, pin_name.pin))}};
}

json glitch(const json& request, Simulation& simulation) {
  const PinName pin_name = pin_of(request);
  simulation.board().chip().glitch(pin_name.port, pin_name.pin, ticks(glitch_time_s(request)));
  return {};
}

json gimbal(const json& request, Simulation& simulation) {
  simulation.board().plant().turn_gimbal(gimbal_angles_rad(request));
  return {};
}

json dock(const json& request, Simulation& simulation) {
  simulation.board().plant().dock(truth_value(request, "docked"));
  return {};
}

json carry_out(Command command, const json& request, Simulation& simulation) {
  switch (command) {
    case Command::status: return status(request, simulation);
    case Command::truth: return truth(request, simulation);
    case Command::pause: return pause(request, simulation);
    case Command::stand_by: return stand_by(request, simulation);
    case Command::run: return run(request, simulation);
    case Command::resume: return resume(request, simulation);
    case Command::reset: return reset(request, simulation);
    case Command::cut_power: return cut_power(request, simulation);
    case Command::quit: return quit(request, simulation);
    case Command::usb: return usb(request, simulation);
    case Command::buttons: return buttons(request, simulation);
    case Command::supply: return supply(request, simulation);
    case Command::pin: return pin(request, simulation);
    case Command::glitch: return glitch(request, simulation);
    case Command::inject: return inject(request, simulation);
    case Command::heal: return heal(request, simulation);
    case Command::hand: return hand(request, simulation);
    case Command::hand_path: return hand_path(request, simulation);
    case Command::gimbal: return gimbal(request, simulation);
    case Command::dock: return dock(request, simulation);
    case Command::meter: return meter(request, simulation);
    case Command::trace: return trace(request, simulation);
  }
  return {};
}

json carry_out_checked(const std::string& line, Simulation& simulation, bool is_within_frame) {
  const Request request = read_request(line);
  if (is_within_frame && !request.info->is_for_any_time)
    throw Refused(
        fmt::format("board time waits for {}, which has stopped; continue or end this program, then repeat the command",
                    fmt::join(simulation.board().usb().late_hosts(), ", ")));
  return carry_out(request.info->command, request.values, simulation);
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

json carry_out(const std::string& line, Simulation& simulation) { return answer(line, simulation, false); }
json carry_out_within_frame(const std::string& line, Simulation& simulation) { return answer(line, simulation, true); }

}  // namespace inkwell::virtual_board
