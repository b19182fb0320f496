#include "host/lab/campaign/result.hpp"

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
#include "host/client/local/text_file.hpp"
#include "host/client/recording/write_text.hpp"

/// Writes null for std::nullopt.
template <>
struct nlohmann::adl_serializer<std::optional<double>> {
  static void to_json(json& out, const std::optional<double>& value) { out = value ? json(*value) : json(); }
  static void from_json(const json& in, std::optional<double>& value) {
    value = in.is_null() ? std::nullopt : std::optional(in.get<double>());
  }
};

/// Writes an empty string for Fault::none.
template <>
struct nlohmann::adl_serializer<inkwell::protocol::Fault> {
  static void to_json(json& out, inkwell::protocol::Fault fault) { out = inkwell::campaign::name_of_reported(fault); }
  static void from_json(const json& in, inkwell::protocol::Fault& fault) {
    const auto& name = in.get_ref<const std::string&>();
    const auto row = std::ranges::find(inkwell::protocol::fault_table, name, &inkwell::protocol::CodeInfo::name);
    if (!name.empty() && row == inkwell::protocol::fault_table.end())
      throw inkwell::device::Error(
          fmt::format("This file is not a result of this version: the firmware has no fault `{}`. Remove it, and run "
                      "the case again.",
                      name));
    fault = name.empty() ? inkwell::protocol::Fault::none : static_cast<inkwell::protocol::Fault>(row->code);
  }
};

