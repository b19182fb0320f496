#include "host/companion/command_line/program.hpp"

int main(int argument_count, char** arguments) { return inkwell::command_line::run(argument_count, arguments); }
