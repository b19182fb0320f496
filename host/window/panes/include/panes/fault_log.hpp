// Faults injected into the virtual board, and the faults that the firmware detected afterwards. Simulation only.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <device/control_client.hpp>
#include <device/session.hpp>

namespace inkwell::window {

struct LoggedFault {
  enum class Phase : std::uint8_t { to_come, in, over };
  struct Noticed {
    protocol::Fault fault;
    /// Board time from the start of the injected fault to the end of the control period that detected it; empty if
    /// unknown.
    std::optional<double> after_s;
  };

  device::PutInFault put_in;
  Phase phase;
  std::optional<Noticed> noticed;  ///< first fault that the board detected after the injection
};

class FaultLog {
 public:
  /// Number of past faults that are still shown.
  static constexpr std::size_t over_maximum = 4;

  /// Adds a newly injected fault. The fault may be over before the next answer of the board.
  void add(const device::PutInFault& put_in);
  /// Processes an answer of the board. A board time before that of the last answer means another board, and the log is
  /// cleared.
  void take(const device::Injections& now);
  /// The device is in a fault. The fault is assigned to injected faults after a later answer has reported the board's
  /// period count.
  void notice(const device::NoticedFault& fault);
  bool waits_for_answer() const { return pending_.has_value(); }

  /// Logged faults in the order of injection.
  const std::vector<LoggedFault>& faults() const { return faults_; }

 private:
  struct Pending {
    device::NoticedFault fault;
    std::vector<unsigned> in = {};  ///< numbers of the faults known to be active at the time of detection
    int answers = 0;                ///< answers whose period count was below that of the fault
    bool was_in(unsigned number) const;
  };

  void end_those_gone(const device::Injections& now);
  void forget_oldest();
  double period_s(const device::Injections& now) const;
  void place_pending(const device::Injections& now);
  void set_beside(protocol::Fault fault, std::optional<double> noticed_s, double run_began_s);

  std::vector<LoggedFault> faults_;
  std::optional<device::Injections> newest_;
  std::optional<Pending> pending_;
};

}  // namespace inkwell::window
