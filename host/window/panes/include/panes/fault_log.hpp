// What has been put into the virtual board, and what the firmware noticed since. Simulation.
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
    /// Board time from when it came to the end of the control period that noticed; none if that cannot be told.
    std::optional<double> after_s;
  };

  device::PutInFault put_in;
  Phase phase;
  std::optional<Noticed> noticed;  ///< the first that the board noticed since it came
};

class FaultLog {
 public:
  /// How many that are over are still told.
  static constexpr std::size_t over_maximum = 4;

  /// One that was put in just now, which may be over before the board is asked again.
  void add(const device::PutInFault& put_in);
  /// What the board answered. A board whose time is behind the last answer's is another one: the log begins anew.
  void take(const device::Injections& now);
  /// The device is in a fault. It is set beside those that were put in when the board has told, in a later answer, how
  /// far its control periods are.
  void notice(const device::NoticedFault& fault);
  bool waits_for_answer() const { return pending_.has_value(); }

  /// In the order in which they were put in.
  const std::vector<LoggedFault>& faults() const { return faults_; }

 private:
  struct Pending {
    device::NoticedFault fault;
    std::vector<unsigned> in = {};  ///< the numbers of those that were known to be in when it was told
    int answers = 0;                ///< that did not reach its control period
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
