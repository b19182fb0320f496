#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <doctest/doctest.h>

#include <campaign/cases.hpp>
#include <campaign/result.hpp>

namespace inkwell::tests {

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Result of an undetected case.
inline campaign::Result seen(const std::string& fault, const std::string& situation, unsigned phase) {
  for (const campaign::Case& c : campaign::all_cases())
    if (c.fault.name() == fault && campaign::name_of(c.situation) == situation && c.phase == phase)
      return {.number = c.number,
              .fault = fault,
              .situation = situation,
              .phase = phase,
              .bridges_were_on = campaign::is_active(c.situation),
              .force_limit_N = 3.3,
              .recovery = "none needed"};
  FAIL("there is no such case: ", fault);
  return {};
}

}  // namespace inkwell::tests
