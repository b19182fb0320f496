#include "host/client/device/virtual_board.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "boards/known/boards.hpp"
#include "host/client/device/address.hpp"
#include "host/client/installation/installed_paths.hpp"
#include "host/client/local/interruption.hpp"
#include "host/client/process/fork.hpp"
#include "protocol/image_identity.hpp"

namespace inkwell::device {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto start_timeout = 30s;
constexpr auto stop_timeout = 5s;
constexpr std::size_t log_kept = 4096, longest_ready_line = 4096;

struct Pipe {
  int read_end = -1, write_end = -1;
  process::OwnDescriptor own;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw Error("A pipe to the virtual board cannot be created: too many files are open.");
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    close_write_end();
    own.forget();
    close(read_end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  /// Call this after the board has inherited the write end.
  void keep_read_end() {
    close_write_end();
    own = process::OwnDescriptor(read_end);
  }
  void close_write_end() {
    if (write_end >= 0) close(write_end);
    write_end = -1;
  }
};

std::vector<std::string> arguments_of(const VirtualBoardOptions& options, const std::filesystem::path& program,
                                      const std::filesystem::path& elf) {
  std::vector<std::string> arguments{program.string(),
                                     "--elf",
                                     elf.string(),
                                     "--usbip",
                                     "unix:",
                                     "--control",
                                     "unix:",
                                     "--mode",
                                     options.mode == SimulationMode::exact ? "exact" : "fast",
                                     "--pricing",
                                     options.pricing == CyclePricing::conservative ? "conservative" : "likely",
                                     "--seed",
                                     std::to_string(options.seed)};
  if (!options.board.empty()) arguments.insert(arguments.end(), {"--board", options.board});
  if (!options.arm.empty()) arguments.insert(arguments.end(), {"--arm", options.arm.string()});
  if (!options.flash.empty()) arguments.insert(arguments.end(), {"--flash", options.flash.string()});
  if (options.host_clock_ppm != 0.0)
    arguments.insert(arguments.end(), {"--host-clock-ppm", std::to_string(options.host_clock_ppm)});
  if (options.brown_out_level != 0)
    arguments.insert(arguments.end(), {"--brown-out", std::to_string(options.brown_out_level)});
  if (options.real_time) arguments.push_back("--real-time");
  if (options.paused) arguments.push_back("--paused");
  if (options.lock_step) arguments.push_back("--lock-step");
  if (options.seconds) arguments.insert(arguments.end(), {"--seconds", std::to_string(*options.seconds)});
  if (options.from_boot_loader) arguments.push_back("--from-boot-loader");
  if (options.strict) arguments.push_back("--strict");
  if (!options.profile.empty()) arguments.insert(arguments.end(), {"--profile", options.profile.string()});
  return arguments;
}

/// Returns the board name of the firmware in a flash file. Returns an empty text if the firmware or its board is
/// unknown.
std::string board_in(const std::filesystem::path& flash) {
  std::ifstream file(flash, std::ios::binary);
  protocol::ImageIdentity identity{};
  file.seekg(protocol::image_identity_offset);
  file.read(reinterpret_cast<char*>(&identity), sizeof identity);
  if (!file || !identity.is_there() || board::find_board(identity.board_name()) == nullptr) return {};
  return std::string(identity.board_name());
}

std::filesystem::path firmware_for(const std::string& name) {
  if (name.empty()) return installation::firmware();
  const board::Facts* const facts = board::find_board(name);
  if (facts == nullptr)
    throw Error(
        fmt::format("There is no board with the name {}. Known boards are {}.", name, board::names_of_boards()));
  return installation::firmware(board::image_name(*facts));
}

/// Parses the line that a ready board prints. Returns false for any other line.
bool read_addresses(const std::string& line, SocketAddress& usbip, SocketAddress& control) {
  std::istringstream words(line);
  std::string ready, usbip_word, control_word;
  words >> ready >> usbip_word >> control_word;
  constexpr std::string_view usbip_key = "usbip=", control_key = "control=";
  if (ready != "ready" || !usbip_word.starts_with(usbip_key) || !control_word.starts_with(control_key)) return false;
  try {
    usbip = parse_socket(std::string_view(usbip_word).substr(usbip_key.size()));
    control = parse_socket(std::string_view(control_word).substr(control_key.size()));
  } catch (const BadAddress&) {
    return false;
  }
  return true;
}

}  // namespace

struct VirtualBoard::Implementation {
  Pipe output, log;
  pid_t process = -1;
  SocketAddress usbip, control;
  std::filesystem::path image;
  std::thread drain;
  mutable std::mutex mutex;
  std::string newest_log;  ///< the last kilobytes of the log, for error messages
  bool exited = false;
  int exit_status = 0;

