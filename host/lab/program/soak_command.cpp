#include "host/lab/program/commands.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "host/client/command_line/help.hpp"
#include "host/client/command_line/interrupt.hpp"
#include "host/client/local/output.hpp"
#include "host/client/recording/write_text.hpp"
#include "host/lab/program/parallel.hpp"
#include "host/lab/soak/result.hpp"
#include "host/lab/soak/run.hpp"

namespace inkwell::lab {
namespace {

using namespace command_line;

constexpr double default_board_time_s = 60;

struct SoakOptions {
  soak::Choices choices;
  /// Total of all sittings. The default is default_board_time_s, or one complete sitting if `sitting` is set.
  std::optional<double> board_time_s;
  unsigned jobs = 1;
  std::optional<unsigned> sitting;  ///< runs only this sitting
  std::string file;
};

struct Plan {
  soak::Choices choices;
  std::vector<unsigned> numbers;  ///< numbers of the sittings
};

/// All sittings have the same length. The plan does not depend on the number of jobs.
Plan plan_of(const SoakOptions& command) {
  if (command.sitting && !command.board_time_s) return {command.choices, {*command.sitting}};
  const double board_time_s = command.board_time_s.value_or(default_board_time_s);
  const unsigned count = soak::sittings_in(board_time_s, command.choices);
  Plan plan{command.choices, std::vector<unsigned>(count)};
  plan.choices.sitting_s = board_time_s / count;
  std::iota(plan.numbers.begin(), plan.numbers.end(), 1u);
  if (!command.sitting) return plan;
  if (*command.sitting > count)
    throw UsageError(
        fmt::format("A soak of --seconds {} has only {} sittings. Give a smaller number, or increase --seconds.",
                    board_time_s, count));
  plan.numbers = {*command.sitting};
  return plan;
}

/// Throws device::Error if the file cannot be written. Does not change an existing file.
void check_writable(const std::string& file) {
  std::error_code ignored;
  const bool was_there = std::filesystem::exists(file, ignored);
  if (!std::ofstream(file, std::ios::app))
    throw device::Error(fmt::format("{} cannot be written. Choose another file with --out.", file));
  if (!was_there) std::filesystem::remove(file, ignored);
}

struct Outcome {
  soak::Soak soak;
  std::string trouble;
};

/// Runs each sitting on a separate board. Ctrl-C stops running sittings.
Outcome run_sittings(const DeviceOptions& options, const SoakOptions& command) {
  const auto board = options.virtual_board(device::SimulationMode::fast, BoardPace::as_asked);
  const auto [choices, numbers] = plan_of(command);
  Outcome outcome{{choices.seed, choices.sitting_s, choices.use_s, false, {}}, ""};
  std::vector<soak::Sitting> sittings(numbers.size());
  std::mutex printing;
  const InterruptGuard interrupt;
  const auto is_stopped = [&] { return interrupt.is_interrupted(); };
  const auto print_text = [&](const std::string& text) {
    if (options.json) return;
    const std::lock_guard lock(printing);
    fmt::print("{}", text);
    local::flush_output();
  };
  run_in_parallel(command.jobs, numbers.size(), [&](std::size_t i) {
    if (is_stopped()) return false;
    try {
      sittings[i] = soak::run_sitting(numbers[i], choices, board, print_text, is_stopped);
      return true;
    } catch (const std::exception& error) {
      const std::lock_guard lock(printing);
      outcome.trouble = fmt::format("Sitting {}: {}", numbers[i], error.what());
      return false;
    }
  });
  outcome.soak.stopped = is_stopped() || !outcome.trouble.empty();
  std::ranges::copy_if(sittings, std::back_inserter(outcome.soak.sittings),
                       [](const soak::Sitting& sitting) { return sitting.number != 0; });
  return outcome;
}

int run_soak(const DeviceOptions& options, const SoakOptions& command) {
  if (!command.file.empty()) check_writable(command.file);
  const auto [result, trouble] = run_sittings(options, command);
  const bool is_known = trouble.empty() || !result.sittings.empty();
  if (!command.file.empty() && is_known) recording::write_text(command.file, soak::json_of(result));
  if (!trouble.empty()) throw device::Error(trouble);
  fmt::print("{}", options.json ? soak::json_of(result) : soak::table_of(result));
  return soak::finding_count(result) > 0 ? 1 : 0;
}

}  // namespace

void add_soak_command(const CommandContext& context) {
  const auto options = std::make_shared<SoakOptions>();
  auto* command = context.program.add_subcommand(
      "soak",
      "Tests virtual boards with random use, faults, unplugged cables and parameter changes\n"
      "Ctrl-C stops the soak and prints the results so far. Exit code 1: the soak found a problem.");
  // tools/lab/soak passes its default options before the user's options. The last value of an option takes precedence.
  command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  const auto positive = number_within(0.1, 1e6);
  command->add_option("--seconds", options->board_time_s, "Total board time, divided equally among the boards")
      ->check(positive)
      ->type_name("SECONDS")
      ->default_str(fmt::format("{:.0f}", default_board_time_s));
  command->add_option("--jobs", options->jobs, "Number of boards to run in parallel")
      ->check(whole_number_within(1, 256))
      ->type_name("NUMBER")
      ->capture_default_str();
  command->add_option("--seed", options->choices.seed, "Seed of all random choices")
      ->type_name("NUMBER")
      ->capture_default_str();
  command->add_option("--sitting", options->sitting, "Run only the board with this number, for its share of --seconds")
      ->check(whole_number_within(1, 1000000))
      ->type_name("NUMBER");
  command->add_option("--sitting-seconds", options->choices.sitting_s, "Maximum board time of one board")
      ->check(positive)
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_option("--use-seconds", options->choices.use_s, "Longest use in one phase")
      ->check(positive)
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_option("--out", options->file, "JSON file for the result")->type_name("FILE");
  add_lab_examples(*command,
                   "inkwell-lab soak --seconds 3600 --jobs 8 --out soak.json\n"
                   "inkwell-lab soak --seed 1 --sitting 3");
  command->callback([context, options] {
    context.action = [&device = context.device, options] { return run_soak(device, *options); };
  });
}

}  // namespace inkwell::lab
