// Interface of the image's force law (-DINKWELL_FORCE).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/force_law.hpp"
#include "protocol/parameters.hpp"
#include "protocol/signals.hpp"

namespace inkwell::control {

/// Values of the law's parameters, in row order.
using ForceLawValues = std::array<float, protocol::force_law_parameters_maximum>;

/// State and signals of the law.
struct ForceLawMemory {
  static constexpr std::size_t state_bytes = 256;

  alignas(8) std::array<std::byte, state_bytes> state{};
  std::array<float, protocol::force_law_signals_maximum> signals{};
};

// ---- control interrupt ----

/// Resets state and signals. Call this function before the first step. Do not call this function and step_force_law()
/// in the same period.
void reset_force_law(ForceLawMemory& memory);

/// Runs one control period of the law. The force may be infinite or NaN. An output argument needs fewer cycles than a
/// return value.
void step_force_law(const Probe& probe, const ForceLawValues& values, ForceLawMemory& memory, Vector3& force_N);

/// Number of used entries of ForceLawMemory::signals.
extern constinit const std::size_t force_law_signal_count;

// ---- main loop ----

struct ForceLawRange {
  float minimum;
  float maximum;
  float default_value;
};

/// Force law data in flash. Interrupts must not read this data, because it is in flash.
struct InstalledForceLaw {
  std::size_t parameter_count;
  std::size_t signal_count;
  std::array<ForceLawRange, protocol::force_law_parameters_maximum> ranges;
  const std::byte* report;  ///< protocol::ForceLawReport including its variable part
  std::size_t report_size;
};
extern constinit const InstalledForceLaw installed_force_law;

}  // namespace inkwell::control