  void start(const std::vector<std::string>& arguments) {
    std::vector<char*> pointers;
    for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    const pid_t parent = getpid();
    process = fork();
    if (process < 0) throw Error("The virtual board cannot be started: the system allows no more processes.");
    if (process == 0) {
      // Ctrl-C in the terminal must not stop the board before the companion does.
      setpgid(0, 0);
      prctl(PR_SET_PDEATHSIG, SIGTERM);
      if (getppid() != parent) _exit(1);  // the parent has already exited
      dup2(output.write_end, STDOUT_FILENO);
      dup2(log.write_end, STDERR_FILENO);
      execv(pointers[0], pointers.data());
      _exit(127);
    }
    output.keep_read_end();
    log.keep_read_end();
    drain = std::thread([this] { read_log(); });
  }

  /// Reads the log continuously, because a full pipe would block the board.
  void read_log() {
    std::array<char, 4096> chunk;
    for (;;) {
      const ssize_t length = local::repeat_interrupted([&] { return read(log.read_end, chunk.data(), chunk.size()); });
      if (length <= 0) return;
      const std::lock_guard lock(mutex);
      newest_log.append(chunk.data(), static_cast<std::size_t>(length));
      if (newest_log.size() > log_kept) newest_log.erase(0, newest_log.size() - log_kept);
    }
  }

  std::string read_ready_line() {
    std::string line;
    const auto deadline = Clock::now() + start_timeout;
    while (Clock::now() < deadline && line.size() < longest_ready_line) {
      pollfd descriptor{output.read_end, POLLIN, 0};
      if (poll(&descriptor, 1, 100) <= 0) continue;
      char character;
      if (local::repeat_interrupted([&] { return read(output.read_end, &character, 1); }) != 1 || character == '\n')
        break;
      line += character;
    }
    return line;
  }

  bool reap_process(int options) {
    const std::lock_guard lock(mutex);
    if (!exited && waitpid(process, &exit_status, options) == process) exited = true;
    return exited;
  }

  void stop() {
    if (process < 0) return;
    if (!reap_process(WNOHANG)) kill(process, SIGTERM);
    const auto deadline = Clock::now() + stop_timeout;
    while (!reap_process(WNOHANG) && Clock::now() < deadline) std::this_thread::sleep_for(5ms);
    if (!reap_process(WNOHANG)) {
      kill(process, SIGKILL);
      while (!reap_process(WNOHANG)) std::this_thread::sleep_for(5ms);
    }
    if (drain.joinable()) drain.join();
    remove_stale_folders();
  }

  /// Removes the sockets and the folder that a killed board leaves.
  void remove_stale_folders() {
    for (const auto& socket : {usbip, control}) {
      struct stat status {};
      if (!socket.is_unix() || lstat(socket.path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode)) continue;
      unlink(socket.path.c_str());
      rmdir(socket.path.parent_path().c_str());
    }
  }

  ~Implementation() { stop(); }
};

VirtualBoard::VirtualBoard(const VirtualBoardOptions& options) : implementation_(std::make_unique<Implementation>()) {
  const auto program = options.program.empty() ? installation::virtual_board() : options.program;
  const auto elf =
      options.elf.empty() ? firmware_for(options.board.empty() ? board_in(options.flash) : options.board) : options.elf;
  if (access(program.c_str(), X_OK) != 0)
    throw Error(fmt::format("The program {} is missing. Build it with tools/build, or install Inkwell again.",
                            program.string()));
  if (access(elf.c_str(), R_OK) != 0)
    throw Error(fmt::format(
        "The firmware {} is missing. Build it with tools/build, install Inkwell again, or give a firmware with --elf.",
        elf.string()));
  auto& self = *implementation_;
  self.image = elf;
  self.start(arguments_of(options, program, elf));
  const std::string line = self.read_ready_line();
  if (!read_addresses(line, self.usbip, self.control)) {
    self.stop();
    const auto end = self.newest_log.find_last_not_of('\n');
    const std::string said = end == std::string::npos ? "It said nothing." : self.newest_log.substr(0, end + 1);
    throw Error(fmt::format("The virtual board did not start. {}", said));
  }
}

VirtualBoard::~VirtualBoard() = default;

const SocketAddress& VirtualBoard::usbip() const { return implementation_->usbip; }
const SocketAddress& VirtualBoard::control_socket() const { return implementation_->control; }

std::optional<Endpoint> VirtualBoard::find() const {
  const auto endpoints = find_usbip_devices(usbip());
  return endpoints.empty() ? std::nullopt : std::optional(endpoints.front());
}

ControlClient VirtualBoard::control() const { return ControlClient(control_socket()); }

const std::filesystem::path& VirtualBoard::image() const { return implementation_->image; }

bool VirtualBoard::is_running() const { return !implementation_->reap_process(WNOHANG); }

}  // namespace inkwell::device
