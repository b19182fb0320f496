#include "boards/virtual/program/injection_commands.hpp"

#include <string>

#include <fmt/format.h>
#include "boards/virtual/program/requests.hpp"

namespace inkwell::virtual_board {

using nlohmann::json;

namespace {

json describe(unsigned number, const Injection& injection) {
  const auto& info = protocol::info(injection.fault);
  json described{{"number", number}, {"fault", info.name}};
  if (!injection.of.empty()) described["of"] = injection.of;
  if (info.has_amount()) described["amount"] = injection.amount;
  return described;
}

json describe(const Injector::Active& active) {
  json described = virtual_board::describe(active.number, active.injection);
  described["since_s"] = seconds(active.since);
  if (active.until) described["until_s"] = seconds(*active.until);
  return described;
}

json describe(const Injector::Planned& planned) {
  json described = virtual_board::describe(planned.number, planned.injection);
  described["at_s"] = seconds(planned.at);
  if (planned.injection.for_s) described["until_s"] = seconds(planned.at) + *planned.injection.for_s;
  return described;
}

}  // namespace

json injected(Board& board) {
  json list = json::array();
  for (const Injector::Active& active : board.injector().active()) list.push_back(describe(active));
  return list;
}

json still_to_come(Board& board) {
  json list = json::array();
  for (const Injector::Planned& planned : board.injector().planned()) list.push_back(describe(planned));
  return list;
}

json inject(const json& request, Simulation& simulation) {
  Board& board = simulation.board();
  try {
    const Injection injection = checked(injection_request(request), board.facts());
    if (injection.fault == protocol::InjectedFault::program_astray && board.locked_up())
      throw Refused("the processor is locked up; reset the board first");
    const unsigned number = board.injector().add(injection);
    return {{"at_s", seconds(board.chip().now()) + injection.after_s}, {"number", number}};
  } catch (const InvalidInjection& error) {
    throw Refused(error.what());
  }
}

json heal(const json& request, Simulation& simulation) {
  Injector& injector = simulation.board().injector();
  if (!request.contains("fault")) {
    if (request.contains("of")) throw Refused("\"of\" requires \"fault\"; omit both to heal all faults");
    const std::size_t healed = injector.active().size();
    injector.heal_all();
    return {{"healed", healed}};
  }
  try {
    const protocol::InjectionRequest wanted = injection_request(request);
    const auto fault = protocol::find_injection(wanted.fault);
    // A request without a position clears the fault at every position.
    const std::string of = fault && wanted.of.empty() ? wanted.of : checked(wanted, simulation.board().facts()).of;
    const unsigned healed = injector.heal(fault.value(), of);
    if (healed == 0)
      throw Refused(fmt::format("{}{}{} is not active or planned; status lists the injected faults", wanted.fault,
                                of.empty() ? "" : " ", of));
    return {{"healed", healed}};
  } catch (const InvalidInjection& error) {
    throw Refused(error.what());
  }
}

}  // namespace inkwell::virtual_board
