#include "commands.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include <recording/write_text.hpp>
#include <soak/result.hpp>
#include <soak/run.hpp>

#include "help.hpp"

namespace inkwell::command_line {
namespace {

struct SoakOptions {
  soak::Choices choices;
  double board_time_s = 60;
  unsigned jobs = 1;
  std::optional<unsigned> sitting;  ///< this one alone
  std::string file;
};

std::vector<unsigned> numbers_of(const SoakOptions& command) {
  if (command.sitting) return {*command.sitting};
  std::vector<unsigned> numbers(soak::sittings_in(command.board_time_s, command.choices));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<unsigned>(i + 1);
  return numbers;
}

/// Before an hour of work, not after it.
void check_writable(const SoakOptions& command) {
  if (!command.file.empty()) recording::write_text(command.file, "");
}

/// Each on a board of its own; as many at once as there are jobs.
std::vector<soak::Sitting> run_sittings(const DeviceOptions& options, const SoakOptions& command) {
  const auto board = options.virtual_board(device::SimulationMode::fast, BoardPace::as_asked);
  const std::vector<unsigned> numbers = numbers_of(command);
  std::vector<soak::Sitting> sittings(numbers.size());
  std::atomic<std::size_t> next{0};
  std::mutex telling;
  std::string trouble;
  const auto tell = [&](const std::string& text) {
    if (options.json) return;
    const std::lock_guard lock(telling);
    fmt::print("{}", text);
    std::fflush(stdout);
  };
  const auto work = [&] {
    for (std::size_t i; (i = next++) < numbers.size();) try {
        sittings[i] = soak::run_sitting(numbers[i], command.choices, board, tell);
      } catch (const std::exception& error) {  // of a thread it would end the program
        const std::lock_guard lock(telling);
        trouble = fmt::format("Sitting {}: {}", numbers[i], error.what());
        next = numbers.size();
      }
  };
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < command.jobs; ++i) workers.emplace_back(work);
  for (auto& worker : workers) worker.join();
  if (!trouble.empty()) throw device::Error(trouble);
  return sittings;
}

int run_soak(const DeviceOptions& options, const SoakOptions& command) {
  check_writable(command);
  const soak::Soak result{command.choices.seed, command.choices.sitting_s, command.choices.use_s,
                          run_sittings(options, command)};
  if (!command.file.empty()) recording::write_text(command.file, soak::json_of(result));
  fmt::print("{}", options.json ? soak::json_of(result) : soak::table_of(result));
  return soak::finding_count(result) > 0 ? 1 : 0;
}

}  // namespace

void add_soak_command(const Place& place) {
  const auto options = std::make_shared<SoakOptions>();
  auto* command = place.program.add_subcommand(
      "soak",
      "Random use, faults, pulled cables and storms of parameters on virtual boards, judged all along.\n"
      "Exit code 1: something was found.");
  const auto positive = CLI::Range(0.1, 1e6).description("");
  command->add_option("--seconds", options->board_time_s, "Board time of all boards together")
      ->check(positive)
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_option("--jobs", options->jobs, "So many boards at once")
      ->check(CLI::Range(1, 256))
      ->type_name("NUMBER")
      ->capture_default_str();
  command->add_option("--seed", options->choices.seed, "Of all that is random")
      ->type_name("NUMBER")
      ->capture_default_str();
  command->add_option("--sitting", options->sitting, "Only this board of the seed, from its start, as it went before")
      ->check(CLI::Range(1, 1000000).description(""))
      ->type_name("NUMBER");
  command->add_option("--sitting-seconds", options->choices.sitting_s, "Board time of one board, at least")
      ->check(positive)
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_option("--use-seconds", options->choices.use_s, "The longest use in a phase")
      ->check(positive)
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_option("--out", options->file, "JSON file of the result")->type_name("FILE");
  add_examples(*command,
               "inkwell soak --seconds 3600 --jobs 8 --out soak.json\n"
               "inkwell soak --seed 1 --sitting 3");
  command->callback(
      [place, options] { place.action = [&device = place.device, options] { return run_soak(device, *options); }; });
}

}  // namespace inkwell::command_line