namespace inkwell::campaign {
namespace {

constexpr std::string_view name_of_restart = "restart", name_of_force_off = "force off";

}  // namespace

static void to_json(nlohmann::json& out, const CaseFault& fault) { out = fault.name(); }
static void from_json(const nlohmann::json& in, CaseFault& fault) {
  const auto& name = in.get_ref<const std::string&>();
  const auto found = find_fault(name);
  if (!found)
    throw device::Error(fmt::format(
        "This file is the result of the fault `{}`, which this version does not inject. Remove the file, and "
        "run the missing cases.",
        name));
  fault = *found;
}

static void to_json(nlohmann::json& out, CaseSituation situation) { out = name_of(situation); }
static void from_json(const nlohmann::json& in, CaseSituation& situation) {
  const auto& name = in.get_ref<const std::string&>();
  const auto found = find_situation(name);
  if (!found)
    throw device::Error(
        fmt::format("This file is the result of the situation `{}`, which this version does not have. Remove the file, "
                    "and run the missing cases.",
                    name));
  situation = *found;
}

static void to_json(nlohmann::json& out, const NoticedInUse& noticed) { out = name_of(noticed); }
static void from_json(const nlohmann::json& in, NoticedInUse& noticed) {
  using enum NoticedInUse::By;
  const auto& name = in.get_ref<const std::string&>();
  noticed = {};
  if (name == name_of_restart)
    noticed.by = restart;
  else if (name == name_of_force_off)
    noticed.by = force_off;
  else if (!name.empty())
    noticed = {NoticedInUse::By::fault, in.get<protocol::Fault>()};
}

static void to_json(nlohmann::json& out, Recovery recovery) { out = name_of(recovery); }
static void from_json(const nlohmann::json& in, Recovery& recovery) {
  using enum Recovery;
  const auto& name = in.get_ref<const std::string&>();
  for (const Recovery each : {unknown, none_needed, clear_fault, force_on_again, board_reset, not_recovered})
    if (name_of(each) == name) {
      recovery = each;
      return;
    }
  throw device::Error(
      fmt::format("This file is not a result of this version: there is no recovery `{}`. Remove it, and run the case "
                  "again.",
                  name));
}

NLOHMANN_JSON_SERIALIZE_ENUM(FirstFault, {{FirstFault::none, "none"},
                                          {FirstFault::reported, "told"},
                                          {FirstFault::black_box, "black_box"},
                                          {FirstFault::lost, "lost"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Result, number, fault, situation, phase, error, injected_at_s, location,
                                   bridges_were_on, off_after_s, bridges_went_on, detected_as, fault_on_healing,
                                   told_before, first_fault, told_once_cleared, restarts, locked_up, missed_boot_loader,
                                   force_limit_N, peak_force_N, energy_J, travel_m, noticed_in_use_as, noticed_in_use_s,
                                   peak_force_in_use_N, energy_in_use_J, recovery, position_error_m)

namespace {

/// Checks the counts, because the conversion of a number out of range is undefined.
void require_counts(const nlohmann::json& result) {
  for (const char* name : {"number", "phase", "restarts"}) {
    const auto& value = result.at(name);
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<unsigned>::max())
      throw device::Error(fmt::format("This file is not a result: {} is {}, which is not a count. Run the case again.",
                                      name, value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
  }
}

/// Results of earlier versions contain the location under the key `place`.
void rename_old_key(nlohmann::json& result) {
  if (const auto old = result.find("place"); old != result.end() && !result.contains("location"))
    result["location"] = *old;
}

}  // namespace

std::string_view name_of(Recovery recovery) {
  switch (recovery) {
    case Recovery::unknown: return "";
    case Recovery::none_needed: return "none needed";
    case Recovery::clear_fault: return "clear_fault";
    case Recovery::force_on_again: return "force on again";
    case Recovery::board_reset: return "board reset";
    case Recovery::not_recovered: return "not recovered";
  }
  return "";
}

std::string_view name_of(const NoticedInUse& noticed) {
  switch (noticed.by) {
    case NoticedInUse::By::nothing: return "";
    case NoticedInUse::By::fault: return protocol::info(noticed.fault).name;
    case NoticedInUse::By::restart: return name_of_restart;
    case NoticedInUse::By::force_off: return name_of_force_off;
  }
  return "";
}

std::string_view name_of_reported(protocol::Fault fault) {
  return fault == protocol::Fault::none ? std::string_view() : protocol::info(fault).name;
}

bool is_detected(const Result& result) {
  return result.detected_as != protocol::Fault::none || result.told_once_cleared != protocol::Fault::none ||
         result.restarts > 0;
}

bool is_unnoticed(const Result& result) { return !is_detected(result) && !result.off_after_s; }

std::string fault_text(const Result& result) {
  std::vector<std::string_view> parts;
  const std::string later = fmt::format("{} after clearing", name_of_reported(result.told_once_cleared));
  if (result.detected_as != protocol::Fault::none) parts.push_back(name_of_reported(result.detected_as));
  if (result.told_once_cleared != protocol::Fault::none) parts.push_back(later);
  if (result.restarts > 0) parts.push_back("restart");
  if (result.locked_up) parts.push_back("lock-up");
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string text_of(const Result& result) { return nlohmann::json(result).dump(2) + "\n"; }

Result parse_result(const std::string& text) {
  try {
    auto result = device::parse_plain_json(text);
    require_counts(result);
    rename_old_key(result);
    return result.get<Result>();
  } catch (const nlohmann::json::exception& error) {
    const std::string_view reason = error.what();  // starts with an error number in brackets
    throw device::Error(fmt::format("This file is not a result of this version: {}. Remove it, and run the case again.",
                                    reason.substr(std::min(reason.size(), reason.find("] ") + 2))));
  }
}

std::filesystem::path file_of(const std::filesystem::path& directory, unsigned number) {
  return directory / fmt::format("case-{:05}.json", number);
}

void save(const Result& result, const std::filesystem::path& directory) {
  recording::write_text(file_of(directory, result.number), text_of(result));
}

std::vector<Result> load_all(const std::filesystem::path& directory) {
  std::error_code code;
  const auto cases = all_cases();
  std::vector<Result> results;
  for (const auto& entry : std::filesystem::directory_iterator(directory, code)) {
    // A second extension belongs to an unfinished file of another process.
    if (!local::has_extension(entry.path(), ".json") || entry.path().stem().has_extension()) continue;
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    try {
      results.push_back(parse_result(text));
      const Result& result = results.back();
      const std::string name = Case{result.number, result.fault, result.situation, result.phase}.name();
      if (result.number == 0 || result.number > cases.size() || cases[result.number - 1].name() != name)
        throw device::Error(
            fmt::format("This file is the result of `{}`, which is not the case with this number in this version. "
                        "Remove the file, and run the missing cases.",
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
