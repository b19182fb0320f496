#include "host/lab/program/commands.hpp"

#include <filesystem>
#include <mutex>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/local/output.hpp"
#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/expected.hpp"
#include "host/lab/campaign/page.hpp"
#include "host/lab/campaign/result.hpp"
#include "host/lab/campaign/run.hpp"
#include "host/lab/program/parallel.hpp"

namespace inkwell::lab {
namespace {

using namespace command_line;

using campaign::Case;

struct CampaignOptions {
  std::vector<unsigned> numbers;
  std::string folder = "campaign-results";
  std::string page = "docs/campaign.md";
  unsigned jobs = 1;
  bool only_numbers = false;
};

int list_cases(const DeviceOptions& options, const CampaignOptions& command) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Case& c : campaign::all_cases()) {
    if (options.json)
      json.push_back({{"number", c.number},
                      {"fault", c.fault.name()},
                      {"situation", campaign::name_of(c.situation)},
                      {"phase", c.phase}});
    else if (command.only_numbers)
      fmt::print("{}\n", c.number);
    else
      fmt::print("{:5} {}\n", c.number, c.name());
  }
  if (options.json) fmt::print("{}\n", json.dump(1));
  return 0;
}

/// Creates a folder. An error names the command-line `option`.
void make_folder(const std::filesystem::path& folder, std::string_view option) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (!std::filesystem::is_directory(folder))
    throw device::Error(fmt::format("The folder {} cannot be created: {}. Choose another folder with {}.",
                                    folder.string(), code.message(), option));
}

/// Creates the folder before the cases run, so that an invalid folder is reported immediately.
void make_folder_of_page(const CampaignOptions& command) {
  make_folder(campaign::folder_of_details(command.page), "--page");
}

void print_result(const Case& the_case, const campaign::Result& result) {
  const std::string off = result.off_after_s
                              ? fmt::format("off after {:.3f} ms", 1e3 * *result.off_after_s)
                              : std::string(result.bridges_were_on ? "bridges stayed on" : "bridges were off");
  const std::string location = result.location.empty() ? "" : " at " + result.location;
  const std::string text = campaign::fault_text(result);
  fmt::print("{:5} {}{}: {}\n", the_case.number, the_case.name(), location,
             result.error.empty() ? fmt::format("{}, {}, {:.2f} N, {}", text.empty() ? "-" : text, off,
                                                result.peak_force_N, campaign::name_of(result.recovery))
                                  : result.error);
  local::flush_output();
}

/// Runs each case on a separate board. Returns exit code 1 if a case could not be run.
int run_cases(const DeviceOptions& options, const CampaignOptions& command, const std::vector<Case>& cases) {
  make_folder(command.folder, "--out");
  const auto board = options.virtual_board(device::SimulationMode::fast, BoardPace::as_asked);
  std::size_t failed = 0;
  std::mutex printing;
  std::string trouble;
  run_in_parallel(command.jobs, cases.size(), [&](std::size_t i) {
    try {
      const auto result = campaign::run_case(cases[i], board);
      campaign::save(result, command.folder);
      const std::lock_guard lock(printing);
      if (!result.error.empty()) ++failed;
      print_result(cases[i], result);
      return true;
    } catch (const std::exception& error) {
      const std::lock_guard lock(printing);
      trouble = error.what();
      return false;
    }
  });
  if (!trouble.empty()) throw device::Error(trouble);
  return failed > 0 ? 1 : 0;
}

int run_chosen(const DeviceOptions& options, const CampaignOptions& command) {
  const auto all = campaign::all_cases();
  std::vector<Case> cases;
  for (const unsigned number : command.numbers) {
    if (number < 1 || number > all.size())
      throw UsageError(
          fmt::format("There is no case {}. Give a number from 1 to {}; `inkwell-lab campaign list` shows all cases.",
                      number, all.size()));
    cases.push_back(all[number - 1]);
  }
  return run_cases(options, command, cases);
}

int merge_results(const CampaignOptions& command) {
  const auto results = campaign::load_all(command.folder);
  if (!results.empty()) make_folder_of_page(command);
  campaign::write_page(results, command.page);
  fmt::print("{} of {} cases: {}\n", results.size(), campaign::all_cases().size(), command.page);
  return 0;
}

int run_missing(const DeviceOptions& options, const CampaignOptions& command) {
  make_folder(command.folder, "--out");
  make_folder_of_page(command);
  campaign::load_all(command.folder);  // reports unreadable files before hours of cases instead of after them
  std::vector<Case> missing;
  for (const Case& c : campaign::all_cases())
    if (!std::filesystem::exists(campaign::file_of(command.folder, c.number))) missing.push_back(c);
  const int exit_code = run_cases(options, command, missing);
  merge_results(command);
  return exit_code;
}

/// Returns the results in the order of the cases.
std::vector<campaign::Result> results_of(const DeviceOptions& options, unsigned jobs, const std::vector<Case>& cases) {
  const auto board = options.virtual_board(device::SimulationMode::fast, BoardPace::as_asked);
  std::vector<campaign::Result> results(cases.size());
  run_in_parallel(jobs, cases.size(), [&](std::size_t i) {
    try {
      results[i] = campaign::run_case(cases[i], board);
    } catch (const std::exception& error) {
      results[i].error = error.what();
    }
    return true;
  });
  return results;
}

