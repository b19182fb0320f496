// A force law with the largest permitted numbers of parameters and signals, and with a table of 1 KB.
#include <control/force_law.hpp>

namespace inkwell::force_laws {

struct largest {
  static constexpr std::string_view help = "The limits of a force law.";

  struct Parameters {
    float gain_1, gain_2, gain_3, gain_4, gain_5, gain_6, gain_7, gain_8, gain_9, gain_10, gain_11, gain_12;
  };
  static constexpr ForceParameter<Parameters> parameter_rows[] = {
      {&Parameters::gain_1, "largest_gain_1", "N/m", 0, 500, 1, "Gain of row 1 in the table of this force law."},
      {&Parameters::gain_2, "largest_gain_2", "N/m", 0, 500, 2, "Gain of row 2 in the table of this force law."},
      {&Parameters::gain_3, "largest_gain_3", "N/m", 0, 500, 3, "Gain of row 3 in the table of this force law."},
      {&Parameters::gain_4, "largest_gain_4", "N/m", 0, 500, 4, "Gain of row 4 in the table of this force law."},
      {&Parameters::gain_5, "largest_gain_5", "N/m", 0, 500, 5, "Gain of row 5 in the table of this force law."},
      {&Parameters::gain_6, "largest_gain_6", "N/m", 0, 500, 6, "Gain of row 6 in the table of this force law."},
      {&Parameters::gain_7, "largest_gain_7", "N/m", 0, 500, 7, "Gain of row 7 in the table of this force law."},
      {&Parameters::gain_8, "largest_gain_8", "N/m", 0, 500, 8, "Gain of row 8 in the table of this force law."},
      {&Parameters::gain_9, "largest_gain_9", "N/m", 0, 500, 9, "Gain of row 9 in the table of this force law."},
      {&Parameters::gain_10, "largest_gain_10", "N/m", 0, 500, 10, "Gain of row 10 in the table of this force law."},
      {&Parameters::gain_11, "largest_gain_11", "N/m", 0, 500, 11, "Gain of row 11 in the table of this force law."},
      {&Parameters::gain_12, "largest_gain_12", "N/m", 0, 500, 12, "Gain of row 12 in the table of this force law."},
  };

  struct Signals {
    float value_1, value_2, value_3, value_4, value_5, value_6, value_7, value_8;
  };
  static constexpr ForceSignal<Signals> signal_rows[] = {
      {&Signals::value_1, "largest_value_1", "m", "Value of row 1 in the table of this force law."},
      {&Signals::value_2, "largest_value_2", "m", "Value of row 2 in the table of this force law."},
      {&Signals::value_3, "largest_value_3", "m", "Value of row 3 in the table of this force law."},
      {&Signals::value_4, "largest_value_4", "m", "Value of row 4 in the table of this force law."},
      {&Signals::value_5, "largest_value_5", "m", "Value of row 5 in the table of this force law."},
      {&Signals::value_6, "largest_value_6", "m", "Value of row 6 in the table of this force law."},
      {&Signals::value_7, "largest_value_7", "m", "Value of row 7 in the table of this force law."},
      {&Signals::value_8, "largest_value_8", "m", "Value of row 8 in the table of this force law."},
  };

  struct State {};

  static constexpr auto table = []() {
    std::array<float, 256> values{};
    for (unsigned i = 0; i < values.size(); ++i) values[i] = 0.001f * static_cast<float>(i * i % 101);
    return values;
  }();

  static Vector3 force_N(const Probe& probe, const Parameters& parameters, State&, Signals& signals) {
    const unsigned index = static_cast<unsigned>(static_cast<int>(1000.0f * probe.position_m.x)) % table.size();
    signals = {table[(index + 1) % table.size()], table[(index + 2) % table.size()], table[(index + 3) % table.size()],
               table[(index + 4) % table.size()], table[(index + 5) % table.size()], table[(index + 6) % table.size()],
               table[(index + 7) % table.size()], table[(index + 8) % table.size()]};
    const float gain = parameters.gain_1 + parameters.gain_2 + parameters.gain_3 + parameters.gain_4 +
                       parameters.gain_5 + parameters.gain_6 + parameters.gain_7 + parameters.gain_8 +
                       parameters.gain_9 + parameters.gain_10 + parameters.gain_11 + parameters.gain_12;
    return 0.001f * gain * signals.value_1 * probe.position_m + wall_force_N(probe);
  }
};

}  // namespace inkwell::force_laws
