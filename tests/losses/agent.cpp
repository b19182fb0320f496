// Executes the commands of losses_test.py through the C++ interface.
#include <iostream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include <inkwell/inkwell.hpp>

#include "tests/losses/answer_commands.hpp"

namespace {

constexpr int pushes = 30;
std::optional<inkwell::Arm> arm;

void enable() {
  arm->clear_fault();
  arm->enable_force(30);
}

void push(double force_N) {
  for (int i = 0; i < pushes; ++i) {
    try {
      arm->wait_for_pose(0.05);
    } catch (const inkwell::Failure&) {  // set_force() must report the loss
    }
    arm->set_force({force_N, 0, 0});
  }
}

void carry_out(std::istringstream& words) {
  std::string name, address;
  double force_N = 0;
  words >> name;
  if (name == "open" && words >> address) {
    arm.emplace(address);
    enable();
  } else if (!arm) {
    throw std::runtime_error("The arm is closed.");
  } else if (name == "enable") {
    enable();
  } else if (name == "pose") {
    const double x_m = arm->pose().position_m[0];
    std::cout << "ok " << x_m << std::endl;
    return;
  } else if (name == "push" && words >> force_N) {
    push(force_N);
  } else if (name == "close") {
    arm.reset();
  }
  std::cout << "ok" << std::endl;
}

}  // namespace

int main() {
  inkwell::tests::answer_commands([](std::istringstream& words) {
    try {
      carry_out(words);
    } catch (const inkwell::Disconnected& lost) {
      throw std::runtime_error(std::to_string(lost.last_pose.position_m[0]) + " " + lost.what());
    } catch (const std::exception& error) {
      throw std::runtime_error(std::string("0 ") + error.what());
    }
  });
}
