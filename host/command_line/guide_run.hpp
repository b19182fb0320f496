// Guides on a terminal: the text of each step, a prompt before anything moves, the numbers as they are measured.
#pragma once

#include <vector>

#include <guides/guides.hpp>

#include "connection.hpp"

namespace inkwell::command_line {

/// What the user agrees to beforehand.
struct Consent {
  bool yes = false;
  bool apply = false;
  bool store = false;

  void add_to(CLI::App& command);
};

/// One after another on the device that the options name, up to the first that fails; then what they changed is stored
/// on the board, if the user wants that. Returns the exit code. Throws
/// device::Error with the failure's sentence, and UsageError where consent is needed and no one can give it.
int run_guides(const DeviceOptions& options, const Consent& consent, const std::vector<const guides::Offer*>& offers,
               const guides::Choices& choices);

}  // namespace inkwell::command_line
