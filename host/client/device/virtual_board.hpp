// Starts and owns the `virtual-board` program. The board exits when this object is destroyed and when this process
// exits, even if the process is killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "host/client/device/control_client.hpp"
#include "host/client/device/transport.hpp"

namespace inkwell::device {

enum class SimulationMode : std::uint8_t {
  exact,  ///< interrupts can occur at any instruction; the same seed repeats the run
  fast,
};

/// Choice of instruction cycle counts if the sources are ambiguous (docs/cycles.md).
enum class CyclePricing : std::uint8_t {
  likely,
  conservative,  ///< for checking deadlines
};

struct VirtualBoardOptions {
  std::filesystem::path program;  ///< empty: the program of this installation or build
  std::filesystem::path elf;      ///< empty: the installed firmware for `board`
  std::string board;              ///< empty: the board of the ELF
  std::filesystem::path arm;      ///< empty: the Omni
  std::filesystem::path flash;    ///< flash content file, created if missing; empty: nothing is saved
  std::filesystem::path profile;  ///< output file for the longest interrupt, written when the board exits; empty: none
  SimulationMode mode = SimulationMode::fast;
  CyclePricing pricing = CyclePricing::likely;
  std::uint64_t seed = 1;        ///< seed of the noise and the serial number
  double host_clock_ppm = 0.0;   ///< deviation of the USB host clock from board time; positive is faster
  unsigned brown_out_level = 0;  ///< brown-out level in the option bytes: 0 is off, as in a new chip; `inkwell flash`
                                 ///< sets 3
  bool real_time = true;         ///< synchronizes board time with wall time
  bool paused = false;           ///< starts with board time stopped
  bool lock_step = false;        ///< board time passes only while the programs that use the device wait for it
  /// The board exits after this board time in seconds. With this option, board time continues after a processor
  /// lock-up, because the watchdog may reset the chip.
  std::optional<double> seconds = {};
  bool from_boot_loader = false;  ///< the boot loader of the chip starts the firmware, instead of a reset
  bool strict = false;            ///< the board exits when the firmware violates a rule of the chip
};

/// Create this object in a thread that lives as long as the board is needed, because Linux terminates the board when
/// that thread exits.
class VirtualBoard {
 public:
  /// Starts the program and waits until it is ready. If the program fails, throws Error with the program's message.
  explicit VirtualBoard(const VirtualBoardOptions& options);
  ~VirtualBoard();
  VirtualBoard(const VirtualBoard&) = delete;
  VirtualBoard& operator=(const VirtualBoard&) = delete;

  /// The Unix sockets are in a private folder, so that no other user can connect. The sockets are removed with the
  /// board.
  const SocketAddress& usbip() const;
  const SocketAddress& control_socket() const;

  /// The device, or none while the board starts or its cable is unplugged.
  std::optional<Endpoint> find() const;
  /// A new connection to the control socket.
  ControlClient control() const;
  bool is_running() const;
  /// The firmware image that the board runs.
  const std::filesystem::path& image() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
