// Runs guides on a terminal. The terminal shows the steps, a prompt before each motion, and measured values.
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

/// Runs guides one after another on the selected device, until one fails. After the last guide, stores the changes on
/// the board if the user agrees. Returns the exit code. Throws device::Error if a guide fails. Throws UsageError if a
/// guide requires consent and standard input is closed.
int run_guides(const DeviceOptions& options, const Consent& consent, const std::vector<const guides::Offer*>& offers,
               const guides::Choices& choices);

}  // namespace inkwell::command_line
