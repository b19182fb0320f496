// Starts the `virtual-board` program and owns it: the board ends with this object, and with this process
// even if it is killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include <device/control_client.hpp>
#include <device/transport.hpp>

namespace inkwell::device {

enum class SimulationMode : std::uint8_t {
  exact,  ///< an interrupt can come at any instruction; the same seed gives the same run
  fast,
};

/// What instructions cost where the sources leave a choice (docs/cycles.md).
enum class CyclePricing : std::uint8_t {
  likely,
  conservative,  ///< by which deadlines are judged
};

struct VirtualBoardOptions {
  std::filesystem::path program;  ///< empty: that of this installation or build
  std::filesystem::path elf;      ///< empty: the one that is flashed on `board`, likewise
  std::string board;              ///< empty: the one that the ELF is for
  std::filesystem::path arm;      ///< empty: the Omni
  std::filesystem::path flash;    ///< file of its flash, made if it is missing; empty: it forgets all at its end
  std::filesystem::path profile;  ///< file for the longest interrupt, written at the board's end; empty: none
  SimulationMode mode = SimulationMode::fast;
  CyclePricing pricing = CyclePricing::likely;
  std::uint64_t seed = 1;        ///< of its noise and of its serial number
  double host_clock_ppm = 0.0;   ///< how much faster than board time the clock of its USB host is
  unsigned brown_out_level = 0;  ///< in its option bytes: 0 is off, as in a new chip; `inkwell flash` sets 3
  bool real_time = true;         ///< paces board time to the wall clock
  bool paused = false;           ///< starts with board time standing still
  bool lock_step = false;        ///< board time passes only while the programs that use the device wait for it
  /// Of board time, then it ends. A processor that locks up does not stop the time then, as its watchdog may bite.
  std::optional<double> seconds = {};
  bool from_boot_loader = false;  ///< the chip's boot loader starts the firmware, not a reset
  bool strict = false;            ///< the board ends when the firmware does what silicon would not bear
};

/// Make it in a thread that lives as long as the board shall: Linux ends the board when that thread ends.
class VirtualBoard {
 public:
  /// Starts the program and waits until it is ready. Throws Error with what the program said if it is not.
  explicit VirtualBoard(const VirtualBoardOptions& options);
  ~VirtualBoard();
  VirtualBoard(const VirtualBoard&) = delete;
  VirtualBoard& operator=(const VirtualBoard&) = delete;

  /// Unix sockets in a private folder: no other user can connect. They go with the board.
  const SocketAddress& usbip() const;
  const SocketAddress& control_socket() const;

  /// The device if the board shows one on its USB, none while it starts or its cable is out.
  std::optional<Endpoint> find() const;
  /// A new connection to the control socket.
  ControlClient control() const;
  bool is_running() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
