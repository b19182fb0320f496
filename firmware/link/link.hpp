// Data exchange between the main loop and the control interrupt.
//
// Each member has one producer and one consumer and never blocks the interrupt.
//
// The link needs about 13 KB, mostly for samples. Scope frames, black-box rows and program requests are in other
// memories.
#pragma once

#include <cstdint>

#include "firmware/exchange/shared.hpp"
#include "firmware/link/command_queue.hpp"
#include "firmware/link/driver_claim.hpp"
#include "firmware/link/program_requests.hpp"
#include "firmware/link/request_results.hpp"
#include "firmware/link/servo_status.hpp"
#include "firmware/record/black_box.hpp"
#include "firmware/record/pose_recorder.hpp"
#include "firmware/record/sample_ring.hpp"
#include "firmware/record/scope_recorder.hpp"
#include "firmware/self_test/self_test.hpp"
#include "firmware/store/parameter_store.hpp"
#include "firmware/store/stored_parameters.hpp"

namespace inkwell::link {

struct Link {
  /// `cycles_per_period`: processor cycles of one control period. `first_period`: number of the first control period.
  template <std::size_t before, std::size_t after>
  Link(std::uint32_t cycles_per_period, ProgramRequests& program_requests, ScopeFrames& frames,
       BlackBoxMemory<before, after>& memory, std::uint32_t first_period = 0)
      : program(program_requests),
        samples(first_period),
        poses(samples, cycles_per_period),
        scope(samples, frames),
        black_box(samples, memory),
        self_test(samples) {}

  ParameterStore parameters;
  StoredParameters stored;
  CommandQueue commands;
  RequestResults request_results{commands};
  DriverClaim driver;
  ProgramRequests& program;
  SampleRing samples;
  PoseRecorder poses;
  ScopeRecorder scope;
  BlackBox black_box;
  SelfTest self_test;
  ServoStatus status;
  Shared<bool> update_requested{false};                 ///< the host requested the boot loader
  Shared<protocol::Conditions> found_in_main_loop{{}};  ///< faults that tolerate a delay of one control period
};

}  // namespace inkwell::link
