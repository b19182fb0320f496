// Opens the arm of INKWELL_DEVICE, executes one command through the C or the C++ interface and prints `returned`. The
// last argument selects how the program exits. Usage: ending c|cpp COMMAND close|exit|kill|wait
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

#include <inkwell/inkwell.hpp>

namespace {

using inkwell::require;

constexpr inkwell_sphere ball{{0, 0, -0.5}, 0.01, {800, 2, 0, 0, 5}};

const std::map<std::string, void (*)(inkwell_arm*)> in_c{
    {"stop", [](inkwell_arm* arm) { require(inkwell_stop(arm)); }},
    {"disable",
     [](inkwell_arm* arm) {
       require(inkwell_enable_force(arm, 30));
       require(inkwell_disable_force(arm));
     }},
    {"clear", [](inkwell_arm* arm) { require(inkwell_clear_fault(arm)); }},
    {"set",
     [](inkwell_arm* arm) {
       const char* const name = "wall_stiffness_N_per_m";
       const double value = 777;
       require(inkwell_set_parameters(arm, &name, &value, 1));
     }},
    {"store", [](inkwell_arm* arm) { require(inkwell_store_parameters(arm)); }},
    {"shapes", [](inkwell_arm* arm) { require(inkwell_place_shapes(arm, nullptr, 0, &ball)); }},
};

const std::map<std::string, void (*)(inkwell::Arm&)> in_cpp{
    {"stop", [](inkwell::Arm& arm) { arm.stop(); }},
    {"disable",
     [](inkwell::Arm& arm) {
       arm.enable_force(30);
       arm.disable_force();
     }},
    {"clear", [](inkwell::Arm& arm) { arm.clear_fault(); }},
    {"set", [](inkwell::Arm& arm) { arm.set_parameter("wall_stiffness_N_per_m", 777); }},
    {"store", [](inkwell::Arm& arm) { arm.store_parameters(); }},
    {"shapes", [](inkwell::Arm& arm) { require(inkwell_place_shapes(arm.get(), nullptr, 0, &ball)); }},
};

void end(const std::string& ending) {
  std::puts("returned");
  std::fflush(stdout);
  if (ending == "exit") std::exit(0);
  if (ending == "kill") std::raise(SIGKILL);
  if (ending == "wait") pause();
}

}  // namespace

int main(int, char** arguments) {
  const std::string interface = arguments[1], command = arguments[2], ending = arguments[3];
  try {
    if (interface == "c") {
      inkwell_arm* arm = nullptr;
      require(inkwell_open(nullptr, &arm));
      in_c.at(command)(arm);
      if (ending == "close") require(inkwell_close(arm));
      end(ending);
    } else {
      auto* arm = new inkwell::Arm;  // exit() leaves the arm open
      in_cpp.at(command)(*arm);
      if (ending == "close") delete arm;
      end(ending);
    }
  } catch (const std::exception& error) {
    std::puts(error.what());
    return 1;
  }
}
