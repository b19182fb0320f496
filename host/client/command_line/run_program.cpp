#include "host/client/command_line/run_program.hpp"

#include <exception>

#include <fmt/format.h>
#include "host/client/device/address.hpp"
#include "protocol/plain_text.hpp"

#include "host/client/command_line/connection.hpp"
#include "host/client/command_line/help.hpp"
#include "host/client/command_line/wrong_value.hpp"
#include "host/client/local/output.hpp"

namespace inkwell::command_line {
namespace {

constexpr int success = 0, failure = 1, wrong_usage = 2;

int complain(const CLI::App& program, const std::exception& error, int exit_code) {
  local::print_error("{}: {}\n", program.get_name(), protocol::plain_lines(error.what()));
  return exit_code;
}

int run_unchecked(CLI::App& program, int argument_count, char** arguments, const Action& action,
                  const std::function<void()>& check) {
  try {
    program.parse(argument_count, arguments);
    if (check) check();
  } catch (const UsageError& error) {
    return complain(program, error, wrong_usage);
  } catch (const CLI::RequiredError& error) {
    return complain(program, UsageError(wrong_command(program).value_or(error.what())), wrong_usage);
  } catch (const CLI::ExtrasError& error) {
    const auto sentence = wrong_command(program);
    return complain(program, UsageError(sentence ? *sentence : sentence_of(program, error)), wrong_usage);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return complain(program, UsageError(sentence_of(program, error)), wrong_usage);
    program.exit(error);  // prints the help or the version
    return success;
  }
  try {
    return action();
  } catch (const UsageError& error) {
    return complain(program, error, wrong_usage);
  } catch (const device::SeveralArms& error) {
    return complain(program, device::NoDevice(fmt::format("{} Choose one with --serial NUMBER.", error.what())),
                    failure);
  } catch (const std::exception& error) {
    if (local::is_output_lost()) return failure;  // the caller reports the reason
    return complain(program, error, failure);
  }
}

}  // namespace

int run_program(CLI::App& program, int argument_count, char** arguments, const Action& action,
                const std::function<void()>& check) {
  const int exit_code = run_unchecked(program, argument_count, arguments, action, check);
  return local::checked_exit_code(program.get_name(), exit_code);
}

}  // namespace inkwell::command_line