/// Runs the expected cases and their fault-free cases. Returns exit code 1 if a result differs from the expectation.
int check_known(const DeviceOptions& options, const CampaignOptions& command) {
  const auto expected = campaign::expected_cases();
  std::vector<Case> cases;
  for (const campaign::Expected& each : expected) cases.push_back(campaign::case_named(each.name));
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (const std::string name = campaign::fault_free_name(cases[i]); !name.empty())
      cases.push_back(campaign::case_named(name));
  const auto results = results_of(options, command.jobs, cases);
  const auto energy_without_fault_J = [&](const Case& the_case) {
    const std::string name = campaign::fault_free_name(the_case);
    for (std::size_t i = expected.size(); i < cases.size(); ++i)
      if (cases[i].name() == name) return results[i].energy_J;
    return 0.0;
  };
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  bool differs = false;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto found = campaign::deviations(expected[i], results[i], energy_without_fault_J(cases[i]));
    differs |= !found.empty();
    if (options.json)
      json.push_back({{"number", cases[i].number}, {"name", expected[i].name}, {"differences", found}});
    else
      fmt::print("{:5} {}: {}\n", cases[i].number, expected[i].name,
                 found.empty() ? "as expected" : fmt::format("{}", fmt::join(found, " ")));
  }
  if (options.json) fmt::print("{}\n", json.dump(1));
  return differs ? 1 : 0;
}

void add_folder(CLI::App& command, CampaignOptions& options) {
  command.add_option("--out", options.folder, "Folder for the results, with one file per case")
      ->type_name("FOLDER")
      ->capture_default_str();
}

void add_page(CLI::App& command, CampaignOptions& options) {
  command
      .add_option("--page", options.page, "Summary page to write; a folder with its name gets the details and plots")
      ->type_name("FILE")
      ->capture_default_str();
}

void add_jobs(CLI::App& command, CampaignOptions& options) {
  command.add_option("--jobs", options.jobs, "Number of cases to run in parallel")
      ->check(whole_number_within(1, 256))
      ->type_name("NUMBER")
      ->capture_default_str();
}

}  // namespace

void add_campaign_command(const CommandContext& context) {
  const auto options = std::make_shared<CampaignOptions>();
  auto* command = context.program.add_subcommand(
      "campaign",
      "Runs every fault in every situation on virtual boards, and writes the results as pages\n"
      "Without a subcommand, runs the cases that have no result yet, then writes the pages.");
  command->require_subcommand(0, 1);
  add_folder(*command, *options);
  add_jobs(*command, *options);
  add_page(*command, *options);
  add_lab_examples(
      *command,
      "inkwell-lab campaign --jobs 8\n"
      "inkwell-lab campaign list --numbers | parallel -S one,two inkwell-lab campaign run {} --out /shared/results\n"
      "inkwell-lab campaign merge /shared/results --page docs/campaign.md");
  command->callback([context, command, options] {
    if (command->get_subcommands().empty())
      context.action = [&device = context.device, options] { return run_missing(device, *options); };
  });

  auto* listed = command->add_subcommand("list", "Lists the cases with their numbers");
  listed->add_flag("--numbers", options->only_numbers, "Print only the numbers, for GNU parallel and batch systems");
  add_lab_examples(*listed, "inkwell-lab campaign list\ninkwell-lab campaign list --numbers");
  listed->callback([context, options] {
    context.action = [&device = context.device, options] { return list_cases(device, *options); };
  });

  auto* runs = command->add_subcommand("run", "Runs cases by number and writes one result file per case");
  runs->add_option("case", options->numbers, "Case numbers")->required()->type_name("NUMBER");
  add_folder(*runs, *options);
  add_jobs(*runs, *options);
  add_lab_examples(
      *runs, "inkwell-lab campaign run 17 --out results\ninkwell-lab campaign run 17 18 19 --jobs 3 --out results");
  runs->callback([context, options] {
    context.action = [&device = context.device, options] { return run_chosen(device, *options); };
  });

  auto* checks = command->add_subcommand(
      "check",
      "Runs the cases with a known detection, and lists results that differ\n"
      "Exit code 1: a fault was detected too late or as another fault, or its effect was too large.");
  add_jobs(*checks, *options);
  add_lab_examples(*checks, "inkwell-lab campaign check --jobs 8");
  checks->callback([context, options] {
    context.action = [&device = context.device, options] { return check_known(device, *options); };
  });

  auto* merges = command->add_subcommand("merge", "Writes the pages from the existing results");
  merges->add_option("results", options->folder, "Folder with the results")->required()->type_name("FOLDER");
  add_page(*merges, *options);
  add_lab_examples(*merges, "inkwell-lab campaign merge results --page docs/campaign.md");
  merges->callback([context, options] { context.action = [options] { return merge_results(*options); }; });
}

}  // namespace inkwell::lab
