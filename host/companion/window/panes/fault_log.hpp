// Log of injected faults and detected faults.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/client/device/control_client.hpp"
#include "host/client/device/session.hpp"

namespace inkwell::window {

struct LoggedInjection {
  enum class Phase : std::uint8_t { to_come, in, over };
  struct Noticed {
    protocol::Fault fault;
    /// Board time from the start of the injected fault to the detection; empty if unknown.
    std::optional<double> after_s;
  };

  device::Injection injection;
  Phase phase;
  std::optional<Noticed> noticed;  ///< first fault that the board detected after the injection
};

class FaultLog {
 public:
  /// Maximum number of past faults in the log.
  static constexpr std::size_t over_maximum = 4;

  /// Adds an injected fault. A short fault may end before the next answer of the board.
  void add(const device::Injection& injection);
  /// Processes an answer of the board. Clears the log if the board time has decreased since the last answer.
  void take(const device::Injections& now);
  /// Records a fault of the device. The log assigns the fault to injected faults once the board has reported a later
  /// period count.
  void notice(const device::NoticedFault& fault);
  bool waits_for_answer() const { return pending_.has_value(); }

  /// Logged faults in the order of injection.
  const std::vector<LoggedInjection>& faults() const { return faults_; }

 private:
  struct Pending {
    device::NoticedFault fault;
    std::vector<unsigned> in = {};  ///< numbers of the faults that were active at the detection
    int answers = 0;                ///< number of answers with a period count below the count of the fault
    bool was_in(unsigned number) const;
  };

  void end_those_gone(const device::Injections& now);
  void forget_oldest();
  double period_s(const device::Injections& now) const;
  void resolve_pending(const device::Injections& now);
  void show_with(protocol::Fault fault, std::optional<double> noticed_s, double run_began_s);

  std::vector<LoggedInjection> faults_;
  std::optional<device::Injections> newest_;
  std::optional<Pending> pending_;
};

}  // namespace inkwell::window
