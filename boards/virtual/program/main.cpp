// virtual-board: runs the firmware that would be flashed on a board made of software.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "board.hpp"
#include "control_server.hpp"
#include "log.hpp"
#include "options.hpp"
#include "simulation.hpp"
#include "stream_server.hpp"

namespace {

std::atomic<bool> end_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "it is set by a signal");

void request_end(int) { end_requested = true; }

}  // namespace

int main(int argc, char** argv) {
  using namespace inkwell::virtual_board;
  const CommandLine command_line = read_command_line(argc, argv);
  if (!command_line.options) return command_line.exit_code;
  const Options& options = *command_line.options;

  struct sigaction action {};
  action.sa_handler = request_end;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);

  try {
    ControlServer server(options.control_port);
    Board board(
        options, [&server] { server.wake(); }, [] { return end_requested.load(); });
    std::optional<StreamServer> gdb;
    if (options.gdb_port) gdb.emplace(*options.gdb_port, "--gdb", [&server] { server.wake(); });
    UartLinks uarts(options.uarts, board.chip(), [&server] { server.wake(); });
    fmt::print("ready usbip={} control={}", board.usb().port(), server.port());
    if (gdb) fmt::print(" gdb={}", gdb->port());
    fmt::print("{}\n", uarts.announcement());
    std::fflush(stdout);
    const int exit_code = Simulation(options, board, server, gdb ? &*gdb : nullptr, uarts).run(end_requested);
    if (options.profile) board.profile().write(*options.profile);
    return exit_code;
  } catch (const std::exception& error) {
    log_line(error.what());
    return 1;
  }
}
