#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <doctest/doctest.h>

#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/page.hpp"
#include "host/lab/campaign/result.hpp"

namespace inkwell::tests {

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the summary page and all detail pages as one text.
inline std::string pages_of(const std::filesystem::path& summary) {
  std::string text = content_of(summary);
  for (const char* name : {"hand.md", "undetected.md", "second-fault.md", "by-situation.md"})
    text += "\n## \n" + content_of(campaign::folder_of_details(summary) / name);
  return text + "\n## \n";
}

/// Result of an undetected case.
inline campaign::Result seen(const std::string& fault, const std::string& situation, unsigned phase) {
  for (const campaign::Case& c : campaign::all_cases())
    if (c.fault.name() == fault && campaign::name_of(c.situation) == situation && c.phase == phase)
      return {.number = c.number,
              .fault = c.fault,
              .situation = c.situation,
              .phase = phase,
              .bridges_were_on = campaign::is_active(c.situation),
              .force_limit_N = 3.3,
              .recovery = campaign::Recovery::none_needed};
  FAIL("there is no such case: ", fault);
  return {};
}

}  // namespace inkwell::tests
