// Runs guides on a terminal. The terminal shows steps, prompts and measured values.
#pragma once

#include <vector>

#include "host/client/command_line/connection.hpp"
#include "host/client/guides/guides.hpp"

namespace inkwell::command_line {

struct Consent {
  bool yes = false;
  bool apply = false;
  bool store = false;

  void add_to(CLI::App& command);
};

/// Runs the guides in order on the selected device. Stops after a failed guide. After the last guide, stores the
/// changes on the board if the user agrees. Returns the exit code. Throws device::Error if a guide fails. Throws
/// UsageError if a guide requires consent and standard input is closed.
int run_guides(const DeviceOptions& options, const Consent& consent, const std::vector<const guides::Offer*>& offers,
               const guides::Choices& choices);

}  // namespace inkwell::command_line
