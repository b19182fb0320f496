// A page section and its number of findings.
#pragma once

#include <cstddef>
#include <string>

namespace inkwell::campaign {

struct Section {
  std::string text;
  std::size_t findings = 0;
};

}  // namespace inkwell::campaign
