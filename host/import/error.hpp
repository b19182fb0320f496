// Errors of the import of files.
#pragma once

#include <stdexcept>
#include <string>

#include "protocol/plain_text.hpp"

namespace inkwell::importer {

/// The file cannot be used. `what()` names the file, the problem and the remedy, and is safe to print.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& sentence) : std::runtime_error(protocol::plain_lines(sentence)) {}
};

}  // namespace inkwell::importer
