// Runs an HDAPI or libhdPhantom program with the drop-in libraries.
#include "host/companion/command_line/commands.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "host/client/command_line/help.hpp"
#include "host/client/installation/installed_paths.hpp"
#include "host/client/local/ending_signals.hpp"
#include "host/client/local/interruption.hpp"
#include "host/client/local/output.hpp"

#include "host/companion/command_line/program_arms.hpp"
#include "host/companion/command_line/program_libraries.hpp"

namespace inkwell::command_line {
namespace {

constexpr int killed_by = 128;  // as shells report a signal
constexpr int passed_on[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2};

volatile std::sig_atomic_t program_process = 0, early_signal = 0;

/// Forwards signals from other processes to the started program. The terminal sends its signals directly to the
/// program.
void pass_on(int signal, siginfo_t* information, void*) {
  if (information->si_code == SI_KERNEL) return;
  if (program_process == 0)
    early_signal = signal;
  else
    kill(program_process, signal);
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

/// Exit code of a program for which the dynamic linker has not found a library.
constexpr int library_missing = 127;

/// Returns the status of the program. Prints a warning if the program loads another device library.
int wait_for_end(pid_t process, const std::filesystem::path& libraries) {
  using namespace std::chrono_literals;
  constexpr auto first_checks = 40;
  int status = 0;
  for (int checks = 0;; ++checks) {
    if (local::repeat_interrupted([&] { return waitpid(process, &status, WNOHANG); }) != 0) return status;
    if (const auto library = loaded_device_library(process, libraries)) {
      if (library->parent_path() != std::filesystem::canonical(libraries))
        local::print_error(
            "inkwell: the program has loaded {}, not the library of this arm, so the program does not get the "
            "arm. A DT_RPATH of the program is searched before LD_LIBRARY_PATH. Remove it with `patchelf "
            "--remove-rpath`, or link the program with -Wl,--enable-new-dtags.\n",
            library->string());
      break;
    }
    std::this_thread::sleep_for(checks < first_checks ? 50ms : 500ms);
  }
  local::repeat_interrupted([&] { return waitpid(process, &status, 0); });
  return status;
}

void explain_missing_library(const std::string& program) {
  for (const auto& library : needed_libraries(program))
    if (is_vendor_driver(library))
      local::print_error(
          "inkwell: {} needs {}, a library of the vendor's driver. Inkwell does not provide it, and its libHD.so "
          "does not need it. Link the program without this library, or remove the entry with `patchelf "
          "--remove-needed {}`.\n",
          program, library, library);
}

int run(const DeviceOptions& options, const std::string& arms_text, std::vector<std::string> words) {
  if (words.empty())
    throw UsageError("The program is missing. Give its name: inkwell run [--virtual] PROGRAM [ARGUMENTS].");
  if (words.front().starts_with('-'))
    throw UsageError(fmt::format("There is no option {}. `inkwell run --help` lists the options.", words.front()));
  const auto libraries = installation::dropins();
  if (!std::filesystem::exists(libraries / "libHD.so"))
    throw device::Error(fmt::format(
        "The libraries in {} are missing. Build them with tools/build, or install Inkwell again.", libraries.string()));

  const ProgramArms arms = open_program_arms(options, arms_text);
  const std::string others = environment("LD_LIBRARY_PATH");
  setenv("LD_LIBRARY_PATH", (libraries.string() + (others.empty() ? "" : ":" + others)).c_str(), 1);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  struct sigaction action {};
  action.sa_sigaction = pass_on;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  for (const int signal : passed_on)
    if (!local::is_ignored_hang_up(signal)) sigaction(signal, &action, nullptr);
  pid_t process = 0;
  if (const int code = posix_spawnp(&process, arguments[0], nullptr, nullptr, arguments.data(), environ); code != 0)
    throw device::Error(fmt::format("{} cannot be started: {}. Check its name and whether it is executable.", words[0],
                                    std::strerror(code)));
  program_process = process;
  if (early_signal != 0) kill(process, early_signal);

  const int status = wait_for_end(process, libraries);
  if (WIFEXITED(status) && WEXITSTATUS(status) == library_missing) explain_missing_library(words.front());
  return WIFSIGNALED(status) ? killed_by + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

void add_run_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "run",
      "Runs a program for the Omni's libraries (HDAPI, CHAI3D) on this arm\n"
      "\n"
      "Replaces the Omni's libraries with libHD.so and libhdPhantom.so of this arm, and sets INKWELL_DEVICE. With\n"
      "--virtual, a virtual board runs as long as the program. Options precede PROGRAM; words after it are its "
      "arguments.\n"
      "With --arms, the program can open several arms by name, such as \"left\". The first arm is the default.\n"
      "The exit code is that of the program, or 128 plus the number of the signal that terminated the program.");
  const auto own = std::make_shared<DeviceOptions>();
  command->fallthrough(false);
  own->add_to(*command);
  const auto arms = std::make_shared<std::string>();
  command
      ->add_option("--arms", *arms,
                   "Names of the arms, such as left,right. With --virtual, a board starts for each name,\n"
                   "and 2 means left,right")
      ->type_name("NAMES")
      ->check(not_empty());
  command->prefix_command();
  // After "--" CLI11 passes the remaining words to the parser of the main program.
  command->preparse_callback([&parser = context.program](std::size_t) { parser.prefix_command(); });
  add_examples(*command,
               "inkwell run ./01-mydevice\ninkwell run --virtual ./HelloHapticDevice\n"
               "inkwell run --virtual --arms 2 ./two-handed\ninkwell run --arms left,right ./two-handed");
  command->callback([context, own, arms, command] {
    const bool marked = command->remaining().empty();
    context.action = [&given = context.device, own, arms, words = (marked ? context.program : *command).remaining()] {
      const bool before = given.is_virtual || !given.usbip.empty() || !given.serial_number.empty();
      return run(before ? given : *own, *arms, words);
    };
  });
}

}  // namespace inkwell::command_line
