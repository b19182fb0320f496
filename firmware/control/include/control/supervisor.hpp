// What the device may do: a state machine of five states.
//
//   from \ to     | starting            | unreferenced       | ready              | active        | fault
//   --------------+---------------------+--------------------+--------------------+---------------+-----------
//   starting      |                     | offsets measured   |                    |               | see below
//   unreferenced  |                     |                    | reference taken    |               | see below
//   ready         |                     |                    |                    | enable_force  | see below
//   active        |                     |                    | disable_force      |               | see below
//   fault         | cleared, offsets    | cleared, no        | cleared, reference |               |
//                 | not yet measured    | reference          | taken              |               |
//
// `cleared`: the command clear_fault came and the fault's cause is gone. The first fault stays until it is
// cleared; of several in one period the first in the list below is shown, because it explains the others.
//
//   fault                | looked for in                      | cause is gone when
//   ---------------------+------------------------------------+-----------------------------------------
//   processor_fault, watchdog, servo_overrun, crystal_failed | every state | at once: raised by the application
//   force_law            | active                             | at once: raised where the law is called
//   not_finite           | every state                        | the values are finite
//   current_sensor       | once the offsets are measured      | never: the board must be reset
//   supply_low, _high    | unreferenced, ready, active        | the supply is within its bounds
//   bridge_fault         | unreferenced, ready, active        | the fault line is released
//   samples_stale        | unreferenced, ready, active        | supply and gimbal are measured again
//   over_current         | unreferenced, ready, active        | the currents are within their bounds
//   motor_hot            | unreferenced, ready, active        | every motor has cooled
//   encoder_implausible  | ready, active                      | at once: the reference is given up with it
//   over_speed           | active                             | at once
//   host_silent          | active                             | at once
#pragma once

#include <control/vector.hpp>
#include <protocol/faults.hpp>

namespace inkwell::control {

/// What is true in this period.
struct Conditions {
  bool offsets_measured = false;
  bool offsets_plausible = true;
  bool referenced = false;
  bool not_finite = false;
  bool supply_low = false;
  bool supply_high = false;
  bool bridge_fault = false;
  bool samples_stale = false;
  bool motor_hot = false;
  bool over_current = false;
  bool encoder_implausible = false;
  bool over_speed = false;
  bool host_silent = false;
};

/// What was asked for since the period before.
struct Requests {
  bool enable_force = false;
  bool disable_force = false;
  bool clear_fault = false;
  protocol::Fault raised = protocol::Fault::none;
};

struct Supervisor {
  protocol::State state = protocol::State::starting;
  protocol::Fault fault = protocol::Fault::none;
  bool operator==(const Supervisor&) const = default;
};

/// The state in the next period.
Supervisor advance(const Supervisor& supervisor, const Conditions& conditions, const Requests& requests);

}  // namespace inkwell::control
