// Main program of virtual-board. The program runs unchanged firmware on the virtual board.
#include <atomic>
#include <exception>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "boards/virtual/program/control_server.hpp"
#include "boards/virtual/program/stream_server.hpp"
#include "host/client/local/ending_signals.hpp"
#include "host/client/local/output.hpp"

#include "boards/virtual/program/board.hpp"
#include "boards/virtual/program/log.hpp"
#include "boards/virtual/program/options.hpp"
#include "boards/virtual/program/simulation.hpp"

namespace {

std::atomic<bool> end_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "it is set by a signal");

void request_end(int) { end_requested = true; }

int run(int argc, char** argv) {
  using namespace inkwell;
  using namespace inkwell::virtual_board;
  const CommandLine command_line = read_command_line(argc, argv);
  if (!command_line.options) return command_line.exit_code;
  const Options& options = *command_line.options;

  const local::EndingSignalsHandler handler(request_end);
  try {
    PrivateSockets sockets;
    ControlServer server(sockets.address_of(options.control, "control"));
    Board board(
        options, sockets.address_of(options.usbip, "usbip"), [&server] { server.wake(); },
        [] { return end_requested.load(); });
    std::optional<StreamServer> gdb;
    if (options.gdb)
      gdb.emplace(sockets.address_of(*options.gdb, "gdb"), "--gdb", &may_be_gdb, [&server] { server.wake(); });
    UartLinks uarts(options.uarts, board.chip(), sockets, [&server] { server.wake(); });
    fmt::print("ready usbip={} control={}", announced(board.usb().address()), announced(server.address()));
    if (gdb) fmt::print(" gdb={}", announced(gdb->address()));
    fmt::print("{}\n", uarts.announcement());
    local::flush_output();
    const int exit_code = Simulation(options, board, server, gdb ? &*gdb : nullptr, uarts).run(end_requested);
    if (options.profile) board.profile().write(*options.profile);
    return exit_code;
  } catch (const std::exception& error) {
    if (!local::is_output_lost()) log_line(error.what());  // main() reports lost output
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int exit_code = run(argc, argv);
  return inkwell::local::checked_exit_code("virtual-board", exit_code);
}
