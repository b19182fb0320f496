// Command loop of the C++ programs for losses_test.py.
#pragma once

#include <exception>
#include <iostream>
#include <sstream>
#include <string>

namespace inkwell::tests {

/// Calls `carry_out` with each line of the standard input until the input ends. `carry_out` prints the answer. If
/// `carry_out` throws an exception, the answer is "error ...".
template <class CarryOut>
void answer_commands(CarryOut carry_out) {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    try {
      carry_out(words);
    } catch (const std::exception& error) {
      std::cout << "error " << error.what() << std::endl;
    }
  }
}

}  // namespace inkwell::tests
