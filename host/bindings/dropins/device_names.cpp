#include "host/bindings/dropins/device_names.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace inkwell::dropins {
namespace {

constexpr std::string_view optional_words[] = {"phantom", "omni", "touch", "device", "arm"};

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::string without_optional_words(std::string_view name) {
  std::istringstream words(lower_case(name));
  std::string kept;
  for (std::string word; words >> word;)
    if (std::ranges::find(optional_words, word) == std::end(optional_words)) kept += (kept.empty() ? "" : " ") + word;
  return kept;
}

void require_names(inkwell_result result) {
  if (result != INKWELL_OK) throw std::runtime_error(inkwell_error_text());
}

}  // namespace

std::vector<inkwell_named_arm> list_names() {
  std::size_t count = 0;
  require_names(inkwell_list_names(nullptr, 0, &count));
  std::vector<inkwell_named_arm> names(count);
  require_names(inkwell_list_names(names.data(), names.size(), &count));
  names.resize(std::min(count, names.size()));
  return names;
}

ConfiguredArm configured_arm(const std::vector<inkwell_named_arm>& names) {
  const char* const configured = std::getenv("INKWELL_DEVICE");
  if (configured == nullptr) return {};
  const auto* named = find_name(names, configured);
  return named == nullptr ? ConfiguredArm{configured} : ConfiguredArm{named->address, true};
}

const inkwell_named_arm* find_name(const std::vector<inkwell_named_arm>& names, std::string_view name) {
  const auto found =
      std::ranges::find_if(names, [&](const auto& each) { return lower_case(each.name) == lower_case(name); });
  return found == names.end() ? nullptr : &*found;
}

std::string bound_address(const std::vector<inkwell_named_arm>& names, std::string_view device_name) {
  if (names.empty()) return {};
  const auto* found = find_name(names, device_name);
  if (found == nullptr) found = find_name(names, without_optional_words(device_name));
  if (found != nullptr) return found->address;
  std::string known;
  for (const auto& each : names) known += (known.empty() ? "" : ", ") + std::string(each.name);
  throw std::runtime_error(
      fmt::format("There is no arm with the name {}. Known names: {}. Bind the name with `inkwell arms bind`, or "
                  "select one arm for "
                  "all names with INKWELL_DEVICE.",
                  device_name, known));
}

}  // namespace inkwell::dropins
