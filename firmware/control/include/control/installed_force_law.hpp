// The force law that this image was built with (-DINKWELL_FORCE), as the rest of the firmware sees it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <control/force_law.hpp>
#include <protocol/parameters.hpp>
#include <protocol/signals.hpp>

namespace inkwell::control {

/// Values of the law's parameters, in the order of its rows.
using ForceLawValues = std::array<float, protocol::force_law_parameters_maximum>;

/// What the law remembers, and its signals of the last period.
struct ForceLawMemory {
  static constexpr std::size_t state_bytes = 256;

  alignas(8) std::array<std::byte, state_bytes> state{};
  std::array<float, protocol::force_law_signals_maximum> signals{};
};

// ---- control interrupt ----

/// Makes state and signals as new. Before the first step, and not in the same period as one.
void reset_force_law(ForceLawMemory& memory);

/// One control period of the law: the force on the hand, which may be any number or none. Given to a place in memory,
/// which the compiler does for fewer cycles than to return it.
void step_force_law(const Probe& probe, const ForceLawValues& values, ForceLawMemory& memory, Vector3& force_N);

/// Entries of ForceLawMemory::signals that the law has.
extern constinit const std::size_t force_law_signal_count;

// ---- main loop ----

struct ForceLawRange {
  float minimum;
  float maximum;
  float default_value;
};

/// Lies in the flash, which interrupts must not read.
struct InstalledForceLaw {
  std::size_t parameter_count;
  std::size_t signal_count;
  std::array<ForceLawRange, protocol::force_law_parameters_maximum> ranges;
  const std::byte* report;  ///< a protocol::ForceLawReport with all that follows it
  std::size_t report_size;
};
extern constinit const InstalledForceLaw installed_force_law;

}  // namespace inkwell::control
