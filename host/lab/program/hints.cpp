#include "host/client/command_line/help.hpp"

#include "host/lab/program/commands.hpp"

namespace inkwell::lab {

void add_lab_examples(CLI::App& command, const std::string& examples) {
  command_line::add_examples(command, examples,
                             "The command starts its virtual boards itself; choose the board, the firmware image and "
                             "the arm with --board,\n"
                             "--elf and --arm. --json prints JSON for programs. `inkwell-lab --help` describes these "
                             "options and the exit codes.");
}

}  // namespace inkwell::lab
