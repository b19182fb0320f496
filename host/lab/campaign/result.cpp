#include "host/lab/campaign/result.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "host/client/device/error.hpp"
#include "host/client/device/plain_json.hpp"
#include "host/client/recording/write_text.hpp"

/// A number, or null for std::nullopt.
template <>
struct nlohmann::adl_serializer<std::optional<double>> {
  static void to_json(json& out, const std::optional<double>& value) { out = value ? json(*value) : json(); }
  static void from_json(const json& in, std::optional<double>& value) {
    value = in.is_null() ? std::nullopt : std::optional(in.get<double>());
  }
};

namespace inkwell::campaign {

NLOHMANN_JSON_SERIALIZE_ENUM(FirstFault, {{FirstFault::none, "none"},
                                          {FirstFault::reported, "told"},
                                          {FirstFault::black_box, "black_box"},
                                          {FirstFault::lost, "lost"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Result, number, fault, situation, phase, error, injected_at_s, place,
                                   bridges_were_on, off_after_s, bridges_went_on, detected_as, fault_on_healing,
                                   told_before, first_fault, told_once_cleared, restarts, locked_up, missed_boot_loader,
                                   force_limit_N, peak_force_N, energy_J, travel_m, noticed_in_use_as, noticed_in_use_s,
                                   peak_force_in_use_N, energy_in_use_J, recovery, position_error_m)

namespace {

/// The library converts any number to unsigned, which is undefined for values out of range.
void require_counts(const nlohmann::json& result) {
  for (const char* name : {"number", "phase", "restarts"}) {
    const auto& value = result.at(name);
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<unsigned>::max())
      throw device::Error(fmt::format("This is no result of a case: {} is {}, which is no count. Run the case again.",
                                      name, value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
  }
}

}  // namespace

bool is_detected(const Result& result) {
  return !result.detected_as.empty() || !result.told_once_cleared.empty() || result.restarts > 0;
}

bool is_unnoticed(const Result& result) { return !is_detected(result) && !result.off_after_s; }

std::string fault_text(const Result& result) {
  std::vector<std::string_view> parts;
  const std::string later = result.told_once_cleared + " after clearing";
  if (!result.detected_as.empty()) parts.push_back(result.detected_as);
  if (!result.told_once_cleared.empty()) parts.push_back(later);
  if (result.restarts > 0) parts.push_back("restart");
  if (result.locked_up) parts.push_back("lock-up");
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string text_of(const Result& result) { return nlohmann::json(result).dump(2) + "\n"; }

Result parse_result(const std::string& text) {
  try {
    const auto result = device::parse_plain_json(text);
    require_counts(result);
    return result.get<Result>();
  } catch (const nlohmann::json::exception& error) {
    const std::string_view reason = error.what();  // starts with an error number in brackets
    throw device::Error(
        fmt::format("This is no result of a case by this version: {}. Remove it, and run the case again.",
                    reason.substr(std::min(reason.size(), reason.find("] ") + 2))));
  }
}

std::filesystem::path file_of(const std::filesystem::path& directory, unsigned number) {
  return directory / fmt::format("case-{:05}.json", number);
}

void save(const Result& result, const std::filesystem::path& directory) {
  const auto file = file_of(directory, result.number);
  // Programs on several machines may write to the folder at the same time.
  auto unfinished = file;
  unfinished += fmt::format(".{}.part", ::getpid());
  recording::write_text(unfinished, text_of(result));
  std::error_code code;
  std::filesystem::rename(unfinished, file, code);
  if (code) throw device::Error(fmt::format("{} cannot be written: {}", file.string(), code.message()));
}

std::vector<Result> load_all(const std::filesystem::path& directory) {
  std::error_code code;
  const auto cases = all_cases();
  std::vector<Result> results;
  for (const auto& entry : std::filesystem::directory_iterator(directory, code)) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    try {
      results.push_back(parse_result(text));
      const Result& result = results.back();
      const std::string name = fmt::format("{} {} {}", result.fault, result.situation, result.phase);
      if (result.number == 0 || result.number > cases.size() || cases[result.number - 1].name() != name)
        throw device::Error(
            fmt::format("This is the result of `{}`, which is no case of that number in this version. Remove it, and "
                        "run the missing cases.",
                        name));
    } catch (const device::Error& error) {
      throw device::Error(fmt::format("{}: {}", entry.path().string(), error.what()));
    }
  }
  if (code) throw device::Error(fmt::format("The folder {} cannot be read: {}", directory.string(), code.message()));
  std::ranges::sort(results, {}, &Result::number);
  return results;
}

}  // namespace inkwell::campaign
