// This force law divides by a parameter, so that tests can cause a division by zero. The signals of the law show some
// of its inputs.
#pragma once

#include "firmware/control/signal_path/force_law.hpp"

namespace inkwell::force_laws {

struct quotient {
  static constexpr std::string_view help = "A force up, divided by a parameter that may be zero.";

  struct Parameters {
    float dividend_N, divisor;
  };
  static constexpr ForceParameter<Parameters> parameter_rows[] = {
      {&Parameters::dividend_N, "quotient_dividend_N", "N", -1.0f, 1.0f, 0.5f, "What is divided."},
      {&Parameters::divisor, "quotient_divisor", "", 0.0f, 1.0f, 1.0f, "What it is divided by."},
  };

  struct Signals {
    float periods, switches;
  };
  static constexpr ForceSignal<Signals> signal_rows[] = {
      {&Signals::periods, "quotient_periods", "", "Control periods since the state was new."},
      {&Signals::switches, "quotient_switches", "", "Which switches are closed, one bit each."},
  };

  struct State {
    float periods = 0.0f;
  };

  static Vector3 force_N(const Probe& probe, const Parameters& parameters, State& state, Signals& signals) {
    signals.periods = state.periods;
    state.periods += 1.0f;
    signals.switches = static_cast<float>(probe.switches);
    return {0.0f, 0.0f, parameters.dividend_N / parameters.divisor};
  }
};

}  // namespace inkwell::force_laws
